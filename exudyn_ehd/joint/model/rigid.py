"""One lubricated bearing between two rigid surfaces as a pure function of its relative motion.

Frame and motion are those of `exudyn_ehd.joint.solved_film`. The wrench acts on the journal, its moment is about O. The
opposite wrench, about the same point, acts on the housing.

Effects with a memory keep it in a `History`, which belongs to an accepted step: ``evaluate(motion, history, step)``
uses the history at the start of the step and the step size, and ``evaluation.history()`` is the history at its end.

At the exact centre the gap is the same all around, and the whole film is at its cavity pressure. A small motion of the
aligned journal has one source in Reynolds' equation, the velocity V relative to the mean motion of the oil::

    div(h^3 / (12 mu) grad p) = -V . n,        V = dx/dt - (omega / 2) e_z x x,

and the film ruptures where V opens the gap, however small V is. The pressure is homogeneous of degree one in V. So in a
bearing that is the same in all directions the force is ``F = -c V`` with one coefficient (with a liner, one matrix that
commutes with rotations). Stiffness K and damping C are those of films slightly off the centre, in any direction. The
tangent of the unbroken film at the centre itself would have twice the coefficient.

In a bearing that is not the same in all directions, as with a groove at the cavity pressure, F is not linear in V, and
no stiffness or damping exists. The force is not linear in tilts and displacements together either: derivatives to the
tilt at the centre are means over the directions of V.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.film.grid import FilmGrid
from exudyn_ehd.film.heat.options import Walls
from exudyn_ehd.film.loads import film_scales
from exudyn_ehd.film.reynolds.gap import rigid_gaps
from exudyn_ehd.film.solvers.answers import OilFields
from exudyn_ehd.joint.model.effects import Effects, film_parts, grid_of
from exudyn_ehd.joint.model.loads import film_loads, recess_of
from exudyn_ehd.joint.model.results import FilmFields, eccentricities, film_fields, quantities
from exudyn_ehd.joint.solved_film import (
    BESIDE,
    MOTION_SIZE,
    BoreState,
    ContactFields,
    ExtraGap,
    FacesHeat,
    GapState,
    History,
    JournalMotion,
    Loads,
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
        Number of linear solves.
    minimum_gap : float
        Minimum film thickness, m; nan if the motion is not finite.
    film : SolvedFilm or None
        None if ``status`` is not CONVERGED; an exception are films beyond the end of a pressure law (NO_PRESSURE).
        Results that need it raise RuntimeError if the model has evaluated another state since.
    """

    status: Status
    motion: np.ndarray
    wrench: np.ndarray
    iterations: int
    minimum_gap: float
    film: SolvedFilm | None = field(repr=False)
    model: BearingModel = field(repr=False)

    @property
    def place(self) -> str:
        """Place of the journal, for messages."""
        x, y, bx, by = self.motion[:4]
        return f"x = {x:.4g} m, y = {y:.4g} m, tilt = ({bx:.3g}, {by:.3g})"

    def tangent(self, slow_motion: bool = False) -> np.ndarray:
        """d wrench / d motion (6, 10), exact for the current active set, from the stored factor; nan without a film.

        ``slow_motion``: the deflection of a liner follows the rates, for the damping of a steady state; no effect
        without a liner. At the exact centre it is the mean over films slightly off the centre.
        """
        if (film := self._current()) is None:
            return np.full((6, MOTION_SIZE), np.nan)
        if self.is_central:
            return self.tangents_beside(slow_motion).mean(axis=0)
        return wrench_tangent(film, slow_motion)

    def steady_tangent(self, exact: bool = False) -> np.ndarray:
        """d wrench / d motion (6, 10) after `BearingModel.evaluate_steady`, with a flexible bore in equilibrium.

        Without ``exact`` it may be an approximation that suffices for a search. ``exact``: tangent for slow motions, in
        which a liner is in equilibrium too.
        """
        return self.tangent(slow_motion=exact)

    @property
    def is_central(self) -> bool:
        """Return whether the journal is at the exact centre of a film that may rupture, with no pressure anywhere."""
        return self.film is not None and not self.model.needs_spin and self.film.is_central

    def beside(self, direction: int = 0) -> Evaluation:
        """Evaluate the film slightly off the centre in one of four directions; without spin also moving in it."""
        film, motion = self.film, np.append(np.zeros(8), self.motion[8:MOTION_SIZE])
        assert film is not None
        # not along a column of the grid: Gümbel's linear pressure would be zero there, its active set undecided
        angle = 1.0 + 0.5 * math.pi * direction
        motion[:2] = BESIDE * film.parts.bearing.radial_clearance * np.array([math.cos(angle), math.sin(angle)])
        motion[4:6] = motion[:2] if motion[8] == 0.0 else 0.0
        return self.model.evaluate_steady(motion, film.history, film.step)

    def tangents_beside(self, exact: bool) -> np.ndarray:
        """Steady tangents (4, 6, 10) slightly off the centre in four directions, ``exact`` or not.

        The evaluation stays valid: its film is solved again, so that the buffers contain it.
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
        """Return the fields of this state, which must have a film."""
        return film_fields(self.solved, self.model.effects.wear, time, bush_displacement)

    def history(self) -> History | None:
        """Return the bearing's history at the end of this step, for an accepted step; None without a memory.

        Raises
        ------
        RuntimeError
            If there is no film.
        """
        if (film := self._current()) is None:
            raise RuntimeError(f"Evaluation.history: {self.status.name}, without a film there is no history to keep.")
        return self.model.next_history(film)

    def heat_with(self, heat_of_faces: Callable[[], FacesHeat]) -> SolvedFilm | None:
        """Return the film with the heat of the thrust faces in its heat balance.

        The function ``heat_of_faces`` is called only if the bearing has a thermal effect.
        """
        if self.film is not None and self.model.effects.thermal is not None:
            self.film = self.film._replace(beside=heat_of_faces())
        return self.film

    @property
    def solved(self) -> SolvedFilm:
        """Film of this state, which must have one; RuntimeError if the model has evaluated another state since."""
        film = self._current()
        assert film is not None
        return film

    def _current(self) -> SolvedFilm | None:
        if self.film is not None:
            self.film.require_current()
        return self.film


class BearingModel:
    """Film between a rigid journal and a rigid bore, with the effects of its options.

    Parameters
    ----------
    bearing : JournalBearing
    start_angle : float
        theta of the first grid column, rad; the line of ambient pressure if the bearing's inlet is `MaximumGap`.
    effects : Effects
    grid : FilmGrid, optional
        Grid in place of that of the bearing.

    Attributes
    ----------
    motion_size : int
        Number of entries of a motion of rigid surfaces.
    """

    flexible, motion_size = False, MOTION_SIZE

    def __init__(
        self,
        bearing: JournalBearing,
        *,
        start_angle: float = 0.0,
        effects: Effects | None = None,
        grid: FilmGrid | None = None,
    ) -> None:
        self.bearing, self.effects = bearing, Effects() if effects is None else effects
        self.parts = p = film_parts(bearing, self.effects, grid_of(bearing, start_angle) if grid is None else grid)
        self.grid, self.solver = p.grid, p.solver
        self.needs_spin = p.supply is not None and p.supply.rotating
        self.remembers_mass = bearing.cavitation.conserves_mass and bearing.squeeze
        self.remembers_deflection = self.effects.liner is not None and bearing.squeeze
        self.remembers = self.remembers_mass or self.remembers_deflection or p.solver.pockets is not None
        self.remembers = self.remembers or self.effects.thermal is not None or self.effects.wear is not None
        self._known = np.array([*bearing.end_pressures, bearing.cavitation.cavity_pressure, *bearing.edge_pressures])
        # displacement of a flexible bore and its rate, scaled
        self._displacement: np.ndarray | None = None
        self._rate = p.solver.nothing
        self._set_viscosity(1.0)

    def _set_viscosity(self, ratio: float) -> None:
        """Set the scales for ``ratio`` times the reference viscosity."""
        b, p, law = self.bearing, self.parts, self.effects.pressure_law
        R, c, self.viscosity_ratio = b.journal_radius, b.radial_clearance, ratio
        self.scales = film_scales(ratio * b.lubricant.viscosity, R, c, self._known)
        pressure = self.scales.pressure
        # prescribed pressures for the solver, transformed by a pressure law
        self._prescribed = (self._known if law is None else law.transform(self._known)) / pressure
        if p.liner is not None and self.effects.liner is not None:
            p.liner.beta = self.effects.liner.compliance * pressure / c
        p.solver.pressure_scale = pressure
        self._prescribe()

    def _prescribe(self) -> None:
        """Write the known pressures of ends, edges of arcs and supply areas into the solver's field."""
        p, P, law = self.parts, self.solver.pressure, self.effects.pressure_law
        P[:, 0], P[:, -1], _, *edges = self._prescribed.tolist()
        if edges:
            P[p.grid.edges.ravel()] = np.array(edges)[:, None]
        if p.supply is not None:
            fed = p.supply.pressures()
            p.supply.prescribe((fed if law is None else law.transform(fed)) / self.scales.pressure, P)

    def forget(self) -> None:
        """Drop the warm start. It never changes a result, only the computing time."""
        self.solver.forget()

    def initial_history(self, motion: np.ndarray) -> History | None:
        """History of a flooded bearing (every gap full of oil) at this motion; None without a memory.

        An elastic liner is deflected as under the steady film; with lines inside the cells, where a vertex is full from
        another pressure on, as under the full film, which changes it twenty times less at every repetition.
        """
        if not self.remembers:
            return None
        self.parts.evaluations += 1
        self._set_gap(self._journal(motion, 0.0), None)
        s, remembers, liner, effects = self.solver, self.remembers_mass, self.parts.liner, self.effects
        found = (self.remembers_deflection or s.pockets is not None) and self.evaluate(motion).film is not None
        void, mass, outflow = s.flooded() if remembers else (None, None, None)
        new = History() if effects.thermal is None else effects.thermal.first_memory()
        wear = None if effects.wear is None else effects.wear.field(None).copy()
        still, pockets = s.nothing if remembers and effects.gap_terms else None, s.pockets if found else None
        new = replace(new, void=void, mass=mass, outflow=outflow, wear=wear, pockets=pockets, growth=still)
        if found and self.remembers_deflection and liner is not None:
            new = replace(new, deflection=liner.deflection)
            for _ in range(2 if s.oil_line else 0):
                if self.evaluate(motion, new).film is not None:
                    new = replace(new, deflection=liner.deflection)
        return new

    def next_history(self, film: SolvedFilm) -> History | None:
        """History at the end of a solved film's step."""
        if not self.remembers:
            return None
        p, s, effects = self.parts, self.solver, self.effects
        old = History() if film.history is None else film.history
        void, mass, outflow = s.memory(old.mass, film.step) if self.remembers_mass else (None, None, None)
        new = replace(
            History() if effects.thermal is None else effects.thermal.memory(film),
            void=void,
            mass=mass,
            outflow=outflow,
            wear=None if effects.wear is None else effects.wear.grown(film),
            deflection=p.liner.deflection if self.remembers_deflection and p.liner is not None else None,
            pockets=s.pockets,
        )
        if effects.gap_terms and void is not None:
            changes = [term.field(new) - term.field(old) for term in effects.gap_terms]
            still = film.history is None or film.step <= 0.0
            new = replace(new, growth=s.nothing if still else np.sum(changes, axis=0) / film.step)
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
            History at the last accepted step; None: the film is a steady one.
        step : float
            Time since the last accepted step, s; 0: the force at that instant.
        spin : float
            Angle of the journal against the housing about the bearing's axis, rad; only read if ``needs_spin``
            (supply areas in the journal).

        Returns
        -------
        Evaluation
            If ``status`` is not CONVERGED, the wrench is nan. With NO_PRESSURE it may be finite: it is computed with a
            continuation of the pressure law beyond its end. It is no solution, but lets Newton's method return.
        """
        p, c = self.parts, self.bearing.radial_clearance
        p.evaluations += 1
        temperature, walls = self._set_temperature(history, step)
        if p.supply is not None and p.supply.turn(spin):
            self.solver.refresh_fixed()
            self._prescribe()
        journal = self._journal(motion, spin)
        # a sum is finite only if all its terms are
        if not math.isfinite(sum(journal.motion.tolist())):
            return self._result(Status.NOT_FINITE, journal, 0, math.nan)
        gap = self._set_gap(journal, history)
        smallest = gap.smallest
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
            if p.contacts is not None and smallest < p.contacts.presses_below:
                gap = gap._replace(pressing=p.contacts)
        loads = self._loads(journal, oil, gap, temperature)
        state = p, self.grid, self.solver, self.scales, journal, history, step, temperature
        bore = self._bore_state(journal, oil, gap.pressing, float(loads.wrench[5]))
        film = SolvedFilm(*state, *gap[1:], oil, loads, c * smallest, bore, p.evaluations, walls)
        return self._result(status, journal, iterations, c * smallest, film)

    def _result(
        self, status: Status, journal: JournalMotion, iterations: int, gap: float, film: SolvedFilm | None = None
    ) -> Evaluation:
        wrench = np.full(6, np.nan) if film is None else film.loads.wrench
        return Evaluation(status, journal.motion, wrench, iterations, gap, film, self)

    def _loads(
        self, journal: JournalMotion, oil: OilFields, gap: GapState, temperature: float | np.ndarray | None
    ) -> Loads:
        """Loads of the film in the solver's buffers."""
        recess = recess_of(self.parts, self.scales, journal, self.effects.thermal, temperature)
        return film_loads(self.parts, self.scales, journal, oil, gap, recess)

    def _bore_state(
        self, journal: JournalMotion, oil: OilFields, pressing: ContactFields | None, moment: float
    ) -> BoreState | None:
        """State of a flexible bore under this film, whose moment on the journal is ``moment``, Nm; None if rigid."""
        return None

    def _journal(self, motion: np.ndarray, spin: float) -> JournalMotion:
        motion = np.array(motion, dtype=float)
        scaled = motion[:8] * self.parts.motion_scale[:8]
        return JournalMotion(motion, scaled[:4], scaled[4:], float(motion[8]), float(motion[9]))

    def _set_temperature(self, history: History | None, step: float) -> tuple[float | np.ndarray | None, Walls | None]:
        """Set the viscosity to that of the extrapolated temperature; return this temperature and that of walls."""
        thermal = self.effects.thermal
        if thermal is None:
            return None, None
        temperature = thermal.extrapolated(history, step)
        if (ratio := thermal.set_viscosity(temperature)) != self.viscosity_ratio:
            self._set_viscosity(ratio)
        return thermal.split(temperature)

    def _set_gap(self, journal: JournalMotion, history: History | None) -> GapState:
        """Write the gaps of a motion into the solver's buffers."""
        s, p = self.solver, self.parts
        smallest, extra = self._set_surfaces(journal, history)
        if p.liner is not None:
            return GapState(smallest, extra, None, None)
        pressing = None if p.contacts is None else p.contacts.press(s.H, smallest)
        limiter, f, limited = self.effects.limiter, p.limiter, None
        if limiter is not None and f is not None and smallest < limiter.limits_below:
            limited = f
            f.gap[:], f.link[:], f.rate[:] = s.H, s.HF, s.H_t
            limiter.limit(s.H, s.HF, s.H_t, f.slope, f.bend, f.face_slope)
        return GapState(smallest, extra, pressing, limited)

    def _set_surfaces(self, journal: JournalMotion, history: History | None) -> tuple[float, ExtraGap | None]:
        """Write the gaps of the surfaces; return the smallest one, scaled, and ``extra`` of `SolvedFilm`."""
        s, p, at = self.solver, self.parts, self.grid.directions
        smallest = rigid_gaps(journal.pose, journal.rate, s.squeeze, at, p.half_length, p.grid.closed, s.H, s.HF, s.H_t)
        if not (self.effects.gap_terms or self.flexible):
            return smallest, None
        return self.effects.add_gap_terms(s, history, self._displacement, self._rate)

    def _solve(self, journal: JournalMotion, history: History | None, step: float) -> tuple[Status, int]:
        """Solve the film for the gaps and the prescribed pressures in the solver's buffers."""
        p, past = self.parts, History() if history is None else history
        if p.liner is not None:
            p.liner.delta_old = past.deflection
        if self.solver.reservoirs is not None:
            self.solver.reservoirs.before = past.pockets
        speeds = 0.5 * journal.omega, 0.5 * journal.axial_speed / self.grid.reference_length
        return self.solver.advance(*speeds, float(self._prescribed[2]), past.void, past.outflow, step)

    def evaluate_steady(
        self, motion: np.ndarray, history: History | None = None, step: float = 0.0, spin: float = 0.0
    ) -> Evaluation:
        """Evaluate the film at a motion (10,), with a flexible bore in equilibrium.

        The other arguments are those of `evaluate`.
        """
        return self.evaluate(motion, history, step, spin)
