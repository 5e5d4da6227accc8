"""The film solver's record over random states: who fails, how many linear
solves it takes, how well the balances are met.

Bearings: L/D 0.25 to 2, eight grids from 24 x 4 to 128 x 12 (odd ones too), short bearings, end pressures,
supply areas (also in the journal), walls, rough surfaces, pressure, shear and density laws. States:
eccentricity ratio uniform to 0.9 or with the gap uniform in its logarithm down to 1e-4 c (pressed into each
other up to 1.02 with a wall), tilt up to 95 % of what the gap leaves, any direction, spin positive, negative,
zero, tiny and large, axial speed, rates from 1e-3 to 10 times the spin; warm and cold starts. Mass-conserving
films also in transient sequences with jumps of position and speed at steps from 1e-6 to 3e-3 s.

Films on liners of 1e7 to 1e11 Pa, 1 mm thick on 20 mm, half of them with wall or asperities, steady
and in motion; the same with pressure and shear laws and rough surfaces. What they leave out, because
there no film need exist: tension that pulls a liner shut (`FullSommerfeld` only with contact and above
1e10 Pa; no contact, no tension in the cavity; else no more than an atmosphere), and steady films after
`Gumbel`, whose balance is not that of a complementarity problem (one in two thousand of these states
is not found). Impedance maps over their whole domain, and beyond it, which they must say.

A state counts as failed if its status is not CONVERGED, a number of it is not finite, its pressure or fill leaves
its bounds, or a balance of its discrete equations is not met. The one exception: oils with a pressure law have no
viscosity beyond some GPa, where they count as solid. A film that would need such pressures has no solution and must
say so (NO_PRESSURE); these states are counted apart, once it is checked that the pressure is beyond the law's range.
A steady film without a pressure above its cavity's has nothing that feeds it, and may say so (NO_OIL).
"""

from __future__ import annotations

import dataclasses
import math
import time
from collections.abc import Callable

import numpy as np

import exudyn_ehd as ehd
from exudyn_ehd.film.lubricant.pressure_viscosity import LARGEST_PRESSURE
from exudyn_ehd.film.reynolds.balance import film_balance, linear_residual
from exudyn_ehd.joint.model.build import build_model

RADIUS, CLEARANCE, VISCOSITY = 0.01, 2e-5, 0.04
GRIDS = [(48, 8), (64, 10), (96, 10), (64, 16), (33, 7), (24, 4), (40, 5), (128, 12)]
STATES_PER_MODEL = 250
# Of a balance: rounding of conductances that differ by the cube of the gaps'
# ratio, over the largest flow that meets at a vertex.
BALANCE = 1e-7
SOLID, DRY = "the oil is solid", "nothing feeds the film"


@dataclasses.dataclass(kw_only=True)
class Record:
    """Outcome of one campaign.

    Attributes
    ----------
    name : str
    states, failures : int
    solid : int
        States whose pressure is beyond the oil's law, properly reported.
    worst, mean : int, float
        Linear solves per film.
    balance : float
        Largest violation of a vertex's balance over the largest flow at that vertex.
    seconds : float
    failed : list
        Seed, model and state of the failed ones.
    """

    name: str
    states: int = 0
    failures: int = 0
    solid: int = 0
    worst: int = 0
    total: int = 0
    balance: float = 0.0
    seconds: float = 0.0
    failed: list = dataclasses.field(default_factory=list)

    @property
    def mean(self) -> float:
        """Linear solves per film."""
        return self.total / max(self.states, 1)


def _supplies(rng, pressure, length):
    groove = ehd.AxialGroove(
        angle=float(rng.uniform(0, 6)), width_angle=float(rng.uniform(0.3, 0.9)), pressure=pressure
    )
    return [
        (groove,),
        (ehd.Hole(angle=float(rng.uniform(0, 6)), diameter=0.9 * min(RADIUS, length), pressure=pressure),),
        (groove, dataclasses.replace(groove, angle=groove.angle + math.pi)),
        (ehd.Pocket(angle=2.0, width_angle=0.6, length=0.4 * RADIUS, pressure=pressure, rotating=True),),
    ][rng.integers(4)]


