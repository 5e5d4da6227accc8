"""A mass-conserving film's rupture line inside its cells: what it solves, from any start; flows, stiffness, damping."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

import exudyn_ehd as ehd
from exudyn_ehd.joint.heat.power import heat_and_exchange, powers
from exudyn_ehd.joint.model.build import build_model, build_study_model
from exudyn_ehd.status import Status
from tests.film.cavitation.test_rupture_line import _coefficients, _films, _random_film
from tests.film.cavitation.test_void import TURN, Run, make

C, R = 25e-6, 0.025
LINE, PLAIN = ehd.ElrodAdams(line_in_cells=True), ehd.ElrodAdams()
BELOW = ehd.ElrodAdams(cavity_pressure=-5e4, line_in_cells=True)
SIZES = ((24, 6, 2.0), (33, 7, 0.5), (16, 4, 4.0), (48, 8, 1.0))


def _start(film, seed):
    """A random film, three of four in time; returns what `FilmSolver.solve` takes.

    Without a history a film is fed, and its gaps do not change: others may have no solution, or more than one.
    """
    rng = np.random.default_rng(seed)
    known, mass, step = _random_film(film, rng), None, 0.0
    shape = film.H.shape
    if rng.random() < 0.75:
        step = 10.0 ** rng.uniform(-4.0, 0.5)
        mass = film.H * np.where(rng.random(shape) < 0.5, 1.0, rng.random(shape))
    else:
        film.H_t[:] = 0.0
        film.pressure[:, 0], film.pressure[:, -1] = 10.0 ** rng.uniform(-2.0, 2.0, 2)
    film.lag(None, 0.0)
    if mass is not None and rng.random() < 0.5:
        drains = abs(known[0]) / 0.3 * rng.random(shape)
        rises = rng.uniform(-1.0, 1.0, shape)
        film.lag(np.stack((mass / film.H, film.H_t / film.H, drains, rises)), step)
    return (*known, mass, step)


def _unbalanced(film, pc, mass, step, dense_matrix):
    """Largest residual of the mass balances at the film's fills, over the flows."""
    s, (n, m), carried = film.system, film.H.shape, film.carried
    out = (dense_matrix(s.kx, s.kz) @ (s.pressure - pc).ravel()).reshape(n, m)
    grow = film.H_t * s.fill if mass is None else (s.fill * film.H - mass) / step
    out += s.area * grow
    for axis, f in ((0, s.fx), (1, s.fz)):
        flow = f * np.where(f > 0.0, carried, np.roll(carried, -1, axis))
        out += flow - np.roll(flow, 1, axis)
    flows = np.abs(s.fx).max() + np.abs(s.kx * (s.pressure - pc)).max() + np.abs(s.kz * (s.pressure - pc)).max()
    flows += (s.area * (np.abs(film.H_t) + (0.0 if mass is None else mass / step))).max() + 1e-12
    return np.where(s.fixed, 0.0, np.abs(out)).max() / flows


def _off_the_curve(film, pc):
    """Largest distance of fills, and of what flows carry, from what the pressures of their vertices make of them."""
    s = film.system
    fixed, p = s.fixed, s.pressure - pc
    near = fixed | np.roll(fixed, 1, 0) | np.roll(fixed, -1, 0)
    out = np.maximum(s.fx, 0.0) + np.maximum(-np.roll(s.fx, 1, 0), 0.0)
    out += np.maximum(s.fz, 0.0) + np.maximum(-np.roll(s.fz, 1, 1), 0.0)
    k, opens = 0.5 * (s.kx + np.roll(s.kx, 1, 0)), (s.b < -1e-13 * out) & (out > 0.0) & ~near
    o = np.where(opens, out, 1.0)
    f = np.where(opens, -s.b / np.sqrt(1.0 + (s.b / o) ** 2), 0.0)
    place = np.sqrt(2.0 * k * np.maximum(p, 0.0) / np.where(opens, f, 1.0))
    held, flows = (
        1.0 - np.where(opens, 0.5 * f / o * np.maximum(1.0 - place / end, 0.0) ** 2, 0.0) for end in (0.25, 1)
    )
    assert p[~fixed].min() >= 0.0
    assert s.fill.min() >= 0.0
    assert s.fill.max() <= 1.0
    off = np.where(p > 0.0, np.abs(s.fill - held), np.maximum(s.fill - held, 0.0))
    # what flows bring along from the step before is known
    off += np.where((p > 0.0) & (s.prompt == 1.0), np.abs(film.carried - flows), 0.0)
    return np.where(fixed, 0.0, off).max()


