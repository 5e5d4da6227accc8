"""Stiffness, damping and whirl threshold of the plain bearing, L/D = 0.5, against an independent solver (2 %).

Periodic film, Swift-Stieber. x along the load, y 90 degrees ahead in the sense of rotation,
``K = k c / W``, ``B = b c omega / W``. The rupture line snaps to cells, which perturbs derivatives
far more than forces: 192 x 16 holds 1 %, the default grid 96 x 10 up to 4 % (and 2 % up to eps 0.6).
"""

from __future__ import annotations

import math

import numpy as np
import pytest

import exudyn_ehd as ehd

SPEED = 100.0


def _errors(row, bearing):
    load = row["So"] * bearing.reference_force(SPEED)
    result = ehd.equilibrium(bearing, speed=SPEED, load=(load, 0.0))
    unit = load / bearing.radial_clearance
    ours = np.concatenate((result.stiffness.ravel() / unit, result.damping.ravel() * SPEED / unit))
    table = np.array([row[k] for k in ("Kxx", "Kxy", "Kyx", "Kyy", "Bxx", "Bxy", "Byx", "Byy")])
    # Relative, but in units of W/c where a coefficient passes through zero (Kyx near eps 0.68).
    worst = float(np.max(abs(ours - table) / np.maximum(1.0, abs(table))))
    return result, worst, result.critical_mass * bearing.radial_clearance * SPEED**2 / load


def test_plain_bearing(table, make_bearing, measured):
    bearing = make_bearing(0.5, film=ehd.FiniteLength(n_theta=192, n_z=16))
    for row in (r for r in table("own_dynamic_coefficients") if r["geometry"] == "plain360_periodicLCP"):
        result, worst, mass = _errors(row, bearing)
        measured(f"K and C at eps {row['eps']}", worst, 0.01)
        measured("eps", abs(result.eccentricity_ratio / row["eps"] - 1.0), 0.005)
        measured("attitude, degrees", abs(math.degrees(result.attitude_angle) - row["phi_deg"]), 0.1)
        if math.isfinite(row["Mcrit_mcw2_W"]):
            measured("whirl ratio", abs(result.whirl_ratio / row["whirl_ratio"] - 1.0), 0.02)
            measured("critical mass", abs(mass / row["Mcrit_mcw2_W"] - 1.0), 0.02)
        else:
            assert math.isinf(mass)


@pytest.mark.parametrize(("limit", "largest"), [(0.02, 0.6), (0.05, 0.9)])
def test_default_grid(table, make_bearing, measured, limit, largest):
    bearing = make_bearing(0.5)
    for row in (r for r in table("own_dynamic_coefficients") if r["geometry"] == "plain360_periodicLCP"):
        if row["eps"] <= largest:
            measured(f"K and C at eps {row['eps']}", _errors(row, bearing)[1], limit)
