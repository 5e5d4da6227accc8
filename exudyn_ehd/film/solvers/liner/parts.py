"""Optional parts of a film on a liner; see `exudyn_ehd.film.solvers.nonlinear`."""

from __future__ import annotations

from typing import NamedTuple

from exudyn_ehd.film.lubricant.density import CompressibleLaw
from exudyn_ehd.film.lubricant.pressure_viscosity import PressureLaw
from exudyn_ehd.film.surfaces.contact import Contact, GapLimiter


class LinerParts(NamedTuple):
    """Optional parts of a film on a liner, None if absent.

    Attributes
    ----------
    contact : Contact or None
        Contact whose pressure acts on the liner, as the film's does.
    limiter : GapLimiter or None
        Limiter of the gap that the film sees; comes with a contact or with flow factors.
    oil : PressureLaw or None
        Law of a viscosity that follows the pressure.
    density : CompressibleLaw or None
        Law of a density that follows the pressure; it is the ``oil`` as well.
    """

    contact: Contact | None
    limiter: GapLimiter | None
    oil: PressureLaw | None
    density: CompressibleLaw | None
