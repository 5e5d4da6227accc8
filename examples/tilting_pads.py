"""A rotor runs up in five tilting pads, while the same rotor whirls in a plain bearing.

A rotor of 31 kg a bearing, with its centre of mass 2 um off the axis, runs up from 8000 to 14000 rpm on oil of
0.02 Pa s. Either bearing has 60 mm diameter, 30 mm length and a radial clearance of 60 um; the pads have 60 degrees
each, a preload of 0.3, and the load between two of them.

1. When does the plain bearing whirl? Where its critical mass, which `equilibrium` gives, falls below that of the rotor.
   Beyond that speed the orbit grows, slowly at first, to nearly the whole clearance, with half of the spin's frequency.
2. Why do the pads not? Each of them tilts until its film pushes through its pivot, so that a displacement has no force
   across it. All eigenvalues of rotor and pads, from `TiltingPadResult`'s K, C and M, keep negative real parts.

Run ``python examples/tilting_pads.py``; a picture is written to ``results/tilting_pads``.
"""

from __future__ import annotations

import argparse
import math
import pathlib

import exudyn as exu
import matplotlib.pyplot as plt
import numpy as np
from exudyn.utilities import InertiaMassPoint, RigidBodyInertia

import exudyn_ehd as ehd
from exudyn_ehd.pictures.style import styled

RPM, CLEARANCE, LOAD, ECCENTRICITY = math.pi / 30.0, 60e-6, 300.0, 2e-6
MASS, FIRST, LAST, FILM = LOAD / 9.81, 8000.0, 14000.0, ehd.FiniteLength(n_theta=64, n_z=6)
SIZE = {"journal_radius": 0.03, "length": 0.03, "radial_clearance": CLEARANCE, "film": FILM}
PLAIN = ehd.JournalBearing(**SIZE, lubricant=ehd.Lubricant(viscosity=0.02))
PADS = ehd.TiltingPads(
    **SIZE, lubricant=PLAIN.lubricant, preload=0.3, pad_thickness=0.01, pad_mass=0.06, pad_inertia=6e-6
)
COLOURS = {"plain bearing": "tab:red", "tilting pads": "tab:blue"}


def run_up(name: str, *, duration: float, steps: int) -> tuple[np.ndarray, np.ndarray, list[ehd.LubricatedJoint]]:
    """Time, place of the journal as complex numbers, m, and the joints of a run-up; it starts in equilibrium."""
    first, rise = FIRST * RPM, (LAST - FIRST) * RPM / duration
    mbs = exu.SystemContainer().AddSystem()
    unbalance = InertiaMassPoint(0.1 * MASS).Translated([10.0 * ECCENTRICITY, 0, 0])
    inertia = RigidBodyInertia(0.9 * MASS, 0.02 * np.eye(3)) + unbalance
    rotor = mbs.CreateRigidBody(
        inertia=inertia, initialAngularVelocity=[0, 0, first], nodeType=exu.NodeType.RotationRxyz, gravity=[0, -9.81, 0]
    )
    place = {"name": name, "itemNumbers": [mbs.CreateGround(), rotor], "position": [0, 0, 0], "axis": [0, 0, 1]}
    create = ehd.CreateTiltingPadBearing if name == "tilting pads" else ehd.CreateLubricatedJoint
    bearing = PADS if name == "tilting pads" else PLAIN
    joint = create(mbs, **place, bearing=bearing, axial=ehd.Held(), tilt=ehd.Held())
    mbs.CreateCoordinateConstraint(
        itemNumbers=[None, rotor],
        coordinates=[None, 5],
        offsetUserFunction=lambda mbs, t, item, offset: first * t + 0.5 * rise * t**2,
        offsetUserFunction_t=lambda mbs, t, item, offset: first + rise * t,
    )
    mbs.Assemble()
    joint.place_in_equilibrium(load=(0.0, -LOAD))
    settings = ehd.ConfigureSolver(exu.SimulationSettings(), spectralRadius=0.9)
    settings.timeIntegration.endTime, settings.timeIntegration.numberOfSteps = duration, steps
    ehd.SolveDynamic(mbs, settings)
    history = joint.history
    x, y = (history.position if name == "tilting pads" else history.eccentricity).T
    return history.time, x + 1j * y, list(getattr(joint, "pads", (joint,)))


def growth(rest: ehd.TiltingPadResult) -> float:
    """Largest real part of the eigenvalues of rotor and pads, 1/s."""
    n, M = len(rest.mass), rest.mass + np.diag([MASS, MASS, *np.zeros(len(rest.mass) - 2)])
    A = np.vstack((np.eye(n, 2 * n, n), -np.linalg.solve(M, np.hstack((rest.stiffness, rest.damping)))))
    return float(np.linalg.eigvals(A).real.max())


def amplitude(time: np.ndarray, place: np.ndarray, windows: int = 40) -> tuple[np.ndarray, np.ndarray]:
    """Speed, rpm, and half of the largest extent of the orbit over the clearance in equal parts of the run."""
    parts = np.array_split(np.arange(time.size), windows)
    extent = [max(np.ptp(place[part].real), np.ptp(place[part].imag)) for part in parts]
    speed = FIRST + (LAST - FIRST) * np.array([time[part].mean() for part in parts]) / time[-1]
    return speed, 0.5 * np.array(extent) / CLEARANCE