def random_bearing(rng, closure, *, laws=True):
    """A bearing of plain closures with any options that go together."""
    n_theta, n_z = GRIDS[rng.integers(len(GRIDS))]
    length = 2.0 * RADIUS * float(rng.choice([0.25, 0.5, 1.0, 2.0]))
    cavity = 0.0
    options = {}
    if not isinstance(closure, ehd.FullSommerfeld):
        cavity = -float(rng.choice([0.0, 1e3, 1e5, 1e6]))
        closure = dataclasses.replace(closure, cavity_pressure=cavity)
    supplied = rng.random() < 0.25 and n_theta >= 48
    if supplied:
        options["supply"] = _supplies(rng, float(rng.choice([0.0, 1e5])), length)
    elif isinstance(closure, ehd.ElrodAdams) and cavity == 0.0:
        options["end_pressures"] = (1e4, 2e4)
    if rng.random() < 0.2:
        options["end_pressures"] = tuple(float(p) for p in rng.uniform(0.0, 1e6, 2))
    surface = rng.random()
    if surface < 0.1:
        options["contact"] = ehd.RegularisedWall(onset=0.03 * CLEARANCE)
    elif surface < 0.2:
        options["asperity"] = ehd.GreenwoodTripp(composite_roughness=0.4e-6, composite_modulus=1e11)
        if rng.random() < 0.5:
            options["roughness"] = ehd.PatirCheng(composite_roughness=0.4e-6)
    film = ehd.FiniteLength(n_theta=n_theta, n_z=n_z)
    if rng.random() < 0.1 and not supplied:
        film = ehd.ShortBearing(n_theta=max(n_theta, 32))
    oil, viscosity = {}, VISCOSITY
    if laws and rng.random() < 0.25:
        # thin enough that most pressures stay below what the laws have a viscosity for
        viscosity = 1e-2 * VISCOSITY
        oil = [
            {"pressure_law": ehd.RoelandsPressure(coefficient=2e-8)},
            {"shear_law": ehd.CarreauShear(relaxation_time=1e-6, exponent=0.6, residual=0.2)},
        ][rng.integers(2)]
    return ehd.JournalBearing(
        journal_radius=RADIUS,
        length=length,
        radial_clearance=CLEARANCE,
        film=film,
        cavitation=closure,
        lubricant=ehd.Lubricant(viscosity=viscosity, **oil),
        **options,
    )


def random_liner(rng, closure):
    """A bearing with a liner; every other one with a contact."""
    bearing = random_bearing(rng, closure, laws=False)
    lowest, contact = 7.0, rng.random() < 0.5
    options = {"contact": None, "asperity": None, "roughness": None}
    if isinstance(closure, ehd.FullSommerfeld):
        lowest, contact = 10.0, True
    elif not contact:
        options["cavitation"] = closure
    elif bearing.cavitation.cavity_pressure < -1e5:
        options["cavitation"] = dataclasses.replace(closure, cavity_pressure=-1e5)
    if isinstance(closure, ehd.ElrodAdams) and not contact:
        options["end_pressures"] = (1e4, 2e4)
    if contact and rng.random() < 0.5:
        options["contact"] = ehd.RegularisedWall(onset=0.03 * CLEARANCE)
    elif contact:
        options["asperity"] = ehd.GreenwoodTripp(composite_roughness=0.4e-6, composite_modulus=1e11)
    if not isinstance(bearing.film, ehd.FiniteLength):
        options["film"] = ehd.FiniteLength()
    liner = ehd.ElasticLiner(thickness=1e-3, youngs_modulus=float(10.0 ** rng.uniform(lowest, 11.0)))
    return dataclasses.replace(bearing, bush=liner, **options)