def _check_states(count, seed, dense_matrix):
    rng, steps, refused = np.random.default_rng(seed), [], 0
    pairs = list(zip(_films(LINE, SIZES), _films(LINE, SIZES), strict=True))
    for k in range(count):
        warm, cold = pairs[rng.integers(len(pairs))]
        same = rng.integers(2**31)
        cold.forget()
        for film in (warm, cold):
            state = _start(film, same)
            status, taken = film.solve(*state)
            if status is not Status.CONVERGED and film.lagging:  # as `FilmSolver.advance` does
                refused += 1
                film.lag(None, 0.0)
                status, taken = film.solve(*state)
            assert status is Status.CONVERGED, (seed, k)
            steps.append(taken)
        pc, mass, step = state[2:]
        # films at rest have no peak, only what is left of the last film
        peak = np.abs(cold.pressure - pc).max() + 1e-3
        assert np.abs(warm.pressure - cold.pressure).max() <= 1e-10 * peak, (seed, k)
        assert _unbalanced(cold, pc, mass, step, dense_matrix) < 1e-11, (seed, k)
        assert _off_the_curve(cold, pc) < 1e-9, (seed, k)
    assert refused < 0.1 * count
    return np.mean(steps)


@pytest.mark.slow
def test_random_films_are_on_their_curves_from_any_start(dense_matrix):
    """The problem has one solution: of 4000 random films, each after another one and alone."""
    assert _check_states(4000, 1, dense_matrix) < 15.0


@pytest.mark.slow
@pytest.mark.parametrize("tilt", (0.0, 1.0))
def test_rupture_is_that_of_swift_and_stieber(tilt):
    """In a film flooded upstream both rupture conditions are one, to a higher order of the cell size."""
    motion = np.array([0.7 * C, 0.0, 2e-4 * tilt, 1e-4 * tilt, 0, 0, 0, 0, 100.0, 0])
    apart = []
    for n, nz in ((48, 8), (96, 12)):
        forces, tangents = [], []
        for closure in (ehd.SwiftStieber, ehd.ElrodAdams):
            bearing = ehd.JournalBearing(
                journal_radius=R, length=0.05, radial_clearance=C, lubricant=ehd.Lubricant(viscosity=0.02),
                film=ehd.FiniteLength(n_theta=n, n_z=nz), cavitation=closure(line_in_cells=True),
                supply=(ehd.AxialGroove(angle=np.pi, width_angle=0.3, length=0.05),),
            )  # fmt: skip
            evaluation = build_model(bearing).evaluate(motion)
            forces.append(evaluation.wrench[:2].copy())
            tangents.append(evaluation.tangent()[:2, :2])
        apart.append(np.abs(forces[1] - forces[0]).max() / np.abs(forces[0]).max())
        assert np.abs(tangents[1] - tangents[0]).max() < 2e-4 * np.abs(tangents[0]).max()
    assert apart[0] < 3e-5
    assert apart[1] < apart[0] / 5.0


def _ruptured_gap(eccentricity, inlet):
    """Gap over c at the rupture of an infinitely long film that starts at ``inlet`` after the largest gap, rad."""

    def gap(x):
        return 1.0 + eccentricity * np.cos(x)

    def pressure(end):
        return quad(lambda x: (gap(x) - gap(end)) / gap(x) ** 3, inlet, end, epsabs=1e-13)[0]

    return gap(brentq(pressure, np.pi + 0.02, 2.0 * np.pi - 0.02, xtol=1e-14))


def _cavity_flow(model, eccentricity):
    """Flow in the cavity upstream of the inlet, over the flow of a gap of c."""
    model.evaluate(np.array([eccentricity * C, 0, 0, 0, 0, 0, 0, 0, 100.0, 0]))
    s = model.solver
    last = np.flatnonzero(~s.work.active[:, 1] & ~s.grid.fixed[:, 1])[-1]
    return s.system.fx[last, 1] * s.carried[last, 1] / (s.vx * s.grid.width_z[1])


