"""Elastic liner: a layer on a stiff housing, whose deflection at a point depends on the pressure at that point only.

A layer of thickness t on a stiff housing, pressed by p without sliding sideways
(plane strain in both directions along the surface), deflects by

    delta = K_nu t p / E,    K_nu = (1 + nu)(1 - 2 nu) / (1 - nu),

the Winkler model. It is right for layers thinner than the width of the contact, and wrong for
incompressible layers. `exudyn_ehd.film.solvers.liner.film` solves the film on a liner.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import ClassVar

from exudyn_ehd.status import NOT_NEGATIVE, POSITIVE, Checked


@dataclass(frozen=True, kw_only=True)
class ElasticLiner(Checked):
    """Thin elastic layer on a rigid housing, which deflects where the pressure acts (Winkler elements).

    Use it for soft or thick layers whose deflection reaches a tenth of the minimum film thickness; a housing that
    bends needs a bush with a mesh. Each point deflects outward by ``compliance`` times its own pressure, in one solve
    with the film; ``compliance`` = (1 + nu) (1 - 2 nu) / (1 - nu) t / E.

    Contact pressure deflects the liner too: journals may sink into soft liners, also at their edges, by more than the
    clearance; under `ElrodAdams` such a film can starve. Liners work with every law and effect, but not with the
    reduced films (such as `ShortBearing`). With `BarusPressure` or `RoelandsPressure` the result is the classical
    elastohydrodynamic film, in which high viscosity and deflection increase each other.

    Parameters
    ----------
    thickness : float
        Thickness t, m.
    youngs_modulus : float
        Young's modulus E, Pa.
    poisson_ratio : float, default 0.3
        Poisson's ratio nu, 0 to 0.49: incompressible layers do not deflect point by point.

    Examples
    --------
    >>> b = dict(journal_radius=0.025, length=0.025, radial_clearance=25e-6, lubricant=ehd.Lubricant(viscosity=0.02))
    >>> liner = ehd.ElasticLiner(thickness=0.002, youngs_modulus=3e9, poisson_ratio=0.35)
    >>> f"{liner.compliance:.2g}"  # m/Pa
    '4.2e-13'
    >>> bearing = ehd.JournalBearing(**b, bush=liner)
    """

    thickness: float
    youngs_modulus: float
    poisson_ratio: float = 0.3

    checks: ClassVar = {
        "thickness": POSITIVE,
        "youngs_modulus": POSITIVE,
        "poisson_ratio": partial(
            NOT_NEGATIVE,
            at_most=0.49,
            hint="a nearly incompressible liner does not deflect point by point, take a bush with a mesh.",
        ),
    }

    @property
    def compliance(self) -> float:
        """Deflection per pressure K_nu t / E, m/Pa."""
        nu = self.poisson_ratio
        return (1.0 + nu) * (1.0 - 2.0 * nu) / (1.0 - nu) * self.thickness / self.youngs_modulus
