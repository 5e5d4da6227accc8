"""One lubricated bearing between two rigid surfaces as a pure function of its relative motion.

Frame and motion as in `exudyn_ehd.joint.solved_film`. The wrench acts on the journal, moment about O; the housing
receives exactly the opposite about the same point.

Effects with a memory keep it in a `History`, which belongs to an accepted step: ``evaluate(motion, history, step)``
reads the history at the start of the step and the time since, and ``evaluation.history()`` is the history at its end.

At the exact centre the gap is the same all around, nothing presses, and the whole film is at its cavity pressure. A
small motion of the aligned journal has one source in Reynolds' equation, the velocity V relative to the mean motion of
the oil::

    div(h^3 / (12 mu) grad p) = -V . n,        V = dx/dt - (omega / 2) e_z x x,

and the film ruptures where V opens the gap, however small V is. The pressure is homogeneous of degree one in V. In a
bearing that is the same in all directions the force therefore is ``F = -c V`` with one coefficient (with a liner one
matrix that commutes with rotations), and K and C are those of films a little off the centre, in any direction. The film
at the centre itself has an unbroken solution, with twice the coefficient.

In a bearing that is not the same in all directions, as with a groove at the cavity pressure, F is not linear in V, and
no stiffness or damping exists. Tilts and displacements together are not linear either: derivatives to the tilt there
are the mean over the directions of V.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.film.heat.options import Walls
from exudyn_ehd.film.reynolds.gap import add_gap, rigid_gaps
from exudyn_ehd.film.solvers.answers import OilFields
from exudyn_ehd.joint.model.effects import Effects, film_parts
from exudyn_ehd.joint.model.loads import film_loads, recess_of
from exudyn_ehd.joint.model.results import FilmFields, eccentricities, film_fields, quantities
from exudyn_ehd.joint.plain_film import is_plain, solve_plain
from exudyn_ehd.joint.solved_film import (
    BESIDE,
    MOTION_SIZE,
    BoreState,
    ContactFields,
    ExtraGap,
    FacesHeat,
    History,
    JournalMotion,
    LimiterFields,
    Scales,
    SolvedFilm,
)
from exudyn_ehd.joint.tangent.wrench import wrench_tangent
from exudyn_ehd.status import Status


@dataclass(eq=False)
class Evaluation:
    """One film evaluation.

    Attributes
    ----------
    status : Status
    motion : (10,) array
    wrench : (6,) array
        Force (N) and moment about O (Nm) on the journal, joint frame; nan if there is no film at all.
    iterations : int
        Linear solves spent.
    minimum_gap : float
        m; nan if the motion is not finite.
    film : SolvedFilm or None
        None with a ``status`` other than CONVERGED, but for films behind the end of a pressure law. What is asked of
        it raises RuntimeError if the model has evaluated another state since.
    """

    status: Status
    motion: np.ndarray
    wrench: np.ndarray
    iterations: int
    minimum_gap: float
    film: SolvedFilm | None = field(repr=False)
    model: BearingModel = field(repr=False)

    def tangent(self, slow_motion: bool = False) -> np.ndarray:
        """d wrench / d motion (6, 10), exact for the current active set, from the stored factor; nan without a film.

        ``slow_motion`` lets a liner follow the rates, for the damping of a steady state; without a liner it changes
        nothing. At the exact centre the mean of films beside it.
        """
        if (film := self._current()) is None:
            return np.full((6, MOTION_SIZE), np.nan)
        if self.is_central:
            return self.tangents_beside(slow_motion).mean(axis=0)
        return wrench_tangent(film, slow_motion)

    def steady_tangent(self, exact: bool = False) -> np.ndarray:
        """d wrench / d motion (6, 10) after `BearingModel.evaluate_steady`; a flexible bore follows.

        Good enough for a search; ``exact`` for slow motions, which a liner follows too.
        """
        return self.tangent(slow_motion=exact)

    @property
    def is_central(self) -> bool:
        """Return whether a film that may rupture lies at the exact centre and presses nowhere."""
        return self.film is not None and not self.model.needs_spin and self.film.is_central

    def beside(self, direction: int = 0) -> Evaluation:
        """Evaluate the film a little off the centre in one of four directions, without spin moving that way."""
        film, motion = self.film, np.append(np.zeros(8), self.motion[8:MOTION_SIZE])
        assert film is not None
        # along a column of the grid Gümbel's linear pressure would be zero there, and its set undecided
        angle = 1.0 + 0.5 * math.pi * direction
        motion[:2] = BESIDE * film.parts.bearing.radial_clearance * np.array([math.cos(angle), math.sin(angle)])
        motion[4:6] = motion[:2] if motion[8] == 0.0 else 0.0
        return self.model.evaluate_steady(motion, film.history, film.step)

    def tangents_beside(self, exact: bool) -> np.ndarray:
        """Steady tangents (4, 6, 10) a little off the centre in four directions, ``exact`` or not.

        Buffers and records of the evaluation stay as they are.
        """
        film, tangents = self.solved, [self.beside(direction).steady_tangent(exact) for direction in range(4)]
        self.model.evaluate_steady(self.motion[:MOTION_SIZE], film.history, film.step)
        film.parts.evaluations = film.serial
        return np.array(tangents)

    def quantities(self) -> dict[str, float]:
        """Scalars of this state in SI units; see `exudyn_ehd.joint.model.results.quantities`."""
        if (film := self._current()) is None:
            p = self.model.parts
            return {"minimum_gap": self.minimum_gap} | eccentricities(p, self.motion[:4] * p.pose_scale)
        return quantities(film, self.model.effects.wear)

    def fields(self, time: float, bush_displacement: np.ndarray | None = None) -> FilmFields:
        """Return the fields of this state, which has a film."""
        return film_fields(self.solved, self.model.effects.wear, time, bush_displacement)

    def history(self) -> History | None:
        """Return the bearing's memory after this state, if it is accepted; None without effects that remember.

        Raises
        ------
        RuntimeError
            If there is no film.
        """
        if (film := self._current()) is None:
            raise RuntimeError(f"Evaluation.history: {self.status.name}, without a film there is no history to keep.")
        return self.model.next_history(film)

    def heat_with(self, heat_of_faces: Callable[[], FacesHeat]) -> SolvedFilm | None:
        """Return the film with the heat of films on end faces in its balance, for which alone they are asked."""
        if self.film is not None and self.model.effects.thermal is not None:
            self.film = self.film._replace(beside=heat_of_faces())
        return self.film

    @property
    def solved(self) -> SolvedFilm:
        """The film of a state that has one, which must be the model's last."""
        film = self._current()
        assert film is not None
        return film

    def _current(self) -> SolvedFilm | None:
        if self.film is not None:
            self.film.require_current()
        return self.film


