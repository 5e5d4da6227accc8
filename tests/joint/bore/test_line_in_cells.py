"""Films on flexible bores with their line inside the cells of the grid: tangents, limits, order, oil, starts."""

from __future__ import annotations

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.joint.model.build import build_model, build_study_model
from tests.sampling import sample

R, L, C, SPEED = 0.03, 0.066, 30e-6, 300.0
MESH = ehd.HollowCylinder(inner_radius=R, thickness=0.02, length=L, axial=2, radial=1, circumferential=12)
SCENES = (
    {},
    {"end_pressures": (2e5, 5e4)},
    {"contact": ehd.RegularisedWall(onset=12e-6, pressure=2e7)},
    {"roughness": ehd.PatirCheng(composite_roughness=1.5e-6, journal_share=0.8)},
    {"turbulence": ehd.Hirs(onset=8.0, full=24.0, coefficient=2.0)},
    {"squeeze": False},
    {"lubricant": ehd.Lubricant(viscosity=9e-3, pressure_law=ehd.BarusPressure(coefficient=1e-8))},
    {"supply": (ehd.AxialGroove(angle=2.0, width_angle=0.4, length=0.5 * L, pressure=1e5),)},
)

SHEAR = ehd.CarreauShear(relaxation_time=1e-6, exponent=0.6)
# of films that conserve mass
THIN = (
    {"lubricant": ehd.Lubricant(viscosity=9e-3, shear_law=SHEAR)},
    {"lubricant": ehd.Lubricant(viscosity=9e-3, shear_law=SHEAR, density_law=ehd.DowsonHigginson())},
)


def surfaces(kind, modulus):
    """Bush, journal or both, of Young's modulus ``modulus``, Pa."""
    material = ehd.SaintVenantKirchhoff(youngs_modulus=modulus, poisson_ratio=0.3, density=7800.0)
    parts = {}
    if kind in ("modal", "both"):
        parts["bush"] = ehd.ModalBush(mesh=MESH, material=material, tolerance=0.2)
    if kind == "nodal":
        parts["bush"] = ehd.ANCFBush(mesh=MESH, material=material)
    if kind in ("journal", "both"):
        held = ehd.HeldEnds()
        parts["journal"] = ehd.ElasticJournal(material=material, span=(-0.6 * L, 0.5 * L), held=held, tolerance=0.2)
    return parts


def make(closure, in_cells=True, grid=(32, 6), cavity_pressure=-1e5, **options):
    plain = {
        "journal_radius": R,
        "length": L,
        "radial_clearance": C,
        "lubricant": ehd.Lubricant(viscosity=9e-3),
        "film": ehd.FiniteLength(n_theta=grid[0], n_z=grid[1]),
        "cavitation": closure(cavity_pressure=cavity_pressure, line_in_cells=in_cells),
    }
    return ehd.JournalBearing(**plain | options)


def states(rng, model, count):
    """Motions, tilted, moving and turned back, and histories of mass-conserving films a step before."""
    k = model.bore.size
    while count > 0:
        e, a, b = rng.uniform(0.1, 0.85), *rng.uniform(0.0, 2.0 * np.pi, 2)
        tilt = rng.choice([0.0, rng.uniform(0.0, 0.8)]) * (1.0 - e) * 2.0 * C / L
        rates = 20.0 * rng.choice([0.0, 1.0], 2).repeat(2) * np.array([C, C, C / L, C / L]) * rng.normal(size=4)
        place = [e * C * np.cos(a), e * C * np.sin(a), tilt * np.cos(b), tilt * np.sin(b)]
        own = 10.0 ** rng.uniform(-7.5, -5.4) * (1.0 - e) / np.sqrt(k) * rng.normal(size=(2, k))
        spin = rng.choice([-1.0, 1.0]) * rng.uniform(50.0, 400.0)
        motion = np.concatenate((place, rates, [spin, 0.3 * rng.normal()], own[0], 20.0 * own[1]))
        args = ()
        if model.remembers_mass and rng.random() < 0.6:
            step, start = 10.0 ** rng.uniform(-4.5, -2.5), motion.copy()
            start[:4] -= step * motion[4:8]
            start[10 : 10 + k] -= step * motion[10 + k :]
            before = model.evaluate(start, model.initial_history(start[:10]), step)
            if before.status is not ehd.Status.CONVERGED:
                continue
            args = before.history(), step
        if model.evaluate(motion, *args).status is ehd.Status.CONVERGED:
            count -= 1
            yield motion, args


