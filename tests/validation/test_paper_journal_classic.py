"""The paper's rotating journal with a rigid bearing, by the paper's own scheme;
reference by independent finite volumes.

L 66 mm, c 30 um, e 24 um, 3000 rpm, 9 mPa s, Gümbel; the radius is not printed: 30 and 33 mm.
"""

from __future__ import annotations

import math

import numpy as np

import exudyn_ehd as ehd


def test_classic_scheme_on_the_papers_journal(table, measured):
    for row in table("seed_rotating_journal_rigid"):
        if row["bc"] != "Gumbel_periodic":
            continue
        bearing = ehd.JournalBearing(
            journal_radius=row["R_m"],
            length=0.066,
            radial_clearance=30e-6,
            lubricant=ehd.Lubricant(viscosity=9e-3),
            film=ehd.ClassicSOR(n_theta=192, n_z=48),
            cavitation=ehd.Gumbel(),
        )
        film = ehd.steady(bearing, speed=100.0 * math.pi, eccentricity_ratio=0.8)
        # Second-order error of this grid (a quarter of that at 96 x 24) plus that of rule (11) at 1e-5.
        measured("load", abs(np.hypot(*film.force[:2]) / row["load_N"] - 1.0), 5e-4)
        measured("attitude, deg", abs(math.degrees(film.attitude_angle) - row["attitude_deg"]), 0.02)
        measured("peak pressure", abs(film.peak_pressure / (1e6 * row["pmax_MPa"]) - 1.0), 2e-3)
        measured("friction", abs(-film.friction_torque / row["friction_torque_full_Nm"] - 1.0), 2e-3)
