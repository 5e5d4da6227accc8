"""Film of a ball at a prescribed position, without a multibody model, and the audit of a ball joint.

The audit says which effects mattered in the films of a ball, and which important ones a spherical film omits. Rows,
limits and verdicts are those of `exudyn_ehd.joint.audit`. Options that a `SphericalBearing` has, such as a pressure
law, a wall, another closure or a finer grid, are switched; a search finds the position at which the other film carries
the same load at the same velocities. Effects that it cannot have (elasticity, roughness, shear thinning, turbulence)
are judged by their indicator alone; such a row has advice, but no remedy.
"""

from __future__ import annotations

import contextlib
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import ClassVar, cast

import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.film.heat.options import known_supply
from exudyn_ehd.film.loads import refined_peak
from exudyn_ehd.film.surfaces.contact import RegularisedWall
from exudyn_ehd.joint.audit import effects
from exudyn_ehd.joint.audit.audit import ROWS, AuditRow, audit_of
from exudyn_ehd.joint.audit.case import Case
from exudyn_ehd.joint.audit.findings import LIMITS, Audit, Finding, Limit, judged
from exudyn_ehd.joint.audit.resolution import Resolution, intervals_at_half
from exudyn_ehd.joint.audit.samples import FilmState, RecordedSteps, Sources, squeeze_share
from exudyn_ehd.joint.audit.switches import ROUGH_STEEL, STEEL, VAPOUR_PRESSURE
from exudyn_ehd.joint.balance.limits import (
    no_film,
    require_bearable,
    warn_of_heat,
    warn_of_overload,
)
from exudyn_ehd.joint.solved_film import LARGEST_SPREAD
from exudyn_ehd.joint.spherical.bearing import SphericalBearing
from exudyn_ehd.joint.spherical.model import (
    PLACE,
    SIZE,
    SPIN,
    VELOCITY,
    SphericalEvaluation,
    SphericalModel,
    loads_of,
    steady_film,
)
from exudyn_ehd.joint.step_error import SMALLEST_GAP_SHARE
from exudyn_ehd.pictures.records import Figure, PolarAxes, Target, shown
from exudyn_ehd.status import FilmError, Status, require_type, require_vector

# Gap over the composite roughness below which asperities carry, where a typical wall begins; upper bound of this onset,
# over the clearance.
TOUCHING, THIN = 4.0, 0.1
# Intervals across a ball's pressure peak with which the error of its load is below 1 %. With four times as many, films
# are not compared with those of a finer grid.
ACROSS = {
    "grid around": Limit(4.0, "intervals", below=True, nothing=16.0),
    "grid along": Limit(3.0, "intervals", below=True, nothing=12.0),
}


def audit_ball(bearing: SphericalBearing, motions: np.ndarray, record: RecordedSteps | None = None) -> Audit:
    """Audit a ball by its films at motions (n, 11), or at the worst motions of a joint's record.

    Raises
    ------
    FilmError
        If there is no film at any of them.
    """
    if record is not None:
        # a record has place, velocity and angular velocity without the zeros between them
        motions = np.insert(record.motion[:, :9], [3, 6], 0.0, axis=1)
        record = replace(record, motion=motions, leakage=moved_oil(bearing, motions))
        spin = np.linalg.norm(motions[:, SPIN], axis=1)
        motions = motions[record.extremes(spin, squeeze_share(ball_sources(motions)))]
    model = SphericalModel(bearing)
    states = []
    for motion in motions:
        # `Case` raises an error if no motion has a film
        with contextlib.suppress(FilmError):
            states.append(FilmState(motion, steady_film(model, motion, "audit").solved.history))
    return audit_of(BallCase(model, states, record), BALL_ROWS)


def ball_sources(motions: np.ndarray) -> Sources:
    """Sources of Reynolds' equation of motions (n, 11) of a ball."""
    place, velocity, spin = (motions[None, :, part] for part in (PLACE, VELOCITY, SPIN))
    return place, velocity, 0.5 * np.linalg.norm(np.cross(place, spin), axis=2)


def moved_oil(b: SphericalBearing, motions: np.ndarray) -> np.ndarray:
    """Flow (n,) of the oil that the surfaces of a ball drag along and squeeze out at motions (n, 11), m3/s."""
    first, last = b.socket_angles
    slide, velocity = (np.linalg.norm(motions[:, part], axis=1) for part in (SPIN, VELOCITY))
    dragged = 0.5 * b.ball_radius * slide * b.radial_clearance * b.ball_radius * (last - first)
    return np.asarray(dragged + math.pi * b.ball_radius**2 * velocity)


