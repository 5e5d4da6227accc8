"""From a lubricant's laws to the seams of a bearing model."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.film.heat.options import LumpedThermal
from exudyn_ehd.film.lubricant.density import CompressibleLaw
from exudyn_ehd.film.lubricant.lubricant import Lubricant
from exudyn_ehd.joint.heat.temperature import FilmTemperature, LumpedTemperature, ViscosityField
from exudyn_ehd.joint.seams import Effects, PressureLaw, shear_product
from exudyn_ehd.status import InputError


def collect_rheology(bearing: JournalBearing) -> Effects:
    """Laws of the lubricant and the thermal effect of a bearing.

    Raises
    ------
    InputError
        For a thermal effect whose lubricant has no temperature law.
    """
    oil, thermal = bearing.lubricant, bearing.thermal
    effects = Effects(pressure_law=_transform_law(oil))
    if isinstance(effects.pressure_law, CompressibleLaw):
        effects = replace(effects, density=effects.pressure_law)
    if oil.shear_law is not None:
        thinning = oil.shear_law.bound(bearing.journal_radius, bearing.radial_clearance)
        effects = replace(effects, flux=(thinning,), shear_factor=thinning)
    if thermal is None:
        return effects
    if oil.temperature_law is None:
        raise InputError(
            f"JournalBearing.thermal={type(thermal).__name__}(...) needs a lubricant whose viscosity depends on "
            'temperature, got Lubricant.temperature_law=None; name a law or take a named oil, oil("ISO VG 46").'
        )
    if isinstance(thermal, LumpedThermal):
        return replace(effects, thermal=LumpedTemperature(thermal, bearing))
    field = ViscosityField()
    return replace(
        effects,
        flux=(*effects.flux, field),
        shear_factor=shear_product(field, effects.shear_factor),
        thermal=FilmTemperature(thermal, bearing, field),
    )


def compressible_law(lubricant: Lubricant) -> CompressibleLaw | None:
    """The lubricant's density law with its viscosity's pressure law; None for an incompressible one."""
    if lubricant.density_law is None:
        return None
    viscosity = None if lubricant.pressure_law is None else lubricant.pressure_law.bound(lubricant.viscosity)
    return lubricant.density_law.bound(viscosity)


def _transform_law(lubricant: Lubricant) -> PressureLaw | None:
    """The law of pressure, which for a compressible oil holds its density too."""
    density = compressible_law(lubricant)
    if density is not None or lubricant.pressure_law is None:
        return density
    return lubricant.pressure_law.bound(lubricant.viscosity)


def known_pressures(lubricant: Lubricant, boundary: float | np.ndarray, cavity: float) -> tuple[np.ndarray, float]:
    """Prescribed pressures and cavity pressure in the transformed variable, Pa.

    Raises
    ------
    InputError
        For a shear law: a film of any gap has no single sliding speed.
    """
    if lubricant.shear_law is not None:
        raise InputError(
            f"solve_film: the lubricant's shear_law must be None, got {lubricant.shear_law!r}; shear thinning needs "
            "the sliding speed of a JournalBearing (steady)."
        )
    law = _transform_law(lubricant)
    if law is None:
        return np.asarray(boundary), cavity
    return law.transform(np.asarray(boundary, dtype=float)), float(law.transform(np.array([cavity]))[0])


def true_pressure(lubricant: Lubricant, q: np.ndarray, scale: float) -> np.ndarray | None:
    """Pressure (n, m) from the transformed one, both divided by ``scale`` in Pa; None if there is none."""
    law = _transform_law(lubricant)
    if law is None:
        return q
    p, ratio, slope = np.empty_like(q), np.empty_like(q), np.empty_like(q)
    found = law.inverse(q * scale, p, ratio, slope)
    return p / scale if found else None
