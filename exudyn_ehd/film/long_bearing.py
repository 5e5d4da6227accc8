"""Infinitely long bearing: no axial flow, every slice across the axis is a ring of its own.

The slices lie at Gauss-Legendre points of the length, so that the loads of a tilted journal are integrated exactly for slices
that change polynomially with z. Without axial flow a closed ring keeps its oil and has no reference pressure: a
complementarity condition can't remove any, so that its solution is the full film with its lowest pressure at the cavity's. One
line of prescribed pressure is therefore required: the line of maximum gap or an axial groove.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from exudyn_ehd.film.grid import FilmGrid
from exudyn_ehd.film.reynolds.link_derivatives import LinkDerivatives
from exudyn_ehd.film.solvers.linear import FilmSolver
from exudyn_ehd.status import Status, require_integer


@dataclass(frozen=True, kw_only=True)
class LongBearing:
    """Long bearing (Sommerfeld): axial flow is dropped.

    Load too high (Swift-Stieber, p = 0 at the maximum gap): at eccentricity ratios 0.5 / 0.8 / 0.95 by 262 / 111 / 39 % at
    L/D = 1, 81 / 41 / 17 % at 2 and 30 / 17 / 8 % at 4; meant for closed forms and for sealed bearings. Needs ``inlet=MaximumGap()`` or axial grooves over the whole length
    (``supply=(AxialGroove(angle=..., width_angle=...),)``) and ambient end pressures.

    Parameters
    ----------
    n_theta : int
        Vertices around the circumference, at least 16.
    n_z : int
        Slices along the bearing, at least 2; 2 do without tilt.
    """

    n_theta: int = 192
    n_z: int = 4

    stretch = 0.0
    circumferential_pressure_flow = True

    def __post_init__(self) -> None:
        require_integer("LongBearing.n_theta", self.n_theta, at_least=16, hint="192 is a good start.")
        require_integer("LongBearing.n_z", self.n_z, at_least=2, hint="4 is a good start.")


def long_bearing_grid(
    radius: float, length: float, n_theta: int, n_z: int, *, start_angle: float = 0.0, open_ring: bool = False
) -> FilmGrid:
    """Film grid of uncoupled slices; parameters as for `bearing_grid`, ``n_z`` slices at Gauss-Legendre points."""
    step = 2.0 * math.pi / n_theta
    theta = start_angle + step * np.arange(n_theta)
    points, weights = np.polynomial.legendre.leggauss(n_z)
    half = 0.5 * length / radius
    width_x, width_z = np.full(n_theta, step), half * weights
    fixed = np.zeros((n_theta, n_z), dtype=np.bool_)
    fixed[0, :] = open_ring
    return FilmGrid(
        x=theta, z=half * points, x_face=theta + 0.5 * step, width_x=width_x, width_z=width_z, link_x=1.0 / width_x,
        link_z=np.zeros(n_z - 1), weight=np.outer(width_x, width_z), fixed=fixed, reference_length=float(radius),
    )  # fmt: skip


class LongSolver(FilmSolver):
    """`FilmSolver` without any axial flow, that of an axially moving surface included."""

    def solve(
        self, vx: float, vz: float, cavity_pressure: float, mass_old: np.ndarray | None = None, step: float = 0.0
    ) -> tuple[Status, int]:
        """As `FilmSolver.solve`; vz is not used."""
        return super().solve(vx, 0.0, cavity_pressure, mass_old, step)

    def link_derivatives(self) -> LinkDerivatives:
        """As `FilmSolver.link_derivatives`, with no flow by vz."""
        out = super().link_derivatives()
        out.SZ[:] = 0.0
        return out