class BallCase(Case):
    """Films of a ball at the audited motions (11,)."""

    model: SphericalModel
    bearing: SphericalBearing  # type: ignore[assignment]
    # a smaller tolerance than for journals: the force depends only weakly on the position in some directions
    axes, tolerance = 3, 3e-4
    replays = False
    surface, steel = "socket", "steel under the peak"
    omitted: ClassVar[Mapping[str, str]] = {
        "elasticity": "even steel gives way: a ball's film is one of rigid surfaces, whose peak is too high and whose "
        "minimum film thickness is too small here.",
        "roughness": "the film is that of smooth surfaces: take load and friction as estimates where it is so thin.",
        "shear thinning": "a multigrade oil thins here: give the lubricant its viscosity at this shear rate.",
        "turbulence": "beyond the laminar film: friction is too low.",
    }

    def build(self, bearing: SphericalBearing) -> SphericalModel:  # type: ignore[override]
        """Model of another ball."""
        return SphericalModel(bearing)

    def steady(  # type: ignore[override]
        self, other: SphericalModel, mine: FilmState
    ) -> Callable[[np.ndarray], SphericalEvaluation]:
        """Return the function of a motion that evaluates another ball's `steady_film`."""
        return lambda motion: steady_film(other, motion, "audit")

    def sources(self, motions: np.ndarray) -> Sources:
        """Sources of Reynolds' equation by motions (n, 11)."""
        return ball_sources(motions)

    def slide(self, motions: np.ndarray) -> np.ndarray:
        """Size (n,) of the angular velocity of motions (n, 11), rad/s."""
        return np.linalg.norm(motions[:, SPIN], axis=1)

    def turns(self, motions: np.ndarray) -> np.ndarray:
        """Zeros (n,): a ball has no turns to count steps by."""
        return np.zeros(len(motions))

    def own_numbers(  # type: ignore[override]
        self, found: SphericalEvaluation
    ) -> tuple[dict[str, float], Resolution]:
        """Numbers of a film for the audit's rows, and the resolution of its pressure peak by the grid."""
        film, b, motion, area = found.film, self.bearing, found.motion, self.model.patch.area
        assert film is not None
        R, p, share = b.ball_radius, film.pressure, area / area.sum()
        unbroken = self.model.solver.work.active | self.model.grid.fixed
        i, j = divmod(int(p.argmax()), p.shape[1])
        half = p.shape[0] // 2
        around, along = intervals_at_half(np.roll(p[:, j], half - i), half), intervals_at_half(p[i], j)
        # deflection of ball and socket as steel half-spaces, under the peak pressure on a circle with the area of the
        # vertices above half of it
        radius = R * math.sqrt(float(area[p >= 0.5 * p.max()].sum()) / math.pi)
        numbers = {
            "speed": R * float(np.linalg.norm(motion[SPIN])) + float(np.linalg.norm(motion[VELOCITY])),
            "minimum_gap": max(found.minimum_gap, SMALLEST_GAP_SHARE * b.radial_clearance),
            "flow": float(moved_oil(b, motion[None])[0]),
            "viscosity": b.lubricant.viscosity * self.model.viscosity_ratio,
            "rise": 0.0
            if film.temperature is None or b.thermal is None
            else float(film.temperature) - known_supply(b.thermal),
            "cavitated": float(share[~unbroken].sum()),
            "tension": float(share[p < VAPOUR_PRESSURE].sum()),
            "compliance": 4.0 * (1.0 - STEEL["poisson_ratio"] ** 2) / STEEL["youngs_modulus"] * radius,
        }
        return numbers, Resolution(around, along, narrowing=1.0, growth=1.0, wanted=None)

    def compared(self, found: SphericalEvaluation) -> tuple[float, float, float]:  # type: ignore[override]
        """Minimum film thickness, m, refined peak pressure, Pa, and loss, W."""
        assert found.film is not None
        grid, chi = found.model.grid, found.model.patch.chi
        peak = refined_peak(found.film.pressure, grid.fixed, grid.x, grid.link_x, chi)[0]
        return found.minimum_gap, peak, found.quantities()["power_loss"]


def _contact(case: Case) -> Finding:
    if case.bearing.contact is not None:
        return effects.contact(case)
    wall = RegularisedWall(onset=min(TOUCHING * ROUGH_STEEL.composite_roughness, THIN * case.bearing.radial_clearance))
    switch, advice = partial(replace, contact=wall), "surfaces touch: contact=RegularisedWall(...)."
    limit = LIMITS["asperities"]._replace(nothing=None)
    return judged(case, "contact", *effects.thinnest(case), False, switch, limit=limit, mattering=advice)


