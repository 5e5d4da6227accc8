"""A rotor in Exudyn with every lubricant law and thermal effect: Newton's iterations stay those of the plain film."""

import dataclasses

import numpy as np
import pytest
import scenes

import exudyn_ehd as ehd
from tests.sampling import sample

SPEED, STEPS = 300.0, 150
OIL = ehd.oil("ISO VG 46", temperature=330.0)
ROELANDS = ehd.RoelandsPressure(coefficient=2e-8)
CARREAU = ehd.CarreauShear(relaxation_time=1e-6, exponent=0.6, residual=0.2)
FIELD = ehd.FilmEnergy(supply_temperature=330.0, bush_coefficient=1e3)
EFFECTS = {
    "barus": ({"pressure_law": ehd.BarusPressure(coefficient=2e-8)}, None),
    "roelands": ({"pressure_law": ROELANDS}, None),
    "carreau": ({"shear_law": CARREAU}, None),
    "density": ({"density_law": ehd.DowsonHigginson(coefficient=3e-9)}, None),
    "density and roelands": ({"density_law": ehd.DowsonHigginson(), "pressure_law": ROELANDS}, None),
    "lumped": ({}, ehd.LumpedThermal(supply_temperature=330.0)),
    "field": ({}, FIELD),
    "all": ({"pressure_law": ROELANDS, "shear_law": CARREAU}, FIELD),
}


def run(laws, thermal, cavitation):
    bearing = ehd.JournalBearing(
        journal_radius=0.02,
        length=0.02,
        radial_clearance=20e-6,
        lubricant=dataclasses.replace(OIL, **laws),
        thermal=thermal,
        cavitation=cavitation,
        end_pressures=(1e5, 1e5),
        film=ehd.FiniteLength(n_theta=48, n_z=8),
    )
    mbs = scenes.new_system()
    ground = scenes.add_body(mbs, "ground")
    body = scenes.add_body(mbs, "RotVec", spin=(0, 0, SPEED), gravity=[0, -500.0, 0])
    joint = ehd.CreateLubricatedJoint(mbs, "rotor", [ground, body], [0, 0, 0], [0, 0, 1], bearing)
    mbs.Assemble()
    mbs.SolveDynamic(ehd.ConfigureSolver(scenes.settings(0.015, STEPS)))
    return mbs.sys["dynamicSolver"].it.newtonStepsCount, joint


@pytest.fixture(
    scope="module", params=[ehd.SwiftStieber(), ehd.ElrodAdams(cavity_pressure=-1e5)], ids=["swift", "elrod"]
)
def plain(request):
    return request.param, *run({}, None, request.param)


@pytest.mark.parametrize("name", sample(list(EFFECTS), 0))
def test_run_with_every_law(name, plain):
    cavitation, expected, reference = plain
    iterations, joint = run(*EFFECTS[name], cavitation)
    print(
        f"{name} {type(cavitation).__name__}: {iterations / STEPS:.2f} iterations per step, plain "
        f"{expected / STEPS:.2f}"
    )
    # a quarter of an iteration more: piezoviscosity makes the film more nonlinear where the cavity moves
    assert iterations <= expected + 0.25 * STEPS
    orbit, plain_orbit = np.asarray(joint.history.eccentricity), np.asarray(reference.history.eccentricity)
    assert orbit.shape == plain_orbit.shape
    assert np.abs(orbit - plain_orbit).max() > 1e-9  # the law shows
    if joint.element.model.effects.thermal is not None:
        assert 330.0 < joint.history.peak_temperature[-1] < 400.0  # it warms up, step by accepted step