@pytest.mark.slow
def test_flow_of_the_cavity_against_the_closed_form(measured):
    """The flow past the rupture line of a long film is proportional to the gap there, and so is its derivative."""
    errors, slopes = {}, {}
    for closure in (LINE, PLAIN):
        for n in (64, 128):
            bearing = ehd.JournalBearing(
                journal_radius=R, length=0.05, radial_clearance=C, lubricant=ehd.Lubricant(viscosity=0.02),
                film=ehd.LongBearing(n_theta=n, n_z=2), inlet=ehd.MaximumGap(), cavitation=closure,
            )  # fmt: skip
            model, off, steep = build_study_model(bearing, np.pi), [], []
            for eccentricity in np.linspace(0.5, 0.6, 12):
                more, less = (_cavity_flow(model, eccentricity + h) for h in (1e-4, -1e-4))
                above, below = (_ruptured_gap(eccentricity + h, 0.0) for h in (1e-4, -1e-4))
                off.append(more / above - 1.0)
                steep.append((more - less) / (above - below) - 1.0)
            errors[closure, n], slopes[closure, n] = np.abs(off).max(), np.abs(steep).max()
    measured("flow, 128 columns", errors[LINE, 128], 1e-4)
    measured("its slope, 128 columns", slopes[LINE, 128], 2e-3)
    assert errors[LINE, 64] > 3.0 * errors[LINE, 128]
    assert slopes[LINE, 64] > 3.0 * slopes[LINE, 128]
    assert slopes[PLAIN, 128] > 5.0 * slopes[LINE, 128]


LINER, SOFT = (ehd.ElasticLiner(thickness=1e-3, youngs_modulus=E) for E in (1e9, 1e8))
THIN = {"shear_law": ehd.CarreauShear(relaxation_time=1e-6, exponent=0.6, residual=0.2)}
DENSE = {"density_law": ehd.DowsonHigginson(), "pressure_law": ehd.BarusPressure(coefficient=1e-8)}


def _oil(**laws):
    return ehd.Lubricant(viscosity=0.02, **laws)


GROOVE = ehd.AxialGroove(angle=2.0, width_angle=0.4, length=0.006, pressure=1e5)
SCENES = {
    "below": {"cavitation": BELOW},
    "groove": {"cavitation": LINE, "supply": (GROOVE,)},
    "hole": {"cavitation": BELOW, "supply": (ehd.Hole(angle=1.0, diameter=3e-3, pressure=1e5),)},
    "ends": {"cavitation": LINE, "end_pressures": (2e5, 0.0)},
    "thin": {"cavitation": BELOW, "lubricant": _oil(**THIN)},
    "liner, groove": {"cavitation": LINE, "bush": SOFT, "supply": (GROOVE,)},
    "liner, dense": {"cavitation": BELOW, "bush": LINER, "lubricant": _oil(**DENSE)},
}


@pytest.mark.slow
@pytest.mark.parametrize("scene", SCENES)
@pytest.mark.parametrize("step", (TURN / 40.0, TURN / 400.0))
def test_oil_is_conserved_in_time(scene, step):
    options = dict(SCENES[scene])
    run = Run(make(options.pop("cavitation"), **options), step)
    run.advance(120)
    assert run.unbalanced < 1e-11
    assert run.lost < 1e-12
    assert run.least > 0.0


