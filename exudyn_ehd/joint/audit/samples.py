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

# Recorded steps that are run again before a state, so that a film that remembers has forgotten where they started: the
# last ones, and so many a turn of the turns before, fewer in a flexible bore.
REPLAYED, A_TURN, TURNS = 60, 80, (3.0, 1.0)
# Smallest amplitude that a squeezing journal is taken to have at one instant, over the clearance: with a larger one the
# frequency of journals that pass the centre is lower, with a smaller one it is higher.
AMPLITUDE = 0.1
# Radial deflection of a steel ring under the peak pressure, over R p / E; half of it under a uniform one.
RING_COMPLIANCE = 0.7

Sources = tuple[np.ndarray, np.ndarray, np.ndarray]
"""Sources of Reynolds' equation by motions (n, k), at both ends of a journal or in the centre of a ball: position and
velocity of the axis (e, n, k), m and m/s, and amplitude (e, n) of the sliding's source, m/s."""


@dataclass(frozen=True, eq=False, kw_only=True)
class FilmSteps:
    """Accepted steps of a joint with a film, as arrays over the steps; what a film model does not report is nan.

    Attributes
    ----------
    time : (n,) array
        s.
    force : (n, 3) array
        N, on the journal.
    minimum_gap, peak_pressure, power_loss, contact_load : (n,) arrays
        m, Pa, W, N.
    step_error : (n,) array
        Estimated error of the gap that the time steps have made, over the minimum film thickness.
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
    """Accepted steps of a joint that an audit looks at.

    Attributes
    ----------
    motion : (n, 10) array
        As in `exudyn_ehd.joint.solved_film`.
    leakage, film_temperature, bush_temperature, journal_temperature, bore_displacement : (n,) arrays
        m3/s, K, K, K, m.
    thrust_power_loss : (n,) array
        W, of films on the end faces.
    """

    motion: np.ndarray
    leakage: np.ndarray
    film_temperature: np.ndarray
    bush_temperature: np.ndarray
    journal_temperature: np.ndarray
    bore_displacement: np.ndarray
    thrust_power_loss: np.ndarray

    def extremes(self, *more: np.ndarray) -> list[int]:
        """Steps, sorted, with the thinnest film, the highest pressure, loss and contact load, and the most of others.

        ``more``: (n,) arrays.
        """
        keys = (-self.minimum_gap, self.peak_pressure, np.abs(self.power_loss), self.contact_load, *more)
        return sorted({int(np.nanargmax(key)) for key in keys if np.any(np.isfinite(key))})


@dataclass(frozen=True, eq=False)
class FilmState:
    """Arguments of one `BearingModel.evaluate`, a flexible bore's in the motion too, and the step of a record."""

    motion: np.ndarray
    history: History | None = None
    step: float = 0.0
    spin: float = 0.0
    recorded: int | None = None

    def evaluate(self, model: BearingModel) -> Evaluation:
        """The film at this state."""
        return model.evaluate(self.motion, self.history, self.step, self.spin)


def time_mean(time: np.ndarray, values: np.ndarray) -> float:
    """Mean over time of what is known of values (n,), whatever the sizes of the steps; nan of none."""
    known = np.isfinite(values)
    time, values = time[known], values[known]
    span = float(np.ptp(time)) if time.size else 0.0
    return float(np.trapezoid(values, time)) / span if span > 0.0 else float(values[-1]) if values.size else math.nan


def adiabatic_rise(bearing: JournalBearing, power: np.ndarray, flow: np.ndarray, speed: np.ndarray) -> np.ndarray:
    """Temperature rise P / (rho c_p Q), K, by power losses, W, flows, m3/s, and sliding speeds, m/s.

    Without flow through the bearing, that of one turn's Couette flow.
    """
    couette = 0.5 * speed * bearing.radial_clearance * bearing.length
    # not true for a flow that is not known
    heat = bearing.lubricant.density * bearing.lubricant.specific_heat * np.where(flow > 1e-2 * couette, flow, couette)
    return np.divide(power, heat, out=np.zeros_like(heat), where=heat > 0.0)


