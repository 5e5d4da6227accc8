"""Data of an audit: recorded steps of a joint, states to evaluate again, numbers of a motion and of a film."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass, replace

import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.film.heat.options import known_supply
from exudyn_ehd.joint.audit.switches import STEEL, VAPOUR_PRESSURE
from exudyn_ehd.joint.model.rigid import BearingModel, Evaluation
from exudyn_ehd.joint.solved_film import FacesHeat, History, SolvedFilm
from exudyn_ehd.joint.step_error import SMALLEST_GAP_SHARE
from exudyn_ehd.status import Status

# Recorded steps that are evaluated again before a state, so that the film's memory no longer depends on its start:
# number of last steps, and of steps per turn before them; number of turns in a rigid and in a flexible bore. Larger:
# slower audits.
REPLAYED, TURNS = 80, (3.0, 1.0)
# Least amplitude of a squeezing journal at a single state, over the clearance. Larger: lower frequencies are estimated
# for journals near the centre; smaller: higher ones.
AMPLITUDE = 0.1
# Radial deflection of steel under the peak pressure, over R p / E: that of a ring, half of it under a uniform pressure;
# that of a free solid pin is 0.6. Larger: elasticity is found to matter more often.
STEEL_COMPLIANCE = 0.7

Sources = tuple[np.ndarray, np.ndarray, np.ndarray]
"""Sources of Reynolds' equation of motions (n, k), at e places: both ends of a journal or the centre of a ball.
Position and velocity of the axis (e, n, k), m and m/s, and amplitude (e, n) of the wedge term, m/s."""


@dataclass(frozen=True, eq=False, kw_only=True)
class FilmSteps:
    """Accepted steps of a joint with a film, as arrays over the steps; quantities that a film model lacks are nan.

    Attributes
    ----------
    time : (n,) array
        s.
    force : (n, 3) array
        Force on the journal, N.
    minimum_gap, peak_pressure, power_loss, contact_load : (n,) arrays
        m, Pa, W, N.
    step_error : (n,) array
        Estimated error of the gap by the time steps, over the minimum film thickness.
    """

    time: np.ndarray
    force: np.ndarray
    minimum_gap: np.ndarray
    peak_pressure: np.ndarray
    power_loss: np.ndarray
    contact_load: np.ndarray
    step_error: np.ndarray


@dataclass(frozen=True, eq=False, kw_only=True)
class RecordedSteps(FilmSteps):
    """Accepted steps of a joint for an audit.

    Attributes
    ----------
    motion : (n, 10) array
        As in `exudyn_ehd.joint.solved_film`.
    leakage, film_temperature, bush_temperature, journal_temperature, bore_displacement : (n,) arrays
        m3/s, K, K, K, m.
    thrust_power_loss : (n,) array
        Power loss of films on the end faces, W.
    """

    motion: np.ndarray
    leakage: np.ndarray
    film_temperature: np.ndarray
    bush_temperature: np.ndarray
    journal_temperature: np.ndarray
    bore_displacement: np.ndarray
    thrust_power_loss: np.ndarray

    def extremes(self, *more: np.ndarray) -> list[int]:
        """Return the sorted numbers of the steps with the thinnest film, the highest pressure, loss and contact load.

        ``more``: (n,) arrays, the steps of whose maxima are returned too.
        """
        keys = (-self.minimum_gap, self.peak_pressure, np.abs(self.power_loss), self.contact_load, *more)
        return sorted({int(np.nanargmax(key)) for key in keys if np.any(np.isfinite(key))})


@dataclass(frozen=True, eq=False)
class FilmState:
    """Arguments of one `BearingModel.evaluate`, and the number ``recorded`` of the state's step in a record.

    The motion contains the coordinates of a flexible bore.
    """

    motion: np.ndarray
    history: History | None = None
    step: float = 0.0
    spin: float = 0.0
    recorded: int | None = None

    def evaluate(self, model: BearingModel) -> Evaluation:
        """The film at this state."""
        return model.evaluate(self.motion, self.history, self.step, self.spin)


def time_mean(time: np.ndarray, values: np.ndarray) -> float:
    """Mean over time of the finite values of (n,), for steps of any size; nan if no value is finite."""
    known = np.isfinite(values)
    time, values = time[known], values[known]
    span = float(np.ptp(time)) if time.size else 0.0
    return float(np.trapezoid(values, time)) / span if span > 0.0 else float(values[-1]) if values.size else math.nan


def adiabatic_rise(bearing: JournalBearing, power: np.ndarray, flow: np.ndarray, speed: np.ndarray) -> np.ndarray:
    """Temperature rise P / (rho c_p Q), K, by power losses, W, flows, m3/s, and sliding speeds, m/s.

    If the flow is below 1 % of the Couette flow, or unknown, Q is the Couette flow, as if replaced in each turn.
    """
    couette = 0.5 * speed * bearing.radial_clearance * bearing.length
    # the comparison is False for an unknown flow, nan
    heat = bearing.lubricant.density * bearing.lubricant.specific_heat * np.where(flow > 1e-2 * couette, flow, couette)
    return np.divide(power, heat, out=np.zeros_like(heat), where=heat > 0.0)


def recorded_states(model: BearingModel, record: RecordedSteps) -> list[FilmState]:
    """Worst states of a record, with the histories from evaluating steps before them again; worn depths start at zero.

    A record does not contain the deflection of flexible bores: they are taken in equilibrium with their films.
    """
    intervals = np.diff(record.time)
    turns = 0.5 * (record.motion[1:, 8] + record.motion[:-1, 8]) * intervals
    spin = np.concatenate([[0.0], np.cumsum(turns)])
    flexible = model.flexible
    motions = record.motion.copy()
    if flexible:
        # rates of an integrator may alternate with those of a flexible bore, which a record does not contain
        motions[1:, 4:8] = np.diff(record.motion[:, :4], axis=0) / np.diff(record.time)[:, None]
    turned = np.concatenate([[0.0], np.cumsum(np.abs(turns))])
    states: list[FilmState] = []
    reached, history, step = -1, None, 0.0
    for k in worst_steps(model.bearing, record):
        before = int(np.searchsorted(turned, turned[k] - TURNS[flexible] * 2.0 * math.pi))
        first = max(0, min(k - REPLAYED, before)) if model.remembers else k
        if reached < first:
            reached, history, step = first, _first_history(model, record, first), 0.0
        for i, after in itertools.pairwise(_replayed(turned, reached, k)):
            if step > 0.0:
                passed = model.evaluate_steady(motions[i], history, step, float(spin[i]))
                if passed.film is not None and record.thrust_power_loss[i] > 0.0:
                    beside = FacesHeat(float(record.thrust_power_loss[i]), np.zeros(2), 0.0)
                    passed.film = passed.film._replace(beside=beside)
                history = passed.history() if passed.status is Status.CONVERGED else history
            step = float(record.time[after] - record.time[i])
        reached, motion = k, motions[k]
        if flexible:
            motion = model.evaluate_steady(motion, history, step, float(spin[k])).motion
        states.append(FilmState(motion, history, step, float(spin[k]), recorded=k))
    return states


def _replayed(turned: np.ndarray, first: int, last: int) -> list[int]:
    """Numbers of steps from ``first`` to ``last``: all of the last `REPLAYED`, and as many per turn before them.

    ``turned`` (n,): angle that the journal has turned up to each step, rad.
    """
    recent = max(first, last - REPLAYED)
    early = np.searchsorted(turned, np.arange(turned[first], turned[recent], 2.0 * math.pi / REPLAYED))
    return np.unique(np.concatenate([np.maximum(early, first), np.arange(recent, last + 1)])).tolist()


def _first_history(model: BearingModel, record: RecordedSteps, k: int) -> History | None:
    """History of a flooded film at a recorded step, with the recorded temperatures of film, bush and journal.

    A wall has one temperature throughout, that of its recorded surface.
    """
    history, thermal = model.initial_history(record.motion[k]), model.effects.thermal
    T = float(record.film_temperature[k])
    if history is None or history.temperature is None or thermal is None or not math.isfinite(T):
        return history
    film, walls = thermal.split(history.temperature)
    film = np.full(np.shape(film), T) if np.ndim(film) else T
    if walls is not None:
        film = walls.at(float(record.bush_temperature[k]), float(record.journal_temperature[k])).behind(film)
    return replace(history, temperature=film)


def worst_steps(bearing: JournalBearing, record: RecordedSteps) -> list[int]:
    """Return the sorted numbers of the steps in which one of the audited quantities is worst.

    These are: minimum film thickness, highest pressure, loss, contact load and speed, largest tilt and deflection,
    strongest squeeze.
    """
    deflected = record.bore_displacement / np.maximum(record.minimum_gap, SMALLEST_GAP_SHARE * bearing.radial_clearance)
    squeeze = squeeze_share(sources(bearing, record.motion))
    return record.extremes(tilt_loss(bearing, record.motion), squeeze, np.abs(record.motion[:, 8]), deflected)


def sources(bearing: JournalBearing, motions: np.ndarray) -> Sources:
    """Sources of Reynolds' equation of motions (n, >= 9), see `Sources`."""
    ends = 0.5 * bearing.length * np.array([[[-1.0]], [[1.0]]])
    place, velocity = (motions[:, k : k + 2] + ends * motions[:, k + 2 : k + 4] for k in (0, 4))
    return place, velocity, 0.5 * np.abs(motions[:, 8]) * np.linalg.norm(place, axis=2)


