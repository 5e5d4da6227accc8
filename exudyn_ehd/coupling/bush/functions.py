"""User functions of a nodal bush's object."""

from __future__ import annotations

import exudyn as exu
import numpy as np
from scipy.sparse import csr_matrix

from exudyn_ehd.coupling.bush.equations import BushEquations
from exudyn_ehd.coupling.contract import START_OF_STEP


class BushFunctions:
    """What Exudyn asks of a nodal bush.

    Parameters
    ----------
    equations : BushEquations
    name : str
        Of the object, for messages.
    """

    def __init__(self, equations: BushEquations, name: str) -> None:
        self.equations, self.name = equations, name
        self._watched = np.nan
        self._weighed = False

    def force(self, mbs: exu.MainSystem, t: float, item: int, q: list[float], q_t: list[float]) -> list[float]:
        """Generalised force (n,), a list, which Exudyn reads fastest; raises if an element was inside out."""
        self.watch(mbs, item)
        return self.equations.force(t, np.array(q), np.array(q_t)).tolist()

    def watch(self, mbs: exu.MainSystem, item: int, places: np.ndarray | slice | None = None) -> None:
        """Raise if an element is inside out at the start of a step; ``places`` of the object's coordinates if known."""
        start = mbs.systemData.GetTime(START_OF_STEP)
        if start != self._watched:
            self._watched = start
            known = np.array(mbs.systemData.GetObjectLTGODE2(item)) if places is None else places
            self.equations.require_upright(mbs, known, start, self.name)

    def jacobian(
        self, mbs: exu.MainSystem, t: float, item: int, q: list[float], q_t: list[float], f_q: float, f_qt: float
    ) -> csr_matrix:
        """Derivative (n, n) of minus the force, weighted for coordinates and rates."""
        return self.equations.jacobian(t, np.array(q), np.array(q_t), f_q, f_qt)

    def mass(self, mbs: exu.MainSystem, t: float, item: int, q: list[float], q_t: list[float]) -> csr_matrix:
        """Mass (n, n) of a bush on a carrier."""
        if not self._weighed:
            self._weighed = True
            self.equations.warn_if_light(mbs, self.name.removesuffix(" bush"), np.array(q))
        return self.equations.mass(np.array(q))
