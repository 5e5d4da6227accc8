"""Audit of a ball joint: which effects mattered in its films, and which of them a spherical film leaves out.

Rows, limits and verdicts are those of `exudyn_ehd.joint.audit`. What a `SphericalBearing` can have (a pressure law, a
wall, another closure, a finer grid) is switched, and the ball moved to where the other film carries the same load at
the same velocities. Elasticity, heat, shear thinning, roughness, turbulence and the oil of cavities, which it can't
have, are judged by their numbers alone: such a row has no remedy but what its advice says.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import cast

import numpy as np

from exudyn_ehd.film.surfaces.wall import RegularisedWall
from exudyn_ehd.joint.audit.assumptions import INERTIA, SURELY_FINE
from exudyn_ehd.joint.audit.audit import Audit
from exudyn_ehd.joint.audit.changes import MATTERS
from exudyn_ehd.joint.audit.findings import LIMITS, PLAINLY_NOTHING, Case, Finding, Limit, finding, judged
from exudyn_ehd.joint.audit.oil import piezoviscosity
from exudyn_ehd.joint.audit.ringing import WINDOW, watched
from exudyn_ehd.joint.audit.samples import TENSION, rate_of_squeeze, time_mean
from exudyn_ehd.joint.audit.switches import (
    STEEL,
    TYPICAL_ROUGHNESS,
    TYPICAL_SHEAR_ONSET,
    TYPICAL_TEMPERATURE_COEFFICIENT,
    Switch,
    swift_stieber,
)
from exudyn_ehd.joint.balance.resolution import intervals_at_half
from exudyn_ehd.joint.spherical.bearing import SphericalBearing
from exudyn_ehd.joint.spherical.changes import BallComparison
from exudyn_ehd.joint.spherical.model import PLACE, SPIN, VELOCITY, SphericalEvaluation, SphericalModel
from exudyn_ehd.joint.step_error import enough_steps
from exudyn_ehd.status import FilmError

# Asperities carry from so many roughnesses on; a typical wall begins there, at most at this share of the clearance.
TOUCHING, THIN = 4.0, 0.1
# Intervals across a ball's pressure peak from which on its load is within 1 %.
ACROSS = {"columns": Limit(4.0, "intervals", below=True), "rows": Limit(3.0, "intervals", below=True)}


@dataclass(frozen=True, eq=False, kw_only=True)
class RecordedBall:
    """Accepted steps of a ball joint, as `exudyn_ehd.coupling.spherical.SphericalHistory`; ``motion`` (n, 11)."""

    time: np.ndarray
    motion: np.ndarray
    force: np.ndarray
    minimum_gap: np.ndarray
    peak_pressure: np.ndarray
    power_loss: np.ndarray
    contact_load: np.ndarray
    step_error: np.ndarray

    def worst(self) -> list[int]:
        """Steps, sorted, with the thinnest film, the highest pressure, loss, contact, speed and squeeze."""
        spin = np.linalg.norm(self.motion[:, SPIN], axis=1)
        squeeze = np.array([squeeze_share(motion) for motion in self.motion])
        keys = (-self.minimum_gap, self.peak_pressure, self.power_loss, self.contact_load, spin, squeeze)
        return sorted({int(np.nanargmax(key)) for key in keys if np.any(np.isfinite(key))})


def squeeze_share(motion: np.ndarray) -> float:
    """Share of the squeeze among the sources of Reynolds' equation, 0 to 1: v / (v + |e x w| / 2)."""
    v = float(np.linalg.norm(motion[VELOCITY]))
    total = v + 0.5 * float(np.linalg.norm(np.cross(motion[PLACE], motion[SPIN])))
    return v / total if total > 0.0 else 0.0


def squeeze_rate(bearing: SphericalBearing, motions: np.ndarray, time: np.ndarray | None = None) -> float:
    """`exudyn_ehd.joint.audit.samples.rate_of_squeeze`, 1/s, of motions (n, 11)."""
    place, velocity, spin = (motions[:, part] for part in (PLACE, VELOCITY, SPIN))
    wedge = 0.5 * np.linalg.norm(np.cross(place, spin), axis=1)
    return rate_of_squeeze(place, velocity, wedge, bearing.radial_clearance, time)


@dataclass(frozen=True, kw_only=True)
class _Sample:
    """Numbers of one film: m/s, m3/s, m, Pa, W; ``cavitated`` and ``tension`` are shares of the socket."""

    speed: float
    flow: float
    minimum_gap: float
    peak_pressure: float
    power_loss: float
    contact_share: float
    squeeze_share: float
    squeeze_rate: float
    deflection: float
    cavitated: float
    tension: float
    columns: float
    rows: float


