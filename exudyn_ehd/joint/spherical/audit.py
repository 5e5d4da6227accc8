"""Audit of a ball joint: which effects mattered in its films, and which of them a spherical film leaves out.

Rows, limits and verdicts are those of `exudyn_ehd.joint.audit`. What a `SphericalBearing` can have (a pressure law, a
wall, another closure, a finer grid) is switched, and the ball moved to where the other film carries the same load at
the same velocities. Elasticity, heat, shear thinning, roughness, turbulence and the oil of cavities, which it can't
have, are judged by their numbers alone: such a row has no remedy but what its advice says.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from typing import cast

import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.film.peak import refined_peak
from exudyn_ehd.film.surfaces.wall import RegularisedWall
from exudyn_ehd.joint.audit import assumptions, indicators, oil, surfaces
from exudyn_ehd.joint.audit.audit import Audit, Kind, audit_states
from exudyn_ehd.joint.audit.changes import STARTS, TOLERANCE, Comparison
from exudyn_ehd.joint.audit.findings import LIMITS, Case, Finding, Limit, finding
from exudyn_ehd.joint.audit.indicators import Indicator
from exudyn_ehd.joint.audit.samples import TENSION, FilmState, RecordedSteps, Sample, rate_of_squeeze
from exudyn_ehd.joint.audit.switches import (
    STEEL,
    TYPICAL_ROUGHNESS,
    TYPICAL_SHEAR_ONSET,
    TYPICAL_TEMPERATURE_COEFFICIENT,
    Switch,
)
from exudyn_ehd.joint.balance.resolution import Resolution, intervals_at_half
from exudyn_ehd.joint.model.rigid import BearingModel, Evaluation
from exudyn_ehd.joint.spherical.bearing import SphericalBearing
from exudyn_ehd.joint.spherical.model import PLACE, SPIN, VELOCITY, SphericalEvaluation, SphericalModel
from exudyn_ehd.status import Status

# Asperities carry from so many roughnesses on; a typical wall begins there, at most at this share of the clearance.
TOUCHING, THIN = 4.0, 0.1
# Intervals across a ball's pressure peak from which on its load is within 1 %.
ACROSS = {"columns": Limit(4.0, "intervals", below=True), "rows": Limit(3.0, "intervals", below=True)}
# Largest step towards the same load, as a share of the minimum film thickness, and largest number of films tried.
STRIDE, MOST_FILMS = 0.3, 30


def audit_ball(bearing: SphericalBearing, motions: Sequence[np.ndarray], record: RecordedSteps | None = None) -> Audit:
    """Audit a ball by its films at motions (11,), or at the worst ones of a record with motions (n, 11).

    Raises
    ------
    FilmError
        If there is no film at any of them.
    """
    if record is not None:
        squeeze = np.array([squeeze_share(motion) for motion in record.motion])
        worst = record.extremes(np.linalg.norm(record.motion[:, SPIN], axis=1), squeeze)
        motions = list(record.motion[worst])
        record = replace(record, leakage=_moved_oil(bearing, record.motion))
    model, states = cast(BearingModel, SphericalModel(bearing)), [FilmState(motion) for motion in motions]
    return audit_states(model, states, record=record, kind=BALLS)


def _moved_oil(b: SphericalBearing, motions: np.ndarray) -> np.ndarray:
    """Flow (n,) that the surfaces of a ball drag along and press aside at motions (n, 11), m3/s."""
    first, last = b.socket_angles
    slide, velocity = (np.linalg.norm(motions[:, part], axis=1) for part in (SPIN, VELOCITY))
    dragged = 0.5 * b.ball_radius * slide * b.radial_clearance * b.ball_radius * (last - first)
    return np.asarray(dragged + math.pi * b.ball_radius**2 * velocity)


def _sources(motions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Amplitudes (n,) of the squeeze and of the wedge among the sources of Reynolds' equation, m/s."""
    wedge = 0.5 * np.linalg.norm(np.cross(motions[:, PLACE], motions[:, SPIN]), axis=1)
    return np.linalg.norm(motions[:, VELOCITY], axis=1), wedge


def squeeze_share(motion: np.ndarray) -> float:
    """Share of the squeeze among the sources of Reynolds' equation, 0 to 1: v / (v + |e x w| / 2)."""
    squeeze, wedge = (float(source[0]) for source in _sources(motion[None]))
    return squeeze / (squeeze + wedge) if squeeze + wedge > 0.0 else 0.0


def squeeze_rate(bearing: SphericalBearing, motions: np.ndarray, time: np.ndarray | None = None) -> float:
    """`exudyn_ehd.joint.audit.samples.rate_of_squeeze`, 1/s, of motions (n, 11)."""
    wedge = _sources(motions)[1]
    return rate_of_squeeze(motions[:, PLACE], motions[:, VELOCITY], wedge, bearing.radial_clearance, time)


