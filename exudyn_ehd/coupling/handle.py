"""`LubricatedJoint`, the handle of a joint that `CreateLubricatedJoint` returns to the user."""

from __future__ import annotations

import dataclasses
import pathlib
from collections.abc import Sequence

import exudyn as exu
import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.coupling.contract import Index
from exudyn_ehd.coupling.element.outputs import FilmDisplay
from exudyn_ehd.coupling.element.rigid import FilmElement
from exudyn_ehd.coupling.record.record import FilmRecorder
from exudyn_ehd.coupling.record.revolutions import Revolutions
from exudyn_ehd.coupling.run.joint_state import Joint
from exudyn_ehd.coupling.run.restart import place
from exudyn_ehd.film.models import FiniteLength
from exudyn_ehd.film.surfaces.contact import ElasticLiner
from exudyn_ehd.joint.audit.audit import audit_record
from exudyn_ehd.joint.audit.findings import Audit
from exudyn_ehd.joint.model.build import ImpedanceModel, build_model
from exudyn_ehd.joint.model.results import FilmFields
from exudyn_ehd.joint.static.equilibrium import EquilibriumResult
from exudyn_ehd.pictures.mixins import FilmPictures, HistoryPictures
from exudyn_ehd.pictures.records import shown
from exudyn_ehd.status import FilmError, InputError, Status, require_type


