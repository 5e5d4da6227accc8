"""Numbers of one evaluated film that the rows of an audit read."""

from __future__ import annotations

import math

import numpy as np

from exudyn_ehd.joint.audit.samples import RecordedSteps, tilt_loss
from exudyn_ehd.joint.audit.switches import STEEL
from exudyn_ehd.joint.model.rigid import BearingModel, Evaluation
from exudyn_ehd.joint.solved_film import SolvedFilm

# Gauge pressure below which oil at ambient pressure would have to carry tension, Pa.
TENSION = -1e5
# Radial deflection of a steel ring under the peak pressure, over R p / E; half of it under a uniform one.
RING_COMPLIANCE = 0.7


def film_numbers(model: BearingModel, evaluation: Evaluation) -> dict[str, float]:
    """Numbers of a film, besides those that its quantities and its motion give.

    Returns
    -------
    dict
        ``speed`` (sliding speed of the surfaces, m/s), ``minimum_gap`` (m), ``flow``
        (m3/s, out of the ends or out of the supply, the larger one), ``viscosity`` (smallest in the film at ambient
        pressure, Pa s), ``rise`` (K, largest temperature of the film above that of the supply; 0 for an isothermal
        film), ``to_bush`` and ``to_journal`` (shares of the film's heat that walls take up), ``cavitated`` and
        ``tension`` (shares of the bore), ``tilt_loss``, ``deflection`` and ``shape`` (largest deflection of a flexible
        surface and largest departure of the surfaces from cylinders, m), ``compliance`` (deflection of steel around the
        film over the peak pressure, m/Pa).
    """
    film = evaluation.film
    assert film is not None
    q, s, g, b, w = evaluation.quantities(), film.solver, film.grid, model.bearing, film.journal
    weight = g.weight / g.weight.sum()
    unbroken = s.fill >= 1.0 if s.closure.conserves_mass else s.work.active | g.fixed
    to_bush, to_journal = _wall_shares(model, film)
    return {
        "speed": math.hypot(g.reference_length * w.omega, w.axial_speed),
        "minimum_gap": max(q["minimum_gap"], 1e-6 * b.radial_clearance),
        "flow": max(q["leakage"], q.get("supply_flow", 0.0), 0.0),
        "viscosity": _smallest_viscosity(film),
        "rise": 0.0 if b.thermal is None else q["peak_temperature"] - b.thermal.supply_temperature,
        "to_bush": to_bush,
        "to_journal": to_journal,
        "cavitated": float(np.sum(weight[~unbroken])),
        "tension": float(np.sum(weight[film.oil.P * film.scales.pressure < TENSION])),
        "tilt_loss": float(tilt_loss(b, w.motion[None])[0]),
        "deflection": q.get("bore_displacement", 0.0),
        "compliance": RING_COMPLIANCE * b.journal_radius / STEEL["youngs_modulus"],
        "shape": _shape(film),
    }


def recorded_numbers(record: RecordedSteps, k: int) -> dict[str, float]:
    """Numbers of a recorded step in place of those of its film, whose bore is settled and not in motion."""
    return {
        "minimum_gap": max(float(record.minimum_gap[k]), 1e-9 * float(np.max(record.minimum_gap))),
        "peak_pressure": float(record.peak_pressure[k]),
        "load": math.hypot(record.force[k, 0], record.force[k, 1]),
        "contact_load": float(record.contact_load[k]),
        "power_loss": float(record.power_loss[k]),
        "deflection": float(record.bore_displacement[k]),
    }


def _wall_shares(model: BearingModel, film: SolvedFilm) -> tuple[float, float]:
    """Shares of a film's heat that enter a bush and a journal that conduct, at the temperatures of the step's start."""
    thermal = model.effects.thermal
    if thermal is None or film.walls is None or film.temperature is None:
        return 0.0, 0.0
    balance = thermal.balance(film, film.walls.behind(film.temperature))
    heat = max(balance["heat_in"], 1e-300)
    return balance["bush"] / heat, balance["journal"] / heat


def _smallest_viscosity(film: SolvedFilm) -> float:
    """Reference viscosity of the film, thinned by shear and heat but not thickened by pressure, Pa s."""
    b, ratio = film.parts.bearing, film.oil.ratio
    viscosity = film.scales.pressure * b.radial_clearance**2 / (12.0 * b.journal_radius**2)
    return viscosity * (1.0 if ratio is None else min(1.0, float(ratio.min())))


def _shape(film: SolvedFilm) -> float:
    """Largest height of profile and wear, of the undeformed surfaces, m."""
    if film.extra is None or not film.extra.surfaces:
        return 0.0
    return float(np.ptp(np.sum(film.extra.surfaces, axis=0))) * film.parts.bearing.radial_clearance
