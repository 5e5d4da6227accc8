"""A film never depends on where its solver started: force, moments and their tangent after a distant film are those of
a cold start."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.joint.model.build import build_model
from tests.descriptions import CAVITATION
from tests.sampling import sample

RADIUS, LENGTH, CLEARANCE, VISCOSITY, SPEED = 0.03, 0.04, 30e-6, 0.02, 300.0
# Share of the force and of the tangent in which two starts may differ: solutions of one linear system leave some 1e-14,
# films of an oil with laws, whose pressures are taken from tables, ten times as much.
SAME = 1e-12
# Pa, below which a film at rest has no pressure.
NOTHING = 1e-6
BORES = {
    "rigid": {},
    "liner": {"bush": ehd.ElasticLiner(thickness=2e-3, youngs_modulus=1e10)},
    "liner and wall": {
        "bush": ehd.ElasticLiner(thickness=2e-3, youngs_modulus=1e9),
        "contact": ehd.RegularisedWall(onset=0.1 * CLEARANCE, pressure=1e7),
    },
    "modal": {
        "bush": ehd.ModalBush(
            mesh=ehd.HollowCylinder(
                inner_radius=RADIUS, thickness=0.5 * RADIUS, length=LENGTH, axial=2, radial=1, circumferential=12
            ),
            material=ehd.SaintVenantKirchhoff(youngs_modulus=2e10, poisson_ratio=0.3, density=7800.0),
            tolerance=0.2,
        )
    },
}
LAWS = {
    "constant": {},
    "barus": {"pressure_law": ehd.BarusPressure(coefficient=1e-8)},
    "roelands": {"pressure_law": ehd.RoelandsPressure(coefficient=1e-8)},
    "density": {"density_law": ehd.DowsonHigginson()},
    "carreau": {"shear_law": ehd.CarreauShear(relaxation_time=2e-6, exponent=0.8)},
}
# Gauge pressures of the cavity and of both ends, Pa.
PRESSURES = ((-1e5, 5e5, 2e5), (-1e5, 0.0, 0.0), (0.0, 0.0, 2e5))


def _closures():
    """Every closure, with its rupture line on the vertices and inside the cells."""
    for kind in CAVITATION:
        options = ({},) if not hasattr(kind, "line_in_cells") or kind is ehd.FullSommerfeld else (False, True)
        yield from ((kind, o if isinstance(o, dict) else {"line_in_cells": o}) for o in options)


def _bearings(bores, laws):
    """Names and bearings of all that go together, at the pressures in turn."""
    for k, ((kind, options), bore, law) in enumerate(itertools.product(_closures(), bores, laws)):
        pc, *ends = PRESSURES[k % 3]
        cavity = {} if kind is ehd.FullSommerfeld else {"cavity_pressure": pc}
        try:
            bearing = ehd.JournalBearing(
                journal_radius=RADIUS,
                length=LENGTH,
                radial_clearance=CLEARANCE,
                lubricant=ehd.Lubricant(viscosity=VISCOSITY, **LAWS[law]),
                film=ehd.FiniteLength(n_theta=48, n_z=6),
                cavitation=kind(**options, **cavity),
                end_pressures=tuple(ends),
                **BORES[bore],
            )
        except ehd.InputError:
            continue
        yield f"{kind.__name__} {options} {bore} {law} {pc:g} {ends}", bearing


def _motion(rng, size):
    """Any position, tilt, spin (or none), axial speed, rates up to ten times the spin's; small shapes of a bore."""
    eps, a, b = rng.uniform(0.02, 0.95), *rng.uniform(0.0, 2.0 * math.pi, 2)
    rest = (1.0 - eps) * CLEARANCE
    tilt = rng.choice([0.0, 0.7]) * rng.uniform() * rest * 2.0 / LENGTH
    rates = rest * SPEED * rng.choice([0.0, 10.0 ** rng.uniform(-3.0, 1.0)], 2)
    e = eps * CLEARANCE
    return np.concatenate(
        (
            [e * math.cos(a), e * math.sin(a), tilt * math.cos(b), tilt * math.sin(b)],
            rates[0] * rng.normal(size=2),
            rates[1] * 2.0 / LENGTH * rng.normal(size=2),
            [SPEED * rng.choice([-1.0, 0.0, 0.01, 1.0, 3.0]), rng.choice([0.0, 0.0, 1.0]) * rng.normal()],
            0.01 * rest * rng.normal(size=size),
            0.01 * rest * SPEED * rng.choice([0.0, 1.0]) * rng.normal(size=size),
        )
    )


