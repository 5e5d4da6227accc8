"""Squeeze-film dampers in circular orbits about the centre, from open to sealed ends.

A damper at the eccentricity e = eps c that circles at the angular frequency w, without spin, in half a film (Gümbel).
With open ends, much shorter than wide, and with tight ends of any length, the forces against the displacement and
against the velocity are ``K e`` and ``C w e`` with

    open:    K = 2 mu w R (L/c)^3 eps / (1 - eps^2)^2,      C = pi/2 mu R (L/c)^3 / (1 - eps^2)^(3/2),
    sealed:  K = 24 mu w L (R/c)^3 eps / (m (1 - eps^2)),   C = 12 pi mu L (R/c)^3 / (m sqrt(1 - eps^2)),

m = 2 + eps^2, of the pressures, with theta from the widest gap, ``-h_t = w eps c sin theta`` and H = 1 + eps cos theta,

    open:    p = 3/2 mu w (L/c)^2 eps sin theta / H^3 at mid-plane,
    sealed:  p = 12 mu w (R/c)^2 eps sin theta (2 + eps cos theta) / (m H^2).

The open damper of the table has L/D = 0.18, at which the flow around it takes some per cent of the forces. Its numbers
go with the third power of L (the pressure with the second), and hold for a sixteenth of it with a 256th of that error.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

import exudyn_ehd as ehd

FILM = ehd.FiniteLength(n_theta=512, n_z=8)


def circling(row, seals, *, shorter=1.0, longer=1.0):
    """Stiffness, damping and peak pressure of the damper of a row with end seals, in its circular orbit."""
    c, w = row["radial_clearance_m"], row["whirl_speed_rad_s"]
    damper = ehd.JournalBearing(
        journal_radius=0.5 * row["journal_diameter_m"],
        length=longer * row["axial_length_m"] / shorter,
        radial_clearance=c,
        lubricant=ehd.Lubricant(viscosity=row["viscosity_Pa_s"]),
        film=FILM,
        cavitation=ehd.Gumbel(),
        end_seals=seals,
    )
    e = row["eccentricity_ratio"] * c
    film = ehd.steady(
        damper, speed=0.0, eccentricity_ratio=row["eccentricity_ratio"], direction=0.7, velocity=whirl(0.7, w * e)
    )
    outward = np.array([math.cos(0.7), math.sin(0.7)])
    force = np.asarray(film.force[:2])
    return -force @ outward / e, -force @ whirl(0.7, 1.0) / (w * e), film.peak_pressure


def whirl(direction, speed):
    """Velocity (2,) across a direction."""
    return -speed * math.sin(direction), speed * math.cos(direction)


@pytest.fixture
def row(table):
    (only,) = table("squeeze_film_damper_closed_form")
    return only


def test_the_table_is_the_closed_form(row):
    R, L, c = 0.5 * row["journal_diameter_m"], row["axial_length_m"], row["radial_clearance_m"]
    eps, w, mu = row["eccentricity_ratio"], row["whirl_speed_rad_s"], row["viscosity_Pa_s"]
    K = 2.0 * mu * w * R * (L / c) ** 3 * eps / (1.0 - eps**2) ** 2
    C = 0.5 * math.pi * mu * R * (L / c) ** 3 / (1.0 - eps**2) ** 1.5
    theta = np.linspace(0.0, math.pi, 200001)
    p = 1.5 * mu * w * (L / c) ** 2 * eps * np.sin(theta) / (1.0 + eps * np.cos(theta)) ** 3
    assert row["kxx_N_per_m"] == pytest.approx(K, rel=1e-6)
    assert row["cxx_Ns_per_m"] == pytest.approx(C, rel=1e-6)
    assert row["p_max_Pa"] == pytest.approx(p.max(), rel=1e-5)


@pytest.mark.parametrize("end", ["no seal", "wide seals", "one wide seal"])
def test_open_ends(row, measured, end):
    wide = ehd.EndSeal(conductance=1.0)
    seals = {"no seal": None, "wide seals": wide, "one wide seal": (wide, None)}[end]
    K, C, peak = circling(row, seals, shorter=16.0) * np.array([16.0**3, 16.0**3, 16.0**2])
    measured("K", abs(K / row["kxx_N_per_m"] - 1.0), 1e-3)
    measured("C", abs(C / row["cxx_Ns_per_m"] - 1.0), 1e-3)
    measured("peak pressure", abs(peak / row["p_max_Pa"] - 1.0), 1e-3)
    # the damper itself is not that short
    away = circling(row, seals)[1] / row["cxx_Ns_per_m"]
    assert 0.95 < away < 0.99


@pytest.mark.parametrize("longer", [1.0, 4.0])
def test_sealed_ends(row, measured, longer):
    R, L, c = 0.5 * row["journal_diameter_m"], longer * row["axial_length_m"], row["radial_clearance_m"]
    eps, w, mu = row["eccentricity_ratio"], row["whirl_speed_rad_s"], row["viscosity_Pa_s"]
    m, theta = 2.0 + eps**2, np.linspace(0.0, math.pi, 200001)
    exact_K = 24.0 * mu * w * L * (R / c) ** 3 * eps / (m * (1.0 - eps**2))
    exact_C = 12.0 * math.pi * mu * L * (R / c) ** 3 / (m * math.sqrt(1.0 - eps**2))
    H = 1.0 + eps * np.cos(theta)
    p = 12.0 * mu * w * (R / c) ** 2 * eps * np.sin(theta) * (1.0 + H) / (m * H**2)
    K, C, peak = circling(row, ehd.EndSeal(conductance=1e-20), longer=longer)
    measured("K", abs(K / exact_K - 1.0), 1e-3)
    measured("C", abs(C / exact_C - 1.0), 1e-3)
    measured("peak pressure", abs(peak / p.max() - 1.0), 1e-3)


def test_between_open_and_sealed(row):
    """Damping and pressure grow from the open to the tight damper as the seals narrow."""
    seals = [ehd.EndSeal(conductance=conductance) for conductance in (1.0, 1e-9, 1e-10, 1e-11, 1e-20)]
    found = np.array([circling(row, seal) for seal in seals])
    assert np.all(np.diff(found[:, 1:], axis=0) > 0.0)
