"""What a film on a liner may be made of besides its closure; see `exudyn_ehd.film.solvers.nonlinear`."""

from __future__ import annotations

from typing import NamedTuple, Protocol

import numpy as np

from exudyn_ehd.film.lubricant.density import CompressibleLaw


class ElementContact(Protocol):
    """What presses on a Winkler element besides the film; as `exudyn_ehd.joint.seams.Contact`."""

    @property
    def presses_below(self) -> float: ...

    def settle(
        self, X: np.ndarray, compliance: float, scale: float, G: np.ndarray, P_out: np.ndarray, slope_out: np.ndarray
    ) -> None: ...


class ElementLimiter(Protocol):
    """The gap that the film sees between touching surfaces; as `exudyn_ehd.joint.seams.GapLimiter`."""

    @property
    def limits_below(self) -> float: ...

    def limit(
        self, H: np.ndarray, HF: np.ndarray, H_t: np.ndarray,
        slope_out: np.ndarray, bend_out: np.ndarray, face_slope_out: np.ndarray,
    ) -> None: ...  # fmt: skip


class ElementOil(Protocol):
    """How pressure follows from the film's unknown; as `exudyn_ehd.joint.seams.PressureLaw`."""

    @property
    def largest_pressure(self) -> float: ...

    def transform(self, p: np.ndarray) -> np.ndarray: ...

    def inverse(self, q: np.ndarray, p_out: np.ndarray, ratio_out: np.ndarray, ratio_q_out: np.ndarray) -> bool: ...


class LinerParts(NamedTuple):
    """What takes part, None: absent.

    Attributes
    ----------
    contact : ElementContact or None
        What presses on the liner besides the film.
    limiter : ElementLimiter or None
        Of the gap that the film sees; goes with the contact or with flow factors.
    oil : ElementOil or None
        Of a viscosity that follows the pressure.
    density : CompressibleLaw or None
        Of a density that does; then it is the ``oil`` as well.
    """

    contact: ElementContact | None
    limiter: ElementLimiter | None
    oil: ElementOil | None
    density: CompressibleLaw | None