def _grid(case: Case, effect: str, name: str, seen: str) -> Finding:
    size, value = getattr(case.bearing, name), min(getattr(found, seen) for found in case.resolutions)
    return judged(
        case,
        effect,
        f"intervals across the peak at half its height, {name} = {size}",
        value,
        None,
        partial(replace, **{name: 2 * size}),
        limit=ACROSS[effect],
        mattering=f"the pressure peak is too narrow for the grid: {name}={2 * size}.",
    )


# Rows that apply to journals only, and rows of a ball's audit.
_JOURNALS = ("misalignment", "journal elasticity", "Taylor vortices")
BALL_ROWS: dict[str, AuditRow] = {name: row for name, row in ROWS.items() if name not in _JOURNALS} | {
    "contact": _contact,
    "grid around": partial(_grid, effect="grid around", name="n_phi", seen="columns"),
    "grid along": partial(_grid, effect="grid along", name="n_chi", seen="rows"),
}


@dataclass(frozen=True, eq=False, kw_only=True)
class SphericalResult:
    """Result of `steady_spherical`: one position of the ball; socket's frame, SI units, fields ``[phi, chi]``.

    Attributes
    ----------
    phi, chi : (n,), (m,) arrays
        Grid: angle about the socket's axis and colatitude from it, rad.
    pressure, gap : (n, m) arrays
        Pa (gauge), m.
    unbroken : (n, m) bool array
        True where the film is not cavitated.
    fill : (n, m) array
        Oil over gap with `ElrodAdams`; 1 with other closures, which do not count it.
    force, torque : (3,) arrays
        Force on the ball, N, and torque on it about its centre, N m. On the socket act minus the force, in the ball's
        centre, and minus the torque.
    tangent : (6, 9) array
        Derivative of the force and of the moment about the socket's centre to place, velocity and angular velocity,
        each x, y, z; SI units. At rest a film that ruptures where the ball moves away has one-sided derivatives:
        entries are nan where both sides differ by more than 5 % of the largest entry of their kind.
    temperature : float or None
        Temperature of the film, K; None for an isothermal film.
    minimum_gap, peak_pressure : float
        Minimum film thickness, m; peak pressure, Pa.
    power_loss, contact_load : float
        Power loss, W; force of the contact, N, a part of ``force``.
    bearing : SphericalBearing
    motion : (11,) array
        Place, velocity and angular velocity, as in `exudyn_ehd.joint.spherical.model`.

    Examples
    --------
    After the example of `steady_spherical`:

    >>> film
    <SphericalResult: load 761 N, minimum film thickness 12 µm, peak pressure 2.34 MPa, power loss 76.1 mW>
    """

    phi: np.ndarray
    chi: np.ndarray
    pressure: np.ndarray
    gap: np.ndarray
    unbroken: np.ndarray
    fill: np.ndarray
    force: np.ndarray
    torque: np.ndarray
    tangent: np.ndarray
    temperature: float | None
    minimum_gap: float
    peak_pressure: float
    power_loss: float
    contact_load: float
    bearing: SphericalBearing = field(repr=False)
    motion: np.ndarray = field(repr=False)

    def __repr__(self) -> str:
        load, gap = shown("force", float(np.linalg.norm(self.force))), shown("length", self.minimum_gap)
        peak, loss = shown("pressure", self.peak_pressure), shown("power", self.power_loss)
        return f"<SphericalResult: load {load}, minimum film thickness {gap}, peak pressure {peak}, power loss {loss}>"

    def audit(self) -> Audit:
        """Find the effects that matter in this film, and those of them that the film omits; print it for a table."""
        return audit_ball(self.bearing, self.motion[None])

    def plot_pressure(self, *, title: str = "", ax: PolarAxes | None = None, path: Target = None) -> Figure:
        """Plot the pressure on the socket, seen along its axis; colatitudes in degrees outwards."""
        # imported here: matplotlib is only needed for pictures
        from exudyn_ehd.pictures.maps import plot_patch

        return plot_patch(self.phi, self.chi, self.pressure, title=title, ax=ax, path=path)