def _sample(model: SphericalModel, found: SphericalEvaluation) -> _Sample:
    film, motion, b, q = found.film, found.motion, model.bearing, found.quantities()
    assert film is not None
    R, c, area, p = b.ball_radius, b.radial_clearance, model.patch.area, film.pressure
    slide, v = R * float(np.linalg.norm(motion[SPIN])), float(np.linalg.norm(motion[VELOCITY]))
    i, j = divmod(int(p.argmax()), p.shape[1])
    half, share = p.shape[0] // 2, area / area.sum()
    # half-spaces of steel under the peak on the circle of the area at half of it, ball and socket
    radius = R * math.sqrt(float(area[p >= 0.5 * p.max()].sum()) / math.pi)
    steel = 4.0 * (1.0 - STEEL["poisson_ratio"] ** 2) / STEEL["youngs_modulus"]
    first, last = b.socket_angles
    load = float(np.linalg.norm(film.wrench[:3]))
    return _Sample(
        speed=slide + v,
        flow=0.5 * slide * c * R * (last - first) + math.pi * R**2 * v,
        minimum_gap=max(found.minimum_gap, 1e-3 * c),
        peak_pressure=q["peak_pressure"],
        power_loss=q["power_loss"],
        contact_share=q["contact_load"] / max(load, q["contact_load"], 1e-300),
        squeeze_share=squeeze_share(motion),
        squeeze_rate=squeeze_rate(b, motion[None]),
        deflection=steel * radius * max(q["peak_pressure"], 0.0),
        cavitated=float(share[~film.unbroken].sum()),
        tension=float(share[p < TENSION].sum()),
        columns=intervals_at_half(np.roll(p[:, j], half - i), half),
        rows=intervals_at_half(p[i], j),
    )


@dataclass(frozen=True, eq=False)
class _BallCase:
    """Subject of the audit of a ball joint, like `exudyn_ehd.joint.audit.findings.Case`."""

    bearing: SphericalBearing
    samples: list[_Sample]
    films: BallComparison
    record: RecordedBall | None

    def largest(self, name: str) -> float:
        return max(getattr(sample, name) for sample in self.samples)

    def smallest(self, name: str) -> float:
        return min(getattr(sample, name) for sample in self.samples)


def audit_ball(bearing: SphericalBearing, motions: Sequence[np.ndarray], record: RecordedBall | None = None) -> Audit:
    """Audit a ball by its films at motions (11,), or at the worst ones of a record.

    Raises
    ------
    FilmError
        If there is no film at any of them.
    """
    model = SphericalModel(bearing)
    motions = motions if record is None else [record.motion[k] for k in record.worst()]
    found = [(motion, model.evaluate(motion)) for motion in motions]
    samples = [_sample(model, film) for _, film in found if film.film is not None]
    if not samples:
        raise FilmError("audit: none of the states has a film that can be evaluated; audit a joint after its run.")
    kept = [motion for motion, film in found if film.film is not None]
    case = _BallCase(bearing, samples, BallComparison(model, kept), record)
    rows = [_surfaces(case), _oil(case), _cavities(case), _flow(case), _numbers_of(case)]
    return Audit(findings=tuple(row for part in rows for row in part))


def _surfaces(case: _BallCase) -> list[Finding]:
    b, thinnest = case.bearing, case.smallest("minimum_gap") / TYPICAL_ROUGHNESS
    gap = f"minimum film thickness / sigma, sigma = {TYPICAL_ROUGHNESS:g} m"
    rows = [
        finding(
            "elasticity",
            "deflection of steel under the peak / minimum film thickness",
            max(s.deflection / s.minimum_gap for s in case.samples),
            None,
            mattering="even steel gives way: a ball's film is one of rigid surfaces, whose peak is too high and whose "
            "minimum film thickness is too small here.",
        ),
        finding(
            "roughness",
            gap,
            thinnest,
            None,
            mattering="the film is that of smooth surfaces: take load and friction as estimates where it is so thin.",
        ),
    ]
    if b.contact is None:
        wall = RegularisedWall(onset=min(TOUCHING * TYPICAL_ROUGHNESS, THIN * b.radial_clearance))
        switch = partial(replace, contact=wall)
        advice = "surfaces touch: contact=RegularisedWall(...)."
        limit = LIMITS["roughness"]
        row = finding("contact", gap, thinnest, False, limit=limit, mattering=advice, switch=cast(Switch, switch))
    else:
        share, alone = case.largest("contact_share"), cast(Switch, partial(replace, contact=None))
        unclear = PLAINLY_NOTHING["contact share"] < share < LIMITS["contact"].value
        row = finding(
            "contact",
            "largest share of the load",
            share,
            True,
            needless="contact carries next to nothing: contact=None.",
            change=case.films.change(alone) if unclear else None,
            switch=alone,
        )
    return [*rows, row]