def _sample(model: BearingModel, state: FilmState, record: RecordedSteps | None) -> Sample | None:
    """Evaluate a state and read its numbers; None if there is no film."""
    ball = cast(SphericalModel, model)
    found = ball.evaluate(state.motion)
    film, motion, b, q = found.film, found.motion, ball.bearing, found.quantities()
    if film is None:
        return None
    R, area, p = b.ball_radius, ball.patch.area, film.pressure
    i, j = divmod(int(p.argmax()), p.shape[1])
    half, share = p.shape[0] // 2, area / area.sum()
    # half-spaces of steel under the peak on the circle of the area at half of it, ball and socket
    radius = R * math.sqrt(float(area[p >= 0.5 * p.max()].sum()) / math.pi)
    steel = 4.0 * (1.0 - STEEL["poisson_ratio"] ** 2) / STEEL["youngs_modulus"]
    columns, rows = intervals_at_half(np.roll(p[:, j], half - i), half), intervals_at_half(p[i], j)
    return Sample(
        speed=R * float(np.linalg.norm(motion[SPIN])) + float(np.linalg.norm(motion[VELOCITY])),
        minimum_gap=max(found.minimum_gap, 1e-3 * b.radial_clearance),
        peak_pressure=q["peak_pressure"],
        load=float(np.linalg.norm(film.wrench[:3])),
        contact_load=q["contact_load"],
        power_loss=q["power_loss"],
        flow=float(_moved_oil(b, motion[None])[0]),
        viscosity=b.lubricant.viscosity,
        cavitated=float(share[~film.unbroken].sum()),
        tension=float(share[p < TENSION].sum()),
        squeeze_share=squeeze_share(motion),
        squeeze_rate=squeeze_rate(b, motion[None]),
        deflection=steel * radius * max(q["peak_pressure"], 0.0),
        resolution=Resolution(columns, rows, narrowing=1.0, growth=1.0, wanted=None),
    )


class BallComparison(Comparison):
    """Films of a ball at the audited states, to compare others with."""

    axes, surface = 3, "socket"

    def build(self, bearing: JournalBearing) -> BearingModel:
        """Model of another ball."""
        return cast(BearingModel, SphericalModel(cast(SphericalBearing, bearing)))

    def spin(self, motions: np.ndarray) -> np.ndarray:
        """Zeros: a ball has no turns to count steps by."""
        return np.zeros(len(motions))

    def squeeze_rate(self, motions: np.ndarray, time: np.ndarray) -> float:
        """`exudyn_ehd.joint.audit.samples.rate_of_squeeze`, 1/s, of a run's motions (n, 11)."""
        return squeeze_rate(cast(SphericalBearing, self.model.bearing), motions, time)

    def force_unit(self, motion: np.ndarray) -> float:
        """Unit of the film's force at a motion, of spin and squeeze, N."""
        ball = cast(SphericalModel, self.model)
        squeeze = float(np.linalg.norm(motion[VELOCITY])) / ball.bearing.radial_clearance
        return ball.force_scale * (float(np.linalg.norm(motion[SPIN])) + squeeze)

    def numbers(self, evaluation: Evaluation) -> tuple[float, float, float]:
        """Minimum film thickness, m, refined peak pressure, Pa, and loss, W."""
        found = cast(SphericalEvaluation, evaluation)
        assert found.film is not None
        model, quantities = found.model, found.quantities()
        peak = refined_peak(found.film.pressure, model.grid.fixed, model.grid.x, model.patch.chi, True)[0]
        return found.minimum_gap, peak, quantities["power_loss"]

    def same_load(self, other: BearingModel, mine: FilmState, force: np.ndarray) -> tuple[float, Evaluation | None]:
        """Load of another ball at a state, N, nan without a film, and its film with this force; None without one."""
        found = _same_load(cast(SphericalModel, other), mine.motion, force)
        load = float(np.linalg.norm(other.evaluate(mine.motion).wrench[:3]))
        return load, cast("Evaluation | None", found)


def _same_load(model: SphericalModel, motion: np.ndarray, force: np.ndarray) -> SphericalEvaluation | None:
    """The film with this force, by Newton's method for the ball's place; None if it is not found."""
    limit, least = TOLERANCE * float(np.linalg.norm(force)), TOLERANCE * model.bearing.radial_clearance
    for start in STARTS:
        place, found = motion[PLACE] * start, None
        step, error = np.zeros(3), math.inf
        for _ in range(MOST_FILMS):
            trial = motion.copy()
            trial[PLACE] = place + step
            new = model.evaluate(trial)
            left = force - new.wrench[:3]
            size = float(np.linalg.norm(left))
            if new.status is not Status.CONVERGED or size > error:
                if found is None or np.linalg.norm(step) < least * TOLERANCE:
                    break
                step = 0.5 * step
                continue
            place, found, error = trial[PLACE], new, size
            if error <= limit:
                return found
            step, *_ = np.linalg.lstsq(found.tangent()[:3, PLACE], left, rcond=1e-9)
            step *= min(1.0, STRIDE * max(found.minimum_gap, least) / max(float(np.linalg.norm(step)), 1e-300))
    return None


