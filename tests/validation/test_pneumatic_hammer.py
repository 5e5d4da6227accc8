"""Hydrostatic bearings with large volumes behind their restrictors: closed forms of lumped pockets, and runs in time.

Four pockets of the angle w and two axial lands of the length l each, without flow from pocket to pocket, around a
journal that rests at the centre. With h = c - x cos(theta) a pocket at theta = 0 gives off, to first order,

    dQ = G dp - R S (c^2 p_0 / (2 mu l) x + (L - l) dx/dt),    G = R w c^3 / (6 mu l),    S = 2 sin(w / 2),

and takes in ``-g dp - V / K d(dp)/dt``, with the restrictor's slope g. Two pockets press with ``2 R S (L - l) dp``, so
that with the damping C of pockets that keep their pressure

    Z(s) = (K_0 + s C_0) / (1 + s tau) + s C,    tau = V / K / (G + g),
    K_0 = 2 (R S)^2 (L - l) c^2 p_0 / (2 mu l) / (G + g),    C_0 = K_0 (L - l) 2 mu l / (c^2 p_0).

A mass M vibrates by ``M s^2 + Z(s) = 0``, a cubic. By Routh it is unstable above

    M = C tau (C_0 + C) / (K_0 tau - C_0 - C),

and at every mass stable while ``K_0 tau < C_0 + C``.
"""

import dataclasses
import math

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.joint.model.build import build_model

RADIUS, LENGTH, CLEARANCE, VISCOSITY, SUPPLY, MODULUS = 0.03, 0.06, 30e-6, 0.008, 4e6, 1e9
DENSITY = 860.0


def _bearing(kind, flow, volume, width, land, film):
    """Pockets with half the supply pressure at this flow, m3/s, each."""
    oil = {"compressible_volume": volume, "bulk_modulus": MODULUS, "supply_pressure": SUPPLY}
    if kind is ehd.Capillary:
        diameter = (128.0 * VISCOSITY * 0.05 * flow / (math.pi * 0.5 * SUPPLY)) ** 0.25
        feed = ehd.Capillary(diameter=diameter, length=0.05, **oil)
    else:
        area = flow / math.sqrt(SUPPLY / DENSITY) / 0.6
        feed = ehd.Orifice(diameter=math.sqrt(area / (0.25 * math.pi)), **oil)
    return ehd.JournalBearing(
        journal_radius=RADIUS,
        length=LENGTH,
        radial_clearance=CLEARANCE,
        lubricant=ehd.Lubricant(viscosity=VISCOSITY, density=DENSITY),
        film=film,
        cavitation=ehd.FullSommerfeld(),
        supply=tuple(
            ehd.Pocket(angle=0.5 * math.pi * k, width_angle=width, length=LENGTH - 2.0 * land, supply=feed)
            for k in range(4)
        ),
    )


def _damping(bearing):
    """Damping of pockets that keep their pressure, at the centre."""
    pockets = (dataclasses.replace(a, supply=None, pressure=0.5 * SUPPLY) for a in bearing.supply)
    model = build_model(dataclasses.replace(bearing, supply=tuple(pockets)))
    return -model.evaluate(np.zeros(10)).tangent()[0, 4]