class BearingModel:
    """Film between a rigid journal and a rigid bore, with the effects that a scene names.

    Parameters
    ----------
    bearing : JournalBearing
    start_angle : float
        theta of the first grid column, rad; the line of ambient pressure if the bearing's inlet is `MaximumGap`.
    effects : Effects
    """

    flexible = False

    def __init__(self, bearing: JournalBearing, *, start_angle: float = 0.0, effects: Effects | None = None) -> None:
        self.bearing, self.effects = bearing, Effects() if effects is None else effects
        self.parts = p = film_parts(bearing, self.effects, start_angle)
        self.grid, self.solver = p.grid, p.solver
        self.needs_spin = p.supply is not None and p.supply.rotating
        self.remembers_mass = bearing.cavitation.conserves_mass and bearing.squeeze
        self.remembers_deflection = self.effects.liner is not None and bearing.squeeze
        self.remembers = self.remembers_mass or self.remembers_deflection or p.solver.pockets is not None
        self.remembers = self.remembers or self.effects.thermal is not None or self.effects.wear is not None
        self._known = np.array([*bearing.end_pressures, bearing.cavitation.cavity_pressure, *bearing.edge_pressures])
        self._scale = p.motion_scale[:8]
        # what a flexible bore adds to the gap, and the slopes of all that is added
        self._displacement: np.ndarray | None = None
        self._rate = p.solver.nothing
        self._plain = not self.flexible and self.effects == Effects() and is_plain(p)
        self._set_viscosity(1.0)

    def _set_viscosity(self, ratio: float) -> None:
        """Scale the film to ``ratio`` times the reference viscosity, that of one temperature for the whole film."""
        b, p, law = self.bearing, self.parts, self.effects.pressure_law
        mu, R, c = ratio * b.lubricant.viscosity, b.journal_radius, b.radial_clearance
        pressure = 12.0 * mu * R**2 / c**2
        known = self._known / pressure
        self.viscosity_ratio = ratio
        edges = known[3:] * np.tile((-1.0, 1.0), len(p.grid.edges)) if known[3:].any() else None
        self.scales = Scales(pressure, pressure * R**2, mu * R**2 / c, known[:2], float(known[2]), edges)
        # what the solver is told: the transformed pressures of a pressure law
        self._prescribed = known if law is None else law.transform(self._known) / pressure
        if p.liner is not None and self.effects.liner is not None:
            p.liner.beta = self.effects.liner.compliance * pressure / c
        p.solver.pressure_scale = pressure

    def forget(self) -> None:
        """Drop the warm start. It never changes a result, only the time it takes."""
        self.solver.forget()

    def initial_history(self, motion: np.ndarray) -> History | None:
        """History of a flooded bearing (every gap full of oil) at this motion; None without effects that remember."""
        if not self.remembers:
            return None
        self.parts.evaluations += 1
        self._set_gap(self._journal(motion, 0.0), None)
        s, remembers, liner, effects = self.solver, self.remembers_mass, self.parts.liner, self.effects
        found = (self.remembers_deflection or s.pockets is not None) and self.evaluate(motion).film is not None
        void, mass, outflow = s.flooded() if remembers else (None, None, None)
        return replace(
            History() if effects.thermal is None else effects.thermal.first_memory(self.grid.shape),
            void=void,
            mass=mass,
            outflow=outflow,
            wear=None if effects.wear is None else effects.wear.field(None).copy(),
            deflection=liner.deflection if found and self.remembers_deflection and liner is not None else None,
            pockets=s.pockets if found else None,
        )

    def next_history(self, film: SolvedFilm) -> History | None:
        """History at the end of a solved film's step."""
        if not self.remembers:
            return None
        p, s, effects = self.parts, self.solver, self.effects
        old = History() if film.history is None else film.history
        void, mass = s.stored(old.mass, film.step) if self.remembers_mass else (None, None)
        new = replace(
            History() if effects.thermal is None else effects.thermal.memory(film),
            void=void,
            mass=mass,
            outflow=s.outflow() if self.remembers_mass else None,
            wear=None if effects.wear is None else effects.wear.grown(film),
            deflection=p.liner.deflection if self.remembers_deflection and p.liner is not None else None,
            pockets=s.pockets,
        )
        if void is not None and film.history is not None:
            for term in effects.gap_terms:  # wear and growth, which the film does not see before the next step
                void += term.field(new) - term.field(old)
        return new

    def evaluate(
        self, motion: np.ndarray, history: History | None = None, step: float = 0.0, spin: float = 0.0
    ) -> Evaluation:
        """Evaluate the film.

        Parameters
        ----------
        motion : (10,) array
            Relative motion in the joint frame, SI units; see `exudyn_ehd.joint.solved_film`.
        history : History, optional
            At the last accepted step; None asks for the steady film.
        step : float
            Time since then, s; 0 asks for the force at that very instant.
        spin : float
            Angle of the journal against the housing about the bearing's axis, rad; only read if ``needs_spin``
            (supply areas in the journal).

        Returns
        -------
        Evaluation
            With ``status`` other than CONVERGED the wrench is nan, or with NO_PRESSURE that of a pressure law that
            goes on behind its end: no solution, but a way back for Newton's method.
        """
        p, c = self.parts, self.bearing.radial_clearance
        p.evaluations += 1
        if self._plain:
            motion = np.array(motion, dtype=float)
            film, iterations = solve_plain(p, self.scales, motion, self._prescribed, step)
            if film is not None:
                return Evaluation(Status.CONVERGED, motion, film.loads.wrench, iterations, film.minimum_gap, film, self)
        journal = self._journal(motion, spin)
        temperature, walls = self._set_temperature(history)
        if p.supply is not None and p.supply.turn(spin):
            self.solver.refresh_fixed()
        # a sum is finite only if all its terms are
        if not math.isfinite(sum(journal.motion.tolist())):
            return self._result(Status.NOT_FINITE, journal, 0, math.nan)
        smallest, extra, pressing, limited = self._set_gap(journal, history)
        if smallest <= 0.0 and not self.effects.contacts and p.liner is None:
            return self._result(Status.NO_FILM, journal, 0, c * smallest)
        status, iterations = self._solve(journal, history, step)
        laws = self.effects.pressure_law, self.effects.shear_factor
        oil = self.solver.oil_fields(*laws) if status is Status.CONVERGED else None
        status = Status.NO_PRESSURE if status is Status.CONVERGED and (oil is None or oil.beyond) else status
        if oil is None:
            return self._result(status, journal, iterations, c * smallest)
        if p.liner is not None:
            smallest = p.liner.smallest_gap()
            if p.contacts is not None:
                pressing = p.contacts if smallest < p.contacts.presses_below else None
        recess = recess_of(p, self.scales, journal, self.effects.thermal, temperature)
        loads = film_loads(p, self.scales, journal, oil, extra, pressing, limited, recess)
        state = p, self.grid, self.solver, self.scales, journal, history, step, temperature
        bore, fields = self._bore_state(journal, oil, pressing, float(loads.wrench[5])), (extra, pressing, limited)
        film = SolvedFilm(*state, *fields, oil, loads, c * smallest, bore, p.evaluations, walls)
        return self._result(status, journal, iterations, c * smallest, film)

    def _result(
        self, status: Status, journal: JournalMotion, iterations: int, gap: float, film: SolvedFilm | None = None
    ) -> Evaluation:
        wrench = np.full(6, np.nan) if film is None else film.loads.wrench
        return Evaluation(status, journal.motion, wrench, iterations, gap, film, self)

    def _bore_state(
        self, journal: JournalMotion, oil: OilFields, pressing: ContactFields | None, moment: float
    ) -> BoreState | None:
        """A flexible bore under this film, which turns the journal with a moment, Nm; None for a rigid one."""
        return None

    def _journal(self, motion: np.ndarray, spin: float) -> JournalMotion:
        motion = np.array(motion, dtype=float)
        scaled = motion[:8] * self._scale
        return JournalMotion(motion, scaled[:4], scaled[4:], float(motion[8]), float(motion[9]))

    def _set_temperature(self, history: History | None) -> tuple[float | np.ndarray | None, Walls | None]:
        """Bring the viscosity to the temperature at the start of the step, which comes back, with that of walls."""
        thermal = self.effects.thermal
        if thermal is None:
            return None, None
        if (temperature := None if history is None else history.temperature) is None:
            temperature = thermal.initial_temperature(self.grid.shape)
        if (ratio := thermal.set_viscosity(temperature)) != self.viscosity_ratio:
            self._set_viscosity(ratio)
        return thermal.split(temperature)

    def _set_gap(
        self, journal: JournalMotion, history: History | None
    ) -> tuple[float, ExtraGap | None, ContactFields | None, LimiterFields | None]:
        """Gaps of a motion into the film solver.

        Returns the smallest, scaled, with the record's fields of these names.
        """
        s, p, at = self.solver, self.parts, self.grid.directions
        smallest = rigid_gaps(journal.pose, journal.rate, s.squeeze, at, p.half_length, p.grid.closed, s.H, s.HF, s.H_t)
        extra = None
        if self.effects.gap_terms or self.flexible:
            smallest, extra = self._add_gap_terms(history)
        if p.liner is not None:
            return smallest, extra, None, None
        pressing = None if p.contacts is None else p.contacts.press(s.H, smallest)
        limiter, f, limited = self.effects.limiter, p.limiter, None
        if limiter is not None and f is not None and smallest < limiter.limits_below:
            limited = f
            f.gap[:], f.link[:], f.rate[:] = s.H, s.HF, s.H_t
            limiter.limit(s.H, s.HF, s.H_t, f.slope, f.bend, f.face_slope)
        return smallest, extra, pressing, limited

    def _add_gap_terms(self, history: History | None) -> tuple[float, ExtraGap]:
        """Add the gap terms and a bore's displacement; returns the smallest gap and what was added."""
        s = self.solver
        surfaces = [term.field(history) for term in self.effects.gap_terms]
        fields = surfaces if self._displacement is None else [*surfaces, self._displacement]
        height = fields[0] if len(fields) == 1 else np.sum(fields, axis=0)
        rate = self._rate if s.squeeze else s.nothing
        if self.effects.lobes is not None:
            s.HF += self.effects.lobes.between
        smallest, slopes = add_gap(height, rate, self.grid, s.H, s.HF, s.H_t)
        if self.effects.lobes is not None:
            slopes += self.effects.lobes.slopes
        return smallest, ExtraGap(height, slopes[0], slopes[1], surfaces)

    def _solve(self, journal: JournalMotion, history: History | None, step: float) -> tuple[Status, int]:
        """Solve for the gaps in the solver's buffers, with the known pressures."""
        p, law = self.parts, self.effects.pressure_law
        P, past = self.solver.pressure, History() if history is None else history
        P[:, 0], P[:, -1], cavity, *edges = self._prescribed.tolist()
        if edges:
            P[p.grid.edges.ravel()] = np.array(edges)[:, None]
        if p.supply is not None:
            fed = p.supply.pressures()
            p.supply.prescribe((fed if law is None else law.transform(fed)) / self.scales.pressure, P)
        if p.liner is not None:
            p.liner.delta_old = past.deflection
        if self.solver.reservoirs is not None:
            self.solver.reservoirs.before = past.pockets
        along = 0.5 * journal.axial_speed / self.grid.reference_length
        return self.solver.advance(0.5 * journal.omega, along, cavity, past.void, past.outflow, step)

    def evaluate_steady(
        self, motion: np.ndarray, history: History | None = None, step: float = 0.0, spin: float = 0.0
    ) -> Evaluation:
        """Evaluate the film at a motion (10,) that lasts.

        A flexible bore settles under it. The rest as for `evaluate`.
        """
        return self.evaluate(motion, history, step, spin)
