"""The gradients of the balances against the way through fields, for films that have both (not on liners)."""

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.joint.model.build import build_model
from exudyn_ehd.joint.tangent.wrench import balance_gradients, field_gradient

CLEARANCE = 50e-6
MOTION = np.array([0.5 * CLEARANCE, 0.4 * CLEARANCE, 1e-4, -2e-4, 2e-3, -1e-3, 3e-2, 1e-2, 300.0, 0.5])
EFFECTS = {
    "none": {},
    "short": {"film": ehd.ShortBearing(n_theta=48)},
    "no squeeze": {"squeeze": False},
    "wall": {"contact": ehd.RegularisedWall(onset=0.5 * CLEARANCE, pressure=1e7)},
    "roughness": {"roughness": ehd.PatirCheng(composite_roughness=5e-6)},
    "rough contact": {
        "roughness": ehd.PatirCheng(composite_roughness=5e-6),
        "asperity": ehd.GreenwoodTripp(composite_roughness=5e-6, composite_modulus=1e10),
    },
    "shear thinning": {
        "lubricant": ehd.Lubricant(viscosity=0.02, shear_law=ehd.CarreauShear(relaxation_time=2e-6, exponent=0.8))
    },
    "turbulent": {"turbulence": ehd.Hirs(onset=8.0, full=24.0, coefficient=2.0)},
    "density": {"lubricant": ehd.Lubricant(viscosity=0.02, density_law=ehd.DowsonHigginson())},
}


@pytest.mark.parametrize("effect", EFFECTS)
@pytest.mark.parametrize("remembered", [True, False])
@pytest.mark.parametrize(
    "cavitation",
    [ehd.FullSommerfeld(), ehd.Gumbel(), ehd.SwiftStieber(), ehd.ElrodAdams(cavity_pressure=-1e5)],
    ids=lambda closure: type(closure).__name__,
)
def test_gradients_are_the_sums_of_the_fields(cavitation, effect, remembered):
    options = {"lubricant": ehd.Lubricant(viscosity=0.02), "film": ehd.FiniteLength(n_theta=48, n_z=8)} | EFFECTS[
        effect
    ]
    model = build_model(
        ehd.JournalBearing(
            journal_radius=0.025,
            length=0.05,
            radial_clearance=CLEARANCE,
            cavitation=cavitation,
            end_pressures=(1e4, 5e4),
            **options,
        )
    )
    history = model.initial_history(0.99 * MOTION) if remembered else None
    film = model.evaluate(MOTION, history, 1e-4).film
    rng = np.random.default_rng(1)
    rows, expected = rng.normal(size=(3, model.solver.work.count)), np.zeros((3, 10))
    field_gradient(film, model.solver.adjoint(rows), expected)
    got = -(rows @ balance_gradients(film).T)
    # the same sums in another order
    assert np.allclose(got, expected, rtol=1e-10, atol=1e-11 * np.abs(expected).max(axis=0))