def tilt_loss(bearing: JournalBearing, motions: np.ndarray) -> np.ndarray:
    """Share (n,) of the smallest mid-plane gap that is lost at an end of a tilted journal, 0 to 1 (rigid cylinders)."""
    c = bearing.radial_clearance
    middle = c - np.linalg.norm(motions[:, :2], axis=1)
    end = c - np.linalg.norm(sources(bearing, motions)[0], axis=2).max(axis=0)
    return np.clip((middle - end) / np.maximum(middle, 1e-3 * c), 0.0, 1.0)


def squeeze_share(by_motion: Sources) -> np.ndarray:
    """Share (n,) of the squeeze term among the sources of the Reynolds equation, 0 to 1: v / (v + e |omega| / 2).

    v is the velocity and e the eccentricity of the journal's axis, each the larger one of both ends. v and e omega / 2
    are the amplitudes of dh/dt and (omega / 2) dh/dtheta. For a ball the share is v / (v + |e x w| / 2).
    """
    squeeze, wedge = np.linalg.norm(by_motion[1], axis=2).max(axis=0), by_motion[2].max(axis=0)
    return squeeze / np.maximum(squeeze + wedge, 1e-300)


def squeeze_rate(by_motion: Sources, clearance: float, time: np.ndarray | None = None) -> float:
    """Acceleration a of the squeeze over the sources of the Reynolds equation, a / (v + wedge), 1/s; the larger end's.

    Flow between plates that oscillates at the angular frequency w needs the pressure gradient ``12 mu q / h^3
    (1 + i Re / 10)`` to first order in Re = rho w h^2 / mu. So rho c^2 / mu times the returned rate is the Re of the
    squeeze; where the surfaces slide as well, it is this Re times the squeeze's share of the sources.

    Parameters
    ----------
    by_motion : Sources
    clearance : float
        m.
    time : (n,) array or None
        Times of the steps of a run, s. The result is then a ratio of time means, and a is the difference of the
        velocities before and after a step, in which alternations from step to step cancel. None: a single state, with
        a = v^2 / e of a circular whirl about the centre.
    """
    place, velocity, wedge = by_motion
    strength = np.linalg.norm(velocity, axis=2) + wedge
    if time is not None and time.size > 2:
        accelerations = np.linalg.norm(velocity[:, 2:] - velocity[:, :-2], axis=2) / (time[2:] - time[:-2])
        means = [[time_mean(time[1:-1], end) for end in values] for values in (accelerations, strength[:, 1:-1])]
        return max(a / whole if whole > 0.0 else 0.0 for a, whole in zip(*means, strict=True))
    amplitude = np.maximum(np.linalg.norm(place, axis=2), AMPLITUDE * clearance)
    accelerations = np.sum(velocity**2, axis=2) / amplitude
    return float(np.max(accelerations / np.maximum(strength, 1e-300)))


