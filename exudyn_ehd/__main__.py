"""Compile kernels ahead, for images and continuous integration: ``python -m exudyn_ehd [film|elrod|bush|all]``.

A group is a short run whose kernels are compiled into numba's cache. Groups share kernels: what one has compiled the
next one reads.
"""

from __future__ import annotations

import sys
import time
from dataclasses import replace

import exudyn as exu
from exudyn.utilities import InertiaCylinder

import exudyn_ehd as ehd
from exudyn_ehd.compilation import COMPILATIONS
from exudyn_ehd.progress import without_lines

FILM = ehd.JournalBearing(
    journal_radius=0.01, length=0.02, radial_clearance=20e-6, lubricant=ehd.Lubricant(viscosity=0.02)
)
GROUPS = {
    "film": FILM,
    "elrod": replace(FILM, cavitation=ehd.ElrodAdams(cavity_pressure=-1e5)),
    "bush": replace(
        FILM,
        bush=ehd.ModalBush(
            mesh=ehd.HollowCylinder(
                inner_radius=0.01, thickness=0.004, length=0.02, axial=2, radial=1, circumferential=24
            ),
            material=ehd.SaintVenantKirchhoff(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7800.0),
        ),
    ),
}
"""Bearing of every group."""


def run_bodies(bearing: ehd.JournalBearing) -> None:
    """Run two steps of a journal in a free housing."""
    container = exu.SystemContainer()
    system = container.AddSystem()
    inertia = InertiaCylinder(7800.0, 0.1, 0.01, 2)
    bodies = [system.CreateRigidBody(inertia=inertia, initialAngularVelocity=[0.0, 0.0, w]) for w in (1.0, 314.0)]
    ehd.CreateLubricatedJoint(system, "film", bodies, [0.0, 0.0, 0.0], [0.0, 0.0, 1.0], bearing)
    system.Assemble()
    settings = exu.SimulationSettings()
    settings.timeIntegration.numberOfSteps, settings.timeIntegration.endTime = 2, 1e-5
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    ehd.ConfigureSolver(settings)
    ehd.SolveDynamic(system, settings)


def run(group: str) -> None:
    """Run a steady film of a group, and two steps of its joint."""
    ehd.steady(GROUPS[group], speed=314.0, eccentricity_ratio=0.5)
    run_bodies(GROUPS[group])


def main(arguments: list[str]) -> None:
    """Compile the groups named, all without a name.

    Raises
    ------
    SystemExit
        For a name that is no group.
    """
    names = [*GROUPS] if arguments in ([], ["all"]) else arguments
    if unknown := [name for name in names if name not in GROUPS]:
        raise SystemExit(f"python -m exudyn_ehd: no group {unknown[0]!r}; give {', '.join(GROUPS)} or all.")
    for name in names:
        before, start = COMPILATIONS.count, time.perf_counter()
        with without_lines():
            run(name)
        found, duration = COMPILATIONS.count - before, time.perf_counter() - start
        print(
            f"{name}: " + (f"{found} kernels compiled in {duration:.0f} s" if found else "all kernels are in the cache")
        )


if __name__ == "__main__":
    main(sys.argv[1:])
