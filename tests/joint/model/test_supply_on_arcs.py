"""Supply areas on arcs: the film of a full ring that grooves at ambient pressure part into the same arcs."""

import dataclasses
import math

import matplotlib.pyplot as plt
import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.joint.model.build import build_model

R, L, C, SPEED = 0.025, 0.03, 25e-6, 300.0
SIZE = {"journal_radius": R, "length": L, "radial_clearance": C}
OIL, HOT = ehd.Lubricant(viscosity=0.02), ehd.oil("ISO VG 46")
ORIFICE = ehd.Orifice(diameter=5e-4, supply_pressure=2e6)
AREAS = {
    "pocket": ehd.Pocket(angle=1.617, width_angle=0.513, length=0.0113, z=0.002, pressure=3e5),
    "groove": ehd.AxialGroove(angle=1.6, width_angle=0.3, length=0.02, pressure=2e5),
    "hole": ehd.Hole(angle=math.pi / 2, diameter=0.004, pressure=4e5),
    "orifice": ehd.Pocket(angle=1.6, width_angle=0.5, length=0.012, supply=ORIFICE),
    "depth": ehd.Pocket(angle=1.6, width_angle=0.5, length=0.012, pressure=3e5, depth=2e-4),
}
CLOSURES = [ehd.FullSommerfeld(), ehd.Gumbel(), ehd.SwiftStieber(line_in_cells=False), ehd.ElrodAdams()]