def _oil(case: _BallCase) -> list[Finding]:
    b, record = case.bearing, case.record
    oil, rows = b.lubricant, [piezoviscosity(cast(Case, case))]
    heat = [(s.power_loss, s.flow) for s in case.samples]
    if record is not None:
        slide = b.ball_radius * np.linalg.norm(record.motion[:, SPIN], axis=1)
        first, last = b.socket_angles
        flows = 0.5 * slide * b.radial_clearance * b.ball_radius * (last - first)
        flows += math.pi * b.ball_radius**2 * np.linalg.norm(record.motion[:, VELOCITY], axis=1)
        heat = [(time_mean(record.time, record.power_loss), time_mean(record.time, flows))]
    rises = [loss / (oil.density * oil.specific_heat * flow) for loss, flow in heat if flow > 0.0]
    rise = max(0.0, *rises) if rises else 0.0
    rows.append(
        finding(
            "heating",
            f"{TYPICAL_TEMPERATURE_COEFFICIENT:.3g} 1/K x rise of {rise:.3g} K in the oil that is moved",
            TYPICAL_TEMPERATURE_COEFFICIENT * rise,
            None,
            mattering="films of balls are isothermal: give the lubricant the viscosity at their temperature.",
        )
    )
    rate = max(s.speed / s.minimum_gap for s in case.samples)
    rows.append(
        finding(
            "shear thinning",
            f"U / minimum film thickness over its onset, {TYPICAL_SHEAR_ONSET:g} 1/s",
            rate / TYPICAL_SHEAR_ONSET,
            None,
            mattering="a multigrade oil thins here: give the lubricant its viscosity at this shear rate.",
        )
    )
    return rows


def _cavities(case: _BallCase) -> list[Finding]:
    closure, cavitated, share = case.bearing.cavitation, case.largest("cavitated"), "cavitated share of the socket"
    rows = [finding("squeeze", "v / (v + |e x w| / 2)", case.largest("squeeze_share"), True)]
    if math.isinf(closure.cavity_pressure):
        advice = "oil does not carry such tension: cavitation=SwiftStieber()."
        what, value = "share of the socket below -1e5 Pa", case.largest("tension")
        return [*rows, finding("cavitation", what, value, False, mattering=advice, switch=swift_stieber)]
    rows.append(finding("cavitation", share, cavitated, True))
    if closure.clips:
        rows.append(
            judged(
                cast(Case, case),
                "rupture",
                share,
                cavitated,
                False,
                swift_stieber,
                mattering="the film breaks where its pressure still falls: cavitation=SwiftStieber() keeps the flow.",
            )
        )
    advice = "cavities keep no oil in a ball's film: where they move or refill, its forces come too early."
    return [*rows, finding("mass conservation", share, cavitated, None, mattering=advice)]


def _flow(case: _BallCase) -> list[Finding]:
    b = case.bearing
    thin, record = b.radial_clearance / b.ball_radius, case.record
    rate = case.largest("squeeze_rate") if record is None else squeeze_rate(b, record.motion, record.time)
    Re = b.lubricant.density * case.largest("speed") * b.radial_clearance / b.lubricant.viscosity
    return [
        finding("turbulence", "Re = rho U c / mu", Re, None, mattering="beyond the laminar film: friction is too low."),
        finding(
            "fluid inertia",
            INERTIA,
            max(Re * thin, b.lubricant.density * rate * b.radial_clearance**2 / b.lubricant.viscosity),
            None,
            mattering="the Reynolds equation leaves the fluid's inertia out: take forces as estimates.",
        ),
    ]


def _numbers_of(case: _BallCase) -> list[Finding]:
    """Grid and time step."""
    rows = [_grid(case, "n_phi", "columns", "grid around"), _grid(case, "n_chi", "rows", "grid along")]
    record = case.record
    if record is None:
        return rows
    if np.any(np.isfinite(record.step_error)):
        needed = enough_steps(record.time, np.zeros_like(record.time), record.step_error)
        rows.append(
            finding(
                "time step",
                "estimated error of the gap / minimum film thickness",
                float(np.nanmax(record.step_error)),
                None,
                mattering=f"the steps are too coarse for the film: take {needed}.",
            )
        )
    watch = watched(record.time, record.force, math.pi * case.bearing.ball_radius**2)
    advice = "forces and pressures jump from step to step: run by ehd.SolveDynamic, with more steps."
    what = f"times within {WINDOW} steps that the force is thrown into alternation"
    return [*rows, finding("ringing", what, float(watch.most), None, mattering=advice)]


def _grid(case: _BallCase, name: str, count: str, effect: str) -> Finding:
    size, value = getattr(case.bearing, name), case.smallest(count)
    indicator = f"intervals across the peak at half its height, {name} = {size}"
    finer = partial(replace, **{name: 2 * size})
    change = None if value > 2.0 * SURELY_FINE * ACROSS[count].value else case.films.change(finer)
    found = replace(finding(effect, indicator, value, None, limit=ACROSS[count]), change=change)
    if change is not None and change.found:
        found = replace(found, matters=change.size > MATTERS)
    if not found.matters:
        return found
    advice = f"the pressure peak is too narrow for the grid: {name}={2 * size}."
    return replace(found, advice=advice, remedy=cast(Switch, finer))
