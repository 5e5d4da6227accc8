"""Viscosity ``mu = mu(0) r(p)`` that depends on pressure, by the Kirchhoff transform ``q = integral of dp / r(p)``.

``r(p)^-1 grad p = grad q``: in q the pressure flow is that of a film of constant viscosity. Pressures are gauge, in Pa.

Barus (C. Barus 1893): ``r = exp(alpha p)``, ``q = (1 - exp(-alpha p)) / alpha``, ``p = -ln(1 - alpha q) / alpha``; no
pressure carries a film with ``q >= 1 / alpha``.

Roelands (C. J. A. Roelands, Correlational aspects of the viscosity-temperature-pressure relationship of lubricating
oils, 1966): ``ln r = a ((1 + p / p_0)^Z - 1)``, ``a = ln(mu_0) + 9.67``, ``Z = alpha p_0 / a``, for p >= 0; below,
where oil cavitates, it is continued by Barus' law with the same slope.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial
from typing import ClassVar, NamedTuple, Protocol, runtime_checkable

import numpy as np
from numba import njit

from exudyn_ehd.status import POSITIVE, Checked, InputError

ROELANDS_SHIFT = 9.67
TABLE_INTERVALS = 4096
# The table ends at this viscosity ratio, at which the oil counts as solid, or at this pressure.
LARGEST_RATIO = 1e7
LARGEST_PRESSURE = 5e9
# Slope dp/dq of the line beyond a law's end. It is just steep enough for the next step of Newton's method to return to
# the law's steep part.
BEYOND = 1e3


class PressureLaw(Protocol):
    """Viscosity ratio ``r(p) = mu(p) / mu(0)`` of an oil with one reference viscosity; pressures are gauge, in Pa."""

    @property
    def coefficient(self) -> float:
        """dr/dp at ambient pressure, 1/Pa; below, the law is Barus' with this coefficient."""

    @property
    def largest_pressure(self) -> float:
        """Pressure at which the oil counts as solid, Pa."""

    def ratio(self, p: np.ndarray) -> np.ndarray:
        """r(p) for p >= 0."""

    def ratio_slope(self, p: np.ndarray) -> np.ndarray:
        """dr/dp for p >= 0, 1/Pa."""


@runtime_checkable
class PressureOption(Protocol):
    """Viscosity that depends on pressure: `BarusPressure`, `RoelandsPressure` or a user's law."""

    @property
    def coefficient(self) -> float:
        """Slope of ln(mu) at ambient pressure, 1/Pa."""

    def bound(self, viscosity: float) -> PressureLaw:
        """Law for a reference viscosity in Pa s."""


COEFFICIENT = partial(POSITIVE, hint="mineral oils have 1e-8 to 2.5e-8 1/Pa.")


@dataclass(frozen=True, kw_only=True)
class BarusPressure(Checked):
    """Viscosity under pressure by Barus' law ``mu = mu_0 exp(alpha p)``; good to some 100 MPa, too steep beyond.

    p is the gauge pressure, mu_0 the viscosity at ambient pressure.

    When: always for peak pressures above some 50 MPa, where oil is 2.7 times as thick with alpha = 2e-8 1/Pa; from 5
    MPa on where 10 % in the viscosity matter.

    Parameters
    ----------
    coefficient : float
        alpha, 1/Pa; 1e-8 to 2.5e-8 for mineral oils.

    Source
    ------
    C. Barus, 1893.

    Examples
    --------
    >>> law = ehd.BarusPressure(coefficient=2e-8)
    >>> oil = ehd.Lubricant(viscosity=0.02, pressure_law=law)
    >>> round(float(np.exp(law.coefficient * 50e6)), 2)  # times as thick at 50 MPa
    2.72
    """

    coefficient: float

    checks: ClassVar = {"coefficient": COEFFICIENT}

    def bound(self, viscosity: float) -> PressureLaw:
        """Law for a reference viscosity in Pa s, on which Barus' law does not depend."""
        return self

    @property
    def largest_pressure(self) -> float:
        """Pressure at which the oil counts as solid, Pa."""
        return min(math.log(LARGEST_RATIO) / self.coefficient, LARGEST_PRESSURE)

    def ratio(self, p: np.ndarray) -> np.ndarray:
        """r(p)."""
        return np.exp(self.coefficient * p)

    def ratio_slope(self, p: np.ndarray) -> np.ndarray:
        """dr/dp, 1/Pa."""
        return self.coefficient * self.ratio(p)


