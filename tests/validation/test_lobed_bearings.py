"""Published bearings with a bore on parts of the circle: an elliptical one, and step bearings with pressure dams.

``lund_thomsen1978_elliptical.csv`` (J. W. Lund, K. K. Thomsen, ASME 1978): two lobes of preload 0.5 between grooves of
20 degrees, L/D = 1, load between the grooves. All is over the machined clearance c_p: ``S = mu N L D / W (R / c_p)^2``,
e / c_p, the attitude angle, ``K = k c_p / W`` and ``B = b c_p omega / W`` with x along the load and y 90 degrees ahead
in the sense of rotation. Columns ``here_...`` are those of an earlier film on 360 x 20 that had the lobes as a table of
depths; the printed attitude angle at S = 0.161 differs from it, and from a smooth course, by two degrees.

``nicholas1980_step_bearings_table6.csv`` and ``..._coefficients.csv`` (J. C. Nicholas et al., step bearings, 1980): a
dam in the upper half, L/D = 1, grooves of 20 degrees at the split; S over the clearance, e / c, threshold speed
``omega_s sqrt(c / g)`` of a rigid rotor; stiffness and damping in inches and pounds with x to the right and y up. Shaft
and oil are not known; ratios of coefficients do not depend on them.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

import exudyn_ehd as ehd

R, MU, SPEED = 0.025, 0.02, 314.0
DIAMETER = 2.0 * R


def rest(arcs, clearance, S, over):
    """Position under a load down of this Sommerfeld number S with the clearance ``over``, and the load, N."""
    bearing = ehd.JournalBearing(
        journal_radius=R, length=DIAMETER, radial_clearance=clearance, lubricant=ehd.Lubricant(viscosity=MU), arcs=arcs
    )
    load = MU * SPEED / (2.0 * math.pi) * DIAMETER**2 / S * (R / over) ** 2
    return ehd.equilibrium(bearing, speed=SPEED, load=(0.0, -load)), load


def along_the_load(matrix):
    """xx, xy, yx, yy for x down along the load and y to the right, 90 degrees ahead, from x to the right and y up."""
    turned = np.array([[0.0, -1.0], [1.0, 0.0]])
    return (turned @ matrix[:2, :2] @ turned.T).ravel()


def test_elliptical_bearing(table, measured):
    """Printed digits: K and B within 0.02, eccentricity within 0.001 of c_p."""
    machined = 50e-6
    for row in table("lund_thomsen1978_elliptical"):
        found, load = rest(
            ehd.two_lobe(preload=0.5, width_angle=math.radians(20.0)), 0.5 * machined, row["S"], machined
        )
        K = along_the_load(found.stiffness) * machined / load
        B = along_the_load(found.damping) * machined * SPEED / load
        measured("e / c_p", abs(np.hypot(*found.position[:2]) / machined - row["eps_on_pad_clearance"]), 1.1e-3)
        measured("attitude, degrees", abs(math.degrees(found.attitude_angle) - row["here_phi_deg"]), 0.05)
        measured("K", np.abs(K - [row[f"K{k}"] for k in ("xx", "xy", "yx", "yy")]).max(), 0.02)
        measured("B", np.abs(B - [row[f"B{k}"] for k in ("xx", "xy", "xy", "yy")]).max(), 0.02)


def test_step_bearings(table, measured):
    """Eccentricity within 0.015, threshold speed within 8 %, as between the source's grid and this one.

    Bearings without a dam come within a digit. Ratios of stiffness within 5 % of the largest, of damping within 1.5 %.
    """
    coefficients = {(row["bearing"], row["rpm"]): row for row in table("nicholas1980_step_bearings_coefficients")}
    for row in table("nicholas1980_step_bearings_table6"):
        clearance, depth = 25.4e-6 * row["radial_clearance_mil"], 25.4e-6 * row["dam_depth_mil"]
        arcs = ehd.two_lobe(preload=0.0, width_angle=math.radians(20.0))
        if depth > 0.0:
            step, length = math.radians(row["step_angle_deg"]), row["dam_over_bearing_length"] * DIAMETER
            arcs = ehd.pressure_dam(depth=depth, step_angle=step, length=length, width_angle=math.radians(20.0))
        found, load = rest(arcs, clearance, row["S"], clearance)
        threshold = math.sqrt(found.critical_mass * clearance * SPEED**2 / load)
        measured("e / c", abs(found.eccentricity_ratio - row["eccentricity_ratio"]), 0.015 if depth else 0.005)
        error = abs(threshold / row["stability_omega_s_sqrt_c_over_g"] - 1.0)
        measured("threshold speed", error, 0.08 if depth else 0.01)
        own = coefficients.get((row["bearing"], 8000))
        if own is None:
            continue
        for name, matrix, unit, limit in (
            ("k", found.stiffness, "lbf_per_in", 0.05),
            ("c", found.damping, "lbf_s_per_in", 0.015),
        ):
            known = np.array([own.get(f"{name}{k}_{unit}", own.get(f"{name}{k}")) for k in ("xx", "xy", "yx", "yy")])
            ratios = matrix[:2, :2].ravel() / matrix[1, 1] - known / known[-1]
            measured(f"{name} over {name}yy", np.abs(ratios).max() / np.abs(known / known[-1]).max(), limit)


@pytest.mark.parametrize("grid", [(200, 20), (400, 32)])
def test_the_step_on_finer_grids(grid):
    """Eccentricity and threshold of the default grid within 0.5 % of those of finer ones."""
    arcs = ehd.pressure_dam(depth=60e-6, step_angle=math.radians(145.0), length=0.75 * DIAMETER)
    found = []
    for film in (ehd.FiniteLength(), ehd.FiniteLength(n_theta=grid[0], n_z=grid[1])):
        bearing = ehd.JournalBearing(
            journal_radius=R, length=DIAMETER, radial_clearance=55e-6, lubricant=ehd.Lubricant(viscosity=MU),
            arcs=arcs, film=film,
        )  # fmt: skip
        at = ehd.equilibrium(bearing, speed=SPEED, load=(0.0, -800.0))
        found.append((at.eccentricity_ratio, math.sqrt(at.critical_mass)))
    np.testing.assert_allclose(*found, rtol=5e-3)