OPTIONS = {
    "plain": {},
    "ends": {"end_pressures": (1e5, 3e4)},
    "long": {
        "film": ehd.LongBearing(n_theta=64, n_z=4),
        "supply": (ehd.AxialGroove(angle=1.0, width_angle=0.2, pressure=1e5),),
    },
    "piezoviscous": {
        "lubricant": ehd.Lubricant(viscosity=0.02, pressure_law=ehd.BarusPressure(coefficient=1e-8)),
    },
    "compressible": {
        "lubricant": ehd.Lubricant(
            viscosity=0.02,
            pressure_law=ehd.BarusPressure(coefficient=1e-8),
            density_law=ehd.DowsonHigginson(coefficient=5e-9),
        )
    },
    "rough": {"roughness": ehd.PatirCheng(composite_roughness=2e-6, journal_share=0.9)},
    "groove": {"supply": (ehd.AxialGroove(angle=1.0, width_angle=0.3, length=0.03, pressure=2e5),)},
    "wall": {"contact": ehd.RegularisedWall(onset=10e-6, pressure=2e7)},
    "heated": {"lubricant": ehd.oil("ISO VG 46"), "thermal": ehd.FilmEnergy(supply_temperature=320.0)},
    "thin": {"lubricant": _oil(**THIN)},
    "thin, dense": {"lubricant": _oil(**THIN, **DENSE)},
    "thin, rough": {
        "lubricant": _oil(**THIN),
        "roughness": ehd.PatirCheng(composite_roughness=2e-6, journal_share=0.9),
    },
    "liner": {"bush": SOFT},
    "liner, dense": {"bush": LINER, "lubricant": _oil(**DENSE)},
    "liner, thin": {"bush": LINER, "lubricant": _oil(**THIN)},
    "liner, wall": {"bush": SOFT, "contact": ehd.RegularisedWall(onset=10e-6, pressure=2e7)},
    "liner, rough": {
        "bush": LINER,
        "lubricant": _oil(pressure_law=ehd.BarusPressure(coefficient=1e-8)),
        "roughness": ehd.PatirCheng(composite_roughness=2e-6, journal_share=0.9),
        "asperity": ehd.GreenwoodTripp(composite_roughness=2e-6, composite_modulus=1e10),
    },
    "liner, heated": {
        "bush": LINER,
        "lubricant": ehd.oil("ISO VG 46"),
        "thermal": ehd.FilmEnergy(supply_temperature=320.0),
    },
}


@pytest.mark.slow
@pytest.mark.parametrize("name", OPTIONS)
def test_tangent_is_the_derivative(make_bearing, name):
    """Random states, steady and in time. Along z the surfaces move, or the oil's way there has a kink."""
    rng = np.random.default_rng(2)
    bearing = make_bearing(1.0, cavitation=BELOW, **{"film": ehd.FiniteLength(n_theta=48, n_z=8)} | OPTIONS[name])
    model, probe = build_model(bearing), build_model(bearing)
    scale = 0.1 * np.array([C, C, C / R, C / R, 100 * C, 100 * C, 100 * C / R, 100 * C / R, 100.0, 1.0])
    at_line = 0
    for trial in range(8):
        e, (a, b) = rng.uniform(0.1, 0.9), rng.uniform(0.0, 2.0 * np.pi, 2)
        tilt = 0.0 if name == "long" else 0.4 * (1.0 - e) * C / R
        place = np.array([C * e * np.cos(a), C * e * np.sin(a), tilt * np.cos(b), tilt * np.sin(b)])
        rates = 30.0 * C * rng.normal(size=4) * [1.0, 1.0, 1.0 / R, 1.0 / R] * (name != "long")
        motion = np.concatenate((place, rates, (rng.choice([-100.0, 300.0]), rng.normal())))
        if trial % 2:
            start, step = motion.copy(), 1e-3
            start[:4] -= step * rates
            history = model.evaluate(start, model.initial_history(start), step).history()
            args = (motion, history, step)
        else:
            args = (motion,)
        tangent, numeric = model.evaluate(*args).tangent() * scale, np.empty((6, 10))
        at_line += int((model.solver.oil_line.fields.s < 1.0).sum())
        for k in range(10):
            step_k = 1e-5 * scale[k] * np.eye(10)[k]
            more, less = (probe.evaluate(motion + sign * step_k, *args[1:]).wrench for sign in (1.0, -1.0))
            numeric[:, k] = (more - less) / 2e-5
        rows = np.abs(tangent).max(axis=1)
        rows[rows < 1e-9 * rows.max()] = np.inf
        assert (np.abs(tangent - numeric) / rows[:, None]).max() < 1e-6, trial
    assert at_line > 8


