"""Films on a liner whose pressures are next to nothing: a journal that is centred, or nearly so."""

from __future__ import annotations

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.joint.model.build import build_model

CLEARANCE = 25e-6
CLOSURES = [ehd.FullSommerfeld(), ehd.Gumbel(), ehd.SwiftStieber(), ehd.ElrodAdams()]


def bearing(cavitation, **options):
    return ehd.JournalBearing(
        journal_radius=0.02,
        length=0.02,
        radial_clearance=CLEARANCE,
        lubricant=ehd.Lubricant(viscosity=0.015),
        film=ehd.FiniteLength(n_theta=48, n_z=4),
        cavitation=cavitation,
        bush=ehd.ElasticLiner(thickness=2e-3, youngs_modulus=1e9),
        **options,
    )


@pytest.mark.parametrize("contact", [None, ehd.RegularisedWall(onset=2e-6)], ids=["plain", "contact"])
@pytest.mark.parametrize("cavitation", CLOSURES, ids=lambda c: type(c).__name__)
def test_a_journal_centred_but_for_rounding_has_a_film(cavitation, contact):
    made = bearing(cavitation, contact=contact)
    rng = np.random.default_rng(1)
    for k in range(30):
        motion = np.zeros(10)
        motion[:2] = rng.normal(size=2) * 10.0 ** rng.uniform(-22, -12)
        if k % 3 == 1:
            motion[4:6] = rng.normal(size=2) * 10.0 ** rng.uniform(-20, -14)
        motion[8] = rng.choice([-1, 1]) * rng.uniform(10.0, 300.0)
        model = build_model(made)
        found = model.evaluate_steady(motion) if k % 2 else model.evaluate(motion)
        if cavitation.conserves_mass and not motion[4:6].any():
            # without pressure nothing feeds the film: how much oil goes round is open
            assert found.status in (ehd.Status.CONVERGED, ehd.Status.NO_OIL)
            continue
        assert found.status is ehd.Status.CONVERGED
        # at most the long bearing's force per offset, 12 pi mu L (R/c)^3; pressures below 1e-9 of the speed's count
        # as rounding
        offset, rate = np.hypot(*motion[:2]), np.hypot(*motion[4:6])
        long = 12.0 * np.pi * 0.015 * 0.02 * (0.02 / CLEARANCE) ** 3
        rounding = 1e-9 * 0.015 * 300.0 * (0.02 / CLEARANCE) ** 2 * 0.02 * 0.02
        assert np.hypot(*found.wrench[:2]) <= long * (0.5 * abs(motion[8]) * offset + rate) + rounding


@pytest.mark.slow
@pytest.mark.parametrize("contact", [None, ehd.RegularisedWall(onset=2e-6)], ids=["plain", "contact"])
def test_slight_films_rupture_without_turning_in_circles(contact):
    """Pressures next to rounding took 400 solves; now some 20, in one of four films some 80 and more in pseudo time."""
    counts, made = [], bearing(ehd.ElrodAdams(), contact=contact)
    for place in (0.0255, 0.02, 0.021, 0.0223, 0.03, 0.04):
        motion, near = np.zeros((2, 10))
        motion[0], motion[8] = place * CLEARANCE, -123.07779066684151
        near[:] = motion
        near[0] *= 1.001
        found, other = (build_model(made).evaluate_steady(m) for m in (motion, near))
        # a film that nothing feeds may have none
        assert found.status is other.status and found.status in (ehd.Status.CONVERGED, ehd.Status.NO_OIL)
        counts += [found.iterations, other.iterations]
        assert found.status is ehd.Status.NO_OIL or np.allclose(
            found.wrench, other.wrench, rtol=1e-2, atol=1e-3 * np.abs(other.wrench).max()
        )
    # which films need pseudo time, and for how long, is a matter of rounding
    assert np.mean(counts) < 100 and max(counts) < 300
