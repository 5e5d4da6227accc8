"""Thin films and surfaces that touch."""

from __future__ import annotations

import dataclasses
import functools
import math

import numpy as np
from hard_registry import hard_case
from hard_scene import CLEARANCE, LENGTH, RADIUS, SPEED, Rotor, bearing
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import exudyn_ehd as ehd
from tests.reference import short_bearing

WALL = ehd.RegularisedWall(onset=1e-6, pressure=2e9)
ROUGH = ehd.GreenwoodTripp(composite_roughness=0.4e-6, composite_modulus=1.15e11, friction_coefficient=0.12)


def settles_at(eps, grid, finer, limit, allowed=None):
    made = bearing(film=grid)
    load = float(np.hypot(*ehd.steady(made, speed=SPEED, eccentricity_ratio=eps).force[:2]))
    eq = ehd.equilibrium(made, speed=SPEED, load=(0.0, -load))
    # turned by the attitude angle, the load meets the grid elsewhere
    assert abs(eq.eccentricity_ratio - eps) < 0.05 * (1.0 - eps)
    rotor = Rotor(made, load=(0.0, -load), position=0.9 / eps * eq.position)
    if allowed is not None:
        rotor.joint.stop_at(pressure=allowed)
    run = rotor.run(0.03, 2e-4)
    h = run.history
    assert h.largest_eccentricity_ratio.max() < 1.0
    assert np.hypot(*(h.eccentricity[-1] - eq.position)) < 1e-3 * (1.0 - eps) * CLEARANCE
    assert abs(h.force[-1, 1] / load - 1.0) < 1e-5
    # the same place on a finer grid carries the load within the grid's error
    fine = ehd.steady(dataclasses.replace(made, film=finer), speed=SPEED, eccentricity_ratio=eps)
    assert abs(np.hypot(*fine.force[:2]) / load - 1.0) < limit
    return run


@hard_case("eps 0.99", rejected=8)
def eps_99():
    """The film is 1 % of the clearance thin and its stiffness ten thousand times that of the centred journal."""
    return settles_at(0.99, ehd.FiniteLength(n_theta=128, n_z=8), ehd.FiniteLength(n_theta=384, n_z=20), 0.02)


@hard_case("eps 0.999", rejected=10, slow=True)
def eps_999():
    """50 nm of oil on a 25 mm journal: the pressure lives on a hundredth of the circumference.

    Steel does not bear it, but the film of rigid smooth surfaces is solved where the user allows it.
    """
    grids = ehd.FiniteLength(n_theta=384, n_z=8), ehd.FiniteLength(n_theta=1152, n_z=12)
    return settles_at(0.999, *grids, 0.05, allowed=math.inf)


@hard_case("sinking at zero speed", rejected=0, slow=True)
def drop_from_rest():
    """A journal is let go in a bearing that does not turn: squeeze alone,
    algebraic decay towards the wall, never an equilibrium."""
    made = bearing(film=ehd.ShortBearing(n_theta=384), length=0.4 * RADIUS)
    mass, weight = 2.0, 500.0
    run = Rotor(made, mass=mass, load=(0.0, -weight), speed=0.0).run(0.05, 1e-4)
    h = run.history
    scale = 0.02 * RADIUS * made.length**3 / CLEARANCE**2

    def equation(t, y):
        return [y[1], (weight - scale * short_bearing.squeeze_force(y[0], cavitated=True) * y[1]) / (mass * CLEARANCE)]

    exact = solve_ivp(equation, (0.0, 0.05), [0.0, 0.0], method="LSODA", rtol=1e-9, atol=1e-12, t_eval=h.time)
    # the load's step costs the first half millisecond a tenth of it; after that the path is the film's
    late = h.time > 1e-3
    assert np.abs(h.eccentricity_ratio - exact.y[0])[late].max() < 1e-3
    assert h.eccentricity_ratio[-1] > 0.9
    assert np.all(np.diff(h.eccentricity_ratio) > 0.0)
    assert np.abs(h.eccentricity[:, 0]).max() < 1e-9 * CLEARANCE
    return run


