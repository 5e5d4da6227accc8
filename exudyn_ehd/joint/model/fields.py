"""The fields of a film on its grid, copied out of an evaluation."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TypedDict

import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.joint.model.rigid import Evaluation, worn_depth
from exudyn_ehd.joint.solved_film import SolvedFilm
from exudyn_ehd.pictures.mixins import FilmPictures


@dataclass(frozen=True, eq=False, kw_only=True)
class FilmFields(FilmPictures):
    """The film of a joint at one instant: joint frame, SI units, arrays ``[theta, z]``.

    Attributes
    ----------
    time : float
        s.
    theta, z : (n,), (m,) arrays
        Grid, rad and m.
    pressure, gap : (n, m) arrays
        Pa (gauge), m.
    unbroken : (n, m) bool array
        Where the film is not cavitated.
    fill : (n, m) array or None
        Film fraction; None for closures that do not conserve mass.
    temperature : (n, m) array, float or None
        K; None for an isothermal bearing.
    bore_displacement : (n, m) array or None
        Of a flexible bore, m, positive outward; None for a rigid one.
    contact_pressure : (n, m) array or None
        Of asperities or wall, Pa; None without contact.
    wear_depth : (n, m) array or None
        Worn off the bore up to this instant, m; None without wear.
    force, moment : (3,) arrays
        On the journal, moment about the joint origin.
    motion : (10,) array
        Of the journal, as in `exudyn_ehd.joint.solved_film`; with a flexible bore followed by its coordinates and
        rates.
    bearing : JournalBearing
    bush_displacement : (k, 3) array or None
        Of all nodes of a bush's mesh against the housing, joint frame, m; None without a bush.
    """

    time: float
    theta: np.ndarray
    z: np.ndarray
    pressure: np.ndarray
    gap: np.ndarray
    unbroken: np.ndarray
    fill: np.ndarray | None
    temperature: float | np.ndarray | None
    bore_displacement: np.ndarray | None
    contact_pressure: np.ndarray | None
    wear_depth: np.ndarray | None
    force: np.ndarray
    moment: np.ndarray
    motion: np.ndarray
    bearing: JournalBearing = field(repr=False)
    bush_displacement: np.ndarray | None = None


class GridFields(TypedDict):
    """What both `FilmFields` and a steady result hold of a film."""

    theta: np.ndarray
    z: np.ndarray
    pressure: np.ndarray
    gap: np.ndarray
    unbroken: np.ndarray
    fill: np.ndarray | None
    temperature: float | np.ndarray | None


def grid_fields(film: SolvedFilm) -> GridFields:
    """Copies of theta, z, pressure, gap, unbroken, fill and temperature of a solved film, by name."""
    film.require_current()
    solver, grid, temperature = film.solver, film.grid, film.temperature
    return {
        "theta": grid.x.copy(),
        "z": grid.z * grid.reference_length,
        "pressure": film.oil.P * film.scales.pressure,
        "gap": solver.H * film.parts.bearing.radial_clearance,
        "unbroken": solver.work.active.copy(),
        "fill": solver.fill.copy() if solver.closure.conserves_mass else None,
        "temperature": temperature.copy() if isinstance(temperature, np.ndarray) else temperature,
    }


def film_fields(evaluation: Evaluation, time: float, bush_displacement: np.ndarray | None = None) -> FilmFields:
    """The fields of an evaluation that found a film."""
    film, wear = evaluation.film, evaluation.model.effects.wear
    assert film is not None
    c, contacts, bore = film.parts.bearing.radial_clearance, film.parts.contacts, film.bore
    return FilmFields(
        time=time,
        **grid_fields(film),
        bore_displacement=None if bore is None else bore.displacement * c,
        contact_pressure=None if contacts is None else np.sum(contacts.P, axis=0),
        wear_depth=None if wear is None else worn_depth(wear, film) * c,
        force=film.loads.wrench[:3].copy(),
        moment=film.loads.wrench[3:].copy(),
        motion=film.journal.motion.copy(),
        bearing=film.parts.bearing,
        bush_displacement=bush_displacement,
    )
