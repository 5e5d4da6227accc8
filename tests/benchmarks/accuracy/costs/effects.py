"""Cost of every effect, closure and reduced film over that of the plain film.

The journal moves along an orbit at eccentricity ratios of 0.75 to 0.85, a degree per evaluation, and every state is
evaluated with its exact tangent, as in a time integration; three states are a step, of which the last is accepted. From
the same run:

    evaluation with tangent    mean over the states,
    accepted step              three evaluations, two tangents and one history, which effects that remember pay in.

Every state counts with the best of some rounds that alternate between the cases (what else the machine does only adds);
several such blocks, each with models built anew, give the spread: where a model lies in memory makes a per cent or two.
"""

from __future__ import annotations

import dataclasses
import math
import time
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from exudyn_ehd.film.cavitation.closures import ElrodAdams, FullSommerfeld, Gumbel
from exudyn_ehd.film.heat.options import FilmEnergy, LumpedThermal
from exudyn_ehd.film.lubricant.density import DowsonHigginson
from exudyn_ehd.film.lubricant.lubricant import VogelTemperature
from exudyn_ehd.film.lubricant.pressure_viscosity import BarusPressure, RoelandsPressure
from exudyn_ehd.film.lubricant.shear_thinning import CarreauShear
from exudyn_ehd.film.models import FiniteLength, LongBearing, ShortBearing
from exudyn_ehd.film.reynolds.turbulence import NgPan
from exudyn_ehd.film.solvers.impedance_map import ImpedanceMap
from exudyn_ehd.film.solvers.sor import ClassicSOR
from exudyn_ehd.film.supply.areas import AxialGroove, CircumferentialGroove, Hole, Pocket
from exudyn_ehd.film.surfaces.contact import ArchardWear, ElasticLiner, RegularisedWall
from exudyn_ehd.film.surfaces.profile import Crown
from exudyn_ehd.film.surfaces.roughness import GreenwoodTripp, PatirCheng
from exudyn_ehd.joint.model.build import build_model
from exudyn_ehd.status import EHDError
from tests.benchmarks.accuracy.costs.growth import CLEARANCE, SPEED, plain_bearing
from tests.benchmarks.accuracy.errors.study import Progress
from tests.benchmarks.accuracy.table import Cost, costs_of_blocks

PLAIN, CONSERVING = "`SwiftStieber`", "`ElrodAdams`"
EVALUATION, STEP = "evaluation with tangent", "accepted step"
COUNT = 60
DEGREE = math.pi / 180.0
# Whirl speed of the orbit over the spin.
WHIRL = 0.3
# Films of 4.5 to 7.5 um: surfaces and walls that they touch here and there.
ROUGH, ONSET, HOT = 1.5e-6, 6e-6, 353.15


@dataclass(frozen=True, kw_only=True)
class Case:
    """Options of a `JournalBearing` whose cost over ``base`` (name of another case) is asked for."""

    options: Mapping[str, Any] = field(default_factory=dict)
    base: str = PLAIN


def _oil(**laws: Any) -> dict[str, Any]:
    hot = VogelTemperature(first=(313.15, 0.0396), second=(373.15, 0.0059))
    return {
        "lubricant": dataclasses.replace(
            plain_bearing().lubricant, temperature=HOT, **({"temperature_law": hot} | laws)
        )
    }


