"""Liner with laws of the oil, rough surfaces and heat: closed forms of the axial flow, limits, balances, solid oil."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

import exudyn_ehd as ehd
from exudyn_ehd.film.lubricant.shear_profile import EXACT, fluidity_table, gauss_points, profile
from exudyn_ehd.film.surfaces.roughness import average_gap_ratio, pressure_flow_factor
from exudyn_ehd.joint.model.build import build_model

R, L, C, MU, SPEED = 0.02, 0.03, 20e-6, 0.02, 200.0
SIGMA = 0.8e-6
LINER = ehd.ElasticLiner(thickness=2e-3, youngs_modulus=5e9)
BARUS = ehd.BarusPressure(coefficient=2e-8)
ROELANDS = ehd.RoelandsPressure(coefficient=2e-8)
CARREAU = ehd.CarreauShear(relaxation_time=2e-6, exponent=0.6, residual=0.1)
HOT = {"temperature_law": ehd.ReynoldsTemperature(point=(320.0, MU), coefficient=0.03), "temperature": 320.0}
EFFECTS = {
    "barus": {"lubricant": ehd.Lubricant(viscosity=MU, pressure_law=BARUS)},
    "roelands": {"lubricant": ehd.Lubricant(viscosity=MU, pressure_law=ROELANDS)},
    "carreau": {"lubricant": ehd.Lubricant(viscosity=MU, shear_law=CARREAU)},
    "barus, carreau": {"lubricant": ehd.Lubricant(viscosity=MU, pressure_law=BARUS, shear_law=CARREAU)},
    "rough": {"roughness": ehd.PatirCheng(composite_roughness=SIGMA)},
    "energy": {
        "lubricant": ehd.Lubricant(viscosity=MU, **HOT),
        "thermal": ehd.FilmEnergy(supply_temperature=320.0),
    },
    "barus, lumped": {
        "lubricant": ehd.Lubricant(viscosity=MU, pressure_law=BARUS, **HOT),
        "thermal": ehd.LumpedThermal(supply_temperature=320.0),
    },
}
CLOSURES = [
    ehd.FullSommerfeld(),
    ehd.Gumbel(),
    ehd.SwiftStieber(),
    ehd.ElrodAdams(cavity_pressure=-1e5),
]
every_closure = pytest.mark.parametrize("closure", CLOSURES, ids=lambda c: type(c).__name__)


def bearing(**options):
    plain = {
        "journal_radius": R,
        "length": L,
        "radial_clearance": C,
        "lubricant": ehd.Lubricant(viscosity=MU),
        "bush": LINER,
        "film": ehd.FiniteLength(n_theta=48, n_z=8),
    }
    return ehd.JournalBearing(**(plain | options))


def motion(eps, angle=0.7, speed=SPEED, rate=0.0):
    out = np.zeros(10)
    out[:2] = eps * C * np.array([np.cos(angle), np.sin(angle)])
    out[4] = rate * C
    out[8] = speed
    return out


def length_of(effect, flow, p_end, K):
    """Length (m) over which a flow (m2/s) along z takes the pressure to ``p_end`` in the sheared gap C + K p."""
    oil, points = fluidity_table(CARREAU), gauss_points(12)
    time = CARREAU.relaxation_time

    def per_slope(p):
        h = C + K * p
        S = time * R * SPEED / h

        def excess(slope):
            return h * h / time * profile(S, 0.0, time / MU * h * slope, oil, points, S, 0.0, EXACT)[0].F_z - flow

        thicker = np.exp(BARUS.coefficient * p) if "barus" in effect else 1.0
        return 1.0 / (thicker * brentq(excess, 0.0, 24.0 * MU * flow / h**3, rtol=1e-12))

    return quad(per_slope, 0.0, p_end)[0]


def conductance(effect, h, p):
    """h^3 over the viscosity's ratio across the sliding, times the flow factor, from the textbook formulas.

    H in m, p in Pa.
    """
    ratio = 1.0
    if "barus" in effect:
        ratio *= np.exp(BARUS.coefficient * p)
    if "roelands" in effect:
        a = np.log(MU) + 9.67
        Z = ROELANDS.coefficient * 1.96e8 / a
        ratio *= np.exp(a * ((1.0 + p / 1.96e8) ** Z - 1.0))
    if effect == "rough":
        return h**3 * float(pressure_flow_factor(h / SIGMA, 1.0))
    return h**3 / ratio


@pytest.mark.parametrize("effect", ["barus", "roelands", "carreau", "barus, carreau", "rough"])
def test_flow_through_a_soft_annulus(effect):
    """Concentric, pressed through from end to end.

    ``q L = 2 pi R / (12 mu) int g(h(p), p) dp`` with ``h = c + K p``, whatever the course of p; with thinning, by the
    length that a flow takes.

    The gap opens by a fifth, the oil thickens by half. 5e-4 on 8 intervals, and second order.
    """
    ends = (0.0, 2e7)
    K = LINER.compliance
    flow = quad(lambda p: conductance(effect, C + K * p, p), *ends)[0] * 2.0 * np.pi * R / (12.0 * MU * L)
    if "carreau" in effect:
        thick = flow / (2.0 * np.pi * R)
        flow *= brentq(lambda times: length_of(effect, times * thick, ends[1], K) - L, 0.5, 20.0, rtol=1e-8)
    assert 0.1 * C < K * ends[1] < 0.3 * C
    errors = []
    for n_z in (4, 8, 16):
        options = EFFECTS[effect] | {"end_pressures": ends, "film": ehd.FiniteLength(n_theta=16, n_z=n_z)}
        found = build_model(bearing(cavitation=ehd.FullSommerfeld(), **options)).evaluate(motion(0.0)).quantities()
        errors.append(abs(found["leakage_lower"] / flow - 1.0))
        assert found["leakage_upper"] == pytest.approx(-found["leakage_lower"], rel=1e-9)
    assert errors[1] < 5e-4
    assert errors[2] < 0.3 * errors[1]


@pytest.mark.parametrize("effect", EFFECTS)
@every_closure
def test_stiff_liner_approaches_the_rigid_bore_at_first_order(closure, effect):
    at = motion(0.7)
    rigid = build_model(bearing(bush=None, cavitation=closure, **EFFECTS[effect])).evaluate(at).wrench
    errors = []
    for modulus in (1e13, 2e13, 4e13):
        bush = dataclasses.replace(LINER, youngs_modulus=modulus)
        found = build_model(bearing(bush=bush, cavitation=closure, **EFFECTS[effect])).evaluate(at).wrench
        errors.append(np.abs(found - rigid)[:2].max())
    np.testing.assert_allclose(np.log2(np.array(errors[:-1]) / errors[1:]), 1.0, atol=0.03)
    assert errors[0] < 0.01 * np.abs(rigid).max()


WEAK = {
    "barus": [
        {"lubricant": ehd.Lubricant(viscosity=MU, pressure_law=ehd.BarusPressure(coefficient=a))}
        for a in (2e-12, 1e-12)
    ],
    "roelands": [
        {"lubricant": ehd.Lubricant(viscosity=MU, pressure_law=ehd.RoelandsPressure(coefficient=a))}
        for a in (2e-12, 1e-12)
    ],
    "carreau": [
        {"lubricant": ehd.Lubricant(viscosity=MU, shear_law=ehd.CarreauShear(relaxation_time=2e-6, exponent=1.0 - a))}
        for a in (2e-5, 1e-5)
    ],
}


@pytest.mark.parametrize("law", WEAK)
@every_closure
def test_weak_laws_recover_the_constant_oil(closure, law):
    """First order in the coefficient, towards the plain liner's film (another program)."""
    at = motion(0.7)
    plain = build_model(bearing(cavitation=closure)).evaluate(at).wrench
    errors = [
        np.abs(build_model(bearing(cavitation=closure, **options)).evaluate(at).wrench - plain)[:2].max()
        for options in WEAK[law]
    ]
    assert errors[0] < 1e-3 * np.abs(plain).max()
    assert errors[1] == pytest.approx(0.5 * errors[0], rel=0.01)


