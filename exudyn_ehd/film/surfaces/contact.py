"""What surfaces that touch offer a film: a pressure of their own, and the gap that the film sees.

Fields are (n, m) arrays on the film grid; gaps are divided by the clearance, contact pressures in Pa.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np


class GapLimiter(Protocol):
    """Keeps the gap that the film sees above zero where surfaces touch."""

    @property
    def limits_below(self) -> float:
        """Scaled gap from which on the film sees the gap itself."""

    def limit(
        self,
        H: np.ndarray,
        HF: np.ndarray,
        H_t: np.ndarray,
        slope_out: np.ndarray,
        bend_out: np.ndarray,
        face_slope_out: np.ndarray,
    ) -> None:
        """Replace gaps at vertices (H) and links (HF) and the gap's rate (H_t) by the film's, in place.

        ``slope_out`` and ``face_slope_out`` take d(film gap)/d(gap), ``bend_out`` the second derivative times the
        gap's rate.
        """


class Contact(Protocol):
    """A pressure between the surfaces that depends on the true gap alone."""

    @property
    def presses_below(self) -> float:
        """Scaled gap from which on there is no pressure."""

    def pressure(self, H: np.ndarray, P_out: np.ndarray, slope_out: np.ndarray) -> None:
        """Contact pressure, Pa, and its derivative with respect to the scaled gap H; overwrites both outputs."""

    def solve_gap(
        self, X: np.ndarray, compliance: float, scale: float, G: np.ndarray, P_out: np.ndarray, slope_out: np.ndarray
    ) -> None:
        """Solve ``G = X + compliance pressure(G) / scale`` for G (n, m), in place.

        Outputs: the pressure there, Pa, and its slope over ``scale``.
        """

    @property
    def friction_coefficient(self) -> float:
        """Boundary friction coefficient; 0 for a frictionless contact."""

    @property
    def transition_speed(self) -> float:
        """Sliding speed over which Coulomb friction is regularised, m/s."""
