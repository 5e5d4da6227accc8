"""The seams of a bearing model: what an effect must offer to take part. Absent effects are absent from these tuples.

All fields are (n, m) arrays on the film grid in scaled form as in `exudyn_ehd.joint.solved_film`; contact pressures
and pressure laws are in Pa.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, Protocol

import numpy as np

from exudyn_ehd.film.arcs import LobeTerm
from exudyn_ehd.film.heat.options import Walls
from exudyn_ehd.film.lubricant.density import CompressibleLaw
from exudyn_ehd.film.lubricant.pressure_viscosity import PressureTransform
from exudyn_ehd.film.reynolds.links import FluxEffect, ShearFactor
from exudyn_ehd.film.surfaces.contact import Contact, GapLimiter
from exudyn_ehd.film.surfaces.elastic_liner import ElasticLiner
from exudyn_ehd.joint.solved_film import History, SolvedFilm

__all__ = [
    "Contact",
    "Effects",
    "FluxEffect",
    "GapLimiter",
    "GapTerm",
    "PressureTransform",
    "ShearFactor",
    "ShearProduct",
    "ThermalEffect",
    "Wear",
]


class GapTerm(Protocol):
    """Adds to the gap of the rigid surfaces; must not depend on the motion."""

    def field(self, history: History | None) -> np.ndarray:
        """Scaled addition to the gap at the vertices (n, m) for the history at the start of the step."""


class Wear(GapTerm, Protocol):
    """A depth that the contact pressure adds to the gap, step by accepted step."""

    def grown(self, film: SolvedFilm) -> np.ndarray:
        """Scaled depth (n, m) at the end of a solved film's step."""


class ThermalEffect(Protocol):
    """Temperature of the film: part of the history of accepted steps, and of the viscosity of the next one.

    The film of a step sees the temperature at the step's start, so that force and tangent do not depend on what it
    will become. ``initial_sump``: temperature of the sump at the start of a motion, K; None without one.
    ``initial_leaving`` (2,): what `leaving` returns, at the start of a motion of a bearing with films on end faces.
    """

    initial_sump: float | None
    initial_leaving: np.ndarray | None

    def initial_temperature(self, shape: tuple[int, int]) -> float | np.ndarray:
        """K, at the start of a motion, on a grid of this shape."""

    def set_viscosity(self, temperature: float | np.ndarray) -> float:
        """Bring the effect's viscosity field to a temperature, K.

        Returns the viscosity over the reference that the whole film shares.
        """

    def split(self, temperature: float | np.ndarray) -> tuple[float | np.ndarray, Walls | None]:
        """The film's own part of a temperature, K, as a history has it, and that of walls and surfaces."""

    def viscosity_ratio(self, temperature: np.ndarray | float) -> np.ndarray:
        """Viscosity at a temperature, K, over the reference."""

    def leaving(self, film: SolvedFilm, temperature: float | np.ndarray) -> np.ndarray | None:
        """Temperature (2,), K, of the oil that leaves a film of a temperature at both ends; None where all has one."""

    def advance(self, film: SolvedFilm) -> float | np.ndarray:
        """Temperature at the end of a solved film's step, K."""

    def balance(self, film: SolvedFilm, temperature: Any) -> dict[str, float]:
        """Terms of the heat balance, W, of a step or a steady state that ends at a temperature."""

    def steady_temperature(self, film: SolvedFilm) -> float | np.ndarray:
        """Temperature in balance with the heat of a solved film, K; not finite if there is none."""


def seen_by_faces(film: SolvedFilm | None, heat: ThermalEffect | None) -> History:
    """Memory from which films on end faces take their temperature beside a steady film."""
    if film is None or film.temperature is None or heat is None:
        return History()
    return replace(film.history or History(), leaving=heat.leaving(film, film.temperature))


class ShearProduct:
    """Two shear factors that act together: their product, with the product rule for the derivatives."""

    def __init__(self, first: ShearFactor, second: ShearFactor) -> None:
        self.first, self.second = first, second

    def factor(
        self, H: np.ndarray, vx: float, ratio_out: np.ndarray, ratio_h_out: np.ndarray, ratio_v_out: np.ndarray
    ) -> np.ndarray | None:
        """Product of both factors with its derivatives, as for `ShearFactor`; one of them knows the gradients."""
        other, other_h, other_v = np.empty_like(H), np.empty_like(H), np.empty_like(H)
        slopes = self.first.factor(H, vx, ratio_out, ratio_h_out, ratio_v_out)
        others = self.second.factor(H, vx, other, other_h, other_v)
        if slopes is not None:
            slopes *= other
        elif others is not None:
            slopes = others * ratio_out
        for out, by in ((ratio_h_out, other_h), (ratio_v_out, other_v)):
            out *= other
            out += ratio_out * by
        ratio_out *= other
        return slopes


@dataclass(frozen=True)
class Effects:
    """Effects of a bearing model in addition to the plain film; empty by default.

    Attributes
    ----------
    gap_terms : tuple of GapTerm
    limiter : GapLimiter or None
    contacts : tuple of Contact
    flux : tuple of FluxEffect
    pressure_law : PressureTransform or None
    shear_factor : ShearFactor or None
    thermal : ThermalEffect or None
    density : CompressibleLaw or None
        Density law of a compressible film; then also the ``pressure_law``.
    wear : Wear or None
        Grows with the pressure of the contacts; one of ``gap_terms``.
    liner : ElasticLiner or None
    lobes : LobeTerm or None
        Shape of arcs; one of ``gap_terms``.
    uneven_drag : bool
        True if a pressure gradient pulls one surface more than the other; see `exudyn_ehd.film.surfaces.patir_cheng`.
    """

    gap_terms: tuple[GapTerm, ...] = ()
    limiter: GapLimiter | None = None
    contacts: tuple[Contact, ...] = ()
    flux: tuple[FluxEffect, ...] = ()
    pressure_law: PressureTransform | None = None
    shear_factor: ShearFactor | None = None
    thermal: ThermalEffect | None = None
    density: CompressibleLaw | None = None
    wear: Wear | None = None
    liner: ElasticLiner | None = None
    lobes: LobeTerm | None = None
    uneven_drag: bool = False
