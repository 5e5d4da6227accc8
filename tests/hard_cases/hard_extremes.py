"""Masses, viscosities, clearances and speeds at the ends of what is built, and beyond."""

from __future__ import annotations

import math
import warnings

import numpy as np
from hard_registry import hard_case
from hard_scene import CLEARANCE, SPEED, Rotor, bearing

import exudyn_ehd as ehd


def settles(made, *, mass, load, speed=SPEED, end, step, tolerance=2e-3, start=(0.0, 0.0)):
    """A run into its equilibrium: position, force and impulse."""
    rotor = Rotor(made, mass=mass, load=(0.0, -load), speed=speed, position=start)
    run = rotor.run(end, step)
    h = run.history
    eq = ehd.equilibrium(made, speed=speed, load=(0.0, -load))
    c = made.radial_clearance
    assert np.hypot(*(h.eccentricity[-1] - eq.position)) < tolerance * c
    assert abs(h.force[-1, 1] / load - 1.0) < 5e-3
    assert h.largest_eccentricity_ratio.max() < 1.0
    assert h.power_loss.min() > 0.0
    return run, rotor, eq


@hard_case("light journal, 1 g", rejected=8)
def light():
    """1 g under 500 N: 50 000 g of acceleration, a time constant of the film far below any step."""
    return settles(bearing(), mass=1e-3, load=500.0, end=0.05, step=2e-4)[0]


@hard_case("heavy journal, 1 t", slow=True)
def heavy():
    """1 t on a film: whirl of long period and of large amplitude, in which the film is next to a rigid wall."""
    made = bearing(length=0.05)
    weight = 9810.0
    rotor = Rotor(made, mass=1000.0, load=(0.0, -weight), speed=40.0)
    run = rotor.run(0.3, 5e-4)
    h = run.history
    assert h.largest_eccentricity_ratio.max() < 1.0
    assert rotor.momentum_error(h) < 5e-3
    # falls freely by e / c = 0.5 within sqrt(c / g), before the film stops it
    early = h.time < 1.5e-3
    fall = -0.5 * 9.81 * h.time[early] ** 2
    assert np.abs(h.eccentricity[early, 1] - fall).max() < 0.05 * CLEARANCE
    # what the film takes is lost: the energy of the fall, or the film's power
    assert h.power_loss.min() > 0.0
    assert abs(h.force[-100:, 1].mean() / weight - 1.0) < 0.3
    return run


def friction_and_load(viscosity, *, load, speed, step, mass, end):
    made = bearing(viscosity=viscosity)
    run, _, eq = settles(made, mass=mass, load=load, speed=speed, end=end, step=step)
    # similarity: the film knows viscosity times speed only
    same = ehd.equilibrium(bearing(viscosity=0.02), speed=viscosity * speed / 0.02, load=(0.0, -load))
    assert np.allclose(eq.position, same.position, rtol=0.0, atol=1e-9 * CLEARANCE)
    assert math.isclose(run.history.friction_torque[-1], same.film.friction_torque, rel_tol=1e-3)
    return run


@hard_case("viscosity 1e-5 Pa s, a gas", slow=True)
def thin_oil():
    """A two-thousandth of an oil's viscosity: pressures of a few kPa and hardly any damping."""
    return friction_and_load(1e-5, load=1.0, speed=SPEED, step=1e-3, mass=0.02, end=0.5)


@hard_case("viscosity 10 Pa s, tar", rejected=6)
def thick_oil():
    """Five hundred times an oil's viscosity: the film is stiffer than anything else in the model."""
    return friction_and_load(10.0, load=5e5, speed=SPEED, step=2e-4, mass=2.0, end=0.06)


@hard_case("clearance 1 um", rejected=12, slow=True)
def narrow():
    """A clearance of 4e-5 of the radius: gaps of a few hundred atoms, pressures of GPa from any disturbance."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        made = bearing(radial_clearance=1e-6)
    return settles(made, mass=2.0, load=2e5, speed=100.0, end=0.4, step=5e-4)[0]


@hard_case("clearance 1 mm", slow=True)
def wide():
    """A clearance of 4 % of the radius, as in studies of worn joints: the journal flies rather than floats."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        made = bearing(radial_clearance=1e-3, viscosity=0.4)
    return settles(made, mass=0.05, load=10.0, end=0.3, step=5e-4)[0]


@hard_case("30 m/s surface speed", slow=True)
def fast():
    """30 m/s on a clearance of 50 um: shear of 6e5 1/s, strong cross-coupling;
    heated, thinned and supplied at one end."""
    oil = ehd.oil("ISO VG 32", temperature=313.15)
    speed = 30.0 / 0.025
    ends = (1e5, 0.0)
    made = bearing(lubricant=oil, thermal=ehd.LumpedThermal(supply_temperature=313.15), end_pressures=ends)
    rotor = Rotor(made, mass=1.0, load=(0.0, -4000.0), speed=speed)
    run = rotor.run(0.15, 1e-4)
    h = run.history
    # hot oil: thinner, hence closer to the wall and with less loss than cold
    cold = ehd.equilibrium(bearing(lubricant=oil, end_pressures=ends), speed=speed, load=(0.0, -4000.0))
    assert h.film_temperature[-1] > h.film_temperature[0] + 5.0
    assert h.power_loss[-1] < 0.95 * cold.film.power_loss
    assert h.largest_eccentricity_ratio.max() < 1.0
    assert rotor.momentum_error(h) < 5e-3
    # oil leaves at one end only in the mean: what enters on the other is not lost
    assert np.all(np.diff(h.film_temperature[-20:]) > -0.05)
    return run


@hard_case("load of a thousandth of a newton")
def tiny_load():
    """A millionth of the film's force and hardly any mass: neutral half-speed
    whirl, which forgives no error of the start."""
    made = bearing()
    load = 1e-3
    eq = ehd.equilibrium(made, speed=SPEED, load=(0.0, -load))
    rotor = Rotor(made, mass=1e-6, load=(0.0, -load), position=eq.position)
    run = rotor.run(0.05, 5e-4)
    h = run.history
    # a massless journal in an unloaded full film keeps any orbit at half the speed: what starts at rest must stay
    # Newton's tolerance of 1e-6 over a hundred steps is all that may move it
    assert np.abs(h.eccentricity - eq.position).max() < 1e-5 * np.hypot(*eq.position)
    # full film about the centre: F = k e at right angles, from the tangent of the concentric film
    k = ehd.steady(made, speed=SPEED, eccentricity_ratio=1e-3).force
    stiffness = np.hypot(*k[:2]) / (1e-3 * CLEARANCE)
    assert abs(np.hypot(*eq.position) * stiffness / load - 1.0) < 1e-2
    return run


@hard_case("load of 100 kN in an instant", rejected=12)
def huge_step():
    """100 kN on 2 kg, from the centre, without warning: 5 km/s2 until the film is thin enough to stop it."""
    made = bearing(film=ehd.FiniteLength(n_theta=96, n_z=8))
    rotor = Rotor(made, load=(0.0, -1e5))
    run = rotor.run(0.02, 1e-4)
    h = run.history
    eq = ehd.equilibrium(made, speed=SPEED, load=(0.0, -1e5))
    assert np.hypot(*(h.eccentricity[-1] - eq.position)) < 1e-3 * CLEARANCE
    assert h.largest_eccentricity_ratio.max() < 1.0
    assert abs(h.force[-1, 1] / 1e5 - 1.0) < 1e-3
    return run
