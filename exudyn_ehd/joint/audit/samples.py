"""Data of an audit: recorded steps of a joint, states to evaluate again, and the numbers of one film."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass, replace

import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.joint.balance.resolution import Resolution, resolution
from exudyn_ehd.joint.model.rigid import BearingModel, Evaluation
from exudyn_ehd.joint.solved_film import History, SolvedFilm
from exudyn_ehd.status import Status

# Recorded steps that are run again before a state, so that a film that remembers has forgotten where they started: the
# last ones, and so many a turn of the turns before, fewer in a flexible bore.
REPLAYED, A_TURN, TURNS = 60, 80, (3.0, 1.0)
# Smallest amplitude that a squeezing journal is taken to have at one instant, over the clearance: with a larger one the
# frequency of journals that pass the centre is lower, with a smaller one it is higher.
AMPLITUDE = 0.1
# Gauge pressure below which oil at ambient pressure would have to carry tension, Pa.
TENSION = -1e5


@dataclass(frozen=True, eq=False)
class RecordedSteps:
    """Accepted steps of a joint, as arrays over the steps; what a film model does not report is nan.

    Attributes
    ----------
    time : (n,) array
        s.
    motion : (n, 10) array
        As in `exudyn_ehd.joint.solved_film`.
    force : (n, 3) array
        N, on the journal.
    minimum_gap, peak_pressure, power_loss, leakage, contact_load, film_temperature : (n,) arrays
        m, Pa, W, m3/s, N, K.
    bush_temperature, journal_temperature, bore_displacement : (n,) arrays
        K, K, m.
    step_error : (n,) array
        Estimated error of the gap that the time steps have made, over the minimum film thickness.
    axial_position, thrust_power_loss : (n,) arrays
        m, W, of films on the end faces.
    """

    time: np.ndarray
    motion: np.ndarray
    force: np.ndarray
    minimum_gap: np.ndarray
    peak_pressure: np.ndarray
    power_loss: np.ndarray
    leakage: np.ndarray
    contact_load: np.ndarray
    film_temperature: np.ndarray
    bush_temperature: np.ndarray
    journal_temperature: np.ndarray
    bore_displacement: np.ndarray
    step_error: np.ndarray
    axial_position: np.ndarray
    thrust_power_loss: np.ndarray

    def worst(self, bearing: JournalBearing) -> list[int]:
        """Steps, sorted, in which something is worst.

        Minimum film thickness, highest pressure, loss, contact load and speed, largest tilt and deflection, strongest
        squeeze.
        """
        tilt = np.array([tilt_loss(bearing, m) for m in self.motion])
        squeeze = np.array([squeeze_share(bearing, m) for m in self.motion])
        deflected = self.bore_displacement / np.maximum(self.minimum_gap, 1e-3 * bearing.radial_clearance)
        return self.extremes(tilt, squeeze, np.abs(self.motion[:, 8]), deflected)

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
    for k in record.worst(model.bearing):
        before = int(np.searchsorted(turned, turned[k] - TURNS[flexible] * 2.0 * math.pi))
        first = max(0, min(k - REPLAYED, before)) if model.remembers else k
        if reached < first:
            reached, history, step = first, _first_history(model, record, first), 0.0
        for i, after in itertools.pairwise(_replayed(turned, reached, k)):
            if step > 0.0:
                passed = model.evaluate_steady(motions[i], history, step, float(spin[i]))
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


@dataclass(frozen=True, kw_only=True)
class Sample:
    """Numbers of one evaluated film.

    Attributes
    ----------
    speed : float
        Sliding speed of the surfaces, m/s.
    minimum_gap, peak_pressure, load : float
        m, Pa, N (film and contact).
    contact_load, power_loss, flow : float
        N, W, m3/s (out of the ends or out of the supply, the larger one; of a ball the oil that it moves).
    viscosity : float
        Smallest in the film at ambient pressure, Pa s.
    rise : float
        Largest temperature of the film above that of the supply, K; 0 for an isothermal film.
    to_bush, to_journal : float
        Shares of the film's heat that walls take up.
    cavitated, tension : float
        Shares of the bore or socket.
    tilt_loss, squeeze_share, squeeze_rate : float
        See the functions of these names.
    deflection, shape : float
        Largest deflection of a liner and largest departure of the surfaces from cylinders, m.
    resolution : Resolution
        Resolution of the pressure peak by the grid.
    """

    speed: float
    minimum_gap: float
    peak_pressure: float
    load: float
    contact_load: float
    power_loss: float
    flow: float
    viscosity: float
    cavitated: float
    tension: float
    squeeze_share: float
    squeeze_rate: float
    deflection: float
    resolution: Resolution
    rise: float = 0.0
    to_bush: float = 0.0
    to_journal: float = 0.0
    tilt_loss: float = 0.0
    shape: float = 0.0


def take_sample(model: BearingModel, state: FilmState, record: RecordedSteps | None) -> Sample | None:
    """Evaluate a state and read its numbers; None if there is no film.

    On a flexible bore, which settles here, a record has the numbers of the bore in motion.
    """
    evaluation = state.evaluate(model)
    film = evaluation.film
    if film is None:
        return None
    q, s, g, b, w = evaluation.quantities(), film.solver, film.grid, model.bearing, film.journal
    pressure = film.oil.P * film.scales.pressure
    weight = g.weight / g.weight.sum()
    unbroken = s.fill >= 1.0 if s.closure.conserves_mass else s.work.active | g.fixed
    thermal = b.thermal
    to_bush, to_journal = _wall_shares(model, film)
    sample = Sample(
        speed=math.hypot(g.reference_length * w.omega, w.axial_speed),
        minimum_gap=max(q["minimum_gap"], 1e-6 * b.radial_clearance),
        peak_pressure=q["peak_pressure"],
        load=math.hypot(evaluation.wrench[0], evaluation.wrench[1]),
        contact_load=q["contact_load"],
        power_loss=q["power_loss"],
        flow=max(q["leakage"], q.get("supply_flow", 0.0), 0.0),
        viscosity=_smallest_viscosity(film),
        rise=0.0 if thermal is None else q["peak_temperature"] - thermal.supply_temperature,
        to_bush=to_bush,
        to_journal=to_journal,
        cavitated=float(np.sum(weight[~unbroken])),
        tension=float(np.sum(weight[pressure < TENSION])),
        tilt_loss=tilt_loss(b, w.motion),
        squeeze_share=squeeze_share(b, w.motion),
        squeeze_rate=squeeze_rate(b, w.motion[None]),
        deflection=q.get("bore_displacement", 0.0),
        shape=_shape(film),
        resolution=resolution(film),
    )
    if record is None or state.recorded is None or not model.flexible:
        return sample
    k = state.recorded
    return replace(
        sample,
        minimum_gap=max(float(record.minimum_gap[k]), 1e-9 * float(np.max(record.minimum_gap))),
        peak_pressure=float(record.peak_pressure[k]),
        load=math.hypot(record.force[k, 0], record.force[k, 1]),
        contact_load=float(record.contact_load[k]),
        power_loss=float(record.power_loss[k]),
        deflection=float(record.bore_displacement[k]),
    )


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


def tilt_loss(bearing: JournalBearing, motion: np.ndarray) -> float:
    """Share of the smallest mid-plane gap that is lost at an end of a tilted journal, 0 to 1 (rigid cylinders)."""
    x, y, bx, by = motion[:4].tolist()
    c, half = bearing.radial_clearance, 0.5 * bearing.length
    middle = c - math.hypot(x, y)
    end = c - max(math.hypot(x + s * half * bx, y + s * half * by) for s in (-1.0, 1.0))
    if end >= middle:
        return 0.0
    return min(1.0, (middle - end) / max(middle, 1e-3 * c))


def squeeze_share(bearing: JournalBearing, motion: np.ndarray) -> float:
    """Share of the squeeze term among the sources of the Reynolds equation, 0 to 1: v / (v + e |omega| / 2).

    v is the velocity and e the eccentricity of the journal's axis, each the largest along the bearing; the amplitudes
    of dh/dt and (omega / 2) dh/dtheta.
    """
    half = 0.5 * bearing.length
    e, v = (
        max(math.hypot(a[0] + s * half * a[2], a[1] + s * half * a[3]) for s in (-1.0, 1.0))
        for a in (motion[:4].tolist(), motion[4:8].tolist())
    )
    total = v + 0.5 * abs(float(motion[8])) * e
    return v / total if total > 0.0 else 0.0


def squeeze_rate(bearing: JournalBearing, motions: np.ndarray, time: np.ndarray | None = None) -> float:
    """`rate_of_squeeze`, 1/s, of motions (n, 10), at the end of the bearing where it is the larger one."""
    rates = []
    for half in (-0.5 * bearing.length, 0.5 * bearing.length):
        place, velocity = (motions[:, k : k + 2] + half * motions[:, k + 2 : k + 4] for k in (0, 4))
        wedge = 0.5 * np.abs(motions[:, 8]) * np.linalg.norm(place, axis=1)
        rates.append(rate_of_squeeze(place, velocity, wedge, bearing.radial_clearance, time))
    return max(rates)


def rate_of_squeeze(
    place: np.ndarray, velocity: np.ndarray, wedge: np.ndarray, clearance: float, time: np.ndarray | None
) -> float:
    """Acceleration a of the squeeze over the sources of the Reynolds equation, 1/s: a / (v + wedge).

    Flow that swings at w between plates takes the pressure ``12 mu q / h^3 (1 + i Re / 10)``, Re = rho w h^2 / mu, up
    to its first order in Re. So rho c^2 / mu times this rate is the Re of the squeeze, times its share of the sources
    where the surfaces slide as well.

    Parameters
    ----------
    place, velocity : (n, k) arrays
        Position and velocity of the axis or centre, m and m/s.
    wedge : (n,) array
        Amplitude of the sliding's source, m/s.
    clearance : float
        m.
    time : (n,) array or None
        s, of the steps of a run, whose means count: a is the difference of the velocities before and after a step,
        which an alternation from step to step leaves alone. None: a single state, a = v^2 / e of a circular whirl about
        the centre.
    """
    sources = np.linalg.norm(velocity, axis=1) + wedge
    if time is not None and time.size > 2:
        accelerations = np.linalg.norm(velocity[2:] - velocity[:-2], axis=1) / (time[2:] - time[:-2])
        whole = time_mean(time[1:-1], sources[1:-1])
        return time_mean(time[1:-1], accelerations) / whole if whole > 0.0 else 0.0
    amplitude = np.maximum(np.linalg.norm(place, axis=1), AMPLITUDE * clearance)
    accelerations = np.sum(velocity**2, axis=1) / amplitude
    return float(np.max(accelerations / np.maximum(sources, 1e-300)))


def _shape(film: SolvedFilm) -> float:
    """Largest height of profile and wear, of the undeformed surfaces, m."""
    if film.extra is None or not film.extra.surfaces:
        return 0.0
    return float(np.ptp(np.sum(film.extra.surfaces, axis=0))) * film.parts.bearing.radial_clearance
