"""Film and tilts of thrust pads that carry a steady axial load, with stiffness and damping.

A pad has the coordinates v = (h, phi_x, phi_y): film thickness at the pivot, m, and rotations of the pad about the
radial and the tangential line through it, rad. Its gap is ``h - phi_x Y + phi_y (X - r_p)`` plus the crown. The film
exerts the axial force F on the collar, and the moments M_x and M_y on the pad about its pivot. With a pad's share W of
the load,

    F(v) = W,   M_x(v) = M_y(v) = 0,

is solved by Newton's method with the exact tangent. Its unknowns are ln h and phi L / h, its residuals ln(F / W) and
M / (F L), with the outer radius L, because plane pads in unbroken films have forces proportional to 1 / h^2 at fixed
phi / h. The forces of small motions are ``Q = -(K v + C dv/dt)`` with K and C (3, 3). J is the tilting inertia, and
S = k + i nu c - nu^2 m for a pivot of stiffness k and damping c under a pad of mass m. The complex stiffness of one pad
under a collar that moves along the axis at the frequency nu is

    Z = Z_f S / (Z_f + S),   Z_f = A_hh - A_h,phi (A_phi,phi - nu^2 J)^-1 A_phi,h,   A = K + i nu C,

and Z_f on a rigid pivot. The pads tilt freely.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cache

import numpy as np

from exudyn_ehd.film.loads import refined_peak
from exudyn_ehd.film.thrust.face import FACE_SIZE, FaceFilm, FaceState
from exudyn_ehd.film.thrust.tilting import TiltingThrustPads
from exudyn_ehd.joint.balance.steady_film import LOAD_TOLERANCE, ROOM
from exudyn_ehd.joint.newton import DampedNewton, SearchState
from exudyn_ehd.joint.step_error import SMALLEST_GAP_SHARE
from exudyn_ehd.pictures.records import shown
from exudyn_ehd.status import FilmError, InputError, Status, require_number

WHERE = "equilibrium"
ALONG = "of TiltingThrustPads it presses the collar onto the pads along the axis."


@dataclass(frozen=True, eq=False, kw_only=True)
class ThrustPadsResult:
    """Result of `equilibrium` for `TiltingThrustPads`; all pads are equal, and forces, flows and losses are their sums.

    Attributes
    ----------
    film_thickness : float
        Film thickness at the pivot, m.
    inclination : (2,) array
        Slopes of the gap at the pivot along the radius, dh / dr, and in the sense of +theta, dh / (r dtheta), rad;
        without the slope of a crown.
    minimum_gap, maximum_gap, peak_pressure : float
        Smallest and largest film thickness, m; peak pressure, Pa.
    power_loss, friction_torque : float
        Power loss, W; torque on the collar about its own axis, positive about +z, N m.
    flows : (4,) array
        Oil that leaves the pads at their leading, trailing, inner and outer edges, m3/s; negative: oil that enters.
        Their sum is 0: the flow at an edge behind a cavity is set to the flow of the film before the cavity. The
        leading edge is that of a positive spin.
    stiffness, damping : float
        Axial stiffness and damping of the collar on pads that tilt freely, N/m and N s/m, at ``frequency``.
    frequency : float
        Size of the speed, rad/s.
    pad_stiffness, pad_damping : (3, 3) arrays
        K and C of one film, for the film thickness at the pivot, m, and rotations of the pad about the radial and the
        tangential line through it, rad; SI units.
    residual, iterations : float, int
        Largest residual of force and moments, over the load and the load times the outer radius; number of films
        solved.
    theta, r : (n,), (m,) arrays
        Grid of a pad: angle from the line through the pivot, rad, and radius, m.
    pressure, gap : (n, m) arrays
        Pressure, Pa (gauge), and film thickness, m.
    bearing : TiltingThrustPads

    Examples
    --------
    After the example of `TiltingThrustPads`:

    >>> rest = ehd.equilibrium(pads, speed=300.0, load=30e3)
    >>> rest
    <ThrustPadsResult: film 57.9 µm at the pivot, minimum 35.3 µm, peak pressure 3.63 MPa, power loss 5.83e+03 W>
    >>> rest.dynamic_stiffness([100.0, 1000.0]).shape  # K + i nu C at these frequencies, rad/s
    (2,)
    """

    film_thickness: float
    inclination: np.ndarray
    minimum_gap: float
    maximum_gap: float
    peak_pressure: float
    power_loss: float
    friction_torque: float
    flows: np.ndarray
    stiffness: float
    damping: float
    frequency: float
    pad_stiffness: np.ndarray
    pad_damping: np.ndarray
    residual: float
    iterations: int
    theta: np.ndarray = field(repr=False)
    r: np.ndarray = field(repr=False)
    pressure: np.ndarray = field(repr=False)
    gap: np.ndarray = field(repr=False)
    bearing: TiltingThrustPads = field(repr=False)

    def __repr__(self) -> str:
        film, gap = shown("length", self.film_thickness), shown("length", self.minimum_gap)
        peak, loss = shown("pressure", self.peak_pressure), shown("power", self.power_loss)
        return f"<ThrustPadsResult: film {film} at the pivot, minimum {gap}, peak pressure {peak}, power loss {loss}>"

    def dynamic_stiffness(self, frequencies: Sequence[float] | np.ndarray) -> np.ndarray:
        """Z = K + i nu C along the axis: the force on the collar is -Z z for a small motion z exp(i nu t).

        Parameters
        ----------
        frequencies : (k,) array
            nu, rad/s (not Hz).

        Returns
        -------
        ndarray (k,)
            Complex, N/m.
        """
        return np.array([axial(self.bearing, self.pad_stiffness, self.pad_damping, float(nu)) for nu in frequencies])


def axial(pads: TiltingThrustPads, K: np.ndarray, C: np.ndarray, nu: float) -> complex:
    """Complex axial stiffness of all pads, N/m, for K and C (3, 3) of one film at the frequency nu, rad/s."""
    A = K + 1j * nu * C
    tilting = A[1:, 1:] - nu**2 * np.diag(pads.pad_inertia)
    Z = A[0, 0] - A[0, 1:] @ np.linalg.solve(tilting, A[1:, 0])
    if pads.pivot_stiffness is not None:
        S = pads.pivot_stiffness + 1j * nu * pads.pivot_damping - nu**2 * pads.pad_mass
        Z = Z * S / (Z + S)
    return complex(pads.pads * Z)


class ThrustPadSearch(DampedNewton[SearchState[FaceState]]):
    """Search for the coordinates x = v of a pad under a collar that turns at a speed.

    The unbalance is (ln(F / W), M_x / (F L), M_y / (F L)).

    Parameters
    ----------
    pads : TiltingThrustPads
    speed : float
        rad/s.
    load : float
        Load of one pad, N.
    """

    tolerance = LOAD_TOLERANCE

    def __init__(self, pads: TiltingThrustPads, speed: float, load: float) -> None:
        self.pads, self.speed, self.load = pads, speed, load
        self.film = FaceFilm(pads, 1, pads.cavitation, pads.lubricant, (0.0, 0.0), True, pads.turbulence)
        # (zeta, bx, by) by v, and force on the collar and moments on the pad by the wrench
        self.by_v = np.array([[1.0, 0.0, -pads.pivot_radius], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
        self.by_wrench = np.zeros((3, 6))
        self.by_wrench[[0, 1, 2, 2], [2, 3, 4, 2]] = 1.0, -1.0, -1.0, -pads.pivot_radius

    def at(self, v: np.ndarray) -> SearchState[FaceState] | None:
        """Return the film at coordinates (3,); None without a film or without an axial force."""
        self.count += 1
        motion = np.zeros(FACE_SIZE)
        motion[:3], motion[6] = self.by_v @ (v - [self.pads.pivot_film, 0.0, 0.0]), self.speed
        found = self.film.evaluate(motion)
        if found.status is not Status.CONVERGED or not found.wrench[2] > 0.0:
            return None
        Q = self.by_wrench @ found.wrench
        L = self.pads.outer_radius
        r = np.array([math.log(Q[0] / self.load), *(Q[1:] / (Q[0] * L))])

        @cache
        def step(resistance: float) -> np.ndarray:
            rows = -self.matrices()[0] / Q[0]
            rows[1:] = rows[1:] / L - np.outer(r[1:], rows[0])
            return np.linalg.solve(rows @ np.column_stack([v, v[0] / L * np.eye(3)[:, 1:]]), -r)

        return SearchState[FaceState](v, r, 1.0, step, found)

    def matrices(self) -> tuple[np.ndarray, np.ndarray]:
        """K and C (3, 3) of the last film."""
        tangent = self.by_wrench @ self.film.tangent()
        return -tangent[:, :3] @ self.by_v, -tangent[:, 3:6] @ self.by_v

    def find(self) -> SearchState[FaceState] | None:
        """Find an equilibrium; None without one.

        Initial guess: a step of the largest size, `ROOM`, has closed the gap at the trailing edge of a parallel pad.
        """
        pads = self.pads
        behind = pads.extent - pads.pivot_angle if self.speed > 0.0 else pads.pivot_angle
        tilt = math.copysign(ROOM / (pads.pivot_radius * math.sin(min(behind, 1.0))), self.speed)
        if (start := self.at(pads.pivot_film * np.array([1.0, tilt, 0.0]))) is None:
            return None
        found, gap = self.search(start), self.film.gap
        # a gap that is even would carry by vanishing, not by a wedge
        carries = self.is_balanced(found, self.tolerance) and np.ptp(gap) / gap.min() > SMALLEST_GAP_SHARE
        return found if carries else None

    def moved(self, state: SearchState[FaceState], step: np.ndarray) -> SearchState[FaceState] | None:
        """Film after a step, which changes the film thickness by a factor of e^2 at most."""
        h, v = state.x[0] * math.exp(float(np.clip(step[0], -2.0, 2.0))), state.x
        return self.at(h * np.array([1.0, *(v[1:] / v[0] + step[1:] / self.pads.outer_radius)]))


def equilibrium_of_pads(
    pads: TiltingThrustPads, speed: float, load: object, others: tuple[object, ...] = ()
) -> ThrustPadsResult:
    """Find film and tilts of pads that carry an axial load, N, under a collar that turns at a speed, rad/s.

    ``others``: arguments of journal bearings; any that is not 0 or None raises `InputError`.
    """
    if any(np.any(np.asarray(other, dtype=object)) for other in others):
        raise InputError(
            f"{WHERE}: tilt, axial_position and axial_load are for a JournalBearing; TiltingThrustPads carry load=..., "
            "one number along the axis, under a collar that does not tilt."
        )
    carried = require_number(f"{WHERE}: load", load, "N", above=0.0, hint=ALONG)  # type: ignore[arg-type]
    search = ThrustPadSearch(pads, speed, carried / pads.pads)
    found = search.find()
    if found is not None and np.linalg.eigvals(search.matrices()[0][1:, 1:]).real.min() > 0.0:
        return _result(search, found)
    raise FilmError(
        f"{WHERE}: no film was found in which TiltingThrustPads carry {carried:.4g} N at {speed:.4g} rad/s with their "
        f"pivot {pads.pivot_angle / pads.extent:.3g} of the extent behind the leading edge of a positive spin: plane "
        "pads carry by a wedge, whose load acts behind the middle; give them a pivot at about 0.6 of the extent in the "
        "sense of rotation, near the middle of the radii, or pads for both senses crown=..., about as deep as the film "
        "is thick."
    )


def _result(search: ThrustPadSearch, found: SearchState[FaceState]) -> ThrustPadsResult:
    """Result at an equilibrium, whose film is the model's last."""
    pads, film, nu = search.pads, search.film, abs(search.speed)
    K, C = search.matrices()
    Z, grid, a = axial(pads, K, C, nu), film.annulus.grid, film.annulus
    (inner, outer), (first, last) = film.flows(), film.flows_along()
    flows = np.array([-first, last, -inner, outer])
    # at the edge behind a cavity the flow is that of the film before it; a full gap would carry more
    flows[int(search.speed > 0.0)] -= flows.sum()
    peak, _, _ = refined_peak(film.fields.P, grid.fixed, grid.x, grid.link_x, grid.z)
    return ThrustPadsResult(
        film_thickness=float(found.x[0]),
        inclination=np.array([found.x[2], -found.x[1]]),
        minimum_gap=found.film.minimum_gap,
        maximum_gap=float(film.gap.max()),
        peak_pressure=film.scales.pressure * peak,
        power_loss=pads.pads * found.film.power_loss,
        friction_torque=-pads.pads * found.film.power_loss / search.speed,
        flows=pads.pads * flows,
        stiffness=Z.real,
        damping=Z.imag / nu,
        frequency=nu,
        pad_stiffness=K,
        pad_damping=C,
        residual=float(np.abs(found.unbalance).max()),
        iterations=search.count,
        theta=grid.x,
        r=a.scale * a.r,
        pressure=film.pressure,
        gap=film.gap,
        bearing=pads,
    )
