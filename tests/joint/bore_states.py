"""Bearings with a flexible bore and smooth states of them, shared by the tests of their tangents."""

from __future__ import annotations

import numpy as np

import exudyn_ehd as ehd

STEEL = ehd.SaintVenantKirchhoff(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7800.0)
CYLINDER = ehd.HollowCylinder(inner_radius=0.03, thickness=0.02, length=0.066, axial=2, radial=1, circumferential=12)
BUSHES = {
    "modal": ehd.ModalBush(mesh=CYLINDER, material=STEEL, tolerance=0.2),
    "nodal": ehd.ANCFBush(mesh=CYLINDER, material=STEEL),
}
_MESH = CYLINDER.mesh()
FOOT = ehd.ModalBush(
    mesh=ehd.mesh_from_arrays(
        _MESH.nodes,
        _MESH.elements,
        bore_radius=0.03,
        held=lambda x: (np.hypot(*x[:, :2].T) > 0.0499) & (x[:, 0] > 0.03),
    ),
    material=STEEL,
    tolerance=0.2,
)
OPTIONS = {
    "swift": {},
    "line in its cells": {"cavitation": ehd.SwiftStieber(line_in_cells=True)},
    "gumbel": {"cavitation": ehd.Gumbel(cavity_shear=0.3)},
    "gumbel in cells": {"cavitation": ehd.Gumbel(cavity_shear=0.3, line_in_cells=True)},
    "full": {"cavitation": ehd.FullSommerfeld()},
    "elrod": {"cavitation": ehd.ElrodAdams(cavity_pressure=-1e5)},
    "elrod in cells": {"cavitation": ehd.ElrodAdams(cavity_pressure=-1e5, line_in_cells=True)},
    "short": {"film": ehd.ShortBearing(n_theta=32, n_z=6)},
    "ends": {"end_pressures": (3e5, 1e5)},
    "no squeeze": {"squeeze": False},
    "piezoviscous": {"lubricant": ehd.Lubricant(viscosity=9e-3, pressure_law=ehd.RoelandsPressure(coefficient=1.8e-8))},
    "shear thinning": {
        "lubricant": ehd.Lubricant(viscosity=9e-3, shear_law=ehd.CarreauShear(relaxation_time=1e-6, exponent=0.7))
    },
    "compressible": {"lubricant": ehd.Lubricant(viscosity=9e-3, density_law=ehd.DowsonHigginson())},
    "rough": {"roughness": ehd.PatirCheng(composite_roughness=1e-6)},
    "rough journal": {"roughness": ehd.PatirCheng(composite_roughness=3e-6, pattern=1 / 3, journal_share=1.0)},
    "wall": {"contact": ehd.RegularisedWall(onset=12e-6, pressure=2e7)},
    # Reynolds numbers of 6 to 48 in the film
    "turbulent": {"turbulence": ehd.Hirs(onset=8.0, full=24.0, coefficient=2.0)},
}
C = 30e-6
POCKETS = tuple(
    ehd.Pocket(angle=0.4 + 2.1 * k, width_angle=0.7, length=0.03, supply=feed)
    for k, feed in enumerate(
        (
            ehd.Orifice(diameter=4e-4, supply_pressure=4e6),
            ehd.Capillary(diameter=5e-4, length=0.08, supply_pressure=3e6, compressible_volume=1e-6),
            None,
        )
    )
)
OPTIONS |= {
    f"pockets, {name}": OPTIONS[name] | {"supply": POCKETS}
    for name in (
        *("swift", "gumbel in cells", "full", "elrod in cells", "piezoviscous", "shear thinning", "compressible"),
        *("rough journal", "wall"),
    )
}


def make_bearing(bush, **options):
    given = {
        "journal_radius": 0.03,
        "length": 0.066,
        "radial_clearance": C,
        "lubricant": ehd.Lubricant(viscosity=9e-3),
        "film": ehd.FiniteLength(n_theta=32, n_z=6),
        "bush": bush,
    }
    return ehd.JournalBearing(**(given | options))


def random_motion(k, seed):
    """Eccentric, tilted and moving journal in a bore that bulges by up to a few micrometres, everything moving."""
    rng = np.random.default_rng(seed)
    rigid = [0.6 * C, 0.2 * C, 1e-4, -1.2e-4, 1e-4, -2e-4, 1e-3, 2e-3, 300.0, 0.4]
    return np.concatenate((rigid, 4e-6 / np.sqrt(k) * rng.normal(size=k), 3e-4 / np.sqrt(k) * rng.normal(size=k)))
