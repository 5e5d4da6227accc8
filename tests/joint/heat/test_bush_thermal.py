"""Steady films that heat up on a flexible bore: temperature and bore settle together."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

import exudyn_ehd as ehd
from tests.sampling import sample

MESH = ehd.HollowCylinder(inner_radius=0.03, thickness=0.02, length=0.066, axial=2, radial=1, circumferential=12)
OIL = ehd.oil("ISO VG 46")
EFFECTS = {
    "lumped": ehd.LumpedThermal(supply_temperature=313.15),
    "field": ehd.FilmEnergy(supply_temperature=313.15, bush_coefficient=5e3),
}


def solve(bush, thermal=None, lubricant=OIL):
    bearing = ehd.JournalBearing(
        journal_radius=0.03,
        length=0.066,
        radial_clearance=30e-6,
        lubricant=lubricant,
        bush=bush,
        thermal=thermal,
        film=ehd.FiniteLength(n_theta=48, n_z=8),
    )
    return ehd.steady(bearing, speed=300.0, eccentricity_ratio=0.8, tilt=(0.0, 5e-5))


def modal(modulus):
    material = ehd.SaintVenantKirchhoff(youngs_modulus=modulus, poisson_ratio=0.3, density=7800.0)
    return ehd.ModalBush(mesh=MESH, material=material, tolerance=0.2)


@pytest.mark.slow
def test_film_at_the_settled_temperature_is_the_isothermal_film_of_its_viscosity():
    hot = solve(modal(2.1e11), EFFECTS["lumped"])
    assert hot.temperature > 313.15 + 1.0
    viscosity = OIL.temperature_law.viscosity(np.asarray(hot.temperature), OIL.density)
    same = solve(modal(2.1e11), lubricant=ehd.Lubricant(viscosity=float(viscosity)))
    # temperature and bore are settled to 1e-11
    assert hot.peak_pressure == pytest.approx(same.peak_pressure, rel=1e-8)
    assert hot.minimum_gap == pytest.approx(same.minimum_gap, rel=1e-8)


@pytest.mark.parametrize("effect", sample(EFFECTS, 1))
def test_a_stiff_bush_tends_to_the_rigid_bore_at_first_order(effect):
    rigid = solve(None, EFFECTS[effect])
    changes = [
        np.array(
            [1.0 - film.peak_pressure / rigid.peak_pressure, np.mean(film.temperature) - np.mean(rigid.temperature)]
        )
        for film in (solve(modal(E), EFFECTS[effect]) for E in (2.1e13, 2.1e14))
    ]
    # ratio 10 to the next order, 1 % of the softer bush
    assert np.allclose(changes[0] / changes[1], 10.0, rtol=0.05)


def test_equilibrium_takes_both():
    bearing = ehd.JournalBearing(
        journal_radius=0.03,
        length=0.066,
        radial_clearance=30e-6,
        lubricant=OIL,
        bush=modal(2.1e11),
        thermal=EFFECTS["lumped"],
        film=ehd.FiniteLength(n_theta=48, n_z=8),
    )
    eq = ehd.equilibrium(bearing, speed=300.0, load=(0.0, -30e3))
    assert np.allclose(eq.film.force[:2], (0.0, 30e3), atol=1e-4)
    cold = ehd.equilibrium(dataclasses.replace(bearing, thermal=None), speed=300.0, load=(0.0, -30e3))
    assert eq.eccentricity_ratio != pytest.approx(cold.eccentricity_ratio, rel=1e-3)
