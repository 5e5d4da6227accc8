"""A ball in its socket that keeps account of its oil: transport, balance, memory, tangent, against films without."""

import math
from functools import partial
from types import SimpleNamespace

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.joint.solved_film import History
from exudyn_ehd.joint.spherical.bearing import SphereFlow, sphere_patch
from exudyn_ehd.joint.spherical.model import PLACE, SPIN, VELOCITY
from exudyn_ehd.status import Status
from tests.joint.spherical.test_model import BARUS, CUP, RING, WALL, C, R, model, motion, numerical, states

VAPOUR = ehd.ElrodAdams(cavity_pressure=-1e5)


def turned(vector, axis, angle):
    axis = axis / np.linalg.norm(axis)
    cross = np.cross(axis, vector)
    return vector * math.cos(angle) + cross * math.sin(angle) + axis * (axis @ vector) * (1 - math.cos(angle))


@pytest.mark.parametrize("angles", [CUP, RING, (0.0, 2.9), (0.05, 0.4)])
@pytest.mark.parametrize("size", [(16, 4), (48, 24)])
def test_flows_of_a_full_film_leave_control_volumes_as_the_gap_says(angles, size):
    """``-N (e x w) / (2 c)``, and nothing at an even gap, by exact integrals over the edges; at the pole too."""
    rng, patch = np.random.default_rng(0), sphere_patch(1.0, angles, *size)
    flow = SphereFlow(patch, 1.0)
    for _ in range(5):
        w, e = rng.normal(size=(2, 3))
        ends = np.stack([patch.link_normals, 0.5 * (patch.normals + np.roll(patch.normals, -1, 2))])
        for place in (0.0 * e, e):
            gap = 1.0 - np.tensordot(place, ends, (0, 1))
            x, z = np.tensordot(w, flow.turn, (0, 1)) * gap + np.einsum("k,l,xklij->xij", w, place, flow.lean)
            leaves = x - np.roll(x, 1, 0) + z
            leaves[:, 1:] -= z[:, :-1]
            # over the first edge, where there is one, nothing is counted
            inner = slice(0 if angles[0] == 0.0 else 1, None)
            exact = -0.5 * np.tensordot(np.cross(place, w), patch.vector, (0, 0))
            assert np.abs(leaves - exact)[:, inner].max() < 1e-13


@pytest.mark.parametrize("angles", [CUP, RING])
@pytest.mark.parametrize("wall", [None, WALL])
def test_a_film_that_nowhere_ruptures_is_that_of_other_closures(angles, wall):
    """To round-off; with a wall that limits the gap to the grid's error."""
    rng, compared = np.random.default_rng(1), 0
    whole = model(cavitation=ehd.FullSommerfeld(), socket_angles=angles, contact=wall)
    kept = model(cavitation=ehd.ElrodAdams(cavity_pressure=-1e9), socket_angles=angles, contact=wall)
    plain = model(socket_angles=angles, contact=wall)
    oil = model(cavitation=ehd.ElrodAdams(), socket_angles=angles, contact=wall)
    for state in states(rng, 6, 0.95 if wall is None else 1.0):
        for one, other in ((whole, kept), (plain, oil)):
            film, its = one.evaluate(state), other.evaluate(state)
            if not all((at.solver.work.active | at.grid.fixed).all() for at in (one, other)):
                continue
            compared += 1
            tolerance = 1e-9 if film.film.limited is None else 1e-2
            assert np.abs(film.wrench - its.wrench)[:3].max() < tolerance * np.abs(film.wrench[:3]).max()
            assert np.abs(film.wrench - its.wrench)[3:].max() < tolerance * np.abs(film.wrench[3:]).max()
            a, b = film.tangent(), its.tangent()
            assert np.abs(a - b)[:3].max() < tolerance * np.abs(a[:3]).max()
    assert compared >= 6


def test_a_ball_that_spins_about_the_line_to_its_place_presses_nowhere():
    rng = np.random.default_rng(2)
    for closure in (VAPOUR, ehd.ElrodAdams()):
        film = model(cavitation=closure, socket_angles=RING)
        for _ in range(3):
            way = rng.normal(size=3)
            way /= np.linalg.norm(way)
            found = film.evaluate(motion(0.7 * C * way, spin=40.0 * way))
            assert found.status is Status.CONVERGED and film.solver.fill.min() > 1.0 - 1e-12
            # a journal of this size has 1e6 Pa
            assert np.abs(found.film.pressure).max() < 1e-5


def void_of(film, centre, width=0.35):
    """Smooth void around a direction, half of the gap at most."""
    return 0.5 * np.exp(-((np.arccos(np.clip(np.tensordot(centre, film.patch.normals, (0, 0)), -1, 1)) / width) ** 2))