def _difference(one, other, size):
    """Largest difference of wrench and of tangent, over the largest force and over the largest entry for a clearance,
    for the spin or for the axial speed."""
    rows = np.array([1.0, 1.0, 1.0, *[1.0 / RADIUS] * 3, *[1.0] * size])
    place = [CLEARANCE, CLEARANCE, CLEARANCE / LENGTH, CLEARANCE / LENGTH]
    columns = np.array(
        [*place, *(SPEED * x for x in place), SPEED, 1.0, *[CLEARANCE] * size, *[CLEARANCE * SPEED] * size]
    )
    forces = [rows[:6] * e.wrench for e in (one, other)]
    tangents = [rows[:, None] * e.tangent() * columns for e in (one, other)]
    least = NOTHING * 2.0 * RADIUS * LENGTH / SAME
    off = np.abs(forces[0] - forces[1]).max() / max(np.abs(forces[1]).max(), least)
    for part in (slice(0, 4), slice(4, 8), slice(8, 9), slice(9, 10), slice(10, None)):
        scale = max(np.abs(tangents[1][:, part]).max(initial=0.0), least)
        off = max(off, np.abs((tangents[0] - tangents[1])[:, part]).max(initial=0.0) / scale)
    return off


def _compare(bearings, states, seed):
    rng, found = np.random.default_rng(seed), 0
    for name, bearing in bearings:
        warm, cold = build_model(bearing), build_model(bearing)
        size = warm.size if warm.flexible else 0
        for k in range(states):
            motion = _motion(rng, size)
            cold.forget()
            one, other = warm.evaluate(motion), cold.evaluate(motion)
            assert one.status is other.status, (name, k, motion, one.status, other.status)
            if one.status is ehd.Status.CONVERGED:
                found += 1
                off = _difference(one, other, size)
                assert off <= SAME, (name, k, motion, off)
    return found


def test_random_films_after_distant_ones():
    """Films between rigid surfaces; the oil's laws and flexible bores are in the slow test."""
    assert _compare(_bearings(["rigid"], ["constant", "barus"]), 12, 1) > 120


@pytest.mark.slow
def test_many_random_films_after_distant_ones():
    """2 000 states of every closure, bore and law that go together."""
    assert _compare(_bearings(BORES, LAWS), 28, 2) > 2000


@pytest.mark.parametrize("line_in_cells", sample([False, True], 1))
def test_dry_films_with_rates_that_last(line_in_cells):
    """Cavities whose gap closes faster than their oil flows out may stay dry or fill up: two films for one motion."""
    bearing = ehd.JournalBearing(
        journal_radius=RADIUS,
        length=LENGTH,
        radial_clearance=CLEARANCE,
        lubricant=ehd.Lubricant(viscosity=VISCOSITY),
        film=ehd.FiniteLength(n_theta=48, n_z=6),
        cavitation=ehd.ElrodAdams(line_in_cells=line_in_cells),
    )
    warm, cold, rng, found = build_model(bearing), build_model(bearing), np.random.default_rng(3), 0
    for _ in range(400):
        eps, a = rng.uniform(0.05, 0.98), rng.uniform(0.0, 2.0 * math.pi)
        rates = (1.0 - eps) * CLEARANCE * 10.0 ** rng.uniform(0.0, 4.0) * rng.normal(size=2)
        place = eps * CLEARANCE * np.array([math.cos(a), math.sin(a)])
        motion = np.array([*place, 0, 0, *rates, 0, 0, SPEED * rng.choice([-1.0, 0.0, 0.1, 1.0]), 0])
        cold.forget()
        one, other = warm.evaluate(motion), cold.evaluate(motion)
        assert one.status is other.status, motion
        if one.status is ehd.Status.CONVERGED:
            found += 1
            assert np.abs(one.wrench - other.wrench).max() <= SAME * np.abs(other.wrench).max(), motion
    assert found > 200