def film_numbers(model: BearingModel, evaluation: Evaluation) -> dict[str, float]:
    """Numbers of a film for an audit.

    Returns
    -------
    dict
        ``speed`` (sliding speed of the surfaces, m/s), ``minimum_gap`` (m), ``flow``
        (m3/s, out of the ends or out of the supply, the larger one), ``viscosity`` (smallest in the film at ambient
        pressure, Pa s), ``rise`` (K, largest temperature of the film above that of the supply; 0 for an isothermal
        film), ``to_bush`` and ``to_journal`` (shares of the film's heat that walls take up), ``cavitated`` and
        ``tension`` (shares of the bore), ``tilt_loss``, ``deflection`` and ``shape`` (largest deflection of a flexible
        surface and largest departure of the surfaces from cylinders, m), ``compliance`` (deflection of steel around the
        film over the peak pressure, m/Pa).
    """
    film = evaluation.solved
    q, s, g, b, w = evaluation.quantities(), film.solver, film.grid, model.bearing, film.journal
    weight = g.weight / g.weight.sum()
    unbroken = s.fill >= 1.0 if s.closure.conserves_mass else s.work.active | g.fixed
    to_bush, to_journal = _wall_shares(model, film)
    return {
        "speed": math.hypot(g.reference_length * w.omega, w.axial_speed),
        "minimum_gap": max(q["minimum_gap"], 1e-6 * b.radial_clearance),
        "flow": max(q["leakage"], q.get("supply_flow", 0.0), 0.0),
        "viscosity": _smallest_viscosity(film),
        "rise": 0.0 if b.thermal is None else q["peak_temperature"] - known_supply(b.thermal),
        "to_bush": to_bush,
        "to_journal": to_journal,
        "cavitated": float(np.sum(weight[~unbroken])),
        "tension": float(np.sum(weight[film.pressure < VAPOUR_PRESSURE])),
        "tilt_loss": float(tilt_loss(b, w.motion[None])[0]),
        "deflection": q.get("bore_displacement", 0.0),
        "compliance": STEEL_COMPLIANCE * b.journal_radius / STEEL["youngs_modulus"],
        "shape": _shape(film),
    }


