"""What a film on columns of liner may be made of beside its closure; see `exudyn_ehd.film.solvers.nonlinear`."""

from __future__ import annotations

from typing import Protocol

import numpy as np


class ColumnContact(Protocol):
    """What presses on a column beside the film; as `exudyn_ehd.joint.seams.Contact`."""

    @property
    def presses_below(self) -> float: ...

    def settle(
        self, X: np.ndarray, compliance: float, scale: float, G: np.ndarray, P_out: np.ndarray, slope_out: np.ndarray
    ) -> None: ...


class ColumnLimiter(Protocol):
    """The gap that the film sees between touching surfaces; as `exudyn_ehd.joint.seams.GapLimiter`."""

    @property
    def limits_below(self) -> float: ...

    def limit(
        self, H: np.ndarray, HF: np.ndarray, H_t: np.ndarray,
        slope_out: np.ndarray, bend_out: np.ndarray, face_slope_out: np.ndarray,
    ) -> None: ...  # fmt: skip


class ColumnOil(Protocol):
    """How pressure follows from the film's unknown; as `exudyn_ehd.joint.seams.PressureLaw`."""

    @property
    def largest_pressure(self) -> float: ...

    def transform(self, p: np.ndarray) -> np.ndarray: ...

    def inverse(self, q: np.ndarray, p_out: np.ndarray, ratio_out: np.ndarray, ratio_q_out: np.ndarray) -> bool: ...
