"""The lubricant: viscosity and density at the reference state."""

from __future__ import annotations

from dataclasses import dataclass

from exudyn_ehd.status import require_number


@dataclass(frozen=True, kw_only=True)
class Lubricant:
    """Newtonian lubricant.

    Parameters
    ----------
    viscosity : float
        Dynamic viscosity, Pa s.
    density : float
        kg/m3; only used where a mass or a Reynolds number is reported.
    """

    viscosity: float
    density: float = 870.0

    def __post_init__(self) -> None:
        require_number("Lubricant.viscosity", self.viscosity, "Pa s", above=0.0)
        require_number("Lubricant.density", self.density, "kg/m3", above=0.0)
