"""Long bearing with the Reynolds condition against quadrature
(``analytic_long_bearing.csv``); p = 0 at the maximum gap."""

from __future__ import annotations

import math

import exudyn_ehd as ehd


def test_reynolds_condition(make_bearing, table, measured):
    """Quadrature of the one-dimensional film with p = dp/dtheta = 0 at the rupture."""
    for row in table("analytic_long_bearing"):
        bearing = make_bearing(film=ehd.LongBearing(n_theta=384), inlet=ehd.MaximumGap())
        film = ehd.steady(bearing, speed=100.0, eccentricity_ratio=row["eps"])
        # Rupture snapped to a vertex: of second order because the pressure starts with zero slope there.
        measured("So", abs(film.sommerfeld_number / row["So_ReynoldsBC_1D(own,1e-6)"] - 1.0), 5e-4)
        measured("phi, deg", abs(math.degrees(film.attitude_angle) - row["phi_ReynoldsBC"]), 0.01)