def test_thick_oil_opens_its_gap():
    """The classical pair.

    Piezoviscosity raises the pressure of a rigid bore until it has no film, on a liner it raises the film.
    """
    found = {}
    for bush in (None, LINER):
        for law in (None, BARUS):
            oil = ehd.Lubricant(viscosity=MU, pressure_law=law)
            model = build_model(bearing(bush=bush, lubricant=oil))
            peak = model.evaluate(motion(0.8)).quantities()["peak_pressure"]
            # the gap at mid-length: at the ends a liner does not deflect
            found[bush is LINER, law is BARUS] = peak, model.solver.H[:, 4].min()
            if bush is None and law is BARUS:
                assert model.evaluate(motion(0.95)).status is ehd.Status.NO_PRESSURE
    raised = {k: found[k, True][0] / found[k, False][0] for k in (False, True)}
    assert raised[False] > 1.1 * raised[True] > 1.1
    assert found[True, True][1] > 1.02 * found[True, False][1] > 1.2 * found[False, False][1]
    model = build_model(bearing(lubricant=oil))
    assert model.evaluate(motion(0.95)).status is ehd.Status.CONVERGED


@every_closure
def test_heat_of_a_film_on_a_liner_is_kept(closure):
    """Energy balance of the temperature field over steps in which liner and journal move; 1e-8 of its largest term."""
    model = build_model(bearing(cavitation=closure, **EFFECTS["energy"]))
    history, at = model.initial_history(motion(0.6)), motion(0.6, rate=20.0)
    for _ in range(20):
        at = at.copy()
        at[0] += at[4] * 2e-4
        evaluation = model.evaluate(at, history, 2e-4)
        assert evaluation.status is ehd.Status.CONVERGED
        history = evaluation.history()
        b = model.effects.thermal.balance(evaluation.film, history.temperature)
        left = b["heat_in"] - b["convected"] - b["conducted"] - b["stored"]
        assert abs(left) < 1e-8 * max(abs(v) for v in b.values())
    assert history.temperature.max() > 325.0