@hard_case("pressed on the wall", rejected=14, slow=True)
def pressed_on_the_wall():
    """No rotation, no film to carry: the load ends on the wall alone, at a gap that the wall's law gives."""
    made = bearing(contact=dataclasses.replace(WALL, pressure=2e8), viscosity=1e-3)
    load = 3e4
    rotor = Rotor(made, mass=2.0, load=(0.0, -load), speed=0.0)
    rotor.spring(0, 1e6)
    run = rotor.run(0.3, 1e-3)
    h = run.history
    assert abs(h.contact_load[-1] / load - 1.0) < 0.02
    assert abs(h.force[-1, 1] / load - 1.0) < 1e-3
    # force of the wall p0 (1 - h/h0)^2 on the whole bore at this gap, by quadrature
    theta = np.linspace(-math.pi, math.pi, 20001)
    gap = CLEARANCE - np.hypot(*h.eccentricity[-1]) * np.cos(theta)
    p = made.contact.pressure * np.clip(1.0 - gap / made.contact.onset, 0.0, None) ** 2
    exact = RADIUS * LENGTH * np.trapezoid(p * np.cos(theta), theta)
    # 64 vertices on a contact of a tenth of the circumference
    assert abs(h.contact_load[-1] / exact - 1.0) < 0.1
    return run


def edge_tilt(contact):
    made = bearing(length=0.05, contact=contact)
    rotor = Rotor(
        made,
        mass=1.0,
        spatial=True,
        inertia=1e-3,
        speed=SPEED,
        load=lambda t: (0.0, -6000.0 * min(t / 2e-3, 1.0)),
        load_z=0.02,
    )
    return rotor


@hard_case("edge contact under tilt", rejected=40, slow=True)
def edge_contact():
    """A load near one end tilts the journal until its edge touches: contact at a corner of the film."""
    rotor = edge_tilt(WALL)
    run = rotor.run(0.02, 1e-4)
    h = run.history
    assert h.contact_load.max() > 0.0
    # film and wall together: force and moment of the load about the centre
    assert abs(h.force[-1, 1] / 6000.0 - 1.0) < 5e-3
    assert abs(h.moment[-1, 0] / (6000.0 * 0.02) + 1.0) < 2e-2
    table = str(rotor.joint.audit())
    assert "contact" in table
    assert "matters" in table.split("contact")[1].split("\n")[0]
    return run


@hard_case("edge contact without contact", rejected=60, newton=20.0)
def edge_without_contact():
    """Edge tilt without contact: there is no film once the edge touches, and the run must stop with that error."""
    rotor = edge_tilt(None)
    run = rotor.run(0.02, 1e-4, fails=True)
    text = str(run.error)
    for part in ("rotor bearing", "t = ", "eccentricity ratio", "minimum gap", "contact=RegularisedWall"):
        assert part in text, text
    h = run.history
    # everything up to the touch is kept, and it is the touch: at the edge, not in the mid-plane
    assert h.minimum_gap[-1] < 0.02 * CLEARANCE
    assert h.largest_eccentricity_ratio[-1] > h.eccentricity_ratio[-1] + 0.1
    return run


def speed_ramp(first, last, duration):
    """Angle and spin of a ramp with smooth ends."""

    def spin(t):
        s = min(max(t / duration, 0.0), 1.0)
        return first + (last - first) * s * s * (3.0 - 2.0 * s)

    def angle(t):
        s = min(max(t / duration, 0.0), 1.0)
        return first * t + (last - first) * duration * (s**3 - 0.5 * s**4) + (last - first) * max(t - duration, 0.0)

    return angle, spin


@functools.cache
def mixed_bearing():
    return bearing(asperity=ROUGH, film=ehd.FiniteLength(n_theta=96, n_z=8), viscosity=0.004)


def lying(made, load):
    """Height at which the contacts alone carry ``load`` at rest, m."""

    def excess(eps):
        return (
            float(np.hypot(*ehd.steady(made, speed=0.0, eccentricity_ratio=eps, direction=-0.5 * math.pi).force[:2]))
            - load
        )

    return -CLEARANCE * brentq(excess, 0.9, 1.0, xtol=1e-12)


