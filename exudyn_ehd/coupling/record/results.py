"""What a joint has computed: its film now, and pictures of film and history."""

from __future__ import annotations

import dataclasses
import pathlib

import exudyn as exu

from exudyn_ehd.coupling.record.element import Element
from exudyn_ehd.coupling.record.films import FilmRecorder
from exudyn_ehd.coupling.record.history import JointHistory
from exudyn_ehd.coupling.record.revolutions import Revolutions
from exudyn_ehd.film.models import FiniteLength
from exudyn_ehd.joint.model.build import build_model
from exudyn_ehd.joint.model.fields import FilmFields, film_fields
from exudyn_ehd.joint.model.impedance import ImpedanceModel
from exudyn_ehd.pictures.mixins import FilmPictures, HistoryPictures
from exudyn_ehd.status import FilmError, InputError, Status


class JointResults(FilmPictures, HistoryPictures):
    """Results of a joint; mixed into `LubricatedJoint`.

    The ``plot_...`` methods draw the film at the last accepted state, or the history over all accepted steps.
    """

    name: str
    mbs: exu.MainSystem
    element: Element

    @property
    def history(self) -> JointHistory:
        """All accepted steps."""
        raise NotImplementedError

    def film(self) -> FilmFields:
        """The film at the last accepted state: pressure, gap, fill and temperature on the grid.

        Available at any time after Assemble, also within a run; read it before the system's state is changed, as
        `history`. With an `ImpedanceMap`, which holds no pressure, the film behind the map is solved.

        Raises
        ------
        InputError
            Before Assemble.
        FilmError
            If there is no film at that state.
        """
        if not self.mbs.systemIsConsistent:
            raise InputError(
                f"LubricatedJoint.film: the system of joint '{self.name}' is not assembled; call mbs.Assemble() first."
            )
        self.element.require_items(self.mbs)
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
            return film_fields(model.evaluate(trial.motion), time)
        return self.element.fields(self.mbs, time, trial, configuration)

    def record_films(self, *, period: float = 0.0, frames: int = 400) -> None:
        """Keep the film at regular instants of the runs that follow, for `films`, `animate` and `export_vtk`.

        Without this call nothing is kept. A film takes some 5 arrays of the grid's size, that is 0.05 MB on the default
        grid, and with a bush the displacements of its mesh.

        Parameters
        ----------
        period : float
            Time between two films, s; 0 keeps every accepted step.
        frames : int
            Most films that are kept; when they are full, every second one is dropped and the period doubled, so that
            memory is bounded and the films span the whole run.
        """
        if isinstance(self.element.model, ImpedanceModel):
            raise InputError(
                f"LubricatedJoint.record_films: joint '{self.name}' has film=ImpedanceMap(...), which holds no "
                "pressure; use film=FiniteLength(...)."
            )
        self.element.steps.recorder = FilmRecorder(period, frames)

    @property
    def films(self) -> tuple[FilmFields, ...]:
        """Films kept since `record_films`, the last one at the last accepted state; empty without it."""
        recorder = self.element.steps.recorder
        if recorder is None or not self.mbs.systemIsConsistent:
            return ()
        now = self.film()
        return (*(film for film in recorder.films if film.time < now.time), now)

    def animate(self, path: str | pathlib.Path, *, frames_per_second: int = 15, largest_count: int = 150) -> None:
        """Write an animation of orbit and pressure over the films kept by `record_films`.

        Parameters
        ----------
        path : path
            Ending in ``.gif``, or in ``.mp4`` where the program ffmpeg is installed.
        frames_per_second : int
        largest_count : int
            Most frames; of more films an even selection is shown. A frame takes about 0.2 s.

        Raises
        ------
        InputError
            Without films, for other endings, or without ffmpeg.
        """
        from exudyn_ehd.pictures.animation import animate

        films = self.films
        if not films:
            raise InputError(
                f"LubricatedJoint.animate: no films of joint '{self.name}' were kept; call joint.record_films() before "
                "the run."
            )
        animate(films, self.history, path, frames_per_second=frames_per_second, largest_count=largest_count)

    def export_vtk(self, path: str | pathlib.Path, *, magnification: float = 1.0) -> list[pathlib.Path]:
        """Write the film on the bore, and the bush with its stress, for ParaView; needs the package meshio.

        With films kept by `record_films` a time series, else the film at the last accepted state; see
        `exudyn_ehd.pictures.vtk.export_films`.

        Parameters
        ----------
        path : path
            Ending in ``.pvd``: the file to open; the data lie in a folder of the same name next to it.
        magnification : float
            Factor on the displacements of bore and bush.

        Returns
        -------
        list of Path
            What was written, the file to open first.
        """
        from exudyn_ehd.pictures.vtk import export_films

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

    def _title(self) -> str:
        return self.name

    def _film(self) -> FilmFields:
        return self.film()

    def _history(self) -> JointHistory:
        return self.history