@pytest.mark.parametrize(
    ("angles", "centre", "spin"),
    [
        (RING, (1.0, 0.0, 0.4), (0.0, 0.0, 20.0)),
        (RING, (1.0, 0.0, 0.9), (0.0, 11.0, 0.0)),
        ((0.0, 2.3), (-0.6, 0.0, 1.0), (0.0, 20.0, 0.0)),
        ((0.0, 2.3), (0.3, -0.4, 1.0), (-9.0, 16.0, 7.0)),
    ],
)
def test_voids_move_with_half_the_angular_velocity(angles, centre, spin):
    """In an even gap a void is carried along as it is, over the pole too; grids widen it, fine ones less."""
    spin, centre, misses = np.array(spin), np.array(centre) / np.linalg.norm(centre), []
    for factor in (1, 2):
        film = model(cavitation=ehd.ElrodAdams(), socket_angles=angles, n_phi=48 * factor, n_chi=24 * factor)
        state, area, time, steps = motion(spin=spin), film.grid.area, 0.12, 30 * factor
        first = void_of(film, centre) * ~film.grid.fixed
        flooded = film.initial_history(state)
        history = History(void=first, mass=1.0 - first, outflow=np.array([1.0 - first, *flooded.outflow[1:]]))
        for _ in range(steps):
            found = film.evaluate(state, history, time / steps)
            assert found.status is Status.CONVERGED
            assert np.abs(found.film.pressure).max() < 1e-6
            history = found.history()
        inside = (area * history.void).sum() / (area * first).sum()
        assert inside == pytest.approx(1.0, abs=0.03)  # the rest has reached an edge
        mean = (film.patch.normals * (area * history.void)).sum((1, 2))
        start = (film.patch.normals * (area * first)).sum((1, 2))
        should = turned(start / np.linalg.norm(start), spin, 0.5 * np.linalg.norm(spin) * time)
        assert mean / np.linalg.norm(mean) @ should > math.cos(0.04 / factor)
        there = void_of(film, turned(centre, spin, 0.5 * np.linalg.norm(spin) * time))
        misses.append((area * np.abs(history.void - there)).sum() / (area * first).sum())
    assert misses[1] < 0.75 * misses[0] and misses[0] < 0.65


def path(t, amplitude=0.75):
    """A place that goes to and fro in the socket, its velocity, and a spin that changes its axis."""
    way = np.array([math.cos(30 * t), math.sin(50 * t), 0.6 * math.cos(70 * t)])
    rate = np.array([-30 * math.sin(30 * t), 50 * math.cos(50 * t), -42 * math.sin(70 * t)])
    spin = 60.0 * np.array([math.cos(9 * t), 0.8, math.sin(14 * t)])
    return motion(0.6 * amplitude * C * way, 0.6 * amplitude * C * rate, spin)


@pytest.mark.parametrize("wall", [None, WALL])
@pytest.mark.parametrize("closure", [VAPOUR, ehd.ElrodAdams()])
@pytest.mark.parametrize("angles", [CUP, RING])
def test_oil_balances_to_round_off_in_a_motion(closure, angles, wall):
    """The film holds more by what flows bring over the edges; cavities come and go."""
    film = model(n_phi=32, n_chi=12, cavitation=closure, socket_angles=angles, contact=wall)
    step, least, amplitude = 5e-4, 1.0, 0.75 if wall is None else 1.0
    history = film.initial_history(path(0.0, amplitude))
    brought, first, area = 0.0, history.mass, film.grid.area
    for k in range(1, 120):
        found = film.evaluate(path(k * step, amplitude), history, step)
        assert found.status is Status.CONVERGED
        brought += step * film.solver.inflow().sum()
        history = found.history()
        least = min(least, film.solver.fill.min())
        held, whole = (area * (history.mass - first)).sum(), (area * history.mass).sum()
        assert abs(held - brought) < 1e-11 * whole
        # the content follows from them but for half of a step's change of the gap
        content = film.solver.H - history.void
        assert abs((area * (content - history.mass)).sum()) < 0.02 * whole
    assert least < 0.9


@pytest.mark.parametrize("wall", [None, WALL])
@pytest.mark.parametrize("law", [None, BARUS])
@pytest.mark.parametrize("closure", [VAPOUR, ehd.ElrodAdams(cavity_pressure=-1e3), ehd.ElrodAdams()])
@pytest.mark.parametrize("angles", [CUP, RING])
def test_tangent_is_exact(closure, angles, law, wall):
    """Derivatives of a steady film, and over steps with a memory that has voids."""
    rng = np.random.default_rng(4)
    film = model(law, n_phi=24, n_chi=8, cavitation=closure, socket_angles=angles, contact=wall)
    cavitated, history = 0.0, None
    for k, state in enumerate(states(rng, 6, 0.8 if wall is None else 1.02)):
        step = (3e-4, 1e-3)[k % 2] if k else 0.0
        state[VELOCITY] *= 1.0 if law is None else 0.1
        found = film.evaluate(state, history, step)
        assert found.status is Status.CONVERGED
        cavitated = max(cavitated, 1.0 - film.solver.fill.min())
        tangent = found.tangent()
        other = numerical(SimpleNamespace(evaluate=partial(film.evaluate, history=history, step=step)), state)
        for rows in (slice(0, 3), slice(3, 6)):
            for columns in (PLACE, VELOCITY, SPIN):
                assert np.abs(tangent - other)[rows, columns].max() < 1e-4 * np.abs(other[rows, columns]).max()
        found = film.evaluate(state, history, step)
        history = found.history()
    assert cavitated > 0.1


