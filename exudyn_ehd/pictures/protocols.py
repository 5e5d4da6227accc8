"""What the pictures look at: a film on its grid, and a history; anything with these attributes can be drawn."""

from __future__ import annotations

import pathlib
from typing import TYPE_CHECKING, Protocol

import numpy as np

if TYPE_CHECKING:
    from exudyn_ehd.bearing import JournalBearing

Target = str | pathlib.Path | None
"""Where a picture is written; None: nowhere."""


class Film(Protocol):
    """A film at one instant; joint frame, SI units, arrays ``[theta, z]``."""

    @property
    def theta(self) -> np.ndarray: ...
    @property
    def z(self) -> np.ndarray: ...
    @property
    def pressure(self) -> np.ndarray: ...
    @property
    def gap(self) -> np.ndarray: ...
    @property
    def unbroken(self) -> np.ndarray: ...
    @property
    def fill(self) -> np.ndarray | None: ...
    @property
    def temperature(self) -> float | np.ndarray | None: ...
    @property
    def force(self) -> np.ndarray: ...
    @property
    def motion(self) -> np.ndarray: ...
    @property
    def bearing(self) -> JournalBearing: ...


class JointFilm(Film, Protocol):
    """The film of a joint at one instant of a run."""

    @property
    def time(self) -> float: ...
    @property
    def bore_displacement(self) -> np.ndarray | None: ...
    @property
    def bush_displacement(self) -> np.ndarray | None: ...
    @property
    def contact_pressure(self) -> np.ndarray | None: ...
    @property
    def wear_depth(self) -> np.ndarray | None: ...


class History(Protocol):
    """Accepted steps of a joint and the bearing's dimensions; joint frame, SI units."""

    @property
    def time(self) -> np.ndarray: ...
    @property
    def motion(self) -> np.ndarray: ...
    @property
    def eccentricity(self) -> np.ndarray: ...
    @property
    def force(self) -> np.ndarray: ...
    @property
    def radial_clearance(self) -> float: ...
    @property
    def length(self) -> float: ...
