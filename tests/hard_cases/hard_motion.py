"""Loads, speeds and motions that change sign, vanish or destabilise."""

from __future__ import annotations

import math

import exudyn.itemInterface as eii
import numpy as np
from hard_contact import speed_ramp
from hard_registry import hard_case
from hard_scene import CLEARANCE, SPEED, Rotor, bearing

import exudyn_ehd as ehd
from tests.reference import short_bearing


@hard_case("sudden load reversal", slow=True)
def load_reversal():
    """2000 N turn around within no time: the journal crosses the bearing, and
    the film ruptures on one side and forms on the other."""
    made = bearing()
    rotor = Rotor(made, load=lambda t: (0.0, -2000.0 if t < 0.06 else 2000.0))
    run = rotor.run(0.12, 2e-4)
    h = run.history
    eq = ehd.equilibrium(made, speed=SPEED, load=(0.0, -2000.0))
    before, after = h.eccentricity[h.time < 0.0599][-1], h.eccentricity[-1]
    # what is left of the orbit after 60 ms, and the grid's difference between both directions
    assert np.hypot(*(before - eq.position)) < 2e-3 * CLEARANCE
    assert np.hypot(*(after + before)) < 2e-3 * CLEARANCE
    assert rotor.momentum_error(h) < 5e-3
    assert h.power_loss.min() > 0.0
    return run


@hard_case("reversed rotation", slow=True)
def reversed_rotation():
    """An orbit and its mirror image with reversed spin: upstream and downstream, rupture and reformation change
    places."""
    made = bearing(cavitation=ehd.ElrodAdams(cavity_pressure=-1e5))
    runs = [Rotor(made, load=(0.0, -2000.0), speed=sign * SPEED).run(0.02, 2e-4) for sign in (1.0, -1.0)]
    one, other = (run.history for run in runs)
    mirrored = one.eccentricity * (-1.0, 1.0)
    # mirror image on a grid that is its own mirror image; Newton's tolerance of 1e-6 is all that is left
    assert np.abs(other.eccentricity - mirrored).max() < 1e-5 * CLEARANCE
    assert np.allclose(other.friction_torque, -one.friction_torque, rtol=1e-4)
    assert np.allclose(other.leakage, one.leakage, rtol=1e-4, atol=1e-12)
    return runs


@hard_case("oscillating rotation", slow=True)
def oscillating_rotation():
    """The journal swings and stands still twice a period, like a gudgeon pin:
    without a wedge the squeeze alone carries."""
    made = bearing()
    rate = 200.0
    angle = (lambda t: 0.5 * math.sin(rate * t), lambda t: 0.5 * rate * math.cos(rate * t))
    rotor = Rotor(made, load=(0.0, -500.0), speed=angle)
    period = 2.0 * math.pi / rate
    run = rotor.run(12 * period, period / 60)
    h = run.history
    e, last, before = h.eccentricity, slice(-60, None), slice(-120, -60)
    assert h.time.size == 721
    # a periodic motion: the last two periods agree
    assert np.abs(e[last] - e[before]).max() < 5e-3 * CLEARANCE
    assert h.eccentricity_ratio.max() < 0.97
    # the wedge of either direction pushes to its own side: over a period the journal stays below the centre
    assert abs(e[last, 0].mean()) < 0.02 * CLEARANCE
    # torque and spin change sign together, apart from the pressure's part while the spin passes zero
    assert np.all(h.friction_torque * h.motion[:, 8] <= 1e-6 * h.power_loss.max())
    assert h.power_loss.min() >= 0.0
    assert rotor.momentum_error(h) < 1e-3
    return run


@hard_case("zero speed and zero squeeze", newton=1.0)
def nothing_moves():
    """No load, no speed, no rate: no pressure and a force of zero whose tangent must still hold the solver."""
    made = bearing(cavitation=ehd.ElrodAdams(cavity_pressure=-1e5))
    place = (0.3 * CLEARANCE, -0.6 * CLEARANCE)
    run = Rotor(made, speed=0.0, position=place).run(0.01, 1e-4)
    h = run.history
    # not a bit moves
    assert np.all(h.eccentricity == place)
    assert np.all(h.force == 0.0)
    assert np.all(h.power_loss == 0.0)
    return run


@hard_case("let go at rest, then turned", slow=True)
def released():
    """The speed jumps from rest within one step: from a film without any pressure to a full one."""
    made = bearing()
    angle = (lambda t: SPEED * max(t - 2e-3, 0.0), lambda t: SPEED if t > 2e-3 else 0.0)
    rotor = Rotor(made, speed=angle, position=(0.0, -0.8 * CLEARANCE))
    run = rotor.run(0.05, 1e-4)
    h = run.history
    resting = h.time < 1.99e-3
    assert np.all(h.force[resting] == 0.0)
    # without a load it spirals inwards or outwards under cross-coupling alone, slower than half the speed turns it
    turned = np.unwrap(np.arctan2(h.eccentricity[:, 1], h.eccentricity[:, 0]))
    rate = (turned[-1] - turned[h.time > 5e-3][0]) / (h.time[-1] - h.time[h.time > 5e-3][0])
    assert 0.35 * SPEED < rate < 0.55 * SPEED
    assert h.eccentricity_ratio.max() < 1.0
    return run