def worst_error(evaluation, probe, args, unit, rng):
    """Largest error of the tangent along four random directions, over the rows' largest entries."""
    motion, tangent, k, worst = evaluation.motion, evaluation.tangent(), evaluation.bore.coordinates.size, 0.0
    rows = np.abs(tangent * unit).max(axis=1)
    rows = np.maximum(rows, 1e-9 * rows.max())
    operator = evaluation.nodal_tangent() if hasattr(probe.bore, "surface") else None
    nodal = None if operator is None else operator.whole()[1]
    for kept in (slice(0, 10), slice(10, 10 + k), slice(10 + k, None), slice(None)):
        change, errors = np.zeros(motion.size), []
        change[kept] = (unit * rng.normal(size=motion.size) / np.sqrt(motion.size))[kept]
        for size in (1e-5, 1e-6, 1e-7):
            ends = []
            for sign in (1.0, -1.0):
                e = probe.evaluate(motion + sign * size * change, *args)
                ends.append((np.concatenate((e.wrench, e.bore.load)), None if nodal is None else e.nodal_forces()))
            # loads at vertices end with the round-off of the largest one
            round_off = np.where(np.arange(rows.size) < 6, 0.0, 1e-14 * np.abs(ends[0][0][6:]).max() / size)
            off = np.abs(tangent @ change - (ends[0][0] - ends[1][0]) / (2.0 * size)) - round_off
            error = np.max(off / rows)
            if nodal is not None:
                along = nodal @ change
                product = operator.changes(*np.split(change[:, None], (10, 10 + k)))[1]
                size_of = np.abs(nodal * unit).max(axis=(0, 2))
                assert np.all(np.abs(product[..., 0] - along) < 1e-9 * size_of)
                error = max(error, np.max(np.abs(along - (ends[0][1] - ends[1][1]) / (2.0 * size)) / size_of))
            errors.append(error)
        worst = max(worst, min(errors))
    return worst


CASES = [
    (closure, kind, count, seed)
    for count, seed in ((8, 1), (200, 2))
    for closure in (ehd.Gumbel, ehd.ElrodAdams)
    for kind in ("modal", "nodal", "journal", "both")
]