def spectrum(time: np.ndarray, place: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies over the spin, forward ones positive, and amplitudes over the clearance in the last eighth."""
    part = slice(7 * time.size // 8, None)
    spin = (FIRST + (LAST - FIRST) * time[part].mean() / time[-1]) / 60.0
    window = np.hanning(time[part].size)
    lines = np.fft.fft((place[part] - place[part].mean()) * window, 8 * window.size) / window.sum()
    return np.fft.fftshift(np.fft.fftfreq(lines.size, time[1])) / spin, np.abs(np.fft.fftshift(lines)) / CLEARANCE


@styled(10.0)
def draw(runs: dict, rest: ehd.TiltingPadResult, threshold: float, folder: pathlib.Path) -> None:
    """Pads with their pressures, orbits over the speed, spectra and orbits at the end."""
    fig, axes = plt.subplots(1, 4, figsize=(16, 4.2), layout="constrained")
    for k, film in enumerate(rest.films):
        # displacements a hundred times enlarged
        around, turned = np.exp(1j * film.theta), np.exp(100j * rest.tilts[k])
        pivot = PADS.arm * np.exp(1j * PADS.pivots[k])
        inner, outer = (pivot + turned * (r * around - pivot) for r in (0.03, 0.04))
        axes[0].fill(*(1e3 * np.r_[inner, outer[::-1]].view(float).reshape(-1, 2).T), fc="0.85", ec="0.3")
        axes[0].plot(1e3 * pivot.real, 1e3 * pivot.imag, "k^", ms=6)
        high = (0.03 - 0.008 * film.pressure[:, FILM.n_z // 2] / rest.peak_pressure) * around
        axes[0].fill(*(1e3 * np.r_[inner, high[::-1]].view(float).reshape(-1, 2).T), color="tab:blue", alpha=0.5)
    axes[0].set(aspect="equal", title=f"pads at {LAST:g} rpm, tilts x 100", xlabel="x [mm]", ylabel="y [mm]")
    for name, (time, place, _) in runs.items():
        axes[1].plot(*amplitude(time, place), color=COLOURS[name], label=name)
        axes[2].plot(*spectrum(time, place), color=COLOURS[name])
        late = place[15 * place.size // 16 :] / CLEARANCE
        axes[3].plot(late.real, late.imag, color=COLOURS[name], lw=0.8)
    axes[1].axvline(threshold, color="0.4", ls="--", label="threshold of the plain bearing")
    axes[1].set(xlabel="speed [rpm]", ylabel="amplitude / clearance [-]", title="run-up", ylim=(0, 1))
    axes[1].legend(loc="upper left")
    axes[2].set(
        xlabel="frequency / spin [-]",
        ylabel="amplitude / clearance [-]",
        title="spectra at the end",
        xlim=(-0.5, 1.5),
    )
    axes[3].add_patch(plt.Circle((0.0, 0.0), 1.0, fill=False, ec="0.4"))
    ticks = np.linspace(-1.0, 1.0, 5)
    axes[3].set(xlabel="x / clearance [-]", ylabel="y / clearance [-]", aspect="equal", title="last orbits")
    axes[3].set(xticks=ticks, yticks=ticks)
    fig.savefig(folder / "tilting_pads.png", dpi=85)
    plt.close(fig)


def main(*, quick: bool = False, output: str | pathlib.Path | None = "results/tilting_pads") -> dict[str, float]:
    """Run both rotors up; returns the figures. ``quick``: a faster run-up; ``output``: folder of the picture."""
    speeds = np.linspace(FIRST, LAST, 13)
    masses = [ehd.equilibrium(PLAIN, speed=n * RPM, load=(0.0, -LOAD)).critical_mass for n in speeds]
    threshold = float(np.interp(-MASS, -np.array(masses), speeds))
    rests = [ehd.equilibrium(PADS, speed=n * RPM, load=(0.0, -LOAD)) for n in (FIRST, LAST)]
    duration, steps = (0.5, 2500) if quick else (0.8, 5500)
    runs = {name: run_up(name, duration=duration, steps=steps) for name in COLOURS}
    rows = {"threshold of the plain bearing [rpm]": threshold}
    for name, (time, place, joints) in runs.items():
        frequency, lines = spectrum(time, place)
        rows[f"{name}: largest amplitude / clearance"] = float(amplitude(time, place)[1].max())
        rows[f"{name}: frequency / spin at the end"] = float(frequency[np.argmax(lines)])
        rows[f"{name}: minimum film thickness [um]"] = 1e6 * min(float(j.history.minimum_gap.min()) for j in joints)
        rows[f"{name}: power loss at the end [W]"] = sum(float(j.history.power_loss[-1]) for j in joints)
    rows["tilting pads: largest real part of all eigenvalues [1/s]"] = max(growth(rest) for rest in rests)
    for key, value in rows.items():
        print(f"  {key:58s}{value:12.4g}")
    if output is not None:
        folder = pathlib.Path(output)
        folder.mkdir(parents=True, exist_ok=True)
        draw(runs, rests[1], threshold, folder)
        print(f"picture: {folder / 'tilting_pads.png'}")
    return rows


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="a faster run-up with coarser steps")
    main(quick=parser.parse_args().quick)