def random_lifted(rng, closure):
    """A bearing with a liner and an oil whose viscosity follows pressure or shear, or rough surfaces."""
    bearing = random_liner(rng, closure)
    kind = rng.integers(4)
    if kind == 0 and bearing.contact is None:
        return dataclasses.replace(bearing, roughness=ehd.PatirCheng(composite_roughness=0.4e-6))
    law = [
        {"shear_law": ehd.CarreauShear(relaxation_time=1e-6, exponent=0.6, residual=0.2)},
        {"shear_law": ehd.CarreauShear(relaxation_time=1e-5, exponent=0.4)},
        {"pressure_law": ehd.BarusPressure(coefficient=2e-8)},
        {"pressure_law": ehd.RoelandsPressure(coefficient=2e-8)},
    ][kind]
    return dataclasses.replace(bearing, lubricant=ehd.Lubricant(viscosity=5e-3 * VISCOSITY, **law))


def random_map(rng):
    """A bearing with an impedance map; two lengths, as every one takes seconds to build."""
    closure = [ehd.Gumbel(), ehd.SwiftStieber()][rng.integers(2)]
    return ehd.JournalBearing(
        journal_radius=RADIUS,
        length=RADIUS * float(rng.choice([1.0, 2.0])),
        radial_clearance=CLEARANCE,
        cavitation=closure,
        lubricant=ehd.Lubricant(viscosity=VISCOSITY),
        film=ehd.ImpedanceMap(n_theta=96),
    )


def random_state(rng, bearing):
    """Motion (10,)."""
    half = 0.5 * bearing.length
    eps = rng.uniform(0.0, 0.9) if rng.random() < 0.5 else 1.0 - 10.0 ** rng.uniform(-4.0, -1.0)
    if (bearing.contact is not None or bearing.asperity is not None) and rng.random() < 0.3:
        eps = rng.uniform(0.97, 1.02)
    oil = bearing.lubricant
    if oil.pressure_law is not None or oil.density_law is not None:
        eps = min(eps, rng.uniform(0.0, 0.99))
    room = max(1.0 - eps, 0.0) * CLEARANCE
    tilt = rng.choice([0.0, rng.uniform(0.0, 0.95)]) * room / half
    a, b = rng.uniform(0.0, 2.0 * np.pi, 2)
    omega = rng.choice([0.0, 300.0, -300.0, 1000.0 * rng.normal(), 1e-3, 3000.0])
    axial = rng.choice([0.0, 0.0, 0.0, rng.normal()])
    rates = np.zeros(4)
    # rates that last would empty or overfill a steady mass-conserving film: only its motions have them
    if rng.random() < 0.6 and not bearing.cavitation.conserves_mass:
        rates = rng.normal(size=4) * max(abs(omega), 1.0) * 10.0 ** rng.uniform(-3.0, 1.0)
        rates *= np.array([CLEARANCE, CLEARANCE, CLEARANCE / half, CLEARANCE / half])
    if isinstance(bearing.film, ehd.ImpedanceMap):
        tilt = rates[2] = rates[3] = 0.0
    pose = [eps * CLEARANCE * np.cos(a), eps * CLEARANCE * np.sin(a), tilt * np.cos(b), tilt * np.sin(b)]
    return np.array([*pose, *rates, omega, axial])