@pytest.mark.slow
@pytest.mark.parametrize("ratio", (0.5, 1.0))
@pytest.mark.parametrize("scene", ({}, {"end_pressures": (2e5, 2e5)}), ids=("below", "ends"))
def test_coefficients_do_not_know_where_the_line_lies(measured, ratio, scene):
    """16 directions on the default grid. The mean of the damping is that of the grid's reformation fronts, too."""
    directions = np.linspace(0.0, 2.0 * np.pi, 16, endpoint=False) + 0.0123 + np.arange(16) * 0.7 * np.pi / 96
    closures = [ehd.ElrodAdams(cavity_pressure=0.0 if scene else -1e5, line_in_cells=line) for line in (True, False)]
    plain = []
    for eccentricity in (0.6, 0.7, 0.8, 0.9):
        places = np.linspace(0.0, 2.0 * np.pi / 384, 4, endpoint=False) + 0.3
        fine = ehd.FiniteLength(n_theta=384, n_z=32)
        mean = _coefficients(fine, ratio, eccentricity, places, closures[0], **scene)[0].mean(axis=0)
        unit = np.maximum(1.0, np.abs(mean))
        line, grid = (
            _coefficients(ehd.FiniteLength(), ratio, eccentricity, directions, c, **scene)[0] for c in closures
        )
        measured(f"{eccentricity}: stiffness", (np.abs(line - mean) / unit)[:, :4].max(), 0.015)
        measured(f"{eccentricity}: damping", (np.abs(line - mean) / unit)[:, 4:].max(), 0.065)
        measured(f"{eccentricity}: damping over the directions", (np.ptp(line, axis=0) / unit)[4:].max() / 2.0, 0.013)
        plain.append((np.abs(grid - mean) / unit)[:, :4].max())
    assert max(plain) > 0.05


@pytest.mark.slow
def test_sudden_motions_meet_the_film_up_to_its_line(measured):
    """Damping before any oil has moved on: that of a fine grid, for all places of the line in a cell."""
    damping, closure = [], ehd.ElrodAdams(cavity_pressure=-1e5, line_in_cells=True)
    for n, count in ((96, 8), (384, 2)):
        bearing = ehd.JournalBearing(
            journal_radius=R, length=0.05, radial_clearance=C, lubricant=ehd.Lubricant(viscosity=0.02),
            film=ehd.FiniteLength(n_theta=n, n_z=20), cavitation=closure,
        )  # fmt: skip
        model, along = build_model(bearing), []
        for a in np.linspace(0.0, 2.0 * np.pi / n, count, endpoint=False):
            place = np.array([np.cos(a), np.sin(a)])
            motion = np.array([*(0.8 * C * place), 0, 0, 0, 0, 0, 0, 150.0, 0])
            evaluation = model.evaluate(motion, model.evaluate(motion).history())
            along.append(-place @ evaluation.tangent()[:2, 4:6] @ place)
        damping.append(np.array(along))
    mean = damping[1].mean()
    measured("mean", abs(damping[0].mean() / mean - 1.0), 0.005)
    measured("over the places", np.abs(damping[0] / mean - 1.0).max(), 0.015)


@pytest.mark.slow
def test_heat_is_the_power_of_the_motion():
    """Power balance of steady films; the flow at partial fill at the rupture line takes part in it."""
    rng = np.random.default_rng(3)
    bearing = ehd.JournalBearing(
        journal_radius=R, length=0.03, radial_clearance=C, lubricant=ehd.Lubricant(viscosity=0.02),
        film=ehd.FiniteLength(n_theta=48, n_z=8), cavitation=ehd.ElrodAdams(cavity_pressure=-2e4, line_in_cells=True),
    )  # fmt: skip
    model = build_model(bearing)
    for _ in range(5):
        e, a = C * rng.uniform(0.3, 0.95), rng.uniform(0.0, 2.0 * np.pi)
        film = model.evaluate(np.array([e * np.cos(a), e * np.sin(a), 0, 0, 0, 0, 0, 0, 300.0, 0.0])).film
        pressed_out = -bearing.cavitation.cavity_pressure * film.parts.flow_scale * heat_and_exchange(film, 1.0)[1]
        assert (model.solver.oil_line.fields.s < 1.0).any()
        heat, loss = heat_and_exchange(film, 1.0)[0], powers(film).loss
        assert abs(heat / loss - 1.0) < 1e-11 + abs(pressed_out / loss)


@pytest.mark.parametrize(
    "options",
    ({"film": ehd.ShortBearing()},),
)
def test_what_does_not_know_the_line_is_refused(make_bearing, options):
    with pytest.raises(ehd.InputError, match=r"ElrodAdams\.line_in_cells=True does not go with"):
        make_bearing(1.0, cavitation=BELOW, **options)


def test_the_option_is_a_truth():
    with pytest.raises(ehd.InputError, match=r"ElrodAdams\.line_in_cells must be True or False"):
        ehd.ElrodAdams(line_in_cells="cell")