@pytest.mark.parametrize("kind", [ehd.Capillary, ehd.Orifice], ids=lambda kind: kind.__name__)
def test_threshold_of_lumped_pockets(kind, measured):
    """Dynamic stiffness, mass at the threshold for a volume, and so the volume at the threshold for a mass."""
    film, land = ehd.ShortBearing(n_theta=480, n_z=16), 0.25 * LENGTH
    width = 107.0 * 2.0 * math.pi / 480.0
    G = RADIUS * width * CLEARANCE**3 / (6.0 * VISCOSITY * land)
    flow = 0.5 * SUPPLY * G
    conductance, span = G + G * (0.5 if kind is ehd.Orifice else 1.0), 2.0 * math.sin(0.5 * width)
    squeeze = 2.0 * VISCOSITY * land / (CLEARANCE**2 * 0.5 * SUPPLY) * (LENGTH - land)
    K = 2.0 * (RADIUS * span * (LENGTH - land)) ** 2 / squeeze / conductance
    for volume in (1e-4, 1e-3):
        bearing, tau = _bearing(kind, flow, volume, width, land, film), volume / MODULUS / conductance
        C = _damping(bearing)
        mass = C * tau * (K * squeeze + C) / (K * tau - K * squeeze - C)
        rest = ehd.equilibrium(bearing, speed=1e-3, load=(0.0, 0.0))
        measured(f"{kind.__name__}, {volume:g} m3: mass at the threshold", abs(rest.critical_mass / mass - 1.0), 2e-3)
        s = 1j * np.array([0.0, 0.1, 1.0, 10.0, 1000.0]) / tau
        exact = K * (1.0 + s * squeeze) / (1.0 + s * tau) + s * C
        found = rest.dynamic_stiffness(s.imag)[:, 0, 0]
        measured(f"{kind.__name__}, {volume:g} m3: Z", np.max(np.abs(found - exact) / np.abs(exact)), 1e-2)
    # a small volume is stable at any mass, but for whirl at so slow a spin
    small = ehd.equilibrium(_bearing(kind, flow, 1e-6, width, land, film), speed=1e-3, load=(0.0, 0.0))
    assert small.critical_mass > 1e9


def _run(bearing, mass, push, step, steps):
    mbs = exu.SystemContainer().AddSystem()
    ground = mbs.AddObject(eii.ObjectGround())
    node = mbs.AddNode(eii.NodeRigidBody2D(referenceCoordinates=[0, 0, 0], initialVelocities=[push, 0, 0]))
    body = mbs.AddObject(eii.ObjectRigidBody2D(nodeNumber=node, mass=mass, inertia=1.0))
    sides = {"itemNumbers": [ground, body], "position": [0, 0, 0], "axis": [0, 0, 1]}
    joint = ehd.CreateLubricatedJoint(mbs, name="pockets", **sides, bearing=bearing)
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.timeIntegration.endTime, settings.timeIntegration.numberOfSteps = steps * step, steps
    settings.timeIntegration.verboseMode, settings.solution.file.write = 0, False
    ehd.ConfigureSolver(settings)
    ehd.SolveDynamic(mbs, settings)
    return joint.history


@pytest.mark.parametrize("factor", [pytest.param(0.5, marks=pytest.mark.slow), 2.0])
def test_hammer_in_time(factor, measured):
    """On the default film a mass below the threshold comes to rest, above it rattles, at the rate of the eigenvalue."""
    bearing = _bearing(ehd.Orifice, 1e-5, 1e-4, 1.15, 0.01, ehd.FiniteLength())
    rest = ehd.equilibrium(bearing, speed=1e-3, load=(0.0, 0.0))
    mass, s = factor * rest.critical_mass, 1j * rest.whirl_ratio * 1e-3
    for _ in range(30):  # Newton's method for M s^2 + Z = 0
        residual, beside = (mass * q**2 + rest.response.at(-1j * q)[0, 0] for q in (s, s * (1.0 + 1e-6)))
        s -= residual / (beside - residual) * s * 1e-6
    assert (s.real > 0.0) == (factor > 1.0)
    rates = []
    for count in (50, 100):
        step = 2.0 * math.pi / abs(s.imag) / count
        history = _run(bearing, mass, 1e-3 * CLEARANCE * abs(s), step, 3 * count + count // 10)
        x = history.eccentricity[:, 0]
        k = np.flatnonzero((x[1:-1] > x[:-2]) & (x[1:-1] > x[2:])) + 1
        # parabolas through the largest values
        bend, slope = x[k + 1] - 2.0 * x[k] + x[k - 1], 0.5 * (x[k + 1] - x[k - 1])
        peaks, times = x[k] - 0.5 * slope**2 / bend, history.time[k] - step * slope / bend
        rates.append(math.log(peaks[3] / peaks[2]) / (times[3] - times[2]))
    # the steps of the pockets are of first order
    measured("rate of growth over the frequency", abs(2.0 * rates[1] - rates[0] - s.real) / abs(s.imag), 2e-3)
    assert (rates[1] > 0.0) == (factor > 1.0)
    assert abs(s.real) > 0.02 * abs(s.imag)
