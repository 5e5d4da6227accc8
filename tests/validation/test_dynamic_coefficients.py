"""Stiffness, damping and whirl threshold of the plain bearing, L/D = 0.5, against an independent solver (2 %).

Periodic film, Swift-Stieber. x along the load, y 90 degrees ahead in the sense of rotation,
``K = k c / W``, ``B = b c omega / W``. The default grid 96 x 10 holds 2 %, in any direction by
`test_default_film`.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.joint.model.build import build_study_model
from tests.sampling import sample

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


@pytest.mark.parametrize(("limit", "largest"), [(0.01, 0.6), (0.02, 0.9)])
def test_default_grid(table, make_bearing, measured, limit, largest):
    bearing = make_bearing(0.5)
    for row in (r for r in table("own_dynamic_coefficients") if r["geometry"] == "plain360_periodicLCP"):
        if row["eps"] <= largest:
            measured(f"K and C at eps {row['eps']}", _errors(row, bearing)[1], limit)


# of load, stiffness and damping: up to eps 0.8, up to 0.95, at nine tenths of the tilt that closes the gap
GRIDS = {
    (96, 10): ((0.002, 0.008, 0.005), (0.004, 0.008, 0.016), (0.032, 0.17, 0.11)),
    (192, 16): ((0.0005, 0.0025, 0.005), (0.0015, 0.0025, 0.011), (0.011, 0.06, 0.035)),
}
NARROW = {(96, 10): ((0.002, 0.015, 0.028), (0.007, 0.015, 0.065), (0.032, 0.17, 0.11))}


def _entries(model, clearance, eps, tilt, direction):
    """Load, stiffness and damping in the frame of a direction."""
    t = tilt * (1.0 - eps) * clearance / (0.5 * model.bearing.length)
    c, s = math.cos(direction), math.sin(direction)
    turn = np.array([[c, s], [-s, c]])
    motion = np.array([eps * clearance * c, eps * clearance * s, t * c, t * s, 0.0, 0.0, 0.0, 0.0, SPEED, 0.0])
    evaluation = model.evaluate(motion)
    tangent = evaluation.tangent()
    return turn @ evaluation.wrench[:2], turn @ tangent[:2, :2] @ turn.T, turn @ tangent[:2, 4:6] @ turn.T


@pytest.mark.slow
@pytest.mark.parametrize("ratio", [0.125, 0.5, 1.0])
def test_table_of_the_grids(make_bearing, measured, ratio):
    """The table of `FiniteLength`, in directions over one column, against a fine grid's mean over its columns."""
    fine = build_study_model(make_bearing(ratio, film=ehd.FiniteLength(n_theta=960, n_z=48)), 0.0)
    models = {
        grid: build_study_model(make_bearing(ratio, film=ehd.FiniteLength(n_theta=grid[0], n_z=grid[1])), 0.0)
        for grid in GRIDS
    }
    c = fine.bearing.radial_clearance
    for eps, tilt in ((0.5, 0.0), (0.8, 0.0), (0.95, 0.0), (0.5, 0.9), (0.8, 0.9), (0.95, 0.9)):
        true = [_entries(fine, c, eps, tilt, 0.1 + 2.0 * math.pi / 960 * k / 4) for k in range(4)]
        mean = [np.mean(values, axis=0) for values in zip(*true, strict=True)]
        for grid, limits in (GRIDS | (NARROW if ratio < 0.5 else {})).items():
            for k in range(12):
                found = _entries(models[grid], c, eps, tilt, 0.1 + 2.0 * math.pi / grid[0] * k / 12)
                limit = limits[2 if tilt else int(eps > 0.8)]
                for name, value, exact, bound in zip(("load", "K", "C"), found, mean, limit, strict=True):
                    worst = float(np.max(np.abs(value - exact)) / np.max(np.abs(exact)))
                    measured(f"{name} of {grid} at eps {eps}, tilt {tilt}", worst, bound)


@pytest.mark.parametrize(
    ("sommerfeld", "on_the_grid", "in_the_cells"), sample([(0.3, 0.015, 0.003), (1.0, 0.4, 0.04), (1.3, None, 0.2)], 0)
)
def test_critical_mass_in_any_direction_of_the_load(make_bearing, measured, sommerfeld, on_the_grid, in_the_cells):
    """The rupture line on the grid's columns moves the threshold as the load turns over one of them."""
    plain = make_bearing(0.5, cavitation=ehd.SwiftStieber(line_in_cells=False))
    load = sommerfeld * plain.reference_force(SPEED)

    def masses(bearing):
        turns = 0.1 + 2.0 * math.pi / 96 * np.arange(8) / 8
        loads = [(load * math.cos(a), load * math.sin(a)) for a in turns]
        return np.array([ehd.equilibrium(bearing, speed=SPEED, load=force).critical_mass for force in loads])

    true = masses(make_bearing(0.5, film=ehd.FiniteLength(n_theta=384, n_z=24))).mean()
    measured("line in cells", np.abs(masses(make_bearing(0.5)) / true - 1.0).max(), in_the_cells)
    if on_the_grid is not None:
        measured("line on the grid", np.abs(masses(plain) / true - 1.0).max(), on_the_grid)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("cavity", "grid", "on_vertices", "in_cells"),
    [(-1e6, (96, 10), 0.035, 0.005), (-1e5, (96, 10), 0.1, 0.055), (-1e5, (192, 20), 0.035, 0.02)],
)
def test_damping_of_a_mass_conserving_film_over_the_direction(measured, cavity, grid, on_vertices, in_cells):
    """Damping at half the speed: spread over the load's direction against the grid, L/D 1, eccentricity ratio 0.8."""
    size = {"journal_radius": 0.025, "length": 0.05, "radial_clearance": 25e-6}
    film, oil = ehd.FiniteLength(n_theta=grid[0], n_z=grid[1]), ehd.Lubricant(viscosity=0.02)
    for inside, limit in ((False, on_vertices), (True, in_cells)):
        closure = ehd.ElrodAdams(cavity_pressure=cavity, line_in_cells=inside)
        bearing = ehd.JournalBearing(**size, lubricant=oil, film=film, cavitation=closure)
        load = np.hypot(*ehd.steady(bearing, speed=314.0, eccentricity_ratio=0.8).force[:2])
        found = []
        for k in range(10):
            angle = 2.0 * np.pi / grid[0] * k / 10 + 0.3 * (k % 2)
            turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
            at = ehd.equilibrium(bearing, speed=314.0, load=tuple(load * turn[0]))
            found.append(turn @ at.dynamic_stiffness([0.5 * 314.0])[0].imag @ turn.T)
        spread = np.ptp(found, axis=0).max() / np.abs(np.mean(found, axis=0)).max()
        measured(f"line {'inside cells' if inside else 'on vertices'}", spread, limit)
