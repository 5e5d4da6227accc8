"""What one evaluation of a bearing model gives back."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from exudyn_ehd.joint.seams import History
from exudyn_ehd.status import Status

if TYPE_CHECKING:
    from exudyn_ehd.joint.model.rigid import BearingModel


@dataclass(eq=False)
class Evaluation:
    """One film evaluation.

    Attributes
    ----------
    status : Status
    motion : (10,) array
    wrench : (6,) array
        Force (N) and moment about O (Nm) on the journal, joint frame; nan if there is no film.
    iterations : int
        Linear solves spent.
    """

    status: Status
    motion: np.ndarray
    wrench: np.ndarray
    iterations: int
    _model: BearingModel = field(repr=False)
    _serial: int = field(repr=False)

    def tangent(self) -> np.ndarray:
        """d wrench / d motion (6, 10), exact for the current active set, from the stored factor.

        Raises
        ------
        RuntimeError
            If the model has evaluated another state since.
        """
        self._require_current()
        return self._model.tangent()

    def quantities(self) -> dict[str, float]:
        """Scalars of this state in SI units; see `exudyn_ehd.joint.model.quantities.quantities`."""
        self._require_current()
        return self._model.quantities()

    def history(self) -> History | None:
        """What the bearing remembers if this state is accepted; None without effects that remember."""
        self._require_current()
        return self._model.history()

    def _require_current(self) -> None:
        if self._model.serial != self._serial:
            raise RuntimeError("Evaluation: the model has evaluated another state since; evaluate this state again.")
