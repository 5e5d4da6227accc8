"""What a film on a liner may be made of besides its closure; see `exudyn_ehd.film.solvers.nonlinear`."""

from __future__ import annotations

from typing import NamedTuple

from exudyn_ehd.film.lubricant.density import CompressibleLaw
from exudyn_ehd.film.lubricant.pressure_viscosity import PressureLaw
from exudyn_ehd.film.surfaces.contact import Contact, GapLimiter


class LinerParts(NamedTuple):
    """What takes part, None: absent.

    Attributes
    ----------
    contact : Contact or None
        Its pressure acts on the liner, as the film's does.
    limiter : GapLimiter or None
        Of the gap that the film sees; goes with the contact or with flow factors.
    oil : PressureLaw or None
        Of a viscosity that follows the pressure.
    density : CompressibleLaw or None
        Of a density that does; then it is the ``oil`` as well.
    """

    contact: Contact | None
    limiter: GapLimiter | None
    oil: PressureLaw | None
    density: CompressibleLaw | None
