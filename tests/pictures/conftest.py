"""One film and one history for the pictures' tests."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

import exudyn_ehd as ehd


@pytest.fixture(scope="session")
def film(make_bearing):
    """A tilted journal at a high eccentricity."""
    bearing = make_bearing(film=ehd.FiniteLength(n_theta=48, n_z=6))
    return ehd.steady(bearing, speed=314.0, eccentricity_ratio=0.8, direction=-1.2, tilt=(1e-4, 0.0))


@pytest.fixture(scope="session")
def fed_film(make_bearing):
    """A mass-conserving film with heating, a groove and a hole across theta = 0."""
    bearing = make_bearing(
        film=ehd.FiniteLength(n_theta=48, n_z=6),
        lubricant=ehd.oil("ISO VG 46"),
        cavitation=ehd.ElrodAdams(),
        supply=(
            ehd.AxialGroove(angle=math.pi / 2, width_angle=0.6, length=0.03, pressure=1e5),
            ehd.Hole(angle=0.0, diameter=0.01, pressure=1e5),
        ),
        thermal=ehd.FilmEnergy(supply_temperature=313.15),
    )
    return ehd.steady(bearing, speed=314.0, eccentricity_ratio=0.7, direction=-1.2)


@pytest.fixture
def history():
    """One turn of a made-up orbit, in the pictures' protocol."""
    t = np.linspace(0.0, 0.02, 41)
    phase = 2.0 * np.pi * t / 0.02
    motion = np.zeros((41, 10))
    motion[:, 0], motion[:, 1] = 12e-6 * np.cos(phase), 8e-6 * np.sin(phase)
    motion[:, 2] = 2e-4 * np.sin(phase)
    force = np.column_stack([900.0 * np.cos(phase), 400.0 * np.sin(phase), 0.0 * t])
    return SimpleNamespace(
        time=t,
        motion=motion,
        eccentricity=motion[:, :2],
        force=force,
        minimum_gap=20e-6 - np.hypot(motion[:, 0], motion[:, 1]),
        peak_pressure=2.5e6 + 1e6 * np.sin(phase),
        supply_flow=np.full(41, np.nan),
        lowest_pocket_pressure=np.full(41, np.nan),
        highest_pocket_pressure=np.full(41, np.nan),
        radial_clearance=20e-6,
        length=0.02,
    )
