"""Heat balance of random bearings by reported quantities: what fresh oil carries away at the film's rise is the loss."""

import functools
import math

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.joint.heat.power import OilFlows
from exudyn_ehd.joint.model.build import build_study_model

SUPPLY = 313.0
OIL = ehd.oil("ISO VG 46")
CAPACITY = OIL.density * OIL.specific_heat


def draw(number):
    """Bearing, speed, rad/s, eccentricity ratio and tilt of a number, over sizes, closures, supplies and models."""
    rng = np.random.default_rng((61, number))
    R = math.exp(rng.uniform(math.log(0.01), math.log(0.1)))
    L, c = 2.0 * R * rng.uniform(0.3, 1.2), R * rng.uniform(8e-4, 2e-3)
    p = rng.choice([0.0, 0.5e5, 2e5, 5e5])
    at, long = rng.uniform(0.0, 2.0 * math.pi), L * rng.uniform(0.4, 0.8)
    axial = ehd.AxialGroove(angle=at, width_angle=rng.uniform(0.2, 0.6), length=long, pressure=p)
    areas = {
        "hole": (ehd.Hole(angle=at, z=0.1 * L * rng.uniform(-1, 1), diameter=L * rng.uniform(0.08, 0.25), pressure=p),),
        "groove": (axial,),
        "two grooves": (axial, ehd.AxialGroove(angle=at + math.pi, width_angle=0.3, length=long, pressure=p)),
        "pocket": (ehd.Pocket(angle=at, width_angle=rng.uniform(0.3, 0.9), length=0.6 * long, pressure=p),),
        "around": (ehd.CircumferentialGroove(width=L * rng.uniform(0.06, 0.2), pressure=p),),
        "none": (),
    }
    supply = areas[list(areas)[number % 6]]
    closures = [ehd.ElrodAdams(), ehd.SwiftStieber(), ehd.ElrodAdams(), ehd.Gumbel(), ehd.FullSommerfeld()]
    closure = closures[(number // 6) % 5]
    if closure.conserves_mass and not supply:
        closure = ehd.ElrodAdams(cavity_pressure=-1e5)
    walls = {"bush_coefficient": rng.uniform(100.0, 3000.0), "bush_temperature": SUPPLY + rng.uniform(0.0, 30.0)}
    models = [
        functools.partial(ehd.LumpedThermal, housing_conductance=rng.choice([0.0, 1.0])),
        ehd.FilmEnergy,
        functools.partial(ehd.FilmEnergy, conductivity=0.13, **walls),
        functools.partial(ehd.FilmEnergy, conductivity=0.13, across=2, **walls),
    ]
    thermal = models[rng.integers(4)](supply_temperature=SUPPLY, carry_over=rng.choice([1.0, 1.0, 0.7]))
    bearing = {
        "journal_radius": R,
        "length": L,
        "radial_clearance": c,
        "lubricant": OIL,
        "cavitation": closure,
        "supply": supply,
        "thermal": thermal,
    }
    eccentricity = rng.uniform(0.2, 0.9)
    tilt = rng.choice([0.0, 0.5]) * (1.0 - eccentricity) * c / (0.5 * L)
    return bearing, rng.uniform(2.0, 15.0) / R, eccentricity, (tilt, 0.0)