class LubricatedJoint(Joint, FilmPictures, HistoryPictures):
    """A lubricated joint in a model, as `CreateLubricatedJoint` returns it: history, films, pictures, sensors, audit.

    The ``plot_...`` methods draw the film at the last accepted state, or the history over all accepted steps.

    Attributes
    ----------
    name : str
        Its name.
    mbs : exudyn.MainSystem
        The system it belongs to.
    bearing : object
        The `JournalBearing` as given.
    objectNumber : exudyn.ObjectIndex
        The film element.
    constraintNumber : exudyn.ObjectIndex or None
        The constraint of a joint with `Held`; None without.
    element : FilmElement
        The film between the two frames.
    display : FilmDisplay
        The film in Exudyn's renderer.
    bush : FlexibleBush or None
        Bush of a bearing with an `ANCFBush`, as an object of the model; None without one.

    Examples
    --------
    After the example of `CreateLubricatedJoint`:

    >>> joint
    <LubricatedJoint 'main': object 2, journal 50 mm x 25 mm, clearance 25 µm>
    >>> sensor = joint.AddSensor("minimum_gap")
    >>> joint.record_films(period=1e-3)
    """

    def __init__(
        self,
        mbs: exu.MainSystem,
        element: FilmElement,
        numbers: tuple[Index, Index | None],
        display: FilmDisplay,
    ) -> None:
        super().__init__(mbs, element, numbers)
        self.display = display
        bush = getattr(element, "bush", None)
        # unlike the element's copy, this one keeps the system alive
        self.bush = None if bush is None else dataclasses.replace(bush, mbs=mbs)

    def __repr__(self) -> str:
        b = self.bearing
        size = (
            ""
            if not isinstance(b, JournalBearing)
            else (
                f", journal {shown('length', 2.0 * b.journal_radius)} x {shown('length', b.length)}, "
                f"clearance {shown('length', b.radial_clearance)}"
            )
        )
        return f"<LubricatedJoint '{self.name}': object {int(self.objectNumber)}{size}>"

    def place_in_equilibrium(
        self, *, load: Sequence[float] | np.ndarray, speed: float | None = None
    ) -> EquilibriumResult:
        """Let the next run start where the film carries a steady load, with the film in its steady state.

        For a body in one film; call it after Assemble. The journal's node is moved across the axis to the equilibrium
        and its velocity across the axis is set to that of the housing; tilt and spin stay. Temperature, oil content and
        modal bush start in their steady state. For rotors in several films use `SolveEquilibrium`, for loads that
        depend on the place `SolveStatic`.

        Parameters
        ----------
        load : (2,) [N]
            Force on the journal along x and y of the joint frame that the film has to carry: all forces on its body,
            with inertia forces.
        speed : float or None, default None
            Spin of the journal against the housing about z, rad/s, for which the equilibrium is computed; it does not
            change the bodies' velocities. None: that of the initial state.

        Returns
        -------
        EquilibriumResult

        Raises
        ------
        InputError
            For a joint without spin, with an `ANCFBush`, or whose journal is not a rigid body; for a system that is not
            assembled.
        FilmError
            If no equilibrium was found.
        """
        self.element.presence.require(self.mbs)
        return place(self.mbs, self.element, self.name, load, speed)

    def audit(self, *, liner: ElasticLiner | None = None, measure_time: bool = False) -> Audit:
        """Find the effects that mattered in the accepted steps, omitted ones that would have, and those without effect.

        The films at the worst recorded states (minimum film thickness, highest pressure, loss, speed, tilt, squeeze)
        are evaluated again in a separate model: the joint does not change. Recorded quantities are taken from the
        record. Quantities that need a field (cavitated share, grid, heat of a field) are computed with a flexible bore
        in equilibrium with the film.

        Parameters
        ----------
        liner : ElasticLiner or None, default None
            Liner with which elasticity is assessed, for bearings with a rigid bore; None: a steel ring.
        measure_time : bool, default False
            True measures the share of computing time of each effect that is on.

        Returns
        -------
        Audit
            Print it for a table; ``neglected`` and ``unneeded`` hold what to change.

        Raises
        ------
        InputError
            If nothing was recorded yet, or if the record is thinned (`Every`, `Period`).
        """
        require_type("LubricatedJoint.audit: bearing", self.bearing, JournalBearing, hint="no other one is audited.")

        return audit_record(self.bearing, self._audited(), liner=liner, measure_time=measure_time)

    def film(self) -> FilmFields:
        """The film at the last accepted state: pressure, gap, fill and temperature on the grid.

        It can be called at any time after Assemble, also within a run. An `ImpedanceMap` holds no pressure: there the
        film on the map's grid is solved once.

        Raises
        ------
        InputError
            Before Assemble, and where the system's state was changed since its run.
        FilmError
            If there is no film at that state.
        """
        self._require_end("film")
        time, trial, configuration = self.element.steps.look_at_accepted(self.mbs)
        if trial.evaluation is None or trial.status is not Status.CONVERGED:
            raise FilmError(
                f"LubricatedJoint.film: no film of joint '{self.name}' at t = {time:.9g} s: {trial.status.advice}"
            )
        model = self.element.model
        if isinstance(model, ImpedanceModel):
            film = model.bearing.film
            grid = FiniteLength(n_theta=film.n_theta, n_z=film.n_z, stretch=film.stretch)
            model = build_model(dataclasses.replace(model.bearing, film=grid))
            return model.evaluate(trial.motion).fields(time)
        return self.element.fields(time, trial, configuration)

    def record_films(self, *, period: float = 0.0, frames: int = 400) -> None:
        """Keep the film at regular instants of the runs that follow, for `films`, `animate` and `export_vtk`.

        Call it before the run; without it no films are kept. A film takes some 5 arrays of the grid's size, 0.05 MB on
        the default grid, and with a bush the displacements of its mesh.

        Parameters
        ----------
        period : float, default 0.0
            Time between two films, s; 0 keeps every accepted step.
        frames : int, default 400
            Largest number of films, at least 2. When it is reached, every second film is dropped and the period
            doubled: memory is bounded, and the films span the whole run.

        Raises
        ------
        InputError
            With an `ImpedanceMap`, which holds no pressure.
        """
        if isinstance(self.element.model, ImpedanceModel):
            raise InputError(
                f"LubricatedJoint.record_films: joint '{self.name}' has film=ImpedanceMap(...), which holds no "
                "pressure; use film=FiniteLength(...)."
            )
        self.element.steps.recorder = FilmRecorder(period, frames)

    @property
    def films(self) -> tuple[FilmFields, ...]:
        """Films kept since `record_films`, the last one at the last accepted state; empty without it.

        If the system's state was changed after its run, the film at the last accepted state is missing.
        """
        recorder = self.element.steps.recorder
        if recorder is None or not self.mbs.systemIsConsistent:
            return ()
        try:
            now = self.film()
        except InputError:
            return tuple(recorder.films)
        return (*(film for film in recorder.films if film.time < now.time), now)

    def animate(self, path: str | pathlib.Path, *, frames_per_second: int = 15, largest_count: int = 150) -> None:
        """Write an animation of orbit and pressure over the films kept by `record_films`.

        Parameters
        ----------
        path : path
            Ending in ``.gif``, or in ``.mp4`` where the program ffmpeg is installed.
        frames_per_second : int, default 15
        largest_count : int, default 150
            Largest number of frames; of more films an even selection is shown. Drawing a frame takes about 0.2 s.

        Raises
        ------
        InputError
            Without films, for other endings, or without ffmpeg.
        """
        from exudyn_ehd.pictures.files import animate

        if not (films := self.films):
            raise InputError(
                f"LubricatedJoint.animate: no films of joint '{self.name}' were kept; call joint.record_films() before "
                "the run."
            )
        animate(films, self.history, path, frames_per_second=frames_per_second, largest_count=largest_count)

    def export_vtk(self, path: str | pathlib.Path, *, magnification: float = 1.0) -> list[pathlib.Path]:
        """Write the film on the bore, and the bush with its stress, for ParaView; needs the package meshio.

        Films kept by `record_films` make a time series; without them the film at the last accepted state is written.
        See `exudyn_ehd.pictures.files.export_films`.

        Parameters
        ----------
        path : path
            Ending in ``.pvd``: the file to open; the data lie in a folder of the same name next to it.
        magnification : float, default 1.0
            Factor on the displacements of bore and bush.

        Returns
        -------
        list of Path
            Written files, first the one to open.
        """
        from exudyn_ehd.pictures.files import export_films

        return export_films(self.films or (self.film(),), path, magnification=magnification)

    def save(self, path: str | pathlib.Path) -> None:
        """Write the history to a NumPy file (npz), whole or not at all; `load_history` reads it."""
        self.history.save(path)

    def to_csv(self, path: str | pathlib.Path) -> None:
        """Write the history as text, with units in the first line."""
        self.history.to_csv(path)

    def revolutions(self, *, period: float | None = None) -> Revolutions:
        """Table of the whole revolutions up to now; see `JointHistory.revolutions`."""
        return self.history.revolutions(period=period)

    def _film(self) -> FilmFields:
        return self.film()
