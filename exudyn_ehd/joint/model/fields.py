"""The fields of a film on its grid, taken out of a model after an evaluation."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.joint.model.rigid import BearingModel
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
        Of the journal, as in `exudyn_ehd.joint.model.rigid`; with a flexible bore followed by its coordinates and rates.
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


def grid_fields(model: BearingModel) -> dict[str, Any]:
    """Copies of theta, z, pressure, gap, unbroken, fill and temperature of the last evaluation, by name."""
    solver, grid = model.solver, model.grid
    temperature = None if model.effects.thermal is None else model.effects.thermal.temperature
    return {
        "theta": grid.x.copy(),
        "z": grid.z * grid.reference_length,
        "pressure": model.P * model.pressure_scale,
        "gap": solver.H * model.bearing.radial_clearance,
        "unbroken": solver.work.active.copy(),
        "fill": solver.fill.copy() if solver.closure.conserves_mass else None,
        "temperature": temperature.copy() if isinstance(temperature, np.ndarray) else temperature,
    }


def film_fields(model: BearingModel, time: float, bush_displacement: np.ndarray | None = None) -> FilmFields:
    """The film of the model's last evaluation."""
    wear = model.effects.wear
    return FilmFields(
        time=time,
        **grid_fields(model),
        bore_displacement=model.bore_fields().get("bore_displacement"),
        contact_pressure=None if model.contact_fields is None else np.sum(model.contact_fields.P, axis=0),
        wear_depth=None if wear is None else model.worn(wear) * model.bearing.radial_clearance,
        force=model.wrench[:3].copy(),
        moment=model.wrench[3:].copy(),
        motion=model.motion.copy(),
        bearing=model.bearing,
        bush_displacement=bush_displacement,
    )
