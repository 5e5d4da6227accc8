"""What a film solver asks of a cavitation model."""

from __future__ import annotations

from typing import Protocol

import numpy as np

from exudyn_ehd.film.banded.workspace import Workspace
from exudyn_ehd.film.cavitation.active_set import FilmSystem
from exudyn_ehd.status import Status


class Closure(Protocol):
    """What a cavitation model offers.

    See `exudyn_ehd.film.cavitation.closures` and `exudyn_ehd.film.cavitation.elrod_adams`.
    """

    @property
    def cavity_pressure(self) -> float: ...

    @property
    def cavity_shear(self) -> float: ...

    @property
    def conserves_mass(self) -> bool: ...

    @property
    def clips(self) -> bool: ...

    @property
    def line_in_cells(self) -> bool | None: ...

    def solve(self, system: FilmSystem, work: Workspace) -> tuple[Status, int]: ...

    def adjoint(self, system: FilmSystem, work: Workspace, rhs: np.ndarray) -> None: ...

    def adjoint_columns(self, work: Workspace, rhs: np.ndarray) -> None: ...

    def direct(self, work: Workspace, rhs: np.ndarray) -> None: ...
