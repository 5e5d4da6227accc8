"""The power that a film takes out of the motion against the heat of its flows, link by link, on every kind of bore."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.joint.heat.power import OilFlows, heat_and_exchange, powers
from exudyn_ehd.joint.model.build import build_model
from tests.sampling import sample

R, C, SPEED, MU = 0.03, 30e-6, 314.0, 9e-3
STEEL = ehd.SaintVenantKirchhoff(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7800.0)
CYLINDER = ehd.HollowCylinder(inner_radius=R, thickness=0.02, length=0.066, axial=2, radial=1, circumferential=12)
BORES = {
    "rigid": None,
    "liner": ehd.ElasticLiner(thickness=5e-4, youngs_modulus=1e9),
    "modal": ehd.ModalBush(mesh=CYLINDER, material=STEEL, tolerance=0.2),
    "nodal": ehd.ANCFBush(mesh=CYLINDER, material=STEEL),
}
# What is left on 48 x 8 and what the finer grid leaves of it: second order; first order where the rupture line is not
# resolved (Gümbel cuts it off, Elrod-Adams moves the fill upwind).
CLOSURES = {
    "swift": (ehd.SwiftStieber(), 0.011, 0.3),
    "swift under tension": (ehd.SwiftStieber(cavity_pressure=-3e5), 0.011, 0.3),
    "linear": (ehd.FullSommerfeld(), 0.011, 0.3),
    "gumbel": (ehd.Gumbel(), 0.011, 0.5),
    "elrod": (ehd.ElrodAdams(cavity_pressure=-1e5), 0.011, 0.5),
}
MOTION = np.array([0.4 * C, -0.5 * C, 1e-4, -2e-4, 1e-3, -2e-3, 3e-3, 1e-2, SPEED, 0.05])


def heat_and_work(film):
    """Heat of shear and of pressure flow, and the work on oil and ends, W; in SI units, link by link."""
    s, g, w = film.solver, film.grid, MOTION[9]
    h, p = s.H * C, s.pressure * film.scales.pressure
    shear = np.sum(MU * ((R * SPEED) ** 2 + w**2) / h * film.share() * g.weight * R**2)
    unit = C * R**2 / film.scales.pressure  # flow per pressure of a scaled conductance
    flow = unit * (np.sum(s.system.kx * (np.roll(p, -1, 0) - p) ** 2))
    flow += unit * np.sum(s.system.kz[:, :-1] * np.diff(p, axis=1) ** 2)
    pc = film.parts.bearing.cavitation.cavity_pressure
    pc = pc if np.isfinite(pc) else 0.0
    outflow = -OilFlows(film, 1.0).outside * C * R**2
    work = np.sum((p - pc) * outflow) - pc * np.sum(s.area * R**2 * s.H_t * C)
    work -= w * np.sum(p[:, -1] * h[:, -1] - p[:, 0] * h[:, 0]) * g.width_x[0] * R
    return float(shear + flow), float(work)


OIL = ehd.Lubricant(temperature_law=ehd.ReynoldsTemperature(point=(320.0, MU), coefficient=0.03), temperature=320.0)
SURFACES = {
    "smooth": {},
    "wall": {"contact": ehd.RegularisedWall(onset=4e-6, pressure=1e8)},
    "turbulent": {"turbulence": ehd.Hirs(onset=8.0, full=24.0, coefficient=1.0)},
    "asperities": {
        "asperity": ehd.GreenwoodTripp(composite_roughness=1e-6, composite_modulus=2e11),
        "roughness": ehd.PatirCheng(composite_roughness=1e-6, journal_share=0.8),
    },
}
# Surfaces that must not touch.
FILM_ALONE = ("smooth", "turbulent")


def moving(bore, closure, ends, n_theta, n_z):
    """A film under a bore and a journal that move, and its power loss, W."""
    bearing = ehd.JournalBearing(
        journal_radius=R,
        length=0.066,
        radial_clearance=C,
        lubricant=ehd.Lubricant(viscosity=MU),
        bush=BORES[bore],
        film=ehd.FiniteLength(n_theta=n_theta, n_z=n_z),
        cavitation=closure,
        end_pressures=ends,
    )
    model, motion, history, step = build_model(bearing), MOTION, None, 0.0
    if bore in ("modal", "nodal"):
        q = model.evaluate_steady(motion).bore.coordinates
        motion = np.concatenate((motion, q, 50.0 * q))
    elif bore == "liner":
        history = model.initial_history(motion)
        history, step = dataclasses.replace(history, deflection=0.99 * history.deflection), 1e-3
        if closure.conserves_mass:
            # every gap full of oil before the step, in which the surfaces' approach and the liner's rate are those of
            # the film
            s = model.solver
            history = dataclasses.replace(history, mass=s.H - step * s.H_t - 0.01 * s.elements.deflection)
    evaluation = model.evaluate(motion, history, step)
    return evaluation.film, evaluation.quantities()["power_loss"]


def balance(bore, closure, ends, n_theta, n_z):
    film, loss = moving(bore, closure, ends, n_theta, n_z)
    heat, work = heat_and_work(film)
    return abs(loss - heat - work) / heat


PAIRS = [("rigid", closure) for closure in CLOSURES]
PAIRS += [(bore, closure) for bore in ("modal", "nodal") for closure in ("swift", "elrod")]
PAIRS += [("liner", "swift"), ("liner", "gumbel"), ("liner", "elrod")]


@pytest.mark.parametrize(
    ("bore", "closure"),
    sample(PAIRS, *(k for k, pair in enumerate(PAIRS) if pair not in (("modal", "elrod"), ("nodal", "swift")))),
)
def test_power_loss_is_the_heat_of_the_flows_and_the_work_on_the_oil(closure, bore):
    spec, limit, left = CLOSURES[closure]
    coarse, fine = (balance(bore, spec, (1e6, 5e5), *grid) for grid in ((48, 8), (96, 16)))
    assert coarse < limit
    assert fine < left * coarse


@pytest.mark.parametrize(
    "contact",
    [
        {"contact": ehd.RegularisedWall(onset=3e-6)},
        {"asperity": ehd.GreenwoodTripp(composite_roughness=1e-6, composite_modulus=2e11)},
    ],
    ids=["wall", "asperities"],
)
def test_power_into_a_liner_by_contact(contact):
    """A journal pressed into its liner through next to no oil.

    What is stored besides what the liner stores is the contact's own energy, and nothing is lost.

    The contact's energy over the step from its pressure at both ends and the middle of the gap's change (Simpson).
    The liner's share is backward Euler: first order in the step, halved with it, and many times larger than what is
    left.
    """
    left = []
    for step in (4e-4, 2e-4):
        bearing = ehd.JournalBearing(
            journal_radius=R,
            length=0.066,
            radial_clearance=C,
            lubricant=ehd.Lubricant(viscosity=1e-9),
            bush=BORES["liner"],
            film=ehd.FiniteLength(n_theta=48, n_z=8),
            **contact,
        )
        model, before, after = build_model(bearing), np.zeros(10), np.zeros(10)
        before[0] = 1.1 * C
        after[:] = before
        after[4] = 0.05 * C / 4e-4
        after[0] += after[4] * step
        history = model.initial_history(before)
        law = model.effects.contacts[0]
        gaps = [model.solver.elements.true_gap.copy()]
        q = model.evaluate(after, history, step).quantities()
        stored = model.solver.elements.stored_power() * model.scales.pressure * model.parts.flow_scale
        gaps.append(model.solver.elements.true_gap.copy())
        p, slope = np.empty_like(gaps[0]), np.empty_like(gaps[0])
        energy = np.zeros_like(p)
        for weight, share in ((1, 0.0), (4, 0.5), (1, 1.0)):
            law.pressure(gaps[0] + share * (gaps[1] - gaps[0]), p, slope)
            energy -= weight / 6.0 * p * (gaps[1] - gaps[0]) * C
        power = float(np.sum(energy * model.grid.weight)) * R**2 / step
        assert abs(q["power_loss"]) < 1e-4 * stored
        left.append(abs(q["stored_power"] - stored - power) / stored)
    assert left[0] < 0.1
    assert left[1] < 0.6 * left[0]


@pytest.mark.parametrize(("bore", "closure"), PAIRS)
def test_heat_of_a_film_is_what_sliding_puts_in_less_the_work_on_oil_and_ends(closure, bore):
    """The thermal effects' heat and leakage in one pass, against fields (1e-9: rounding of cancelling sums).

    Against the heat of the flows, link by link: to the grid's error.
    """
    film, _ = moving(bore, CLOSURES[closure][0], (1e6, 5e5), 48, 8)
    heat, exchanged = heat_and_exchange(film, 1.0)
    oil, s, p = OilFlows(film, 1.0), film.solver, film.solver.pressure * film.scales.pressure
    assert exchanged == pytest.approx(oil.leaving.sum() + max(0.0, np.sum(oil.lost - oil.found)), rel=1e-12)
    pc = film.parts.bearing.cavitation.cavity_pressure
    pc = pc if np.isfinite(pc) else 0.0
    work = np.sum((p - pc) * (oil.outside - s.area * oil.rate)) * C * R**2
    ends = np.sum(p[:, -1] * s.H[:, -1] - p[:, 0] * s.H[:, 0]) * C * film.grid.width_x[0] * R
    assert heat == pytest.approx(powers(film).sliding + work + MOTION[9] * ends, rel=1e-9)
    assert heat == pytest.approx(heat_and_work(film)[0], rel=0.011)


def energy(surfaces, bore, closure, grid, **more):
    """A model whose oil has a temperature field, sucked in and let out at pressure 0."""
    bearing = ehd.JournalBearing(
        journal_radius=R,
        length=0.04,
        radial_clearance=C,
        lubricant=OIL,
        thermal=ehd.FilmEnergy(supply_temperature=320.0, bush_coefficient=5e3),
        bush=BORES[bore],
        film=ehd.FiniteLength(n_theta=grid[0], n_z=grid[1]),
        cavitation=closure,
        **SURFACES[surfaces],
        **more,
    )
    return build_model(bearing)


def heats(model, motion, history=None, step=0.0):
    """Heat of the temperature field and of the lumped one, power loss and stored power of a state, W."""
    evaluation = model.evaluate(motion, history, step)
    film, q = evaluation.film, evaluation.quantities()
    field = model.effects.thermal.balance(film, film.temperature)["heat_in"]
    return field, heat_and_exchange(film, 1.0)[0], q["power_loss"], q["stored_power"]


def states(count, seed, lowest=0.5, highest=1.02, rates=0.0):
    """Motions (10,) of tilted journals in every direction, by default from light running to surfaces that touch."""
    rng = np.random.default_rng(seed)
    for _ in range(count):
        e, angle = rng.uniform(lowest, highest), rng.uniform(0.0, 2.0 * np.pi)
        swing = rates * rng.uniform(-1.0, 1.0, 4) * C * np.array([1.0, 1.0, 20.0, 20.0])
        place = [e * C * np.cos(angle), e * C * np.sin(angle), *rng.uniform(-1e-4, 1e-4, 2)]
        yield np.array([*place, *swing, rng.uniform(-SPEED, SPEED), rng.uniform(-0.5, 0.5)])


@pytest.mark.parametrize("bore", ["rigid", "liner"])
@pytest.mark.parametrize("surfaces", SURFACES)
@pytest.mark.parametrize(
    "closure", [ehd.SwiftStieber(), ehd.Gumbel(), ehd.ElrodAdams()], ids=["swift", "gumbel", "elrod"]
)
def test_heat_of_a_steady_film_is_its_power_loss(closure, surfaces, bore):
    """However closely the surfaces touch, to rounding (1e-8: the liner's Newton steps)."""
    model = energy(surfaces, bore, closure, (32, 6))
    for motion in states(10, 4):
        if surfaces in FILM_ALONE:
            motion[:2] *= 0.9
            motion[2:4] *= 0.3
        _, lumped, loss, stored = heats(model, motion)
        assert stored == 0.0 < loss
        assert lumped == pytest.approx(loss, rel=1e-8)


@pytest.mark.parametrize("surfaces", SURFACES)
def test_heat_of_a_temperature_field_tends_to_the_power_loss(surfaces):
    """However closely the surfaces touch: sums over control volumes against the loads' integrals, second order."""
    left = []
    for grid in ((32, 8), (128, 32)):
        model, worst = energy(surfaces, "rigid", ehd.SwiftStieber(), grid), 0.0
        for motion in states(4, 6, highest=0.95 if surfaces in FILM_ALONE else 1.02):
            field, _, loss, _ = heats(model, motion * [1, 1, 0.3, 0.3, 1, 1, 1, 1, 1, 1])
            worst = max(worst, abs(field / loss - 1.0))
        left.append(worst)
    assert left[0] < 0.02
    assert left[1] < 0.2 * left[0]


@pytest.mark.parametrize("bore", ["rigid", "liner"])
@pytest.mark.parametrize("surfaces", sample(["wall", "asperities"], 0))
def test_what_touching_surfaces_store_is_no_heat(surfaces, bore):
    """A journal that is pressed into its bore or drawn out of it: heat and loss differ by the grid's error alone.

    Without what is stored they would differ by more than the finer grid's error.
    """
    left, most = [], 0.0
    for grid in ((32, 8), (128, 32)):
        model, worst = energy(surfaces, bore, ehd.SwiftStieber(), grid), 0.0
        for motion in states(6, 5, 1.0, 1.1, rates=100.0):
            history = model.initial_history(motion) if bore == "liner" else None
            _, lumped, loss, stored = heats(model, motion, history, 1e-4)
            most = max(most, abs(stored) / lumped)
            worst = max(worst, abs(loss / lumped - 1.0))
        left.append(worst)
    assert most > 2.0 * left[1]
    assert left[0] < 0.05
    assert left[1] < 0.2 * left[0]
