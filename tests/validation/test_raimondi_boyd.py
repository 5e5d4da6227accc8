"""Raimondi and Boyd, A solution for the finite journal bearing and its application to analysis and design, III (1958).

Printed columns, which are design charts, and those of an independent solver for the same rows. Inlet: p = 0 on the line
of maximum gap. Friction with the whole clearance sheared. Flows in units of R c N L, N in revolutions per second.
Default film.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

import exudyn_ehd as ehd

SPEED = 100.0
# Largest errors against the printed columns up to an eccentricity ratio of 0.9, which were computed by relaxation, and
# against those of the independent solver up to 0.97.
LIMITS = {
    "S": (0.014, 0.005),
    "phi_deg": (0.013, 0.004),
    "f_R_over_c": (0.02, 0.004),
    "Q_over_RcNL": (0.0025, 0.003),
    "Qs_over_Q": (0.0045, 0.0015),
    "P_over_pmax": (0.026, 0.01),
}
OWN = dict(zip(LIMITS, ("S_own", "phi_own", "f_own", "Q_own", "QsQ_own", "Ppmax_own"), strict=True))


def variables(film):
    """Return the variables of the charts for a film of `steady`."""
    b = film.bearing
    unit = b.journal_radius * b.radial_clearance * b.length * abs(film.motion[8]) / (2.0 * math.pi)
    mean = float(np.hypot(*film.force[:2])) / (2.0 * b.journal_radius * b.length)
    values = (
        film.characteristic_number,
        math.degrees(film.attitude_angle),
        film.friction_number,
        film.inlet_flow / unit,
        film.leakage / film.inlet_flow,
        mean / film.peak_pressure,
    )
    return dict(zip(LIMITS, values, strict=True))


@pytest.mark.parametrize("ratio", (1.0, 0.5, 0.25))
def test_charts(table, make_bearing, measured, ratio):
    """The charts' variables from the results of `steady`, in any direction and for both senses of rotation."""
    bearing, worst, rng = make_bearing(ratio, inlet=ehd.MaximumGap()), {}, np.random.default_rng(1958)
    for row in (r for r in table("raimondi_boyd1958") if r["L_over_D"] == ratio):
        speed, direction = rng.choice((-SPEED, SPEED)), rng.uniform(-math.pi, math.pi)
        film = ehd.steady(bearing, speed=speed, eccentricity_ratio=row["eps"], direction=direction)
        for name, value in variables(film).items():
            printed = abs(value / row[name] - 1.0) if row["eps"] <= 0.9 else 0.0
            errors = printed, abs(value / row[OWN[name]] - 1.0)
            worst[name] = np.maximum(worst.get(name, 0.0), errors)
    for name, errors in worst.items():
        measured(f"{name}, printed", errors[0], LIMITS[name][0])
        measured(f"{name}, independent", errors[1], LIMITS[name][1])


def test_charts_at_a_load(table, make_bearing, measured):
    """`equilibrium` with the line of the charts reads them at a given load: the row's S gives its other columns."""
    worst, rng = 0.0, np.random.default_rng(3)
    for row in (r for r in table("raimondi_boyd1958") if r["eps"] <= 0.9):
        bearing, speed, angle = make_bearing(row["L_over_D"], inlet=ehd.MaximumGap()), rng.choice((-SPEED, SPEED)), 2.0
        load = bearing.reference_force(speed) / (2.0 * math.pi * row["S_own"])
        rest = ehd.equilibrium(bearing, speed=speed, load=(load * math.cos(angle), load * math.sin(angle)))
        found = variables(rest.film) | {"eps": rest.eccentricity_ratio}
        errors = [found[name] / row[OWN.get(name, name)] - 1.0 for name in ("eps", "f_R_over_c", "Q_over_RcNL")]
        worst = np.maximum(worst, np.abs(errors))
    for name, error, limit in zip(("eps", "friction", "inlet flow"), worst, (2e-3, 3e-3, 3e-3), strict=True):
        measured(name, error, limit)
