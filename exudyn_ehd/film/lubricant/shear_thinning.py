"""Viscosity that depends on the shear rate: Carreau's law at every height of the film.

``mu / mu_0 = r(G) = r_inf + (1 - r_inf) (1 + (lambda G)^2)^((n - 1) / 2)``   (P. J. Carreau, Trans. Soc. Rheology 16
(1972) 99).

Sliding, squeeze and pressure flow thin the oil together: `exudyn_ehd.film.lubricant.shear_profile` integrates the
profile across the gap. A link in theta or z then carries ``V H - a H^3 dP/ds``; the ratio a depends on the gap, the
speed, the link's own gradient, and the gradient across it, the mean of those at its two vertices. The film so becomes
nonlinear in its pressure (`exudyn_ehd.film.solvers.liner`). Couette flux H unchanged, because pressure flow is odd
in the gradient; the shear on the walls is ``tau_m -+ (h / 2) dp/dx``, its mean ``tau_m = ratio mu_0 U / h``.

Two effects are omitted. Axial sliding, which is slow compared with the rotation, does not thin the oil; its viscosity
ratio is that of the rotation. The mean stress along z due to pressure flow in both directions cancels over an aligned
film.
With a density law the gradients of the transformed pressure P stand for pressure gradients over the viscosity ratio;
this neglects the density ratio. A viscosity that depends on pressure or temperature scales mu_0 and does not change the
relaxation time.

Symbols: k = 2 lambda R / c, so that lambda U / h = k vx / H.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, partial
from typing import ClassVar, Protocol, runtime_checkable

import numpy as np
from scipy.sparse import csr_matrix, diags, kron

from exudyn_ehd.film.grid import FilmGrid
from exudyn_ehd.film.lubricant.shear_profile import (
    FLOW_POINTS,
    LAST,
    STRESS_POINTS,
    RateLaw,
    fluidity_table,
    gauss_points,
    thin_links,
    thin_shear,
)
from exudyn_ehd.film.reynolds.gap import drops, on_links
from exudyn_ehd.film.reynolds.links import LinkFlux, LinkLaw
from exudyn_ehd.status import NOT_NEGATIVE, POSITIVE, Checked, InputError

THINS = "the law is that of an oil that thins."


@runtime_checkable
class ShearLaw(Protocol):
    """Viscosity that depends on the shear rate: `CarreauShear`, or a user's law."""

    @property
    def onset(self) -> float:
        """Shear rate above which the oil thins, 1/s, for the audit."""

    def bound(self, radius: float, clearance: float) -> LinkLaw:
        """The law as flux effect and shear factor of a bearing of this radius and clearance, m.

        `ShearThinning` where it follows the shear rate at every height of the film; the law is then a `RateLaw`.
        """


@dataclass(frozen=True, kw_only=True)
class CarreauShear(Checked):
    """Shear thinning after Carreau, for multigrade and polymer-thickened oils.

    ``mu / mu_0 = r_inf + (1 - r_inf) (1 + (lambda G)^2)^((n - 1) / 2)`` with the shear rate G at every height of the
    film, under sliding, squeeze and pressure flow; assumptions: `exudyn_ehd.film.lubricant.shear_thinning`.

    When: multigrade oils at shear rates above 1e5 to 1e6 1/s; 10 m/s over 10 um make 1e6. The error of the load of long
    bearings, against the exact flow across the film, is 0.3 %, from hardly thinning oils to a power law.

    Parameters
    ----------
    relaxation_time : float
        lambda, s: thinning begins at a shear rate of 1 / lambda.
    exponent : float
        n, above 0 and up to 1 (Newtonian): at high rates the viscosity falls as the rate to the power n - 1.
    residual : float, default 0.0
        r_inf, viscosity at infinite shear rate over mu_0, 0 to 1.

    Source
    ------
    P. J. Carreau, Trans. Soc. Rheology 16 (1972) 99; D. Dowson, Int. J. Mech. Sci. 4 (1962) 159.

    Examples
    --------
    >>> law = ehd.CarreauShear(relaxation_time=1e-6, exponent=0.6, residual=0.5)
    >>> law.onset  # 1/s
    1000000.0
    >>> ehd.Lubricant(viscosity=0.02, shear_law=law).shear_law is law
    True
    """

    relaxation_time: float
    exponent: float
    residual: float = 0.0

    checks: ClassVar = {
        "relaxation_time": POSITIVE,
        "exponent": partial(POSITIVE, at_most=1.0, hint=THINS),
        "residual": partial(NOT_NEGATIVE, at_most=1.0, hint=THINS),
    }

    def ratio(self, rate: np.ndarray) -> np.ndarray:
        """mu / mu_0 at shear rates in 1/s."""
        b = 1.0 + (self.relaxation_time * np.asarray(rate)) ** 2
        return self.residual + (1.0 - self.residual) * b ** (0.5 * (self.exponent - 1.0))

    def ratio_slope(self, rate: np.ndarray) -> np.ndarray:
        """Derivative of the ratio to the rate, s."""
        n, k, x = self.exponent, self.relaxation_time, self.relaxation_time * np.asarray(rate)
        return (1.0 - self.residual) * (n - 1.0) * k * x * (1.0 + x * x) ** (0.5 * (n - 3.0))

    def ratio_bend(self, rate: np.ndarray) -> np.ndarray:
        """Second derivative of the ratio to the rate, s^2."""
        n, k, x = self.exponent, self.relaxation_time**2, self.relaxation_time * np.asarray(rate)
        steep = (n - 1.0) * (1.0 + (n - 2.0) * x * x) * (1.0 + x * x) ** (0.5 * (n - 5.0))
        return (1.0 - self.residual) * k * steep

    @property
    def onset(self) -> float:
        """Shear rate above which the oil thins, 1/s."""
        return 1.0 / self.relaxation_time

    def bound(self, radius: float, clearance: float) -> ShearThinning:
        """The law as flux effect and shear factor of a bearing of this radius and clearance, m."""
        return ShearThinning(self, radius, clearance)


