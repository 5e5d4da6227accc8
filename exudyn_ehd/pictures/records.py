"""What the pictures look at: a film on its grid, the film of a joint, and a history; whatever is one can be drawn."""

from __future__ import annotations

import pathlib
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from exudyn_ehd.bearing import JournalBearing
    from exudyn_ehd.film.heat.conduction import Walls

Target = str | pathlib.Path | None
"""Where a picture is written; None: nowhere."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Film:
    """A film at one instant; joint frame, SI units, arrays ``[theta, z]``.

    Attributes
    ----------
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
    walls : Walls or None
        Temperatures of bush and journal, and the clearance that they leave; None where none conducts and
        the film has one temperature across it.
    bore_displacement : (n, m) array or None
        Of a flexible bore or a liner, m, positive outward; None for a rigid one.
    force, moment : (3,) arrays
        On the journal, moment about the joint origin.
    bearing : JournalBearing
    motion : (10,) array
        Of the journal, as in `exudyn_ehd.joint.solved_film`; with a flexible bore followed by its coordinates and
        rates.
    """

    theta: np.ndarray
    z: np.ndarray
    pressure: np.ndarray
    gap: np.ndarray
    unbroken: np.ndarray
    fill: np.ndarray | None
    temperature: float | np.ndarray | None
    bore_displacement: np.ndarray | None
    force: np.ndarray
    moment: np.ndarray
    bearing: JournalBearing = field(repr=False)
    motion: np.ndarray = field(repr=False)
    walls: Walls | None = None


@dataclass(frozen=True, eq=False, kw_only=True)
class JointFilm(Film):
    """The film of a joint at one instant of a run.

    Attributes
    ----------
    time : float
        s.
    contact_pressure : (n, m) array or None
        Of asperities or wall, Pa; None without contact.
    wear_depth : (n, m) array or None
        Worn off the bore up to this instant, m; None without wear.
    bush_displacement : (k, 3) array or None
        Of all nodes of a bush's mesh against the housing, joint frame, m; None without a bush.
    """

    time: float
    contact_pressure: np.ndarray | None
    wear_depth: np.ndarray | None
    bush_displacement: np.ndarray | None = None


@dataclass(frozen=True, kw_only=True)
class History:
    """Accepted steps of a joint and the bearing's dimensions; joint frame, SI units.

    Attributes
    ----------
    time : ndarray (n,)
        [s]
    motion : ndarray (n, 10)
        As in `exudyn_ehd.joint.solved_film`.
    eccentricity : ndarray (n, 2)
        Journal axis in the mid-plane [m].
    force : ndarray (n, 3)
        On the journal [N].
    radial_clearance, length : float
        Of the bearing [m].
    """

    time: np.ndarray
    motion: np.ndarray
    eccentricity: np.ndarray
    force: np.ndarray
    radial_clearance: float
    length: float
