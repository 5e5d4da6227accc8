"""Seals at the ends: closed form of a sealed damper, open and tight limits, flows, exact tangents."""

from __future__ import annotations

import math

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.joint.model.build import build_model

RADIUS, LENGTH, CLEARANCE, VISCOSITY = 0.025, 0.03, 25e-6, 0.02
SIZE = {
    "journal_radius": RADIUS,
    "length": LENGTH,
    "radial_clearance": CLEARANCE,
    "lubricant": ehd.Lubricant(viscosity=VISCOSITY),
}
GRID = ehd.FiniteLength(n_theta=48, n_z=8)
# of a film as thick as the clearance and as long as the bearing
NOMINAL = CLEARANCE**3 / (12.0 * VISCOSITY * LENGTH)
GROOVE = ehd.CircumferentialGroove(width=0.003, pressure=3e5)
CLOSURES = [ehd.FullSommerfeld(), ehd.Gumbel(), ehd.SwiftStieber(), ehd.ElrodAdams(line_in_cells=True)]
ARCS = (
    ehd.Arc(start=0.3, extent=2.4, leading_pressure=1e5, dam=ehd.Dam(depth=5e-5, length=0.012, extent=1.2)),
    ehd.Arc(start=3.4, extent=2.4),
)
SCALE = np.array([1e-6, 1e-6, 1e-4, 1e-4, 1e-3, 1e-3, 1e-2, 1e-2, 10.0, 0.1])


def _name(value):
    return type(value).__name__


def test_damping_of_a_sealed_damper(measured):
    """Small motions of a centred journal: p = P(z) cos theta, P'' - P / R^2 = 12 mu V / c^3, with the seal's law at the
    ends

        C = 12 pi mu R^3 / c^3 (L - 2 R sinh a / (cosh a + b sinh a)),  a = L / (2 R),  b = c^3 / (12 mu R conductance).
    """
    R, L, c, mu = 0.065, 0.04, 1e-4, 0.02
    plain = {"journal_radius": R, "length": L, "radial_clearance": c, "lubricant": ehd.Lubricant(viscosity=mu)}
    a, found = 0.5 * L / R, []
    for conductance in (1e-20, 1e-12, 1e-11, 1e-10, 1e-9, 1e-6, 1.0):
        seal = ehd.EndSeal(conductance=conductance)
        bearing = ehd.JournalBearing(**plain, cavitation=ehd.FullSommerfeld(), end_seals=seal)
        b = c**3 / (12.0 * mu * R * conductance)
        exact = 12.0 * math.pi * mu * R**3 / c**3 * (L - 2.0 * R * math.sinh(a) / (math.cosh(a) + b * math.sinh(a)))
        damping = -build_model(bearing).evaluate(np.zeros(10)).tangent()[:2, 4:6]
        measured(f"damping at {conductance:g}", np.abs(damping / exact - np.eye(2)).max(), 5e-4)
        found.append(damping[0, 0])
    # from a tight damper to an open one
    assert found[0] > 30.0 * found[-1] and np.all(np.diff(found) < 0.0)


@pytest.mark.parametrize("closure", CLOSURES, ids=_name)
def test_tight_and_open_ends(closure, measured):
    """Tight ends make the long bearing, wide ones the open bearing."""
    state = {"speed": 100.0, "eccentricity_ratio": 0.6, "direction": 0.4}
    place, film = {"angle": 1.7, "width_angle": 0.3, "pressure": 2e5}, ehd.FiniteLength(n_theta=96)
    closure_of_both = ehd.ElrodAdams() if closure.conserves_mass else closure
    long = ehd.JournalBearing(
        **SIZE, film=ehd.LongBearing(n_theta=96), cavitation=closure_of_both, supply=(ehd.AxialGroove(**place),)
    )
    groove = ehd.AxialGroove(**place, length=0.9975 * LENGTH)
    tight = ehd.JournalBearing(
        **SIZE, film=film, cavitation=closure_of_both, supply=(groove,), end_seals=ehd.EndSeal(conductance=0.0)
    )
    sealed, exact = ehd.steady(tight, **state), ehd.steady(long, **state)
    measured("tight: force", np.linalg.norm(sealed.force - exact.force) / np.linalg.norm(exact.force), 1e-3)
    assert sealed.leakage == pytest.approx(0.0, abs=1e-15)
    ends = {**SIZE, "film": film, "cavitation": closure, "end_pressures": (1e5, 2e5)}
    wide = ehd.steady(ehd.JournalBearing(**ends, end_seals=ehd.EndSeal(conductance=1e8 * NOMINAL)), **state)
    exact = ehd.steady(ehd.JournalBearing(**ends), **state)
    measured("wide: force", np.linalg.norm(wide.force - exact.force) / np.linalg.norm(exact.force), 1e-6)
    assert wide.friction_torque == pytest.approx(exact.friction_torque, rel=1e-6)