def recorded_numbers(record: RecordedSteps, k: int) -> dict[str, float]:
    """Recorded numbers of a step, for flexible bores: the state's film has a bore in equilibrium, at rest."""
    return {
        "minimum_gap": max(float(record.minimum_gap[k]), 1e-9 * float(np.max(record.minimum_gap))),
        "peak_pressure": float(record.peak_pressure[k]),
        "load": math.hypot(record.force[k, 0], record.force[k, 1]),
        "contact_load": float(record.contact_load[k]),
        "power_loss": float(record.power_loss[k]),
        "deflection": float(record.bore_displacement[k]),
    }


def _wall_shares(model: BearingModel, film: SolvedFilm) -> tuple[float, float]:
    """Shares of a film's heat that enter a conducting bush and journal, at the start-of-step temperatures."""
    thermal = model.effects.thermal
    if thermal is None or film.walls is None or film.temperature is None:
        return 0.0, 0.0
    balance = thermal.balance(film, film.walls.behind(film.temperature))
    heat = max(balance["heat_in"], 1e-300)
    return balance["bush"] / heat, balance["journal"] / heat


def _smallest_viscosity(film: SolvedFilm) -> float:
    """Reference viscosity of the film, thinned by shear and heat but not thickened by pressure, Pa s."""
    b, ratio = film.parts.bearing, film.oil.ratio
    viscosity = film.scales.pressure * b.radial_clearance**2 / (12.0 * b.journal_radius**2)
    return viscosity * (1.0 if ratio is None else min(1.0, float(ratio.min())))


def _shape(film: SolvedFilm) -> float:
    """Largest height of profile and wear, of the undeformed surfaces, m."""
    if film.extra is None or not film.extra.surfaces:
        return 0.0
    return float(np.ptp(np.sum(film.extra.surfaces, axis=0))) * film.parts.bearing.radial_clearance
