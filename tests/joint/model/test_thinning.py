"""Films that thin by their own flow: random states of every closure converge from any start, with exact tangents."""

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.joint.model.build import build_model

R, C = 0.025, 25e-6
CLOSURES = [ehd.SwiftStieber(), ehd.Gumbel(), ehd.FullSommerfeld(), ehd.ElrodAdams()]
SIZES = np.array([C, C, C / R, C / R, 500.0 * C, 500.0 * C, 500.0 * C / R, 500.0 * C / R, 500.0, 1.0])


def _scene(rng, closure):
    """A bearing and a motion: hardly thinning to a power law, thick and thin films, tilted, turning or squeezed."""
    law = ehd.CarreauShear(
        relaxation_time=10.0 ** rng.uniform(-9, -4), exponent=rng.uniform(0.4, 1.0), residual=rng.choice([0.0, 0.3])
    )
    b = ehd.JournalBearing(
        journal_radius=R, length=0.05, radial_clearance=C, cavitation=closure, end_pressures=(1e4, 2e4),
        lubricant=ehd.Lubricant(viscosity=0.03, shear_law=law), film=ehd.FiniteLength(n_theta=32, n_z=6),
    )  # fmt: skip
    eps, angle = rng.uniform(0.1, 0.95), rng.uniform(0.0, 2.0 * np.pi)
    tilt = rng.uniform(-0.4, 0.4, 2) * (1.0 - eps) * C / 0.025
    # oil that is carried turns round where the journal does: a bend, at which there is no tangent
    speed = rng.choice([-1.0, 1.0] if closure.conserves_mass else [-1.0, 0.0, 1.0]) * 10.0 ** rng.uniform(0.0, 3.0)
    rates = 100.0 * C * rng.normal(size=2)
    at = eps * C * np.array([np.cos(angle), np.sin(angle)])
    return build_model(b), np.array([*at, *tilt, *rates, 0.0, 0.0, speed, 0.1])


@pytest.mark.slow
@pytest.mark.parametrize("closure", CLOSURES, ids=lambda c: type(c).__name__)
def test_random_states(closure):
    rng = np.random.default_rng(11)
    for _ in range(8):
        model, motion = _scene(rng, closure)
        history, step = model.initial_history(motion), 1e-4
        found = model.evaluate(motion, history, step)
        assert found.status is ehd.Status.CONVERGED
        tangent = found.tangent()
        model.evaluate(np.array([0.3 * C, -0.2 * C, *np.zeros(6), 100.0, 0.0]), history, step)
        again = model.evaluate(motion, history, step).wrench
        np.testing.assert_allclose(again, found.wrench, atol=1e-10 * np.abs(found.wrench[:3]).max())
        change = np.empty((6, 10))
        for k, size in enumerate(1e-6 * SIZES):
            ends = [model.evaluate(motion + s * size * np.eye(10)[k], history, step).wrench for s in (-1.0, 1.0)]
            change[:, k] = 0.5 * (ends[1] - ends[0])
        scale = np.abs(change).max(axis=1, keepdims=True)
        np.testing.assert_allclose(tangent * 1e-6 * SIZES / scale, change / scale, atol=1e-6)