_ASPERITY = {"asperity": GreenwoodTripp(composite_roughness=ROUGH, composite_modulus=2e10)}
_ROUGHNESS = {"roughness": PatirCheng(composite_roughness=ROUGH)}
_LAWS: dict[str, dict[str, Any]] = {
    "`BarusPressure`": _oil(pressure_law=BarusPressure(coefficient=1e-8)),
    "`RoelandsPressure`": _oil(pressure_law=RoelandsPressure(coefficient=1.5e-8)),
    "`CarreauShear`": _oil(shear_law=CarreauShear(relaxation_time=1e-6, exponent=0.6, residual=0.2)),
    "`DowsonHigginson`": _oil(density_law=DowsonHigginson()),
    "`DowsonHigginson`, `BarusPressure`": _oil(
        density_law=DowsonHigginson(), pressure_law=BarusPressure(coefficient=1e-8)
    ),
    "`LumpedThermal`": {**_oil(), "thermal": LumpedThermal(supply_temperature=HOT)},
    "`FilmEnergy`": {**_oil(), "thermal": FilmEnergy(supply_temperature=HOT)},
}
_LINER = {"bush": ElasticLiner(thickness=0.002, youngs_modulus=1e10)}
_CONSERVING = {"cavitation": ElrodAdams(cavity_pressure=-1e5)}
CLOSURES: dict[str, Case] = {
    "`Gumbel`": Case(options={"cavitation": Gumbel()}),
    "`FullSommerfeld`": Case(options={"cavitation": FullSommerfeld()}),
    CONSERVING: Case(options=_CONSERVING),
}
EFFECTS: dict[str, Case] = {
    "`squeeze=False`": Case(options={"squeeze": False}),
    "`VogelTemperature`": Case(options=_oil()),
    **{name: Case(options=options) for name, options in _LAWS.items()},
    "`AxialGroove`": Case(options={"supply": (AxialGroove(angle=3.4, width_angle=0.3),)}),
    "`CircumferentialGroove`": Case(options={"supply": (CircumferentialGroove(width=0.006),)}),
    "`Hole`": Case(options={"supply": (Hole(angle=3.4, diameter=0.012),)}),
    "`Pocket`": Case(options={"supply": (Pocket(angle=3.4, width_angle=0.5, length=0.03),)}),
    "`PatirCheng`": Case(options=_ROUGHNESS),
    "`PatirCheng`, unequally rough": Case(
        options={"roughness": PatirCheng(composite_roughness=ROUGH, journal_share=0.9)}
    ),
    "`NgPan`": Case(options={"turbulence": NgPan(onset=1.0, full=2.0)}),
    "`GreenwoodTripp`": Case(options=_ASPERITY),
    "`PatirCheng`, `GreenwoodTripp`": Case(options=_ROUGHNESS | _ASPERITY),
    "`GreenwoodTripp`, `ArchardWear`": Case(options=_ASPERITY | {"wear": ArchardWear(wear_rate=1e-15)}),
    "`RegularisedWall`": Case(options={"contact": RegularisedWall(onset=ONSET)}),
    "`Crown`": Case(options={"profile": Crown(drop=1e-6)}),
    "`ElasticLiner`": Case(options=_LINER),
    "`ElasticLiner`, `GreenwoodTripp`": Case(options=_LINER | _ASPERITY),
    "`ElasticLiner`, `BarusPressure`": Case(options=_LINER | _LAWS["`BarusPressure`"]),
    "`ElasticLiner`, `PatirCheng`": Case(options=_LINER | _ROUGHNESS),
    "`ElasticLiner`, `CarreauShear`": Case(options=_LINER | _LAWS["`CarreauShear`"]),
    "`ElasticLiner`, `FilmEnergy`": Case(options=_LINER | _LAWS["`FilmEnergy`"]),
}
WITH_CONSERVING: dict[str, Case] = {
    f"{CONSERVING}, {name}": Case(options=options | _CONSERVING, base=CONSERVING)
    for name, options in {
        **_LAWS,
        "`ElasticLiner`": _LINER,
        "`ElasticLiner`, `GreenwoodTripp`": _LINER | _ASPERITY,
    }.items()
}
FILMS: dict[str, Case] = {
    "`ShortBearing`": Case(options={"film": ShortBearing()}),
    "`LongBearing`": Case(
        options={"film": LongBearing(), "supply": (AxialGroove(angle=0.3 + math.pi, width_angle=0.2),)}
    ),
    "`ImpedanceMap`": Case(options={"film": ImpedanceMap()}),
    "`ClassicSOR`, `Gumbel`": Case(options={"film": ClassicSOR(n_theta=96, n_z=10), "cavitation": Gumbel()}),
}
CASES: dict[str, Case] = {PLAIN: Case(base=""), **CLOSURES, **EFFECTS, **WITH_CONSERVING, **FILMS}