@hard_case("whirl threshold of the short bearing", rejected=0, slow=True)
def whirl_threshold():
    """A rigid rotor 3 % on either side of its threshold: growth and decay
    of 1 % a turn decide between stable and lost."""
    eps, speed = 0.2, 400.0
    made = bearing(film=ehd.ShortBearing(n_theta=192), length=0.01)
    load = made.reference_force(speed) * short_bearing.load(eps, made.length / (2 * made.journal_radius))
    ratio, mass = short_bearing.whirl_threshold(eps)
    critical = mass * load / (CLEARANCE * speed**2)
    runs, growth = [], []
    for factor in (0.9, 1.1):
        eq = ehd.equilibrium(made, speed=speed, load=(0.0, -load))
        rotor = Rotor(
            made, mass=factor * critical, load=(0.0, -load), speed=speed, position=eq.position + (1e-3 * CLEARANCE, 0.0)
        )
        run = rotor.run(0.6, 6e-4, spectral_radius=1.0)
        away = np.hypot(*(run.history.eccentricity - eq.position).T)
        half = away.size // 2
        growth.append(away[half:].max() / away[:half].max())
        if factor > 1.0:
            x = run.history.eccentricity[:, 0] - eq.position[0]
            crossings = run.history.time[1:][(x[:-1] < 0.0) & (x[1:] >= 0.0)]
            whirl = 2.0 * math.pi * (crossings.size - 1) / (crossings[-1] - crossings[0])
            assert abs(whirl / (ratio * speed) - 1.0) < 0.03
        runs.append(run)
    assert growth[0] < 0.9 and growth[1] > 1.1
    return runs


def whip(first, last, duration, end, step):
    """Disc of 4 kg on a shaft of 300 rad/s, whose journal of 0.4 kg runs in the bearing under the weight's half."""
    made = bearing(film=ehd.ShortBearing(n_theta=96), length=0.016, viscosity=0.01)
    disc, natural = 4.0, 300.0
    rotor = Rotor(made, mass=0.4, speed=speed_ramp(first, last, duration), load=(0.0, -5.0))
    mbs = rotor.mbs
    node = mbs.AddNode(eii.NodePoint2D(referenceCoordinates=[0, 0]))
    mbs.AddObject(eii.ObjectMassPoint2D(nodeNumber=node, mass=disc))
    unbalance = 2e-4 * disc * CLEARANCE

    def load(mbs, t, vector):
        w, a = rotor_spin(t), rotor_angle(t)
        return [unbalance * w * w * math.cos(a), -disc * 9.81 + unbalance * w * w * math.sin(a), 0.0]

    rotor_angle, rotor_spin = speed_ramp(first, last, duration)
    mbs.AddLoad(
        eii.LoadForceVector(
            markerNumber=mbs.AddMarker(eii.MarkerNodePosition(nodeNumber=node)),
            loadVector=[0, 0, 0],
            loadVectorUserFunction=load,
        )
    )
    for k in (0, 1):
        ends = [mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=n, coordinate=k)) for n in (rotor.node, node)]
        mbs.AddObject(
            eii.ObjectConnectorCoordinateSpringDamper(
                markerNumbers=ends, stiffness=disc * natural**2, damping=0.01 * disc * natural
            )
        )
    return rotor.run(end, step), natural


@hard_case("run-up through whirl into whip", rejected=4, slow=True)
def run_up():
    """A flexible rotor passes its critical speed, starts to whirl at half its
    speed and locks to its own frequency: a limit cycle."""
    run, natural = whip(100.0, 1000.0, 0.5, 1.5, 5e-4)
    h = run.history
    late = h.time > 1.2
    t, x = h.time[late], h.eccentricity[late, 0]
    r = h.eccentricity_ratio[late]
    crossings = t[1:][(x[:-1] < x.mean()) & (x[1:] >= x.mean())]
    frequency = 2.0 * math.pi * (crossings.size - 1) / (crossings[-1] - crossings[0])
    # whip: locked to the shaft, far below half of the speed of 1000 rad/s
    assert 0.9 * natural < frequency < 1.1 * natural
    # a limit cycle: large, inside the clearance, of constant amplitude
    assert 0.6 < r.max() < 0.99
    first, second = np.array_split(r, 2)
    assert abs(first.max() - second.max()) < 0.02
    # and stable at the start of the ramp, where only unbalance and weight act
    assert h.eccentricity_ratio[h.time < 0.2].max() < 0.9
    return run


@hard_case("rotating load of constant size", slow=True)
def rotating_load():
    """The load turns with the journal: the film meets its own pressure again at every angle of the grid."""
    made = bearing()
    size = 1000.0
    rotor = Rotor(made, load=lambda t: (size * math.cos(SPEED * t), size * math.sin(SPEED * t)))
    run = rotor.run(0.12, 2e-4)
    h = run.history
    late = h.time > 0.09
    # seen from the load, a bearing turning at minus the speed: e from the
    # equilibrium that also has the journal's inertia
    r = h.eccentricity_ratio[late]
    assert np.ptp(r) < 5e-3
    turned = np.unwrap(np.arctan2(h.eccentricity[late, 1], h.eccentricity[late, 0]))
    assert abs((turned[-1] - turned[0]) / (h.time[late][-1] - h.time[late][0]) / SPEED - 1.0) < 1e-3
    # steady precession at the speed itself is a wedge of minus half the speed: the film sees -speed / 2 in the mean
    eps = float(r.mean())
    film = ehd.steady(made, speed=-SPEED, eccentricity_ratio=eps, direction=0.0)
    phase = turned[0] - SPEED * h.time[late][0]
    inertia = 2.0 * SPEED**2 * eps * CLEARANCE
    push = size * np.array([math.cos(-phase), math.sin(-phase)]) + (inertia, 0.0)
    assert np.hypot(*(film.force[:2] + push)) < 0.02 * size
    return run