@dataclass(frozen=True, kw_only=True)
class RoelandsPressure(Checked):
    """Viscosity under pressure by Roelands' law: like Barus' at low pressure, less steep at high pressure.

    ``ln(mu / mu_0) = a ((1 + p / p_0)^Z - 1)``, ``a = ln(mu_0) + 9.67``, ``Z = alpha p_0 / a``, with the gauge pressure
    p and the viscosity at ambient pressure mu_0 in Pa s, which must be above 6.3e-5.

    When: as `BarusPressure`, and in its place above 100 MPa.

    Parameters
    ----------
    coefficient : float
        alpha, the slope of ln(mu) at ambient pressure, 1/Pa; 1e-8 to 2.5e-8 for mineral oils.
    reference_pressure : float, default 1.96e8
        p_0, Pa, a constant of the law for all oils.

    Source
    ------
    C. J. A. Roelands, 1966.

    Examples
    --------
    >>> law = ehd.RoelandsPressure(coefficient=2e-8)
    >>> oil = ehd.oil("ISO VG 46")
    >>> import dataclasses
    >>> dataclasses.replace(oil, pressure_law=law).pressure_law.reference_pressure  # Pa
    196000000.0
    """

    coefficient: float
    reference_pressure: float = 1.96e8

    checks: ClassVar = {"coefficient": COEFFICIENT, "reference_pressure": POSITIVE}

    def bound(self, viscosity: float) -> PressureLaw:
        """The law for a reference viscosity in Pa s.

        Raises
        ------
        InputError
            For viscosities below exp(-9.67) Pa s, where the law has no meaning.
        """
        a = math.log(viscosity) + ROELANDS_SHIFT
        if a <= 0.0:
            raise InputError(
                f"RoelandsPressure needs a lubricant with a viscosity > {math.exp(-ROELANDS_SHIFT):.3g} Pa s, got "
                f"{viscosity:g} Pa s; use BarusPressure for thinner liquids."
            )
        return BoundRoelands(a, self.coefficient, self.reference_pressure)


class BoundRoelands(NamedTuple):
    """Roelands' law for one reference viscosity: a = ln(mu_0) + 9.67, alpha in 1/Pa and p_0 in Pa."""

    a: float
    coefficient: float
    p0: float

    @property
    def Z(self) -> float:
        """Exponent alpha p_0 / a."""
        return self.coefficient * self.p0 / self.a

    @property
    def largest_pressure(self) -> float:
        """Pressure at which the oil counts as solid, Pa."""
        # ln(1 + p / p_0) at that ratio; bounded, because a nearly constant viscosity reaches the ratio at no pressure
        end = min(math.log1p(math.log(LARGEST_RATIO) / self.a) / self.Z, 100.0)
        return min(self.p0 * math.expm1(end), LARGEST_PRESSURE)

    def ratio(self, p: np.ndarray) -> np.ndarray:
        """r(p) for p >= 0."""
        return np.exp(self.a * np.expm1(self.Z * np.log1p(p / self.p0)))

    def ratio_slope(self, p: np.ndarray) -> np.ndarray:
        """dr/dp for p >= 0, 1/Pa."""
        return self.ratio(p) * self.coefficient * (1.0 + p / self.p0) ** (self.Z - 1.0)


class LawTable(NamedTuple):
    """Splines of a `PressureTransform` for the kernels, in one form for every law of viscosity and density.

    Attributes
    ----------
    exponent : float
        k of ``q = (1 - exp(-k p)) / k`` below ambient pressure, 1/Pa.
    q : (intervals + 1,) array
        Nodes of the splines, Pa.
    table, ratio : (intervals, 7) arrays
        `quintic` splines of p(q) and of the density ratio rho(q).
    bucket : (b + 1,) array
        Interval at the start of each of b equal parts of q; ``bucket_scale``: their number per pressure, 1/Pa.
    lowest, highest : float
        Range of q, Pa.
    a : float
        Slope of the density ratio at ambient pressure, 1/Pa.
    """

    exponent: float
    q: np.ndarray
    table: np.ndarray
    ratio: np.ndarray
    bucket: np.ndarray
    bucket_scale: float
    lowest: float
    highest: float
    a: float


