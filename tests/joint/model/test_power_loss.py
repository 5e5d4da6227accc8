"""The power that a film takes out of the motion against the heat of its flows, link by link, on every kind of bore."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.joint.heat.oil_flows import Exchange, heat_and_leakage
from exudyn_ehd.joint.model.build import build_model

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
    outflow = -Exchange(film).outside * C * R**2
    work = np.sum((p - pc) * outflow) - pc * np.sum(s.area * R**2 * s.H_t * C)
    work -= w * np.sum(p[:, -1] * h[:, -1] - p[:, 0] * h[:, 0]) * g.width_x[0] * R
    return float(shear + flow), float(work)


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
            history = dataclasses.replace(history, mass=s.H - step * s.H_t - 0.01 * s.deflection)
    evaluation = model.evaluate(motion, history, step)
    return evaluation.film, evaluation.quantities()["power_loss"]


def balance(bore, closure, ends, n_theta, n_z):
    film, loss = moving(bore, closure, ends, n_theta, n_z)
    heat, work = heat_and_work(film)
    return abs(loss - heat - work) / heat


PAIRS = [("rigid", closure) for closure in CLOSURES]
PAIRS += [(bore, closure) for bore in ("modal", "nodal") for closure in ("swift", "elrod")]
PAIRS += [("liner", "swift"), ("liner", "gumbel"), ("liner", "elrod")]


@pytest.mark.parametrize(("bore", "closure"), PAIRS)
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

    What it puts in besides what the liner stores is the contact's own energy.

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
        loss = model.evaluate(after, history, step).quantities()["power_loss"]
        stored = model.solver.stored_power() * model.scales.pressure * model.parts.flow_scale
        gaps.append(model.solver.elements.true_gap.copy())
        p, slope = np.empty_like(gaps[0]), np.empty_like(gaps[0])
        energy = np.zeros_like(p)
        for weight, share in ((1, 0.0), (4, 0.5), (1, 1.0)):
            law.pressure(gaps[0] + share * (gaps[1] - gaps[0]), p, slope)
            energy -= weight / 6.0 * p * (gaps[1] - gaps[0]) * C
        power = float(np.sum(energy * model.grid.weight)) * R**2 / step
        left.append(abs(loss - power) / stored)
    assert left[0] < 0.1
    assert left[1] < 0.6 * left[0]


@pytest.mark.parametrize(("bore", "closure"), PAIRS)
def test_heat_of_a_film_leaves_out_the_work_on_oil_ends_and_vapour(closure, bore):
    """The thermal effects' heat and leakage in one pass, against fields; 1e-9: rounding of cancelling sums."""
    film, loss = moving(bore, CLOSURES[closure][0], (1e6, 5e5), 48, 8)
    heat, leaving = heat_and_leakage(film)
    assert leaving == pytest.approx(Exchange(film).leaving, rel=1e-12)
    assert heat == pytest.approx(loss - heat_and_work(film)[1], rel=1e-9)