@pytest.mark.parametrize("closure", [VAPOUR, ehd.ElrodAdams()])
def test_films_do_not_depend_on_the_one_before(closure):
    used, step = model(n_phi=32, n_chi=12, cavitation=closure, socket_angles=RING), 1e-3
    history = used.initial_history(path(0.0))
    for k in range(1, 25):
        found = used.evaluate(path(k * step), history, step)
        fresh = model(n_phi=32, n_chi=12, cavitation=closure, socket_angles=RING)
        cold = fresh.evaluate(path(k * step), history, step)
        assert np.abs(found.wrench - cold.wrench).max() < 1e-9 * np.abs(cold.wrench).max()
        used.evaluate(path(k * step), history, step)
        history = found.model.evaluate(path(k * step), history, step).history()


@pytest.mark.parametrize("angles", [CUP, RING])
def test_turned_motions_have_turned_wrenches(angles):
    """Turns of the whole scene about the socket's axis by whole columns, over steps."""
    turn, step = 2 * math.pi * 5 / 48, 1e-3
    q = np.array([[math.cos(turn), -math.sin(turn), 0], [math.sin(turn), math.cos(turn), 0], [0, 0, 1]])
    films, histories = [], []
    for _ in range(2):
        films.append(model(cavitation=VAPOUR, socket_angles=angles))
        histories.append(films[-1].initial_history(path(0.0)))

    def moved(state):
        return motion(q @ state[PLACE], q @ state[VELOCITY], q @ state[SPIN])

    for k in range(1, 20):
        one = films[0].evaluate(path(k * step), histories[0], step)
        other = films[1].evaluate(moved(path(k * step)), histories[1], step)
        both = np.concatenate([q @ one.wrench[:3], q @ one.wrench[3:]])
        assert np.abs(other.wrench - both).max() < 1e-8 * np.abs(both).max()
        histories = [one.history(), other.history()]
    assert films[0].solver.fill.min() < 0.9


@pytest.mark.slow
@pytest.mark.parametrize("angles", [CUP, RING])
def test_steady_films_converge_with_the_grid(angles):
    """Force and torque of random steady films that rupture, against a grid twice as fine in both directions."""
    rng, errors = np.random.default_rng(8), []
    films = [model(cavitation=VAPOUR, socket_angles=angles, n_phi=n, n_chi=n // 2) for n in (24, 48, 96, 192)]
    for state in states(rng, 6, 0.85):
        state[VELOCITY], state[SPIN] = 0.0, 3.0 * state[SPIN]
        wrenches = [film.evaluate(state).wrench for film in films]
        size = np.linalg.norm(wrenches[-1][:3])
        errors.append([np.linalg.norm((w - wrenches[-1])[:3]) / size for w in wrenches[:-1]])
    errors = np.array(errors)
    # voids that come back to the film are carried by upwind fills, of first order
    assert np.median(errors[:, 1]) < 0.015 and errors[:, 1].max() < 0.2
    assert (errors[:, 1] < 0.7 * errors[:, 0]).all() and (errors[:, 2] < 0.5 * errors[:, 1]).all()


def test_steady_films_without_a_source_of_oil_say_so():
    ball = ehd.SphericalBearing(
        ball_radius=R, radial_clearance=C, lubricant=ehd.Lubricant(viscosity=0.1), cavitation=ehd.ElrodAdams()
    )
    with pytest.raises(ehd.FilmError, match="NO_OIL"):
        ehd.steady_spherical(ball, place=(0.5 * C, 0.0, 0.0), angular_velocity=(0.0, 0.0, 30.0))
    fed = ehd.steady_spherical(ball, place=(0.5 * C, 0.0, 0.0), angular_velocity=(30.0, 10.0, 30.0))
    assert 0.0 < fed.fill.min() < 1.0 and np.isfinite(fed.tangent).all()


@pytest.mark.parametrize("seed", range(4))
def test_derivatives_to_the_velocity_at_rest_are_those_of_the_force(seed):
    """`steady_spherical` keeps the oil content of the film at rest while the ball begins to move."""
    rng = np.random.default_rng(seed)
    ball = ehd.SphericalBearing(
        ball_radius=0.015,
        radial_clearance=30e-6,
        lubricant=ehd.Lubricant(viscosity=0.1),
        socket_angles=((0.7, math.pi - 0.7), (0.0, 2.0))[seed % 2],
        cavitation=VAPOUR,
    )
    e, at = rng.normal(size=3), {"angular_velocity": 80.0 * rng.normal(size=3)}
    at["place"] = 0.6 * 30e-6 * e / np.linalg.norm(e)

    def load(velocity):
        film = ehd.steady_spherical(ball, **at, velocity=velocity)
        return np.concatenate((film.force, np.cross(at["place"], film.force) + film.torque))

    found = ehd.steady_spherical(ball, **at).tangent[:, 3:6]
    for k, velocity in enumerate(1e-6 * np.eye(3)):
        assert found[:, k] == pytest.approx(
            (load(velocity) - load(-velocity)) / 2e-6, abs=1e-3 * np.abs(found[:3]).max()
        )