def balance_error(model):
    """Largest violation of the discrete equations, each over the largest flow
    at its vertex (or a millionth of the largest of all)."""
    s, g, closure = model.solver, model.grid, model.bearing.cavitation
    y = s.system
    out = np.empty(g.shape)
    if closure.conserves_mass:
        film_balance(y.pressure, y.fill, None, y.terms, out)
    else:
        linear_residual((y.kx, y.kz, y.b), y.linear_pressure, out)
        out *= -1.0
    P, joins = y.linear_pressure, 0.0
    if s.complementary:
        # pressures above the cavity's are the unknowns
        P = P - y.cavity_pressure
    peak = np.abs(P).max()
    if s.line is not None:
        # what appears at the line, and what a vertex without film has to lack for it to join
        out -= np.where(s.line.s < 1.0, 0.5 * s.line.f * (1.0 - s.line.s) ** 2, 0.0)
        joins = 0.5 * s.line.f
    flow = np.maximum(np.abs(y.fx), np.abs(np.roll(y.fx, 1, axis=0)))
    flow = np.maximum(flow, np.abs(y.kx * P) + np.abs(y.kx * np.roll(P, -1, axis=0)))
    flow = np.maximum(flow, np.abs(np.roll(y.kx * P, 1, axis=0)))
    flow[:, :-1] = np.maximum(flow[:, :-1], np.abs(y.kz * P)[:, :-1])
    flow[:, 1:] = np.maximum(flow[:, 1:], np.abs(y.kz[:, :-1] * P[:, 1:]))
    flow[:, 1:] = np.maximum(flow[:, 1:], np.abs(y.fz[:, :-1]))
    if closure.conserves_mass and y.inverse_step > 0.0:
        flow = np.maximum(flow, y.area * np.maximum(y.mass_old, y.fill * y.H) * y.inverse_step)
    else:
        flow = np.maximum(flow, np.abs(y.area * y.H_t))
    # a closure stops at pressures right to 1e-13 of the peak; where the gap is
    # wide, that is a flow against which others vanish; where oil thins, 3e-8 of the peak
    wide = y.kx + np.roll(y.kx, 1, axis=0) + y.kz
    wide[:, 1:] += y.kz[:, :-1]
    thins = model.bearing.lubricant.shear_law is not None
    flow = np.maximum(flow, (0.3 if thins else 1e-5) * wide * peak)
    if model.parts.liner is not None:
        # pressures that deflect a liner by less than 1e-10 of the smallest gap count as none
        flow = np.maximum(flow, wide * (1e-10 * s.H.min() / model.parts.liner.beta / BALANCE))
    scale = np.maximum(flow, 1e-6 * flow.max()) + 1e-300
    free = ~g.fixed
    unbroken = free & (
        np.ones_like(free)
        if closure.conserves_mass or closure.clips or s.closure.cavity_pressure == -np.inf
        else s.work.active
    )
    error = np.max(np.abs(out / scale)[unbroken], initial=0.0)
    # where the film is broken, oil piles up nowhere
    return max(float(error), float(np.max(((-out - joins) / scale)[free & ~unbroken], initial=0.0)))


def beyond_law(model, motion, past):
    """Return whether the film of constant density and viscosity exceeds the largest pressure of the oil's laws.

    With a density law and the line inside the cells it suffices that the film with its line on the vertices has no
    pressure.
    """
    law = model.effects.pressure_law
    if law is None:
        return False
    if model.solver.law is not None:
        if isinstance(model.bearing.cavitation, ehd.SwiftStieber) and model.bearing.closure.line_in_cells:
            vertices = dataclasses.replace(model.bearing.cavitation, line_in_cells=False)
            other = build_model(dataclasses.replace(model.bearing, cavitation=vertices))
            if other.evaluate(motion, *past).status is ehd.Status.NO_PRESSURE:
                return True
        bearing = dataclasses.replace(
            model.bearing, lubricant=ehd.Lubricant(viscosity=model.bearing.lubricant.viscosity)
        )
        return build_model(bearing).evaluate(motion, *past).quantities()["peak_pressure"] > LARGEST_PRESSURE
    if model.parts.liner is not None:
        # the last film that pseudo time reached on its way
        highest = float(model.parts.liner.load.p.max()) * model.scales.pressure
        return highest > 0.9 * law.largest_pressure
    highest = float(law.transform(np.array([law.largest_pressure]))[0])
    return float(model.solver.pressure.max()) * model.scales.pressure > highest * (1.0 - 1e-9)


def feeds(bearing):
    """Return whether an end or a supply has more than the cavity pressure."""
    known = (*bearing.end_pressures, *(area.pressure for area in bearing.supply))
    return max(known) > bearing.cavitation.cavity_pressure