@pytest.mark.parametrize(
    "options",
    [
        {
            "supply": (ehd.CircumferentialGroove(width=0.003, pressure=3e5),),
            "end_seals": ehd.EndSeal(conductance=NOMINAL),
        },
        {"end_seals": (ehd.EndSeal(conductance=0.3 * NOMINAL), None), "end_pressures": (2e5, 1e5)},
        {
            "supply": (
                ehd.Pocket(
                    angle=0.3,
                    width_angle=0.6,
                    length=0.015,
                    supply=ehd.Orifice(diameter=4e-4, supply_pressure=2e6),
                ),
            ),
            "end_seals": (ehd.EndSeal(conductance=0.3 * NOMINAL), ehd.EndSeal(conductance=0.0)),
            "turbulence": ehd.NgPan(),
            "contact": ehd.RegularisedWall(onset=8e-6),
        },
        {"arcs": ARCS, "end_seals": (ehd.EndSeal(conductance=0.3 * NOMINAL), None), "end_pressures": (2e5, 1e5)},
    ],
    ids=["fed in the middle", "one end", "pocket", "arcs"],
)
@pytest.mark.parametrize("closure", CLOSURES, ids=_name)
def test_flow_and_tangent(closure, options):
    """Tilted, squeezed, sliding axially: the seal's law at the end, and the derivative against differences."""
    rng = np.random.default_rng(4)
    bearing = ehd.JournalBearing(**SIZE, film=GRID, cavitation=closure, **options)
    model, compared = build_model(bearing), 0
    for sign in (1.0, -1.0, 1.0):
        e, angle = CLEARANCE * rng.uniform(0.2, 0.6), rng.uniform(0.0, 2.0 * math.pi)
        motion = np.array([e * math.cos(angle), e * math.sin(angle), *(rng.uniform(-2.0, 2.0, 6) * SCALE[2:8]), 0, 0])
        motion[8:] = 150.0 * sign, 0.03 * rng.uniform(-1.0, 1.0)
        known = model.initial_history(motion), 1e-3
        evaluation = model.evaluate(motion, *known)
        P, s = evaluation.film.oil.P * evaluation.film.scales.pressure, model.solver
        width, along = RADIUS * model.grid.width_x, 0.5 * motion[9]
        fill = s.carried[:, 1] if along < 0.0 else s.carried[:, 0]
        sealed = ~np.isin(np.arange(len(P)), model.grid.edges)
        through = bearing.seals[0] * CLEARANCE * RADIUS * np.sum((P[:, 1] - P[:, 0]) * width * sealed)
        dragged = -np.sum(along * 0.5 * CLEARANCE * (s.H[:, 0] + s.H[:, 1]) * fill * width)
        if not closure.clips:  # which cuts pressures off afterwards
            leakage = evaluation.quantities()["leakage_lower"]
            if bearing.arcs:  # whose leakage counts the axial speed for a full film
                leakage = -model.parts.flow_scale * s.inflow()[:, 0].sum()
            assert leakage == pytest.approx(through + dragged, rel=1e-6)
        direction = rng.standard_normal(10) * SCALE
        tangent, sets, sides, same = evaluation.tangent() @ direction, s.work.active.copy(), [], True
        for side in (1.0, -1.0):
            sides.append(model.evaluate(motion + side * 2e-5 * direction, *known).wrench)
            same &= np.array_equal(s.work.active, sets)
        compared += same
        if not same:  # a vertex's pressure is cut off in between
            continue
        size = np.array([1.0] * 3 + [RADIUS] * 3) * np.linalg.norm(evaluation.wrench[:3])
        assert np.all(np.abs((sides[0] - sides[1]) / 4e-5 - tangent) < 2e-6 * size)
    assert compared > 0


