"""Turbulent films: more resistance to pressure flow and more shear, by the local Reynolds number of the sliding.

Linearised about the turbulent Couette flow of the sliding surfaces, the mean flow through the gap stays a Reynolds
equation with two resistances in place of 12,

    q_x = U/2 h - h^3 / (k_x mu) dp/dx,      q_z = - h^3 / (k_z mu) dp/dz,

and the mean shear stress tau = t mu U / h; all three factors grow with Re = rho |U| h / mu.

Ng and Pan (eddy viscosity after Reichardt), as the fits that are in use:

    k_x = 12 + 0.0136 Re^0.90,    k_z = 12 + 0.0043 Re^0.96,    t = 1 + 0.0012 Re^0.94.

Hirs (bulk flow): a mean flow u relative to a wall meets the stress ``n rho u^2 / 2 (rho u h / mu)^m`` there. About u =
U/2 at both walls that gives

    k_x = n (2 + m) 2^-(1 + m) Re^(1 + m),    k_z = n 2^-(1 + m) Re^(1 + m),    t = n 2^-(3 + m) Re^(1 + m),

with n = 0.066, m = -0.25: k_x = 0.0687 Re^0.75 and k_z = 0.0392 Re^0.75. Where these are below the laminar 12 (1 for
t), the film is laminar; the corner between both laws is rounded by 2 %.

Between the Reynolds numbers ``onset`` and ``full`` the excess over the laminar value is multiplied by ``w = s^3 (10 -
15 s + 6 s^2)``, twice differentiable. Re contains only the sliding of the journal in the bore, not axial motion,
squeeze, or the pressure flow, which must be slow in comparison. The carrier h of the Couette flow is unchanged by
symmetry.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from typing import ClassVar

import numpy as np
from numba import njit

from exudyn_ehd.film.reynolds.links import LinkFlux, LinkLaw
from exudyn_ehd.status import POSITIVE, Checked, InputError, require_number

# Options of a `Lubricant` whose conductances or density follow the pressure; they exclude turbulence.
FOLLOWING = ("pressure_law", "density_law", "shear_law")
# Taylor number Re sqrt(c / R) above which there are vortices between concentric cylinders; larger values delay
# turbulence. G. I. Taylor, Phil. Trans. R. Soc. A 223 (1923) 289.
TAYLOR = 41.2
# Width, in units of k / 12, over which the corner between Hirs' law and the laminar law is rounded. The largest error
# of k / 12 is half of it; smaller values make the corner sharper.
ROUNDING = 0.04


class _Transition(Checked):
    """Base of the turbulence laws: Reynolds numbers between which a film changes from laminar to turbulent."""

    onset: float | None
    full: float | None
    # U h / nu above which turbulence persists in plane Couette flow; larger values delay turbulence. It is 4 times the
    # 360 with half speed and half gap of N. Tillmark and P. H. Alfredsson, J. Fluid Mech. 235 (1992) 89.
    plane_onset: ClassVar[float] = 1440.0

    checks: ClassVar = {
        **dict.fromkeys(("onset", "full"), partial(POSITIVE, hint="it is a Reynolds number.")),
        "coefficient": POSITIVE,
        "exponent": partial(require_number, at_least=-1.0, at_most=0.0),
    }

    def __post_init__(self) -> None:
        super().__post_init__()
        name = type(self).__name__
        if self.onset is not None and self.full is not None and not self.full > self.onset:
            raise InputError(
                f"{name}.full must be above {name}.onset, got {self.full!r} and {self.onset!r}; the film is laminar up "
                "to the one and turbulent from the other on."
            )

    def transition(self, radius: float, clearance: float, plane: bool = False) -> tuple[float, float]:
        """Reynolds numbers up to which a film is laminar, and from which on it is turbulent.

        Parameters
        ----------
        radius, clearance : float
            Radius of the journal and radial clearance, m.
        plane : bool, default False
            True: for a thrust face, in which there are no Taylor vortices.

        Returns
        -------
        tuple of float
        """
        if self.onset is not None:
            return self.onset, 2.0 * self.onset if self.full is None else self.full
        onset = self.plane_onset if plane else TAYLOR * math.sqrt(radius / clearance)
        if self.full is None:
            return onset, 2.0 * onset
        return min(onset, 0.5 * self.full), self.full

    def bound(
        self, radius: float, clearance: float, density: float, viscosity: float, plane: bool = False
    ) -> TurbulentFlow:
        """Return the law as flux effect and shear factor of a bearing; radius and clearance in m, density in kg/m3,
        viscosity in Pa s."""
        per_speed = 2.0 * density * radius * clearance / viscosity
        return TurbulentFlow(self._powers(), self.transition(radius, clearance, plane), per_speed)

    def _powers(self) -> np.ndarray:
        """Coefficients (3, 4) of k_x / 12, k_z / 12 and t: factor, exponent, subtracted value, width of the rounded
        corner."""
        raise NotImplementedError


@dataclass(frozen=True, kw_only=True)
class NgPan(_Transition):
    """Turbulent film after Ng and Pan, for fast or thin liquids; equations: `exudyn_ehd.film.reynolds.turbulence`.

    When: thin liquids (water, refrigerants, hot turbine oil) at Re = rho U c / mu above some 1000, with the journal's
    surface speed U; the audit reports Re. In the film Re is local, with its gap in place of c.

    Not with a ``pressure_law``, ``density_law`` or ``shear_law``, `PatirCheng`, or `FilmEnergy.conductivity`, which
    hold for laminar flow. The fits differ from the theory's own numbers by at most 6 % from Re = 1500 to 15000, 12 % up
    to 30000.

    Parameters
    ----------
    onset : float or None, default None
        Reynolds number up to which the film is laminar; None: 41.2 sqrt(R / c), where Taylor's vortices begin, and 1440
        on thrust faces, where turbulence of plane Couette flow begins to last.
    full : float or None, default None
        Reynolds number from which on the film is fully turbulent; None: twice the onset.

    Source
    ------
    C. W. Ng and C. H. T. Pan, J. Basic Engineering 87 (1965) 675.

    Examples
    --------
    >>> b = dict(journal_radius=0.1, length=0.1, radial_clearance=2e-4, lubricant=ehd.Lubricant(viscosity=1e-3))
    >>> laminar, turbulent = (
    ...     ehd.steady(ehd.JournalBearing(**b, turbulence=law), speed=300.0, eccentricity_ratio=0.6)
    ...     for law in (None, ehd.NgPan())
    ... )
    >>> [round(np.hypot(*film.force[:2])) for film in (laminar, turbulent)]  # N
    [746, 1492]
    """

    onset: float | None = None
    full: float | None = None

    def _powers(self) -> np.ndarray:
        x, z = (0.0136 / 12.0, 0.90, 0.0, 0.0), (0.0043 / 12.0, 0.96, 0.0, 0.0)
        return np.array([x, z, (0.0012, 0.94, 0.0, 0.0)])


@dataclass(frozen=True, kw_only=True)
class Hirs(_Transition):
    """Turbulent film by Hirs' bulk flow, for fast or thin liquids; equations: `exudyn_ehd.film.reynolds.turbulence`.

    When: as `NgPan`, and with the same exclusions; its two constants can be measured on the surfaces at hand.

    Parameters
    ----------
    onset, full : float or None, default None
        As for `NgPan`.
    coefficient, exponent : float, default 0.066, -0.25
        n and m of the shear stress on a wall, ``(n / 2) rho u^2 (rho u h / mu)^m``, with the speed u of the
        mean flow relative to this wall; m from -1 (laminar) to 0 (rough).

    Source
    ------
    G. G. Hirs, J. Lubrication Technology 95 (1973) 137.

    Examples
    --------
    >>> law = ehd.Hirs()
    >>> law.coefficient, law.exponent
    (0.066, -0.25)
    >>> [round(Re) for Re in law.transition(radius=0.1, clearance=1e-4)]
    [1303, 2606]
    """

    onset: float | None = None
    full: float | None = None
    coefficient: float = 0.066
    exponent: float = -0.25

    def _powers(self) -> np.ndarray:
        power = 1.0 + self.exponent
        z = self.coefficient * 0.5**power
        factors = (1.0 + power) * z / 12.0, z / 12.0, 0.25 * z
        return np.array([(factor, power, 1.0, ROUNDING) for factor in factors])


def check_turbulence(name: str, bearing: Mapping[str, object]) -> None:
    """Raise `InputError` for turbulence with properties that follow the pressure, or with models of laminar flow."""
    oil = bearing["lubricant"]
    others = [f"Lubricant.{law}" for law in FOLLOWING if getattr(oil, law) is not None]
    others += [] if bearing["roughness"] is None else ["JournalBearing.roughness"]
    others += [] if getattr(bearing["thermal"], "conductivity", None) is None else ["FilmEnergy.conductivity"]
    if bearing["turbulence"] is not None and others:
        raise InputError(
            f"{name}.turbulence={type(bearing['turbulence']).__name__}() does not go with {', '.join(others)}: "
            "its Reynolds number takes viscosity and density at ambient pressure, its walls are smooth, and its eddies "
            "carry heat across the film; leave one out."
        )


class TurbulentFlow(LinkLaw):
    """`NgPan` or `Hirs` in scaled form: flux effect and shear factor of one bearing model.

    Parameters
    ----------
    powers : (3, 4) array
        Coefficients of `NgPan` or `Hirs`, see ``_powers`` there.
    transition : (float, float)
        Reynolds numbers between which the film becomes turbulent.
    per_speed : float
        Reynolds number over the scaled speed vx at the clearance and the reference viscosity.

    Attributes
    ----------
    field : Fluidity or None
        Viscosity over the reference, if it varies.
    """

    changes_carriers = False
    depends_on_speed = True

    def __init__(self, powers: np.ndarray, transition: tuple[float, float], per_speed: float) -> None:
        self.powers, self.transition, self.per_speed = powers, transition, per_speed

    def apply(self, flux: LinkFlux, gap_x: np.ndarray, gap_z: np.ndarray, vx: float, vz: float) -> None:
        """Divide the conductances of the links by k / 12 at their gaps (n, m), with their derivatives."""
        one, f = np.ones((1, 1)), self.field
        x, z = (one, one) if f is None else (f.inverse_x, f.inverse_z)
        speed, (law_x, law_z, _) = (self.per_speed, vx), self.powers
        multiply(gap_x, x, *speed, law_x, self.transition, True, flux.gx, flux.gx_h, flux.gx_v)
        multiply(gap_z, z, *speed, law_z, self.transition, True, flux.gz, flux.gz_h, flux.gz_v)

    def factor(
        self, H: np.ndarray, vx: float, ratio_out: np.ndarray, ratio_h_out: np.ndarray, ratio_v_out: np.ndarray
    ) -> None:
        """Set t at the gaps H (n, m), and its derivatives to H and vx."""
        fluid = np.ones((1, 1)) if self.field is None else 1.0 / self.field.ratio
        ratio_out[:] = 1.0
        ratio_h_out[:] = ratio_v_out[:] = 0.0
        speed, out = (self.per_speed, vx), (ratio_out, ratio_h_out, ratio_v_out)
        multiply(H, fluid, *speed, self.powers[2], self.transition, False, *out)


@njit(cache=True)
def excess(Re, power, transition):
    """Return the excess of a law over the laminar value 1 at a Reynolds number above the onset, and its derivative."""
    onset, full = transition
    s = min((Re - onset) / (full - onset), 1.0)
    w, w_R = s * s * s * (10.0 - s * (15.0 - 6.0 * s)), 30.0 * s * s * (1.0 - s) * (1.0 - s) / (full - onset)
    y = power[0] * Re ** power[1]
    y_R = y * power[1] / Re
    y -= power[2]
    root = math.sqrt(y * y + power[3] * power[3])
    if root > 0.0:
        y_R *= 0.5 * (1.0 + y / root)
    y = 0.5 * (y + root)
    return w * y, w_R * y + w * y_R


@njit(cache=True)
def multiply(gap, fluid, per_speed, vx, power, transition, inverse, value, value_h, value_v):
    """Multiply values (n, m) by 1 + `excess`, or divide by it if ``inverse``, in place, with their derivatives to gap
    and vx."""
    n, m = gap.shape
    one = fluid.size == 1
    last, f, f_R = 0.0, 1.0, 0.0
    for i in range(n):
        for j in range(m):
            Re = per_speed * abs(vx) * gap[i, j] * (fluid[0, 0] if one else fluid[i, j])
            if Re <= transition[0]:
                continue
            if Re != last:  # an aligned journal has one gap per column
                e, f_R = excess(Re, power, transition)
                last, f = Re, 1.0 + e
                if inverse:
                    f = 1.0 / f
                    f_R *= -f * f
            by = f_R * Re
            value_h[i, j] = value_h[i, j] * f + value[i, j] * by / gap[i, j]
            value_v[i, j] = value_v[i, j] * f + value[i, j] * by / vx
            value[i, j] *= f