def check(model, evaluation, past):
    """Return the fault of an evaluation from the ``past`` (history, step), or None; and its balance error."""
    if evaluation.status is ehd.Status.NO_PRESSURE and beyond_law(model, evaluation.motion, past):
        return SOLID, 0.0
    if evaluation.status is ehd.Status.NO_OIL and past[0] is None and not feeds(model.bearing):
        return DRY, 0.0
    if isinstance(model.bearing.film, ehd.ImpedanceMap):
        return check_map(model, evaluation), 0.0
    if evaluation.status is not ehd.Status.CONVERGED:
        return evaluation.status.name, 0.0
    if not np.all(np.isfinite(evaluation.wrench)):
        return "wrench not finite", 0.0
    if not all(math.isfinite(v) for v in evaluation.quantities().values()):
        return "quantities not finite", 0.0
    s = model.solver
    if (
        np.isfinite(s.system.cavity_pressure)
        and s.pressure[~model.grid.fixed].min(initial=np.inf) < s.system.cavity_pressure
    ):
        return "pressure below the cavity's", 0.0
    if s.closure.conserves_mass and (s.fill.min() < 0.0 or s.fill.max() > 1.0):
        return "fill outside 0 to 1", 0.0
    if not hasattr(s.system, "kx") or model.solver.law is not None:
        return None, 0.0
    error = balance_error(model)
    return ("balance" if not error <= BALANCE else None), error


def check_map(model, evaluation):
    """Return the fault of an evaluation of an impedance map, or None: beyond its table it must have that status, within
    it the power loss must not be negative."""
    motion = evaluation.motion
    inside = math.hypot(*motion[:2]) <= model.bearing.film.largest_eccentricity_ratio * CLEARANCE
    if evaluation.status is not (ehd.Status.CONVERGED if inside else ehd.Status.OUTSIDE_MAP):
        return evaluation.status.name
    if not inside:
        return None
    if not (np.all(np.isfinite(evaluation.wrench)) and np.all(np.isfinite(evaluation.tangent()))):
        return "wrench or tangent not finite"
    return None if evaluation.quantities()["power_loss"] >= 0.0 else "power out of nothing"


def steady_campaign(name: str, make: Callable, states: int, seed: int, per_model: int = STATES_PER_MODEL) -> Record:
    """Films at random motions, without history."""
    record, rng = Record(name=name), np.random.default_rng(seed)
    begin = time.process_time()
    while record.states < states:
        bearing = make(rng)
        model = build_model(bearing)
        for _ in range(min(per_model, states - record.states)):
            motion = random_state(rng, bearing)
            if rng.random() < 0.5:
                model.forget()
            count(record, model, model.evaluate(motion, spin=float(rng.uniform(0.0, 6.0))), (seed, bearing, motion))
    record.seconds = time.process_time() - begin
    return record


def transient_campaign(name: str, make: Callable, states: int, seed: int, per_model: int = STATES_PER_MODEL) -> Record:
    """Sequences of steps with the history of the ones before."""
    record, rng = Record(name=name), np.random.default_rng(seed)
    begin = time.process_time()
    while record.states < states:
        bearing = make(rng)
        model = build_model(bearing)
        motion, step = random_state(rng, bearing), 10.0 ** rng.uniform(-6.0, -2.5)
        history = model.initial_history(motion)
        for k in range(min(per_model, states - record.states)):
            new = random_state(rng, bearing)
            if rng.random() < 0.8:
                # a small move; now and then a jump
                near = motion.copy()
                near[:2] += 1e-2 * CLEARANCE * rng.normal(size=2)
                near[8] = new[8] if rng.random() < 0.1 else motion[8]
                inside = np.hypot(*near[:2]) + 0.5 * bearing.length * np.hypot(*near[2:4]) < 0.9999 * CLEARANCE
                new = near if inside else new
            new[4:8] = (new[:4] - motion[:4]) / step
            motion = new
            evaluation = model.evaluate(motion, history, step, spin=0.3 * k)
            if count(record, model, evaluation, (seed, bearing, motion, step), (history, step)):
                history = evaluation.history()
            else:
                history = model.initial_history(motion)
    record.seconds = time.process_time() - begin
    return record