def test_oil_balance_in_time():
    """Oil of a groove leaves through the seals or fills the gap, over 40 steps of a mass-conserving film."""
    bearing = ehd.JournalBearing(
        **SIZE,
        film=GRID,
        cavitation=ehd.ElrodAdams(),
        supply=(GROOVE,),
        end_seals=ehd.EndSeal(conductance=0.2 * NOMINAL),
    )
    model, step = build_model(bearing), 2e-4
    volume = model.solver.area * CLEARANCE * RADIUS**2
    history = model.initial_history(np.zeros(10))
    start, fed = float(np.sum(volume * history.mass)), 0.0
    for k in range(40):
        e, angle = CLEARANCE * (0.3 + 0.6 * math.sin(0.05 * k)), 0.2 * k
        motion = np.array([e * math.cos(angle), e * math.sin(angle), 0, 0, 0, 0, 0, 0, 150.0, 0.0])
        evaluation = model.evaluate(motion, history, step)
        q, history = evaluation.quantities(), evaluation.history()
        fed += (q["supply_flow"] - q["leakage"]) * step
    change = float(np.sum(volume * history.mass)) - start
    assert abs(change - fed) < 1e-9 * start


def test_heat_leaves_with_the_oil():
    """The temperature of `LumpedThermal` behind seals: the power that enters is what the leaking oil takes along."""
    oil = ehd.oil("ISO VG 46")
    bearing = ehd.JournalBearing(
        **SIZE | {"lubricant": oil},
        film=GRID,
        cavitation=ehd.ElrodAdams(),
        thermal=ehd.LumpedThermal(supply_temperature=313.0),
        supply=(GROOVE,),
        end_seals=ehd.EndSeal(conductance=0.2 * NOMINAL),
    )
    film = ehd.steady(bearing, speed=300.0, eccentricity_ratio=0.5)
    carried = oil.density * oil.specific_heat * film.leakage * (film.temperature - 313.0)
    pumped = GROOVE.pressure * float(film.supply_flows[0])
    assert carried == pytest.approx(film.power_loss + pumped, rel=1e-6)


@pytest.mark.parametrize("closure", CLOSURES, ids=_name)
def test_tight_and_open_ends_of_arcs(closure):
    """Wide seals are open ends; behind tight ones the film feeds and drains through the edges alone."""
    state = {"speed": 100.0, "eccentricity_ratio": 0.5, "direction": 0.4}
    size = {**SIZE, "film": GRID, "cavitation": closure, "arcs": ARCS, "end_pressures": (3e5, 1e5)}
    wide, tight, exact = (
        ehd.steady(ehd.JournalBearing(**size, **seals), **state)
        for seals in (
            {"end_seals": ehd.EndSeal(conductance=1e8 * NOMINAL)},
            {"end_seals": ehd.EndSeal(conductance=0.0)},
            {},
        )
    )
    np.testing.assert_allclose(wide.force, exact.force, rtol=0.0, atol=1e-6 * np.linalg.norm(exact.force))
    assert wide.friction_torque == pytest.approx(exact.friction_torque, rel=1e-6)
    assert wide.power_loss == pytest.approx(exact.power_loss, rel=1e-6)
    assert tight.leakage == pytest.approx(0.0, abs=1e-14)
    assert np.linalg.norm(tight.force) > 1.5 * np.linalg.norm(exact.force)