def _bearing(closure, bore, **options):
    """Bearing whose ends have the cavity's pressure, if no option says otherwise."""
    plain = {
        "journal_radius": RADIUS,
        "length": LENGTH,
        "radial_clearance": CLEARANCE,
        "lubricant": ehd.Lubricant(viscosity=VISCOSITY),
        "film": ehd.FiniteLength(n_theta=48, n_z=6),
        "cavitation": closure,
    }
    return ehd.JournalBearing(**(plain | BORES[bore] | options))


@pytest.mark.parametrize("line_in_cells", [False, True])
@pytest.mark.parametrize(
    ("kind", "bore"), [(ehd.SwiftStieber, "rigid"), (ehd.SwiftStieber, "liner"), (ehd.ElrodAdams, "liner")]
)
def test_nothing_carries_oil_into_a_gap(kind, line_in_cells, bore):
    """Films without wedge and squeeze have any set of full vertices: the tangent is that of the whole film.

    Between rigid surfaces a film that conserves mass keeps its cavities from step to step.
    """
    model = build_model(_bearing(kind(line_in_cells=line_in_cells), bore))
    turning = np.array([0.6 * CLEARANCE, 0.1 * CLEARANCE, 0, 0, 0, 0, 0, 0, SPEED, 0])
    flooded = model.initial_history(turning)
    at_rest, pushed, centred = turning.copy(), turning.copy(), turning.copy()
    at_rest[8], pushed[8:], centred[:2] = 0.0, (0.0, 0.5), 0.0
    for still in (at_rest, pushed, centred):
        assert model.evaluate(turning, flooded, 1e-4).status is ehd.Status.CONVERGED
        one = model.evaluate(still, flooded, 1e-4)
        wrench, tangent = one.wrench.copy(), one.tangent()
        model.forget()
        other = model.evaluate(still, flooded, 1e-4)
        assert np.abs(wrench - other.wrench).max() <= NOTHING * RADIUS * LENGTH
        assert np.abs(tangent - other.tangent()).max() <= 1e-9 * np.abs(tangent).max()


def test_instants_on_a_liner():
    """The force at the very instant of a history, when the journal has got other rates, is found in few steps."""
    liner = {"bush": ehd.ElasticLiner(thickness=2e-3, youngs_modulus=3e9)}
    model, rng = build_model(_bearing(ehd.SwiftStieber(line_in_cells=True), "liner", **liner)), np.random.default_rng(6)
    for _ in range(24):
        motion = _motion(rng, 0)
        motion[8:] = SPEED, 0.0
        history = model.evaluate(motion, model.initial_history(motion), 1e-4).history()
        motion[4:8] = -500.0 * motion[:4]
        one = model.evaluate(motion, history, 0.0)
        assert one.status is ehd.Status.CONVERGED, motion
        assert one.iterations < 50, motion
        wrench = one.wrench
        model.forget()
        other = model.evaluate(motion, history, 0.0)
        assert np.abs(wrench - other.wrench).max() <= 1e-11 * np.abs(wrench).max(), motion


@pytest.mark.parametrize("law", ["constant", "roelands"])
def test_journals_that_nearly_touch_a_soft_liner(law):
    """A cold start finds a film that opens the gap by a hundred times its width."""
    liner = {"bush": ehd.ElasticLiner(thickness=1e-3, youngs_modulus=1e7)}
    oil = {"lubricant": ehd.Lubricant(viscosity=0.005, **LAWS[law])}
    model = build_model(_bearing(ehd.ElrodAdams(line_in_cells=True), "liner", **liner, **oil, end_pressures=(5e5, 5e5)))
    for touching in (0.99, 0.999, 0.9999):
        eps, tilt = 0.99 * CLEARANCE, touching * 0.01 * CLEARANCE * 2.0 / LENGTH
        motion = np.array([eps, 0, -tilt, 0, 0, 0, 0, 0, 0, 0.14])
        model.forget()
        assert model.evaluate(motion).status is ehd.Status.CONVERGED, touching