def test_solid_oil_has_no_film():
    """A stiff liner and a squeeze that would take gigapascals: said so, not a number."""
    bush = dataclasses.replace(LINER, youngs_modulus=1e13)
    for name in ("barus", "roelands"):
        model = build_model(bearing(bush=bush, **EFFECTS[name]))
        evaluation = model.evaluate(motion(0.95, rate=1e5))
        assert evaluation.status is ehd.Status.NO_PRESSURE
        assert np.all(np.isnan(evaluation.wrench))
        # and the next film is found again
        assert model.evaluate(motion(0.5)).status is ehd.Status.CONVERGED


def test_rough_surfaces_that_overlap_have_no_film_without_a_contact():
    """The average gap between rough surfaces stays open; without a contact nothing holds them apart."""
    soft = dataclasses.replace(LINER, youngs_modulus=1e8)
    model = build_model(bearing(bush=soft, **EFFECTS["rough"]))
    assert model.evaluate(motion(1.02)).status is ehd.Status.NO_FILM


def test_average_gap_is_the_nominal_one_here():
    """`test_flow_through_a_soft_annulus` needs no average gap: 25 sigma and more."""
    assert float(average_gap_ratio(np.array([C / SIGMA]), 0.0)[0]) == pytest.approx(C / SIGMA, rel=1e-12)


