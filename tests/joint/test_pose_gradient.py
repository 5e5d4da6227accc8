"""The one-sweep gradient of the plain film against the way through fields."""

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.film.pose_gradient import plain_pose_gradient
from exudyn_ehd.joint.build import build_model
from exudyn_ehd.joint.gradients import field_gradient, is_plain

CLEARANCE = 50e-6
MOTION = np.array([0.5 * CLEARANCE, 0.4 * CLEARANCE, 1e-4, -2e-4, 2e-3, -1e-3, 3e-2, 1e-2, 300.0, 0.5])


@pytest.mark.parametrize("squeeze", [True, False])
@pytest.mark.parametrize("film", [ehd.FiniteLength(n_theta=48, n_z=8), ehd.ShortBearing(n_theta=48)])
@pytest.mark.parametrize("cavitation", [ehd.FullSommerfeld(), ehd.Gumbel(), ehd.SwiftStieber()])
def test_sweep_is_the_sum_of_the_fields(cavitation, film, squeeze):
    bearing = ehd.JournalBearing(
        journal_radius=0.025, length=0.05, radial_clearance=CLEARANCE, lubricant=ehd.Lubricant(viscosity=0.02),
        film=film, cavitation=cavitation, squeeze=squeeze, end_pressures=(1e4, 5e4),
    )  # fmt: skip
    model = build_model(bearing)
    model.evaluate(MOTION)
    assert is_plain(model)
    s, g = model.solver, model.grid
    rng = np.random.default_rng(1)
    lam = s.adjoint(rng.normal(size=(3, s.work.count)))
    expected = np.zeros((3, 10))
    field_gradient(model, lam, expected)
    got = np.empty((3, 10))
    plain_pose_gradient(
        lam, s.system.linear_pressure, s.H, s.HF, model.cos_x, model.sin_x, model.cos_f, model.sin_f, g.z, s.vx, s.vz,
        s.flow_x, float(s.squeeze), g.width_x, g.width_z, g.link_x, g.link_z, got,
    )  # fmt: skip
    # the same sums in another order
    assert np.allclose(got, expected, rtol=1e-11, atol=1e-11 * np.abs(expected).max())
