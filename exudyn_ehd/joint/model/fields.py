"""The fields of a film on its grid, copied out of an evaluation."""

from __future__ import annotations

import numpy as np

from exudyn_ehd.joint.model.rigid import Evaluation
from exudyn_ehd.joint.solved_film import History, SolvedFilm
from exudyn_ehd.pictures.mixins import FilmPictures
from exudyn_ehd.pictures.records import FilmRecord, JointFilm, shown


class FilmFields(JointFilm, FilmPictures):
    """The film of a joint at one instant: joint frame, SI units, arrays ``[theta, z]``.

    Attributes
    ----------
    time : float
        Time of the film, s.
    theta, z : (n,), (m,) arrays
        Angles from x about z, rad, and places along the axis from the mid-plane, m, of the grid.
    pressure, gap : (n, m) arrays
        Film pressure above ambient, Pa, and film thickness, m.
    unbroken : (n, m) bool array
        True where the film is not cavitated.
    fill : (n, m) array or None
        Film fraction: oil over gap; None for closures that do not conserve mass.
    temperature : (n, m) array, float or None
        Temperature of the film, K; one number with `LumpedThermal`, None for an isothermal bearing.
    walls : Walls or None
        Temperatures of bush and journal, and the radial clearance that they leave; None unless a wall conducts or the
        film has two temperatures across it.
    bore_displacement : (n, m) array or None
        Deflection of a flexible bore or a liner, m, positive outward; None for a rigid one.
    contact_pressure : (n, m) array or None
        Pressure of asperities or wall, Pa; None without contact.
    wear_depth : (n, m) array or None
        Depth worn off the bore up to this instant, m; None without wear.
    force, moment : (3,) arrays
        Force [N] and moment [N m] on the journal, the moment about the frame's origin.
    motion : (10,) array
        Motion of the journal, as in `JointHistory`; with a flexible bore its coordinates and rates follow.
    bearing : JournalBearing
    bush_displacement : (k, 3) array or None
        Displacements of all nodes of a bush's mesh against the housing, joint frame, m; None without a bush.

    Examples
    --------
    After the example of `SolveDynamic`:

    >>> film = joint.film()
    >>> film.pressure.shape, film.time
    ((112, 11), 0.002)
    >>> round(float(1e-6 * film.pressure.max()), 2)  # MPa
    0.77
    """

    def __repr__(self) -> str:
        gap, peak = shown("length", float(self.gap.min())), shown("pressure", float(self.pressure.max()))
        return f"<FilmFields at {shown('time', self.time)}: minimum film thickness {gap}, peak pressure {peak}>"


def film_record(film: SolvedFilm) -> FilmRecord:
    """Return the common data of `FilmFields` and of a steady result for a solved film, copied."""
    film.require_current()
    solver, grid, temperature, bearing = film.solver, film.grid, film.temperature, film.parts.bearing
    liner, bore = film.parts.liner, film.bore
    yields = bore.displacement if bore is not None else None if liner is None else liner.deflection
    return FilmRecord(
        theta=grid.x.copy(),
        z=grid.z * grid.reference_length,
        pressure=film.oil.P * film.scales.pressure,
        gap=solver.H * bearing.radial_clearance,
        unbroken=solver.work.active.copy(),
        fill=solver.fill.copy() if solver.closure.conserves_mass else None,
        temperature=temperature.copy() if isinstance(temperature, np.ndarray) else temperature,
        walls=film.walls,
        bore_displacement=None if yields is None else yields * bearing.radial_clearance,
        force=film.loads.wrench[:3].copy(),
        moment=film.loads.wrench[3:].copy(),
        bearing=bearing,
        motion=film.journal.motion.copy(),
    )


def remembered(film: FilmRecord) -> History:
    """History with the temperatures of a film and its walls."""
    T = film.temperature
    return History(temperature=T if film.walls is None or T is None else film.walls.behind(T))


def film_fields(evaluation: Evaluation, time: float, bush_displacement: np.ndarray | None = None) -> FilmFields:
    """The fields of an evaluation that found a film."""
    film, wear = evaluation.film, evaluation.model.effects.wear
    assert film is not None
    contacts = film.parts.contacts
    return FilmFields(
        **vars(film_record(film)),
        time=time,
        contact_pressure=None if contacts is None else np.sum(contacts.P, axis=0),
        wear_depth=None if wear is None else wear.grown(film) * film.parts.bearing.radial_clearance,
        bush_displacement=bush_displacement,
    )