def _elasticity(case: Case) -> Finding:
    return finding(
        "elasticity",
        "deflection of steel under the peak / minimum film thickness",
        max(s.deflection / s.minimum_gap for s in case.samples),
        None,
        mattering="even steel gives way: a ball's film is one of rigid surfaces, whose peak is too high and whose "
        "minimum film thickness is too small here.",
    )


def _roughness(case: Case) -> Finding:
    advice = "the film is that of smooth surfaces: take load and friction as estimates where it is so thin."
    return finding("roughness", *_thinnest(case), None, mattering=advice)


def _thinnest(case: Case) -> tuple[str, float]:
    """Minimum film thickness over a typical roughness, in words and as a number."""
    text = f"minimum film thickness / sigma, sigma = {TYPICAL_ROUGHNESS:g} m"
    return text, case.smallest("minimum_gap") / TYPICAL_ROUGHNESS


def _contact(case: Case) -> Finding:
    if case.bearing.contact is not None:
        return surfaces.contact(case)
    wall = RegularisedWall(onset=min(TOUCHING * TYPICAL_ROUGHNESS, THIN * case.bearing.radial_clearance))
    switch, advice = partial(replace, contact=wall), "surfaces touch: contact=RegularisedWall(...)."
    limit = LIMITS["roughness"]
    return finding("contact", *_thinnest(case), False, limit=limit, mattering=advice, switch=cast(Switch, switch))


def _heating(case: Case) -> Finding:
    rise = oil.temperature_rise(case)
    return finding(
        "heating",
        f"{TYPICAL_TEMPERATURE_COEFFICIENT:.3g} 1/K x rise of {rise:.3g} K in the oil that is moved",
        TYPICAL_TEMPERATURE_COEFFICIENT * rise,
        None,
        mattering="films of balls are isothermal: give the lubricant the viscosity at their temperature.",
    )


def _shear_thinning(case: Case) -> Finding:
    return finding(
        "shear thinning",
        f"U / minimum film thickness over its onset, {TYPICAL_SHEAR_ONSET:g} 1/s",
        max(s.speed / s.minimum_gap for s in case.samples) / TYPICAL_SHEAR_ONSET,
        None,
        mattering="a multigrade oil thins here: give the lubricant its viscosity at this shear rate.",
    )


def _squeeze(case: Case) -> Finding:
    return finding("squeeze", "v / (v + |e x w| / 2)", case.largest("squeeze_share"), True)


def _mass_conservation(case: Case) -> Finding | None:
    if math.isinf(case.bearing.cavitation.cavity_pressure):
        return None
    advice = "cavities keep no oil in a ball's film: where they move or refill, its forces come too early."
    share = "cavitated share of the socket"
    return finding("mass conservation", share, case.largest("cavitated"), None, mattering=advice)


def _turbulence(case: Case) -> Finding:
    advice = "beyond the laminar film: friction is too low."
    return finding("turbulence", "Re = rho U c / mu", assumptions.reynolds(case), None, mattering=advice)


def _grid(case: Case, name: str, count: str, effect: str) -> Finding:
    size, value = getattr(case.bearing, name), min(getattr(s.resolution, count) for s in case.samples)
    indicator = f"intervals across the peak at half its height, {name} = {size}"
    finer = cast(Switch, partial(replace, **{name: 2 * size}))
    change = None if value > 2.0 * assumptions.SURELY_FINE * ACROSS[count].value else case.films.change(finer)
    advice = f"the pressure peak is too narrow for the grid: {name}={2 * size}."
    limit = ACROSS[count]
    return finding(effect, indicator, value, None, limit=limit, mattering=advice, change=change, switch=finer)


_ROWS: tuple[Callable[[Case], Finding | None], ...] = (
    _elasticity,
    _roughness,
    _contact,
    oil.piezoviscosity,
    _heating,
    _shear_thinning,
    _squeeze,
    indicators.cavitation,
    indicators.rupture,
    _mass_conservation,
    _turbulence,
    assumptions.inertia,
    partial(_grid, name="n_phi", count="columns", effect="grid around"),
    partial(_grid, name="n_chi", count="rows", effect="grid along"),
    assumptions.time_step,
    assumptions.ringing,
)
BALLS = Kind(_sample, BallComparison, tuple(map(Indicator, _ROWS)))