def orbit(clearance: float = CLEARANCE, speed: float = SPEED, count: int = COUNT) -> np.ndarray:
    """Motions (count, 10) along the orbit, a degree apart, with its own velocities."""
    k = np.arange(count) * DEGREE
    angle, e = 0.3 + k, clearance * (0.8 + 0.05 * np.sin(5.0 * k))
    v = WHIRL * speed * e
    out = np.zeros((count, 10))
    out[:, 0], out[:, 1] = e * np.cos(angle), e * np.sin(angle)
    out[:, 4], out[:, 5] = -v * np.sin(angle), v * np.cos(angle)
    out[:, 8] = speed
    return out


def stages(model: Any, states: np.ndarray) -> np.ndarray:
    """Processor times (len(states), 3) in s of evaluation, tangent and history along the orbit."""
    out = np.zeros((len(states), 3))
    step = 3.0 * DEGREE / (WHIRL * states[0, 8])
    clock = time.process_time
    history = model.initial_history(states[0])
    for k, state in enumerate(states):
        start = clock()
        evaluation = model.evaluate(state, history, step)
        evaluated = clock()
        evaluation.tangent()
        differentiated = clock()
        if k % 3 == 2:
            history = evaluation.history()
        out[k] = evaluated - start, differentiated - evaluated, clock() - differentiated
    return out


def block(models: Mapping[str, Any], states: np.ndarray, rounds: int) -> dict[str, tuple[float, float]]:
    """Times of an evaluation with tangent and of an accepted step by case.

    Of every state the best of ``rounds``, all cases in turns.
    """
    best = {name: np.full((len(states), 3), math.inf) for name in models}
    for _ in range(rounds):
        for name, model in models.items():
            best[name] = np.minimum(best[name], stages(model, states))
    out = {}
    for name, times in best.items():
        evaluate, tangent, accept = times.sum(axis=0) / len(states)
        # one state in three was accepted
        out[name] = float(evaluate + tangent), float(3.0 * evaluate + 2.0 * tangent + 3.0 * accept)
    return out


def measure_effects(
    names: Iterable[str] | None = None,
    *,
    blocks: int = 5,
    rounds: int = 8,
    grid: tuple[int, int] = (96, 10),
    progress: Progress = print,
) -> list[Cost]:
    """Cost of effects over their bases.

    Parameters
    ----------
    names : of `CASES`, or None for all
        Their bases are measured with them.
    blocks : int
        For the spread.
    rounds : int
        Of which every state's best counts, per block.
    grid : (n_theta, n_z)
        Of the two-dimensional films.
    progress : function
        Gets a line per block.

    Returns
    -------
    list of Cost
        Two rows per case; a case that fails says so in its own.
    """
    asked = list(CASES if names is None else names)
    wanted = {name for asked_name in asked for name in (asked_name, CASES[asked_name].base) if name}
    states = orbit()
    bearings, failures = {}, {}
    for name, case in CASES.items():
        if name not in wanted:
            continue
        try:
            bearing = plain_bearing(**({"film": FiniteLength(n_theta=grid[0], n_z=grid[1])} | dict(case.options)))
            stages(build_model(bearing), states)
            bearings[name] = bearing
        except (EHDError, ValueError, RuntimeError) as error:
            failures[name] = str(error).splitlines()[0]
    times: dict[str, list[tuple[float, float]]] = {name: [] for name in bearings}
    for k in range(blocks):
        progress(f"effects: block {k + 1} of {blocks}")
        models = {name: build_model(bearing) for name, bearing in bearings.items()}
        for name, found in block(models, states, rounds).items():
            times[name].append(found)
    bases = {name: case.base for name, case in CASES.items() if case.base}
    out = []
    for column, per in enumerate((EVALUATION, STEP)):
        out += costs_of_blocks(per, {name: [t[column] for t in found] for name, found in times.items()}, bases)
        out += [Cost(what=name, per=per, failure=text) for name, text in failures.items()]
    order = list(CASES)
    return sorted(out, key=lambda cost: (cost.per != EVALUATION, order.index(cost.what)))
