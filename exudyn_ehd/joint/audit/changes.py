"""Changes by another description of a bearing at the audited states: computed, not guessed.

At a steady state the journal of the other bearing is moved to where its film carries the same load; minimum film
thickness, peak pressure and loss are compared there, the load at the same position. The films of a record that remember
are compared at the same motion with the same memory, where the peak is related to the load, and the minimum film
thickness estimated from it: a film pressed together carries about 1 / h^2.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.film.solvers.impedance_map import ImpedanceMap
from exudyn_ehd.joint.audit.samples import FilmState, RecordedSteps, recorded_states, squeeze_rate
from exudyn_ehd.joint.audit.switches import Switch, two_dimensional
from exudyn_ehd.joint.balance.newton import Balance
from exudyn_ehd.joint.model.build import build_study_model
from exudyn_ehd.joint.model.quantities import refined_peak
from exudyn_ehd.joint.model.rigid import BearingModel, Evaluation
from exudyn_ehd.joint.solved_film import MOTION_SIZE
from exudyn_ehd.status import FilmError, InputError, Status

# From this change on an effect matters; below the second one nobody needs it.
MATTERS, NOTHING = 0.03, 0.02
# Search for the same load: relative unbalance, largest number of film solves, and the starts as shares of the
# eccentricity.
TOLERANCE, EFFORT, STARTS = 1e-3, 600, (1.0, 0.95, 0.7)
# Loads below it, over L D mu omega / psi^2, have no relative changes.
NO_LOAD = 1e-6


@dataclass(frozen=True, kw_only=True)
class Change:
    """Changes by another description, relative to the bearing as it is, at the state where they are largest.

    Attributes
    ----------
    load : float
        Change at the same position or motion; nan if there is no such film.
    minimum_gap, peak_pressure, power_loss : float
        Changes at the same load; nan if no film was found that carries it.
    """

    load: float
    minimum_gap: float
    peak_pressure: float
    power_loss: float

    @property
    def found(self) -> bool:
        """Return whether a film was found that carries the same load."""
        return not math.isnan(self.minimum_gap)

    @property
    def size(self) -> float:
        """Largest change at the same load; inf without a film."""
        return max(abs(self.minimum_gap), abs(self.peak_pressure), abs(self.power_loss)) if self.found else math.inf

    def __str__(self) -> str:
        load = "" if math.isnan(self.load) else f"load {self.load:+.1%} at the same position; "
        if not self.found:
            return f"{load}no film found that carries the same load"
        rest = f"minimum film thickness {self.minimum_gap:+.1%}, peak {self.peak_pressure:+.1%}"
        return f"{load}{rest}, loss {self.power_loss:+.1%} at the same load"


class Comparison:
    """Films of a bearing at the audited states, to compare others with.

    Bearings of another kind have a subclass, with the methods that depend on how they move.

    Parameters
    ----------
    model : BearingModel
    states : sequence of FilmState
    record : RecordedSteps, optional
        Record that the states come from.

    Attributes
    ----------
    axes : int
        Components of the force that the film carries.
    surface : str
        Name of the surface around the film, for messages.
    """

    axes, surface = 2, "bore"

    def __init__(self, model: BearingModel, states: Sequence[FilmState], record: RecordedSteps | None) -> None:
        self.model, self.states, self.record = model, states, record
        if isinstance(model.bearing.film, ImpedanceMap):
            self.model = self.build(two_dimensional(model.bearing))

    def build(self, bearing: JournalBearing) -> BearingModel:
        """Model of another bearing, with the grid's start of this one."""
        return build_study_model(bearing, float(self.model.grid.x[0]))

    def spin(self, motions: np.ndarray) -> np.ndarray:
        """Spin of the journal, rad/s, (n,) of motions (n, k)."""
        return motions[:, 8]

    def squeeze_rate(self, motions: np.ndarray, time: np.ndarray) -> float:
        """`exudyn_ehd.joint.audit.samples.rate_of_squeeze`, 1/s, of a run's motions (n, k)."""
        return squeeze_rate(self.model.bearing, motions, time)

    def force_unit(self, motion: np.ndarray) -> float:
        """Unit of the film's force at a motion, of spin and squeeze, N."""
        b = self.model.bearing
        rates = float(np.max(np.abs(motion[4:6]))) + 0.5 * b.length * float(np.max(np.abs(motion[6:8])))
        return b.reference_force(abs(float(motion[8])) + rates / b.radial_clearance)

    def numbers(self, evaluation: Evaluation) -> tuple[float, float, float]:
        """Minimum film thickness, m, refined peak pressure, Pa, and loss, W."""
        q, film = evaluation.quantities(), evaluation.film
        assert film is not None
        return q["minimum_gap"], refined_peak(film)[0], q["power_loss"]

    def change(self, switch: Switch) -> Change | None:
        """Worst change by a switch; None where no state could be compared."""
        try:
            other = self.build(switch(self.model.bearing))
        except InputError:
            return None
        states: Sequence[FilmState] = self.states
        remembers = self.record is not None and (other.remembers or self.model.remembers or self.model.needs_spin)
        if self.record is not None and remembers and self._has_own_memory(other):
            if other.flexible:  # tens of steps before every state, each a search for the bore's balance: seconds
                return None
            states = recorded_states(other, self.record)
        found = [self._at(other, mine, its, remembers) for mine, its in zip(self.states, states, strict=True)]
        changes = [change for change in found if change is not None]
        return max(changes, key=lambda change: change.size, default=None)

    def _has_own_memory(self, other: BearingModel) -> bool:
        """Return whether another bearing remembers what this one does not; without, it takes the memory of this one."""
        gains = other.remembers_mass and not self.model.remembers_mass
        return gains or other.grid.shape != self.model.grid.shape

    def _at(self, other: BearingModel, mine: FilmState, its: FilmState, remembers: bool) -> Change | None:
        film = mine.evaluate(self.model)
        if film.status is not Status.CONVERGED:
            return None
        force, q = film.wrench[: self.axes].copy(), self.numbers(film)
        size = float(np.linalg.norm(force))
        if not size > NO_LOAD * self.force_unit(mine.motion):
            return None
        if remembers:
            motion = its.motion[:MOTION_SIZE]
            found = other.evaluate_steady(motion, its.history, its.step, its.spin)
            return self._same_motion(found, size, q) if found.status is Status.CONVERGED else None
        load, moved = self.same_load(other, mine, force)
        share = load / size - 1.0
        if moved is None:
            return Change(load=share, minimum_gap=math.nan, peak_pressure=math.nan, power_loss=math.nan)
        gap, peak, loss = (
            new / old - 1.0 if old > 0.0 else 0.0 for new, old in zip(self.numbers(moved), q, strict=True)
        )
        return Change(load=share, minimum_gap=gap, peak_pressure=peak, power_loss=loss)

    def _same_motion(self, evaluation: Evaluation, size: float, q: tuple[float, float, float]) -> Change:
        """Change of a film that remembers, whose step can't be taken again elsewhere, from a force, N, and numbers."""
        share = max(float(np.hypot(*evaluation.wrench[:2])) / size, 1e-12)
        pairs = zip(self.numbers(evaluation), q, strict=True)
        gap, peak, loss = (new / old if old > 0.0 else 1.0 for new, old in pairs)
        gap, peak = gap * math.sqrt(share), peak / share
        return Change(load=share - 1.0, minimum_gap=gap - 1.0, peak_pressure=peak - 1.0, power_loss=loss - 1.0)

    def same_load(self, other: BearingModel, mine: FilmState, force: np.ndarray) -> tuple[float, Evaluation | None]:
        """Load of another bearing at a state, N, nan without a film, and its film with this force; None without one."""
        # the temperature is held where both have the same: what else changes it is of second order; one that is a
        # field settles anew on another grid
        own = self.model.bearing
        held = mine.history if other.bearing.thermal is not None and other.bearing.thermal == own.thermal else None
        if held is not None and isinstance(held.temperature, np.ndarray) and other.grid.shape != self.model.grid.shape:
            held = None
        if other.flexible and other.bearing.bush is own.bush and other.bearing.journal is own.journal:
            other.evaluate(mine.motion, held)  # the search for its bore's shape starts from this one's
        motion, placed = mine.motion[:MOTION_SIZE], Balance(other, "audit", held=held)
        load, temperature = math.nan, placed.temperature_of(None)
        try:
            there = placed.solve(motion, temperature)
            load, temperature = float(np.hypot(*there.evaluation.wrench[:2])), there.temperature
        except FilmError:
            pass
        return load, _same_load(Balance(other, "audit", -force, held=held, effort=EFFORT), motion, temperature)


def _same_load(balance: Balance, motion: np.ndarray, temperature: np.ndarray) -> Evaluation | None:
    """The film that carries the load, near a motion; None if it is not found."""
    for start in STARTS:
        trial = motion.copy()
        trial[:2] *= start
        try:
            found = balance.solve(trial, temperature, TOLERANCE)
        except FilmError:
            continue
        if balance.is_balanced(found, TOLERANCE):
            return found.evaluation
    return None
