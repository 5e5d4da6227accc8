"""Tilted journal: forces and moments against an independent solver (one code, one grid: 1 %).

The eccentricity varies linearly, ``e(z)/c = eps + tau 2 z / L``, in the direction of the eccentricity,
here x. Inlet: p = 0 on the line of maximum gap (theta = pi for every z). The table's radial and
tangential load point along the eccentricity and, for the load on the bore, against the sense of rotation:
``So_radial = int p cos / F_ref``, ``So_tang = -int p sin / F_ref``; its moments are the first z-moments
of the same two densities over F_ref L / 2. The wrench on the journal has ``F = -int p (cos, sin)`` and
``M = int z p (sin, -cos)``, hence m_rad = -M_y and m_tan = -M_x. Grid 96 x 10 (the default).
"""

from __future__ import annotations

import pytest

import exudyn_ehd as ehd

SPEED = 100.0


@pytest.mark.parametrize("sign", (1.0, -1.0))
def test_forces_and_moments(table, make_bearing, measured, sign):
    force = moment = peak = 0.0
    for row in table("own_misaligned_reference"):
        tau = row["tau(e varies linearly: eps(z)=eps+tau*2z/L in direction of minimum film thickness)"]
        bearing = make_bearing(row["L_over_D"], inlet=ehd.MaximumGap())
        slope = sign * tau * bearing.radial_clearance * 2.0 / bearing.length
        film = ehd.steady(bearing, speed=SPEED, eccentricity_ratio=row["eps_mid"], tilt=(slope, 0.0))
        unit = bearing.reference_force(SPEED)
        arm = sign * unit * bearing.length / 2.0
        force = max(force, abs(-film.force[0] / unit / row["So_radial"] - 1.0))
        force = max(force, abs(film.force[1] / unit / row["So_tang"] - 1.0))
        assert film.minimum_gap == pytest.approx((1.0 - row["eps_mid"] - tau) * bearing.radial_clearance, rel=1e-12)
        if tau > 0.0:
            moment = max(moment, abs(-film.moment[1] / arm / row["m_rad=M/(F_ref L/2)"] - 1.0))
            moment = max(moment, abs(-film.moment[0] / arm / row["m_tan"] - 1.0))
        else:
            assert abs(film.moment[:2]).max() < 1e-12 * unit * bearing.length
        scale = 0.02 * SPEED / bearing.clearance_ratio**2
        peak = max(peak, abs(film.peak_pressure / scale / row["pmax_c2_muomR2(cell)"] - 1.0))
    measured("forces", force, 0.01)
    measured("moments", moment, 0.01)
    # A cell value in the table, and in its last row the peak stands at an edge with a gap of 0.05 c.
    measured("peak pressure", peak, 0.05)


def test_tilt_across_the_eccentricity_turns_into_the_mirrored_moment(make_bearing):
    # A concentric journal tilted in x is the same problem as one tilted in y, turned by 90 degrees: 96 / 4 columns.
    bearing = make_bearing(1.0)
    slope = 0.5 * bearing.radial_clearance * 2.0 / bearing.length
    a = ehd.steady(bearing, speed=SPEED, eccentricity_ratio=0.0, tilt=(slope, 0.0))
    b = ehd.steady(bearing, speed=SPEED, eccentricity_ratio=0.0, tilt=(0.0, slope))
    assert b.moment[0] == pytest.approx(-a.moment[1], rel=1e-9)
    assert b.moment[1] == pytest.approx(a.moment[0], rel=1e-9)