class ShearThinning(LinkLaw):
    """Law of the shear rate in scaled form: flux effect and shear factor of one bearing model.

    The film solver calls `place` once, and `see` whenever its pressure changes.

    Parameters
    ----------
    law : RateLaw
    radius, clearance : float
        m.

    Attributes
    ----------
    field : Fluidity or None
        Viscosity over the film's reference viscosity, if it varies over the film; else None.
    radii : pair of arrays (m,) or floats
        Radii of the rows of vertices and of the links in z, over the film's radius. On a face the sliding speed and the
        distances around grow with this ratio r: the shear rate of sliding is ``k vx / (H / r)``, and gradients act as
        in the gap H / r.
    """

    changes_carriers = False
    depends_on_speed = True
    radii: tuple[np.ndarray | float, np.ndarray | float] = (1.0, 1.0)

    def __init__(self, law: RateLaw, radius: float, clearance: float) -> None:
        if not abs(rest := float(law.ratio(np.zeros(1))[0]) - 1.0) < 1e-9:
            raise InputError(
                f"{type(law).__name__}: the ratio must be 1 at rest, got {1.0 + rest:g}; it multiplies "
                "Lubricant.viscosity, which is that of low shear rates."
            )
        self.law = law
        self.oil = fluidity_table(law)
        self.flow_points, self.stress_points = gauss_points(FLOW_POINTS), gauss_points(STRESS_POINTS)
        self.per_speed = 2.0 * radius * law.relaxation_time / clearance

    def place(self, grid: FilmGrid, flow_x: float) -> None:
        """Make the buffers for a grid; ``flow_x`` = 0 drops the circumferential pressure flow."""
        # with gradients and without: profiles of links in theta and z, and at vertices
        self.profiles = np.zeros((2, 3, *grid.shape, LAST))
        self.found = np.zeros((2, 5, *grid.shape))
        along, across = flow_x * grid.link_x, np.append(grid.link_z, 0.0)
        self.cuts = grid.cuts
        self.links = np.array((along[:, None] * np.ones(across.size), np.ones((along.size, 1)) * across))
        self.weights = *_central(along), *_central(across)
        self.lengths = np.divide(1.0, self.links, out=np.zeros_like(self.links), where=self.links != 0.0)

    def see(self, P: np.ndarray) -> None:
        """Compute the gradients (2, n, m) of the unknown P (n, m): along the links, across them, and at vertices."""
        self.last = self.profiles[int(P.any())]
        self.slopes = -drops(P) * self.links
        if self.cuts is not None:
            self.slopes *= self.cuts
        self.vertex = np.array([(gradient @ P.ravel()).reshape(P.shape) for gradient in self.operators])
        self.cross = np.array((on_links(self.vertex[1])[0], on_links(self.vertex[0])[1]))

    def apply(self, flux: LinkFlux, gap_x: np.ndarray, gap_z: np.ndarray, vx: float, vz: float) -> None:
        """Multiply the conductances of the links by the ratios for thinned oil, at the gradients of the last `see`."""
        k, one, f = self.per_speed, np.ones((1, 1)), self.field
        parts = (
            (gap_x, one if f is None else f.inverse_x, flux.gx, flux.gx_h, flux.gx_v),
            (gap_z, one if f is None else f.inverse_z, flux.gz, flux.gz_h, flux.gz_v),
        )
        for axis, (gap, fluid, g, g_h, g_v) in enumerate(parts):
            found, r = self.found[axis], self.radii[axis]
            thin_links(
                gap / r, self.slopes[axis], self.cross[axis], fluid, k * vx, k, axis, self.oil, self.flow_points,
                self.last[axis], found,
            )  # fmt: skip
            g_h[:] = g_h * found[0] + g * (found[1] / r)
            g_v[:] = g_v * found[0] + g * found[2]
            g *= found[0]

    def slide(self, flux: LinkFlux, vx: float) -> np.ndarray:
        """Make the conductances in theta exact where sliding alone thins, after `apply` without gradients.

        Their ratio is the law's inverse slope dS/dT. `apply` interpolates it and sets no derivatives, which are not
        needed without flow. Returns the factors (n, m) by which the conductances were multiplied.
        """
        gap, k = flux.gap_x, self.per_speed * self.radii[0]
        law, S = self.law, k * vx / gap
        rate = np.abs(S) / law.relaxation_time
        thins = law.ratio_slope(rate)
        slope = law.ratio(rate) + rate * thins
        bend = np.sign(S) / law.relaxation_time * (2.0 * thins + rate * law.ratio_bend(rate))
        exact, by_rate = 1.0 / (slope * self.found[0, 0]), -bend / slope
        flux.gx[:] *= exact
        flux.gx_h[:] = flux.gx_h * exact - flux.gx * by_rate * S / gap
        flux.gx_v[:] = flux.gx_v * exact + flux.gx * by_rate * k / gap
        return exact

    def response(self) -> tuple[np.ndarray, ...]:
        """Fields of the last call of `apply` for Newton's matrix, as `add_tangents` and `add_corners` of
        `exudyn_ehd.film.banded.workspace` take them."""
        along, across = self.found[:, 3].copy(), self.found[:, 4] * self.lengths
        if self.cuts is not None:
            across /= self.cuts
        return (along, across, *self.weights)

    def factor(
        self, H: np.ndarray, vx: float, ratio_out: np.ndarray, ratio_h_out: np.ndarray, ratio_v_out: np.ndarray
    ) -> np.ndarray:
        """tau_m h / (mu_0 U) at the vertices, at the gradients of the last `see`, with its derivatives to H and vx.

        Returns its derivatives (2, n, m) to the gradients along theta and z.
        """
        fluid = np.ones((1, 1)) if self.field is None else 1.0 / self.field.ratio
        out, r = np.empty((5, *H.shape)), self.radii[0]
        k = self.per_speed
        thin_shear(H / r, self.vertex, fluid, k * vx, k, self.oil, self.stress_points, self.last[2], out)
        ratio_out[:], ratio_h_out[:], ratio_v_out[:] = out[0], out[1] / r, out[2]
        return out[3:]

    def gather(self, weights: np.ndarray) -> np.ndarray:
        """Sums (n, m) by the film's unknown of weights (2, n, m) of the gradients at the vertices."""
        x, z = (w.ravel() @ gradient for w, gradient in zip(weights, self.operators, strict=True))
        return np.reshape(x + z, weights.shape[1:])

    @cached_property
    def operators(self) -> tuple[csr_matrix, csr_matrix]:
        """Gradients along theta and z at the vertices as matrices (n m, n m) of the film's unknown."""
        back_x, on_x, back_z, on_z = self.weights
        n, m = back_x.size, back_z.size
        x = diags([back_x - on_x, on_x[:-1], -back_x[1:]], [0, 1, -1]).tolil()
        x[0, -1] -= back_x[0]
        x[-1, 0] += on_x[-1]
        z = diags([back_z - on_z, on_z[:-1], -back_z[1:]], [0, 1, -1])
        return csr_matrix(kron(x, diags(np.ones(m)))), csr_matrix(kron(diags(np.ones(n)), z))


def _central(link: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Factors of the differences to the previous and to the next vertex in a gradient, of second order.

    ``link`` is 1 over the distance to the next vertex of a ring, 0 where there is none.
    """
    before = np.roll(link, 1)
    total = before + link
    share = np.divide(1.0, total, out=np.zeros_like(total), where=total > 0.0)
    return before * before * share, link * link * share