def count(record, model, evaluation, context, past=(None, 0.0)) -> bool:
    """Enter one evaluation; whether it was a film."""
    wrong, balance = check(model, evaluation, past)
    record.states += 1
    record.worst = max(record.worst, evaluation.iterations)
    record.total += evaluation.iterations
    record.balance = max(record.balance, balance)
    if wrong == SOLID:
        record.solid += 1
    elif wrong not in (None, DRY):
        record.failures += 1
        record.failed.append((wrong, record.states, balance, *context))
    return wrong is None


def _compressible(rng):
    bearing = random_bearing(rng, ehd.SwiftStieber(), laws=False)
    plain = dataclasses.replace(
        bearing,
        film=ehd.FiniteLength(n_theta=48, n_z=8),
        supply=(),
        contact=None,
        asperity=None,
        roughness=None,
        cavitation=ehd.ElrodAdams(cavity_pressure=-1e5),
    )
    oil = ehd.Lubricant(viscosity=1e-2 * VISCOSITY, density_law=ehd.DowsonHigginson())
    return dataclasses.replace(plain, lubricant=oil)


def _dense(rng):
    """A bearing with a density law that carries up to the end of its range, every other one with a pressure law."""
    bearing = random_bearing(rng, ehd.SwiftStieber(), laws=False)
    film = bearing.film if isinstance(bearing.film, ehd.FiniteLength) else ehd.FiniteLength()
    thickens = ehd.RoelandsPressure(coefficient=2e-8) if rng.random() < 0.5 else None
    oil = ehd.Lubricant(
        viscosity=VISCOSITY * 10.0 ** rng.uniform(-2.8, -1.0), density_law=ehd.DowsonHigginson(), pressure_law=thickens
    )
    return dataclasses.replace(bearing, film=film, lubricant=oil)


CAMPAIGNS: dict[str, Callable[[int, int], Record]] = {
    "FullSommerfeld": lambda n, seed: steady_campaign(
        "FullSommerfeld", lambda r: random_bearing(r, ehd.FullSommerfeld()), n, seed
    ),
    "Gumbel": lambda n, seed: steady_campaign("Gumbel", lambda r: random_bearing(r, ehd.Gumbel()), n, seed),
    "SwiftStieber": lambda n, seed: steady_campaign(
        "SwiftStieber", lambda r: random_bearing(r, ehd.SwiftStieber()), n, seed
    ),
    "SwiftStieber, line on vertices": lambda n, seed: steady_campaign(
        "SwiftStieber, line on vertices", lambda r: random_bearing(r, ehd.SwiftStieber(line_in_cells=False)), n, seed
    ),
    "ElrodAdams, steady": lambda n, seed: steady_campaign(
        "ElrodAdams, steady", lambda r: random_bearing(r, ehd.ElrodAdams()), n, seed
    ),
    "ElrodAdams, in motion": lambda n, seed: transient_campaign(
        "ElrodAdams, in motion", lambda r: random_bearing(r, ehd.ElrodAdams()), n, seed
    ),
    "SwiftStieber, compressible": lambda n, seed: steady_campaign("SwiftStieber, compressible", _dense, n, seed, 50),
    "ElrodAdams, compressible": lambda n, seed: transient_campaign("ElrodAdams, compressible", _compressible, n, seed),
}


def _liner_campaign(name, make, closure) -> Callable[[int, int], Record]:
    run = transient_campaign if name.endswith("in motion") else steady_campaign
    return lambda n, seed: run(name, lambda r: make(r, closure), n, seed, 50)


LINERS = {
    name: _liner_campaign(name, make, closure)
    for what, make in (("liner", random_liner), ("liner with laws", random_lifted))
    for closure in (ehd.FullSommerfeld(), ehd.Gumbel(), ehd.SwiftStieber(), ehd.ElrodAdams())
    for name in (f"{type(closure).__name__}, {what}, {motion}" for motion in ("steady", "in motion"))
    if name.endswith("in motion") or not isinstance(closure, ehd.Gumbel)
}
CAMPAIGNS |= LINERS
COSTLY = {*LINERS, "SwiftStieber, compressible"}
CAMPAIGNS["ImpedanceMap"] = lambda n, seed: steady_campaign("ImpedanceMap", random_map, n, seed, 500)
