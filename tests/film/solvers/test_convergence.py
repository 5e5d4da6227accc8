"""Order of convergence of the load in theta and in z."""

from __future__ import annotations

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.joint.model.build import build_model

EPS, DIRECTION = 0.6, 0.3


def _wrench(make_bearing, cavitation, n_theta, n_z, eps=EPS, direction=DIRECTION):
    """Force and moment of a tilted journal that also squeezes, in units of F_ref and F_ref L."""
    b = make_bearing(1.0, cavitation=cavitation, film=ehd.FiniteLength(n_theta=n_theta, n_z=n_z))
    c, speed = b.radial_clearance, 100.0
    e = eps * c * np.array([np.cos(direction), np.sin(direction)])
    tilt = 0.1 * c / b.length
    motion = np.array([*e, tilt, -2 * tilt, 5 * c, -3 * c, 0.0, 0.0, speed, 0.0])
    w = build_model(b).evaluate(motion).wrench
    F = b.reference_force(speed)
    return np.array([w[0] / F, w[1] / F, w[3] / (F * b.length), w[4] / (F * b.length)])


def _slopes(errors):
    errors = np.array(errors)
    return np.log2(errors[:-1] / errors[1:])


def test_full_sommerfeld_in_theta(make_bearing):
    """Second order: smooth integrands are summed exactly, the fluxes are central differences."""
    exact = _wrench(make_bearing, ehd.FullSommerfeld(), 1024, 10)
    errors = [abs(_wrench(make_bearing, ehd.FullSommerfeld(), n, 10) - exact).max() for n in (32, 64, 128)]
    slopes = _slopes(errors)
    print("theta", errors, slopes)
    assert (slopes > 1.9).all()
    assert (slopes < 2.4).all()


def test_full_sommerfeld_in_z(make_bearing):
    """Convergence is at least of second order in z: control volumes on stretched vertices, fourth-order integration."""
    exact = _wrench(make_bearing, ehd.FullSommerfeld(), 48, 192)
    errors = [abs(_wrench(make_bearing, ehd.FullSommerfeld(), 48, n) - exact).max() for n in (8, 16, 32)]
    slopes = _slopes(errors)
    print("z", errors, slopes)
    assert (slopes > 1.85).all()


@pytest.mark.parametrize(("cavitation", "name"), [(ehd.Gumbel(), "Gumbel"), (ehd.SwiftStieber(), "Swift-Stieber")])
def test_other_closures_stay_within_a_bound(make_bearing, cavitation, name):
    """The rupture line snaps to cells, so that no order can be asserted state
    by state: a bound falls by four per halving.

    The worst of several directions between two columns counts. Bound at 32 columns: 0.8 % of the load's size, about
    twice the worst that was seen.
    """
    directions = np.linspace(0.0, 2 * np.pi / 32, 6)[:-1]
    exact = [_wrench(make_bearing, cavitation, 768, 10, direction=d) for d in directions]
    size = max(np.hypot(*e[:2]) for e in exact)
    errors = [
        max(
            abs(_wrench(make_bearing, cavitation, n, 10, direction=d) - e).max()
            for d, e in zip(directions, exact, strict=True)
        )
        / size
        for n in (32, 64, 128)
    ]
    print(name, errors, _slopes(errors))
    for error, bound in zip(errors, (0.008, 0.002, 0.0005), strict=True):
        assert error < bound
