"""Protocols of contacts, which press where surfaces touch, and of limiters of the gap that the film sees.

Fields are (n, m) arrays on the film grid; gaps are divided by the clearance, contact pressures in Pa.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np

# Share of land below which a vertex lies inside an area: far above round-off, far below what an edge leaves.
INSIDE = 1e-9


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


class LandContact:
    """A contact outside of supply areas, where nothing touches: its pressure times the land's share of a vertex.

    Parameters
    ----------
    contact : Contact
    land : (n, m) array
        As of `exudyn_ehd.film.supply.cuts.SupplyMap`; it may change.
    """

    def __init__(self, contact: Contact, land: np.ndarray) -> None:
        self.contact, self.land = contact, land
        self.presses_below = contact.presses_below
        self.friction_coefficient, self.transition_speed = contact.friction_coefficient, contact.transition_speed

    def pressure(self, H: np.ndarray, P_out: np.ndarray, slope_out: np.ndarray) -> None:
        """Pressure and slope as of `Contact`."""
        self.contact.pressure(H, P_out, slope_out)
        P_out *= self.land
        slope_out *= self.land

    def solve_gap(
        self, X: np.ndarray, compliance: float, scale: float, G: np.ndarray, P_out: np.ndarray, slope_out: np.ndarray
    ) -> None:
        """Gap and slope on the land, as of `Contact`, and the land's share of the pressure; no contact in areas."""
        self.contact.solve_gap(X, compliance, scale, G, P_out, slope_out)
        inside = self.land < INSIDE
        G[inside], slope_out[inside] = X[inside], 0.0
        P_out *= self.land