@pytest.mark.parametrize("contact", [False, True])
@every_closure
def test_drag_of_unequally_rough_surfaces_on_a_liner(closure, contact):
    """Tangent against central differences.

    The pressure drags the rougher surface more, by a gap that follows the pressure; 1e-6.
    """
    options = {"roughness": ehd.PatirCheng(composite_roughness=SIGMA, journal_share=0.9)}
    if contact:
        options["asperity"] = ehd.GreenwoodTripp(composite_roughness=SIGMA, composite_modulus=1e10)
    model = build_model(bearing(cavitation=closure, **options))
    at = motion(0.9)
    at[2:4], at[4:8], at[9] = (1e-5, -2e-5), (4e-4, -3e-4, 2e-2, 1e-2), 0.3
    history, step = model.initial_history(at - 0.01 * np.array([C, C, 0, 0, 0, 0, 0, 0, 0, 0])), 2e-4
    evaluation = model.evaluate(at, history, step)
    assert evaluation.status is ehd.Status.CONVERGED
    assert (evaluation.quantities()["contact_load"] > 0.0) is contact
    tangent = evaluation.tangent()
    scale = np.array([C, C, C / L, C / L, C * SPEED, C * SPEED, C * SPEED / L, C * SPEED / L, SPEED, SPEED * R])
    difference = np.empty((6, 10))
    for k in range(10):
        d = np.zeros(10)
        d[k] = 1e-6 * scale[k]
        difference[:, k] = (
            model.evaluate(at + d, history, step).wrench - model.evaluate(at - d, history, step).wrench
        ) / 2e-6
    assert np.all(np.abs(tangent * scale - difference) < 1e-6 * np.abs(difference).max(axis=1, keepdims=True))


OILS = {
    "constant": {},
    "compressible": {"density_law": ehd.DowsonHigginson()},
    "thinning": {"shear_law": ehd.CarreauShear(relaxation_time=1e-6, exponent=0.7, residual=0.5)},
}


@pytest.mark.parametrize("oil", OILS)
@pytest.mark.parametrize("line_in_cells", [False, True], ids=["vertices", "cells"])
def test_films_with_a_memory_on_a_stiff_liner_are_those_of_the_rigid_bore(oil, line_in_cells):
    """Random histories, calm and with speeds that grow manifold from step to step; from a cold start too."""
    bearing = ehd.JournalBearing(
        journal_radius=0.025,
        length=0.025,
        radial_clearance=25e-6,
        lubricant=ehd.Lubricant(viscosity=0.02, **OILS[oil]),
        film=ehd.FiniteLength(n_theta=32, n_z=4),
        cavitation=ehd.ElrodAdams(cavity_pressure=-1e5, line_in_cells=line_in_cells),
    )
    stiff = ehd.ElasticLiner(thickness=1e-4, youngs_modulus=2e12, poisson_ratio=0.3)
    models = [build_model(bearing), build_model(dataclasses.replace(bearing, bush=stiff))]
    rng = np.random.default_rng(7)
    for _ in range(4):
        angle, place, speed = rng.uniform(0, 6.3), rng.uniform(7e-6, 22e-6), rng.uniform(5.0, 50.0)
        histories = [None, None]
        for step in range(14):
            wild = step in (0, 9, 10, 12)
            turn = angle + 0.3 * math.sin(step)
            motion = np.zeros(10)
            motion[:2] = place * math.cos(turn), place * math.sin(turn)
            motion[4:6] = 2e-3 * math.cos(step), 1e-3
            motion[8] = speed * (rng.uniform(20.0, 60.0) * (-1) ** step if wild and step else 1.0)
            forces = []
            for k, model in enumerate(models):
                histories[k] = model.initial_history(motion) if step == 0 else histories[k]
                found = model.evaluate(motion, histories[k], 2e-3)
                model.forget()
                cold = model.evaluate(motion, histories[k], 2e-3)
                size = np.abs(found.wrench[:2]).max()
                assert np.abs(cold.wrench - found.wrench)[:2].max() <= 1e-9 * size
                histories[k] = cold.history()
                forces.append(cold.wrench[:2])
            assert np.abs(forces[1] - forces[0]).max() <= 1e-2 * np.abs(forces[0]).max()