class PressureTransform:
    """Transform ``q = integral dp / s(p)``, s = r, whose inverse p(q) is a quintic Hermite spline.

    With it the pressure flow ``mu_0 / mu(p) grad p = grad q`` is that of a film of constant viscosity in q, whatever
    the law: the complementarity problem and its solver stay as they are. For p <= 0 it is that of Barus' law.

    q comes from Gauss quadrature of ``dq/dp`` over each of 4096 intervals of p; p, ``s = dp/dq`` and
    ``s ds/dp = d2p/dq2`` are exact at the nodes. The spline's error in p is about (alpha dp)^6 / (400 alpha), below
    1e-13 of p, and its derivatives are those of the pressures that it gives, so that a tangent built with them is
    exact.

    Parameters
    ----------
    viscosity : PressureLaw

    Attributes
    ----------
    alpha : float
        ds/dp at p = 0, 1/Pa; not 0.
    largest_pressure : float
        End of the table, Pa.
    kernel_table : LawTable
    """

    # slope of the density ratio at ambient pressure, 1/Pa
    compressibility = 0.0

    def __init__(self, viscosity: PressureLaw) -> None:
        self.viscosity: PressureLaw | None = viscosity
        self._tabulate(viscosity.largest_pressure, viscosity.coefficient)

    def _tabulate(self, largest_pressure: float, alpha: float) -> None:
        self.alpha, self.largest_pressure = alpha, largest_pressure
        self.p = np.linspace(0.0, largest_pressure, TABLE_INTERVALS + 1)
        widths = self._quadrature(self.p[:-1], self.p[1:])
        self.q = np.concatenate(([0.0], np.cumsum(widths)))
        slope, slope_p = self.slopes(self.p)
        # so fine that the search in a part hardly takes a step
        parts = 4 * TABLE_INTERVALS
        edges = np.linspace(0.0, self.q[-1], parts + 1)
        self.kernel_table = LawTable(
            alpha,
            self.q,
            quintic(self.p, slope, slope * slope_p, widths),
            quintic(*self.densities(slope, slope_p), widths),
            np.clip(np.searchsorted(self.q, edges, side="right") - 1, 0, TABLE_INTERVALS - 1),
            parts / self.q[-1],
            # below this q there is no pressure p
            -np.inf if alpha >= 0.0 else 0.999 / alpha,
            self.q[-1],
            self.compressibility,
        )

    def densities(self, slope: np.ndarray, slope_p: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Density ratio at the nodes and its first two derivatives to q, for s = dp/dq and ds/dp there."""
        return np.ones_like(self.p), np.zeros_like(self.p), np.zeros_like(self.p)

    def slopes(self, p: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """s = dp/dq and ds/dp, 1/Pa, for p >= 0."""
        assert self.viscosity is not None
        return self.viscosity.ratio(p), self.viscosity.ratio_slope(p)

    def _quadrature(self, lower: np.ndarray, upper: np.ndarray) -> np.ndarray:
        place, weight = np.polynomial.legendre.leggauss(8)
        half = np.asarray(0.5 * (upper - lower))
        points = np.asarray(lower)[..., None] + half[..., None] * (1.0 + place)
        return half * np.sum(weight / self.slopes(points)[0], axis=-1)

    def transform(self, p: np.ndarray) -> np.ndarray:
        """q(p), Pa."""
        p = np.asarray(p, dtype=float)
        negative = -np.expm1(-self.alpha * np.minimum(p, 0.0)) / self.alpha
        at = np.clip(np.searchsorted(self.p, p, side="right") - 1, 0, TABLE_INTERVALS - 1)
        positive = self.q[at] + self._quadrature(self.p[at], np.maximum(p, 0.0))
        return np.where(p > 0.0, positive, negative)

    def inverse(self, q: np.ndarray, p_out: np.ndarray, ratio_out: np.ndarray, ratio_q_out: np.ndarray) -> bool:
        """p(q), mu(p)/mu_0 (= dp/dq of an incompressible film) and its derivative to q, 1/Pa, for fields (n, m).

        Returns False if some q has no p. There p is continued by a straight line, so that iterations can come back.
        """
        inside, (p_out[:], s, s_q, rho, rho_q) = self.fields(q)
        ratio_out[:], ratio_q_out[:] = rho * s, rho * s_q + rho_q * s
        return inside

    def fields(self, q: np.ndarray) -> tuple[bool, np.ndarray]:
        """Return whether every q has a p, and p(q), s = dp/dq, ds/dq, density ratio and its derivative (5, ...)."""
        out = np.empty((5, *q.shape))
        return bool(law_fields(q.reshape(-1), self.kernel_table, out.reshape(5, -1))), out


def quintic(values: np.ndarray, slopes: np.ndarray, bends: np.ndarray, widths: np.ndarray) -> np.ndarray:
    """1 / width and the coefficients in t = (x - x_k) / width of the quintic Hermite spline, (intervals, 7).

    ``bends``: second derivatives at the nodes, ``widths`` (intervals,) the distances between them.
    """
    h = widths
    d0, d1, e0, e1 = slopes[:-1] * h, slopes[1:] * h, 0.5 * bends[:-1] * h**2, 0.5 * bends[1:] * h**2
    f, g, w = np.diff(values) - d0 - e0, d1 - d0 - 2.0 * e0, e1 - e0
    c3, c4, c5 = 10.0 * f - 4.0 * g + w, -15.0 * f + 7.0 * g - 2.0 * w, 6.0 * f - 3.0 * g + w
    return np.ascontiguousarray(np.array([1.0 / h, values[:-1], d0, e0, c3, c4, c5]).T)


@njit(cache=True)
def law_fields(q, law, out):
    """Set p(q), s, ds/dq, density ratio and its derivative (5, count); return whether every q (count,) has a p.

    Below the range of q, p is nan. Above it, p is continued with the slope BEYOND, and the density is that at the end.
    """
    inside = True
    for c in range(q.size):
        if not q[c] > law.lowest:
            inside = False
            out[:, c] = np.nan
            continue
        p, rho, s, s_q, rho_q = law_at(min(q[c], law.highest), law)
        if not q[c] < law.highest:
            inside = False
            p, s, s_q, rho_q = p + BEYOND * (q[c] - law.highest), BEYOND, 0.0, 0.0
        out[0, c], out[1, c], out[2, c], out[3, c], out[4, c] = p, s, s_q, rho, rho_q
    return inside


@njit(cache=True, inline="always")
def interval_at(x, q_table, table, bucket, bucket_scale):
    """Interval of one x > 0 below the end of the table of `hermite_inverse`, and t there."""
    at = min(int(x * bucket_scale), bucket.size - 2)
    low, high = bucket[at], bucket[at + 1] + 1
    while high - low > 1:
        middle = (low + high) // 2
        if q_table[middle] <= x:
            low = middle
        else:
            high = middle
    return low, (x - q_table[low]) * table[low, 0]


@njit(cache=True, inline="always")
def expand(table, low, t):
    """Value, slope and half of the second derivative at t in an interval of a `quintic` spline."""
    c = table[low]
    w = c[0]
    return (
        c[1] + t * (c[2] + t * (c[3] + t * (c[4] + t * (c[5] + t * c[6])))),
        w * (c[2] + t * (2.0 * c[3] + t * (3.0 * c[4] + t * (4.0 * c[5] + t * 5.0 * c[6])))),
        w * w * (c[3] + t * (3.0 * c[4] + t * (6.0 * c[5] + t * 10.0 * c[6]))),
    )


@njit(cache=True, inline="always")
def law_at(q, law):
    """Pressure p, Pa, and density ratio at a transformed pressure q, Pa, within the law's range; s = dp/dq, ds/dq and
    the density's derivative to q, 1/Pa."""
    if q > 0.0:
        low, t = interval_at(q, law.q, law.table, law.bucket, law.bucket_scale)
        p, s, half = expand(law.table, low, t)
        rho, rho_q, _ = expand(law.ratio, low, t)
        return p, rho, s, 2.0 * half, rho_q
    a, k = law.a, law.exponent
    p, s = -np.log1p(-k * q) / k, 1.0 / (1.0 - k * q)
    rho = np.exp(a * p)
    return p, rho, s, k * s * s, a * s * rho