def films(area, closure, count, n=96, lubricant=OIL, **options):
    """Films of a ring with ``count`` grooves along the axis, and of arcs between them, with an area on one of them."""
    step, span, gap = 2.0 * math.pi / n, n // count, n // 12
    arcs = tuple(ehd.Arc(start=(gap // 2 + k * span) * step, extent=(span - gap) * step) for k in range(count))
    grooves = tuple(ehd.AxialGroove(angle=k * span * step, width_angle=gap * step, length=L) for k in range(count))
    both = {**SIZE, "film": ehd.FiniteLength(n_theta=n, n_z=12), "cavitation": closure, "lubricant": lubricant}
    state = {"speed": SPEED, "eccentricity_ratio": 0.6, "direction": 1.0, "velocity": (1e-3, -2e-3)}
    ring = ehd.JournalBearing(**both, **options, supply=(*grooves, area))
    return ehd.steady(ring, **state), ehd.steady(
        ehd.JournalBearing(**both, **options, arcs=arcs, supply=(area,)), **state
    )


@pytest.mark.parametrize("closure", CLOSURES, ids=lambda closure: type(closure).__name__)
@pytest.mark.parametrize("name", AREAS)
@pytest.mark.parametrize("count", [1, 2])
def test_film_of_a_ring_with_grooves(name, closure, count):
    """Pressure and flow out of the area; integrals by the weights of either grid."""
    ring, arcs = films(AREAS[name], closure, count)
    # beside a groove the ring has fewer rows, as its own grooves pass there
    same = 1e-7 if name != "groove" else 2e-2
    assert arcs.peak_pressure == pytest.approx(ring.peak_pressure, rel=same)
    assert arcs.supply_flows[-1] == pytest.approx(ring.supply_flows[-1], rel=same)
    assert len(arcs.supply_flows) == 2 * count + 1
    np.testing.assert_allclose(arcs.pocket_pressures[-1], ring.pocket_pressures[-1], rtol=same)
    assert arcs.friction_torque == pytest.approx(ring.friction_torque, rel=1e-3)
    assert np.linalg.norm(arcs.force - ring.force) < 1.2e-2 * np.linalg.norm(ring.force)


@pytest.mark.parametrize("name", ["pocket", "hole"])
def test_the_force_of_both_grids_tends_to_one(name):
    """The difference falls with the second order of the ring's weights next to its grooves."""
    away = []
    for n in (96, 192):
        ring, arcs = films(AREAS[name], ehd.SwiftStieber(), 2, n)
        assert arcs.supply_flows[-1] == pytest.approx(ring.supply_flows[-1], rel=1e-3)
        away.append(np.linalg.norm(arcs.force - ring.force) / np.linalg.norm(ring.force))
    assert away[1] < 0.35 * away[0]


@pytest.mark.parametrize("arcs", [ehd.two_lobe(preload=0.5, pressure=2e5), (ehd.Arc(start=3.6, extent=2.1),)])
def test_what_areas_and_edges_feed_leaves_at_the_ends(arcs):
    arcs = tuple(dataclasses.replace(arc, leading_pressure=2e5, trailing_pressure=1e5) for arc in arcs)
    hole = ehd.Hole(angle=4.7, diameter=0.003, pressure=3e5)
    bearing = ehd.JournalBearing(**SIZE, lubricant=OIL, arcs=arcs, supply=(hole,))
    film = ehd.steady(bearing, speed=0.0, eccentricity_ratio=0.5, direction=4.7)
    assert film.supply_flows.min() > 0.0
    assert film.supply_flows.sum() == pytest.approx(film.leakage, rel=1e-10)


LOBES = ehd.two_lobe(preload=0.4, offset=0.6, pressure=1e5)
SUPPLY = (
    ehd.Pocket(angle=-math.pi / 2, width_angle=0.6, length=0.012, supply=ORIFICE),
    ehd.Hole(angle=1.7, z=0.003, diameter=0.003, pressure=3e5),
)
HEAT = ehd.FilmEnergy(supply_temperature=313.0, conductivity=0.13)
EFFECTS = {
    "plain": {},
    "oil kept": {"cavitation": ehd.ElrodAdams(line_in_cells=True)},
    "one temperature": {"lubricant": HOT, "thermal": ehd.LumpedThermal(supply_temperature=313.0)},
    "temperatures": {"lubricant": HOT, "thermal": HEAT},
    "wall": {"contact": ehd.RegularisedWall(onset=3e-6)},
}


@pytest.mark.parametrize("name", EFFECTS)
def test_tangent_against_differences(name):
    rng = np.random.default_rng(3)
    model = build_model(ehd.JournalBearing(**{**SIZE, "lubricant": OIL} | EFFECTS[name], arcs=LOBES, supply=SUPPLY))
    size = np.array([C, C, C / R, C / R, 300 * C, 300 * C, 300 * C / R, 300 * C / R, 300.0, 1.0])
    motion = np.array([0.3 * C, -0.5 * C, *rng.uniform(-1.0, 1.0, 8) * 0.05 * size[2:]])
    motion[8] = SPEED
    history, step = model.initial_history(motion), 0.0
    if history is not None:
        step, history = 1e-4, model.evaluate(motion, history, 1e-4).history()
    found = model.evaluate(motion, history, step)
    tangent, wrench, differences = found.tangent() * size, np.abs(found.wrench), np.empty((6, 10))
    for k, h in enumerate(1e-6 * size):
        beside = [model.evaluate(motion + way * h * np.eye(10)[k], history, step).wrench for way in (1.0, -1.0)]
        differences[:, k] = (beside[0] - beside[1]) / (2.0 * h) * size[k]
    scale = np.array([wrench[:2].max()] * 2 + [wrench[:2].max()] + [wrench[3:5].max()] * 2 + [wrench[5]])
    assert (np.abs(tangent - differences) / scale[:, None]).max() < 2e-5


def test_heat_balances_with_areas_between_grooves():
    bearing = ehd.JournalBearing(**SIZE, lubricant=HOT, thermal=HEAT, arcs=LOBES, supply=SUPPLY)
    film = ehd.steady(bearing, speed=SPEED, eccentricity_ratio=0.5, direction=-1.2)
    assert film.heat_by_oil + film.heat_to_walls == pytest.approx(film.power_loss, rel=0.05)
    cold = dataclasses.replace(bearing, supply=())
    hotter = ehd.steady(cold, speed=SPEED, eccentricity_ratio=0.5, direction=-1.2)
    assert film.peak_temperature < hotter.peak_temperature - 0.5


def test_a_jacking_pocket_lifts_the_journal_of_a_lobed_bearing():
    """Against the pocket's pressure on its area and beside: at hardly any speed the oil carries what it presses on."""
    film = {"film": ehd.FiniteLength(n_theta=96, n_z=12), "lubricant": OIL}
    load, pocket = 800.0, ehd.Pocket(angle=-math.pi / 2, width_angle=0.6, length=0.012, supply=ORIFICE)
    gaps = []
    for supply in ((), (pocket,)):
        bearing = ehd.JournalBearing(**SIZE, **film, arcs=ehd.two_lobe(preload=0.4), supply=supply)
        rest = ehd.equilibrium(bearing, speed=10.0, load=(0.0, -load))
        gaps.append(rest.film.minimum_gap)
    pressure = rest.film.pocket_pressures[0]
    inside, outside = 2.0 * R * math.sin(0.3) * 0.012, 2.0 * R * math.sin(1.0) * L
    assert gaps[1] > 2.5 * gaps[0]
    assert pressure * inside < load < pressure * outside


def test_pictures_show_areas_on_arcs():
    bearing = ehd.JournalBearing(**SIZE, lubricant=OIL, arcs=LOBES, supply=SUPPLY)
    figure = ehd.steady(bearing, speed=SPEED, eccentricity_ratio=0.5).plot_pressure()
    plt.close(figure)


@pytest.mark.parametrize(
    "change",
    [
        {"supply": (ehd.Hole(angle=0.0, diameter=0.003),)},
        {"supply": (ehd.Pocket(angle=0.45, width_angle=0.6, length=0.01),)},
        {"supply": (ehd.AxialGroove(angle=1.5, width_angle=0.01),)},
        {"supply": (ehd.CircumferentialGroove(width=0.003),)},
        {"supply": (ehd.Hole(angle=1.5, diameter=0.003, rotating=True),)},
    ],
    ids=["groove between arcs", "edge", "narrow", "all around", "turns"],
)
def test_areas_that_no_arc_can_have_are_refused(change):
    good = {"arcs": LOBES, "supply": (ehd.Hole(angle=1.5, diameter=0.003),)}
    ehd.JournalBearing(**SIZE, lubricant=OIL, **good)
    with pytest.raises(ehd.InputError, match=r"supply\[0\]: on arcs"):
        ehd.JournalBearing(**SIZE, lubricant=OIL, **good | change)
    dams = ehd.pressure_dam(depth=40e-6, step_angle=2.4, length=0.02)
    with pytest.raises(ehd.InputError, match=r"does not go with JournalBearing.supply=.*sides of dams"):
        ehd.JournalBearing(**SIZE, lubricant=OIL, **good | {"arcs": dams})