def recorded_states(model: BearingModel, record: RecordedSteps) -> list[FilmState]:
    """The worst states of a record, with the histories that its last steps lead to (a worn depth starts at zero).

    Flexible bores, which a record does not hold, settle under their films.
    """
    intervals = np.diff(record.time)
    turns = 0.5 * (record.motion[1:, 8] + record.motion[:-1, 8]) * intervals
    spin = np.concatenate([[0.0], np.cumsum(turns)])
    flexible = model.flexible
    motions = _differenced(record) if flexible else record.motion
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
    """Steps from one to another one, of the angles (n,) that the journal has turned: the last ones, some before."""
    recent = max(first, last - REPLAYED)
    early = np.searchsorted(turned, np.arange(turned[first], turned[recent], 2.0 * math.pi / A_TURN))
    return np.unique(np.concatenate([np.maximum(early, first), np.arange(recent, last + 1)])).tolist()


def _differenced(record: RecordedSteps) -> np.ndarray:
    """Motions (n, 10) with the rates of the steps' own differences.

    Rates that an integrator leaves behind on a flexible bore alternate, those of the journal with those of the bore,
    which a record does not hold.
    """
    motions = record.motion.copy()
    motions[1:, 4:8] = np.diff(record.motion[:, :4], axis=0) / np.diff(record.time)[:, None]
    return motions


def _first_history(model: BearingModel, record: RecordedSteps, k: int) -> History | None:
    """History of a flooded film at a recorded step, at the recorded temperature, with walls as hot as at the film."""
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
    """Steps, sorted, in which something is worst.

    Minimum film thickness, highest pressure, loss, contact load and speed, largest tilt and deflection, strongest
    squeeze.
    """
    deflected = record.bore_displacement / np.maximum(record.minimum_gap, SMALLEST_GAP_SHARE * bearing.radial_clearance)
    squeeze = squeeze_share(sources(bearing, record.motion))
    return record.extremes(tilt_loss(bearing, record.motion), squeeze, np.abs(record.motion[:, 8]), deflected)


def sources(bearing: JournalBearing, motions: np.ndarray) -> Sources:
    """Sources of Reynolds' equation by motions (n, >= 9), see `Sources`."""
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

    v is the velocity and e the eccentricity of the journal's axis, each the largest along the bearing; the amplitudes
    of dh/dt and (omega / 2) dh/dtheta. Of a ball v / (v + |e x w| / 2).
    """
    squeeze, wedge = np.linalg.norm(by_motion[1], axis=2).max(axis=0), by_motion[2].max(axis=0)
    return squeeze / np.maximum(squeeze + wedge, 1e-300)


def squeeze_rate(by_motion: Sources, clearance: float, time: np.ndarray | None = None) -> float:
    """Acceleration a of the squeeze over the sources of the Reynolds equation, 1/s: a / (v + wedge), the larger end's.

    Flow that swings at w between plates takes the pressure ``12 mu q / h^3 (1 + i Re / 10)``, Re = rho w h^2 / mu, up
    to its first order in Re. So rho c^2 / mu times this rate is the Re of the squeeze, times its share of the sources
    where the surfaces slide as well.

    Parameters
    ----------
    by_motion : Sources
    clearance : float
        m.
    time : (n,) array or None
        s, of the steps of a run, whose means count: a is the difference of the velocities before and after a step,
        which an alternation from step to step leaves alone. None: a single state, a = v^2 / e of a circular whirl about
        the centre.
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
    """Numbers of a film, besides those that its quantities and its motion give.

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
        "tension": float(np.sum(weight[film.oil.P * film.scales.pressure < VAPOUR_PRESSURE])),
        "tilt_loss": float(tilt_loss(b, w.motion[None])[0]),
        "deflection": q.get("bore_displacement", 0.0),
        "compliance": RING_COMPLIANCE * b.journal_radius / STEEL["youngs_modulus"],
        "shape": _shape(film),
    }


def recorded_numbers(record: RecordedSteps, k: int) -> dict[str, float]:
    """Numbers of a recorded step in place of those of its film, whose bore is settled and not in motion."""
    return {
        "minimum_gap": max(float(record.minimum_gap[k]), 1e-9 * float(np.max(record.minimum_gap))),
        "peak_pressure": float(record.peak_pressure[k]),
        "load": math.hypot(record.force[k, 0], record.force[k, 1]),
        "contact_load": float(record.contact_load[k]),
        "power_loss": float(record.power_loss[k]),
        "deflection": float(record.bore_displacement[k]),
    }


def _wall_shares(model: BearingModel, film: SolvedFilm) -> tuple[float, float]:
    """Shares of a film's heat that enter a bush and a journal that conduct, at the temperatures of the step's start."""
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
