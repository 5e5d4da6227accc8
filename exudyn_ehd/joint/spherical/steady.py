"""A prescribed position of the ball, without a multibody model."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, cast

import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.joint.balance.limits import advice, refuse_pressed_through, warn_of_overload
from exudyn_ehd.joint.spherical.bearing import SphericalBearing
from exudyn_ehd.joint.spherical.model import PLACE, SIZE, SPIN, VELOCITY, SphericalEvaluation, SphericalModel
from exudyn_ehd.joint.tangent.one_sided import LARGEST_SPREAD
from exudyn_ehd.pictures.records import Target, shown
from exudyn_ehd.status import FilmError, require_type, require_vector

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from matplotlib.projections.polar import PolarAxes

    from exudyn_ehd.joint.audit.audit import Audit


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
    force, torque : (3,) arrays
        On the ball; torque about its centre, N and N m. The socket gets minus the force in the ball's centre and minus
        the torque.
    tangent : (6, 9) array
        Derivative of the force and of the moment about the socket's centre to place, velocity and angular velocity.
        A film that ruptures where the ball moves away has one-sided derivatives at rest: entries are nan where both
        sides of that coordinate differ, by more than 5 % of the largest of their kind.
    minimum_gap, peak_pressure : float
        m, Pa.
    power_loss, contact_load : float
        W that turn into heat, N of the wall in ``force``.
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
    force: np.ndarray
    torque: np.ndarray
    tangent: np.ndarray
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
        # imported here: films need none of it
        from exudyn_ehd.joint.spherical.audit import audit_ball

        return audit_ball(self.bearing, self.motion[None])

    def plot_pressure(self, *, title: str = "", ax: PolarAxes | None = None, path: Target = None) -> Figure:
        """The pressure on the socket, seen along its axis; colatitudes in degrees outwards. See `FilmPictures`."""
        # imported here: matplotlib is only needed for pictures
        from exudyn_ehd.pictures.maps import plot_patch

        return plot_patch(self.phi, self.chi, self.pressure, title=title, ax=ax, path=path)


def _derivatives(found: SphericalEvaluation) -> np.ndarray:
    """Tangent (6, 9); nan where both sides of a film at rest differ."""
    tangent, sides = np.delete(found.tangent(), (3, 7), axis=1), found.sides()
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
    """Film of a ball at a prescribed place and motion in its socket: pressure, force, torque.

    Parameters
    ----------
    bearing : SphericalBearing
    place : (3,) [m]
        The ball's centre in the socket's frame, whose z is the axis of the socket.
    velocity : (3,) [m/s], default (0.0, 0.0, 0.0)
        Velocity of the ball's centre as seen from the socket.
    angular_velocity : (3,) [rad/s], default (0.0, 0.0, 0.0)
        Angular velocity of the ball as seen from the socket.

    Returns
    -------
    SphericalResult

    Raises
    ------
    InputError
        For values that are not numbers.
    FilmError
        If there is no film at this place, or the ball is through its contact by more than the clearance.

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
    model = SphericalModel(bearing)
    found = model.evaluate(motion)
    film = found.film
    if film is None:
        raise FilmError(
            f"{where}: {found.status.name} at place {motion[PLACE]} m, minimum film thickness "
            f"{found.minimum_gap:.3g} m: {advice(found.status, bearing)}"
        )
    sizes = cast(JournalBearing, bearing)
    refuse_pressed_through(sizes, found.minimum_gap, where)
    quantities = found.quantities()
    force, peak = film.wrench[:3], quantities["peak_pressure"]
    warn_of_overload(sizes, peak, float(np.linalg.norm(force)), where)
    return SphericalResult(
        phi=model.grid.x,
        chi=model.patch.chi,
        pressure=film.pressure,
        gap=film.gap,
        unbroken=film.unbroken,
        force=force,
        torque=film.torque,
        tangent=_derivatives(found),
        minimum_gap=quantities["minimum_gap"],
        peak_pressure=peak,
        power_loss=quantities["power_loss"],
        contact_load=quantities["contact_load"],
        bearing=bearing,
        motion=motion,
    )