@hard_case("start-up from contact", rejected=6, slow=True)
def start_up():
    """Journal at rest on its asperities; the oil film has to lift it while the speed rises."""
    load = 4000.0
    rotor = Rotor(
        mixed_bearing(),
        load=(0.0, -load),
        speed=speed_ramp(0.0, SPEED, 0.1),
        position=(0.0, lying(mixed_bearing(), load)),
    )
    run = rotor.run(0.14, 5e-4)
    h = run.history
    assert abs(h.contact_load[0] / load - 1.0) < 1e-6
    assert h.contact_load[-1] < 1e-3 * load
    eq = ehd.equilibrium(mixed_bearing(), speed=SPEED, load=(0.0, -load))
    assert np.hypot(*(h.eccentricity[-1] - eq.position)) < 0.01 * CLEARANCE
    # once lifted, the contact does not come back
    lifted = np.flatnonzero(h.contact_load < 1e-3 * load)[0]
    assert np.all(h.contact_load[lifted:] < 1e-2 * load)
    return run


@hard_case("coast-down into contact", rejected=6, slow=True)
def coast_down():
    """The film vanishes with the speed, and the asperities take over: mixed friction rises through Stribeck's curve."""
    load = 4000.0
    eq = ehd.equilibrium(mixed_bearing(), speed=SPEED, load=(0.0, -load))
    rotor = Rotor(mixed_bearing(), load=(0.0, -load), speed=speed_ramp(SPEED, 0.0, 0.1), position=eq.position)
    run = rotor.run(0.14, 5e-4)
    h = run.history
    # load sharing: contact grows as the gap closes, smoothly
    assert h.contact_load[0] < 1e-3 * load
    assert h.contact_load[-1] > 0.5 * load
    assert np.all(np.diff(h.contact_load) > -0.02 * load)
    assert np.abs(h.force[:, 1] - load).max() < 0.05 * load
    # the coefficient of friction passes a minimum that lies below both ends of the ramp
    turning = h.motion[:, 8] > 0.02 * SPEED
    mu = np.abs(h.friction_torque[turning]) / (RADIUS * load)
    assert mu.min() < 0.5 * mu[0] and mu.min() < 0.5 * mu[-1]
    return run


def thrown(duration, step, *, speed=0.0, load=0.0):
    """A journal in a bearing that does not turn, narrow and with thin oil, so that it reaches the wall."""
    wall = ehd.RegularisedWall(onset=3e-6, pressure=1e9)
    made = bearing(contact=wall, viscosity=1e-5, length=0.01)
    return Rotor(
        made,
        mass=1.0,
        load=(0.0, -load),
        speed=0.0,
        velocity=(0.0, -speed),
        step_control=ehd.StepControl(largest_gap_change=0.1),
    ).run(duration, step)


@hard_case("impact on the wall", rejected=30)
def impact():
    """A journal is thrown on the bush at 0.5 m/s through thin oil; it must rebound without a gain of energy."""
    run = thrown(5e-4, 2e-5, speed=0.5)
    h = run.history
    energy = 0.5 * (h.motion[:, 4] ** 2 + h.motion[:, 5] ** 2)
    assert h.contact_load.max() > 0.0
    free = energy[h.contact_load == 0.0]
    # the wall returns what it took; the film only takes
    assert np.all(np.diff(free) <= 1e-3 * energy[0])
    assert 0.5 * energy[0] < free[-1] < energy[0]
    # down, up and down again: one rebound at the bottom, one at the top
    assert np.count_nonzero(np.diff(np.sign(h.motion[:, 5])) != 0) == 2
    assert abs(h.eccentricity[:, 0]).max() < 1e-9 * CLEARANCE
    return run


@hard_case("bouncing to rest", rejected=80, slow=True)
def bouncing():
    """Impacts follow each other ever faster until the journal lies still: the
    contact's time scale is far below the step."""
    load = 200.0
    run = thrown(0.02, 2e-5, load=load)
    h = run.history
    y = h.eccentricity[:, 1]
    peaks = y[1:-1][(y[1:-1] > y[:-2]) & (y[1:-1] >= y[2:])]
    assert peaks.size >= 3
    assert np.all(np.diff(peaks) < 1e-9)
    assert abs(h.force[-20:, 1].mean() / load - 1.0) < 0.05
    return run