def _derivatives(found: SphericalEvaluation) -> np.ndarray:
    """Tangent (6, 9); nan where the one-sided derivatives of a film at rest differ.

    For velocities the oil content is constant, also at velocity 0.
    """
    tangent, sides, model = np.delete(found.tangent(), (3, 7), axis=1), found.sides(), found.model
    kept, T = found.history(), found.solved.temperature
    if kept is not None and kept.void is not None and sides is None and not found.motion[VELOCITY].any():
        held = model.evaluate(found.motion, replace(kept, temperature=T))
        tangent[:, 3:6] = held.tangent()[:, VELOCITY]
    if sides is not None:
        blocks = np.delete(sides, (3, 7), axis=2).reshape(2, 2, 3, 3, 3)
        largest = LARGEST_SPREAD * np.abs(blocks).max(axis=(0, 2, 4), keepdims=True)[0]
        tangent[(np.abs(blocks[0] - blocks[1]) > 2.0 * largest).reshape(6, 9)] = np.nan
    return tangent


def steady_spherical(
    bearing: SphericalBearing,
    *,
    place: Sequence[float] | np.ndarray,
    velocity: Sequence[float] | np.ndarray = (0.0, 0.0, 0.0),
    angular_velocity: Sequence[float] | np.ndarray = (0.0, 0.0, 0.0),
) -> SphericalResult:
    """Compute the film of a ball at a prescribed place and motion in its socket: pressure, force, torque.

    Parameters
    ----------
    bearing : SphericalBearing
    place : (3,) [m]
        The ball's centre in the socket's frame: origin in the socket's centre, z = axis of the socket. The gap must
        stay open, so its length must be below the radial clearance.
    velocity : (3,) [m/s], default (0.0, 0.0, 0.0)
        Velocity of the ball's centre as seen from the socket.
    angular_velocity : (3,) [rad/s], default (0.0, 0.0, 0.0)
        Angular velocity of the ball as seen from the socket.

    The film is a steady one. With `ElrodAdams` and a velocity it is the film at the instant at which a ball at rest
    begins to move: its oil content is that of the steady film at rest, and is constant in ``tangent``. At rest
    this holds for the columns of ``tangent`` that belong to velocities; the others are derivatives of steady films.
    With ``thermal`` the film has the temperature at which heat and cooling are in balance.

    Returns
    -------
    SphericalResult

    Raises
    ------
    InputError
        For values that are not numbers.
    FilmError
        If there is no film at this place, or if the ball penetrates its contact by more than the clearance.

    Examples
    --------
    After the example of `SphericalBearing`:

    >>> film = ehd.steady_spherical(ball, place=(0.0, 0.0, 18e-6), velocity=(0.0, 0.0, 1e-4))
    >>> round(float(film.force[2]), 1)  # N
    -761.2
    """
    where = "steady_spherical"
    require_type(f"{where}: bearing", bearing, SphericalBearing)
    motion = np.zeros(SIZE)
    motion[PLACE] = require_vector(f"{where}: place", place, 3, "m")
    motion[VELOCITY] = require_vector(f"{where}: velocity", velocity, 3, "m/s")
    motion[SPIN] = require_vector(f"{where}: angular_velocity", angular_velocity, 3, "rad/s")
    return result_of(steady_film(SphericalModel(bearing), motion, where), where)


def result_of(found: SphericalEvaluation, where: str) -> SphericalResult:
    """Return the result of an evaluation, the last one of its model; errors in the name of ``where``."""
    film, motion, model, bearing = found.film, found.motion, found.model, found.model.bearing
    if film is None or found.status is not Status.CONVERGED:
        raise FilmError(no_film(found, where))
    quantities, loads, solver, T = found.quantities(), loads_of(film), model.solver, film.temperature
    force, peak = loads.wrench[:3], quantities["peak_pressure"]
    warn_of_overload(cast(JournalBearing, bearing), found.minimum_gap, peak, float(np.linalg.norm(force)), where)
    require_bearable(film, where)
    warn_of_heat(T, film.grid, where)
    return SphericalResult(
        phi=model.grid.x,
        chi=model.patch.chi,
        pressure=film.pressure,
        gap=solver.H * bearing.radial_clearance,
        unbroken=solver.work.active | film.grid.fixed,
        fill=solver.fill.copy() if model.remembers_mass else solver.ones,
        force=force,
        torque=loads.torque,
        tangent=_derivatives(found),
        temperature=None if T is None else float(T),
        minimum_gap=quantities["minimum_gap"],
        peak_pressure=peak,
        power_loss=quantities["power_loss"],
        contact_load=quantities["contact_load"],
        bearing=bearing,
        motion=motion,
    )