@pytest.mark.parametrize(("closure", "kind", "count", "seed"), sample(CASES, 1))
def test_tangent_is_the_derivative(closure, kind, count, seed):
    """Random states of random bores of 1e7 to 2e11 Pa: loads on coordinates, forces on nodes, product and matrix.

    1e-6: truncation and round-off of central differences, of which the best of three steps counts, as states may lie
    beside a kink.
    """
    rng, at_line, scenes = np.random.default_rng(seed), 0, SCENES + THIN * (closure is ehd.ElrodAdams)
    for trial in range(count // 4):
        pressure = rng.choice([-1e5, -3e4])
        parts = surfaces(kind, 10.0 ** rng.uniform(7.0, 11.3))
        bearing = make(closure, cavity_pressure=pressure, **parts, **scenes[trial % len(scenes)])
        model, probe = build_model(bearing), build_model(bearing)
        k = model.bore.size
        units = ([C, C, C / R, C / R, 0.01, 0.01, 0.3, 0.3, 300.0, 9.0], np.full(k, C), np.full(k, 0.01))
        for motion, args in states(rng, model, 4):
            evaluation = model.evaluate(motion, *args)
            line = model.solver.oil_line
            at_line += 1 if line is None else int((line.fields.s < 1.0).sum())
            assert worst_error(evaluation, probe, args, np.concatenate(units), rng) < 1e-6, (trial, motion)
    assert at_line >= count


@pytest.mark.slow
@pytest.mark.parametrize(
    ("closure", "kind"), sample([(c, k) for c in (ehd.Gumbel, ehd.ElrodAdams) for k in ("modal", "nodal", "both")], 0)
)
def test_hard_bores_are_rigid(closure, kind):
    """Differences from a rigid bore fall with the compliance, in force, K, C and threshold."""
    where = {"speed": SPEED, "eccentricity_ratio": 0.7, "direction": 0.4}
    rigid = ehd.steady(make(closure), **where).force
    off = [np.abs(ehd.steady(make(closure, **surfaces(kind, E)), **where).force - rigid).max() for E in (2e13, 2e15)]
    assert off[0] == pytest.approx(100.0 * off[1], rel=0.01)
    assert off[0] < 2e-3 * np.abs(rigid).max()
    load = tuple(0.5 * rigid[:2])
    hard, plain = (
        ehd.equilibrium(bearing, speed=SPEED, load=load)
        for bearing in (make(closure, **surfaces(kind, 2e15)), make(closure))
    )
    for name in ("stiffness", "damping", "whirl_ratio", "critical_mass"):
        expected = getattr(plain, name)
        assert np.abs(getattr(hard, name) - expected).max() < 1e-4 * np.abs(expected).max(), name


def coefficients(bearing, place):
    """Force, K c and C c omega of the film on a bore that is held where it has settled, N."""
    model, motion = build_study_model(bearing, 0.0), np.zeros(10)
    motion[:2], motion[8] = place, SPEED
    evaluation = model.evaluate_steady(motion)
    tangent = model.elasticity.tangent(evaluation, exact=True)
    return evaluation.wrench[:2], -C * tangent[:2, :2], -C * SPEED * tangent[:2, 4:6]


@pytest.mark.slow
@pytest.mark.parametrize("modulus", (3e9, 2e10))
@pytest.mark.parametrize("closure", (ehd.Gumbel, ehd.ElrodAdams))
def test_order_two_on_a_soft_bush(closure, modulus, measured):
    """Against a grid of 384 columns, for six directions; the bush recedes by 0.2 and 0.5 of the clearance.

    A groove feeds the film, so that none reforms: where it does, `ElrodAdams` is of order one on rigid bores too.
    """
    groove = (ehd.AxialGroove(angle=0.0, width_angle=2.0 * np.pi / 12.0, pressure=1e5),)
    options = {"cavity_pressure": 0.0, "supply": groove, **surfaces("modal", modulus)}
    angles = np.pi + np.random.default_rng(1).uniform(-0.5, 0.5, 6)
    places = 0.7 * C * np.column_stack((np.cos(angles), np.sin(angles)))

    def found(in_cells, n):
        values = [coefficients(make(closure, in_cells, (n, 12), **options), place) for place in places]
        return [np.array(part) for part in zip(*values, strict=True)]

    fine, errors = found(True, 384), {}
    for key in ((True, 48), (True, 96), (False, 96)):
        pairs = zip(found(*key), fine, strict=True)
        errors[key] = [np.abs(got - expected).max() / np.abs(expected).max() for got, expected in pairs]
    measured("force", errors[True, 96][0], 0.001)
    measured("stiffness", errors[True, 96][1], 0.004)
    measured("damping", errors[True, 96][2], 0.004)
    for part in (1, 2):
        assert errors[True, 48][part] > 2.8 * errors[True, 96][part]
        assert errors[False, 96][part] > 3.0 * errors[True, 96][part]


@pytest.mark.slow
@pytest.mark.parametrize("kind", ("modal", "nodal", "both"))
def test_oil_is_in_balance_and_films_do_not_know_their_start(kind):
    """In time, on soft and hard bores: flows balance content to round-off; warm and cold starts give one film."""
    rng = np.random.default_rng(6)
    for scene in (0, 1, 7):
        bearing = make(ehd.ElrodAdams, **surfaces(kind, 10.0 ** rng.uniform(8.0, 11.0)), **SCENES[scene])
        model, fresh = build_model(bearing), build_model(bearing)
        for motion, args in states(rng, model, 8):
            if not args:
                continue
            warm, s = model.evaluate(motion, *args), model.solver
            gain = np.sum((warm.history().mass - args[0].mass) * s.area) / args[1]
            inflow = s.inflow()
            assert inflow.sum() == pytest.approx(gain, abs=1e-11 * (np.abs(inflow).sum() + abs(gain)) + 1e-9)
            fresh.forget()
            cold = fresh.evaluate(motion, *args)
            for one, other in ((warm.wrench, cold.wrench), (warm.bore.load, cold.bore.load)):
                assert np.abs(one - other).max() < 1e-12 * np.abs(other).max()
