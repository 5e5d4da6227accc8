"""Films on both end faces of a joint as a pure function of the journal's motion.

The motion (11,) is that of `exudyn_ehd.joint.solved_film` followed by the axial position z of the journal's centre, the
point of its axis that lies at O in the reference configuration. The collars are planes perpendicular to the journal's
axis at fixed distances from the centre. The axis is at (x, y) in the mid-plane and at e = (x, y) + (bx, by) z_f at a
face, z_f = +-L/2. A collar crosses the bearing's axis at the distance ``zeta = z + bx x + by y`` from its middle
position and slides there with ``u = de/dt - omega e_z x e``. Terms of second order in the tilt, clearance squared over
length, are omitted.

Between parallel planes that are at rest along the axis the film has its cavity pressure. A film that ruptures then has
one-sided derivatives only: it carries where its gap closes. The tangent there is the mean of both sides of every
coordinate. For the axial position midway between two equal faces, and for tilts at any position, both sides are equal:
about half of an unbroken film.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.film.cavitation.closures import place_line
from exudyn_ehd.film.heat.options import known_supply
from exudyn_ehd.film.thrust.face import FACE_SIZE, FaceFilm, FaceState
from exudyn_ehd.joint.heat.temperature import OilTemperature, viscosity_ratio
from exudyn_ehd.joint.solved_film import BESIDE, LARGEST_SPREAD, MOTION_SIZE, FacesHeat, History, SolvedFilm
from exudyn_ehd.status import ROUNDING, FilmError, Status

PLACE = MOTION_SIZE
"""Index of the axial position in the motion, the last one."""


@dataclass(frozen=True, eq=False)
class ThrustEvaluation:
    """One evaluation of the films on end faces.

    Attributes
    ----------
    status : Status
        The worst status of the faces.
    motion : (11,) array
    wrench : (6,) array
        Force (N) and moment about O (Nm) on the journal, joint frame; nan unless converged.
    states : tuple of FaceState
        State of every face, the lower one first.
    """

    status: Status
    motion: np.ndarray
    wrench: np.ndarray
    states: tuple[FaceState, ...]
    model: ThrustModel
    serial: int

    @property
    def minimum_gap(self) -> float:
        """Smallest gap of all faces, m."""
        return min(state.minimum_gap for state in self.states)

    def tangent(self) -> np.ndarray:
        """d wrench / d motion (6, 11), exact; it must be called before the model's next evaluation."""
        if self.serial != self.model.serial:
            raise RuntimeError("ThrustEvaluation.tangent: the model has evaluated another state since.")
        if not np.isfinite(self.wrench.sum()):
            return np.full((6, PLACE + 1), np.nan)
        out = np.zeros((6, PLACE + 1))
        for face in self.model.faces:
            height, own = self.model.height(face), face.tangent()
            own += self.model.change_at_rest(face) if is_at_rest(face) else 0.0
            out += about_origin(own, height) @ face_motion_map(self.motion, height)
        return out

    def axial_damping(self) -> float:
        """Axial damping -dF/dw, N s/m; nan for planes at rest if it differs between both directions of motion."""
        damping = -float(self.tangent()[2, 9])
        uneven = sum(face.side * float(face.tangent()[2, 3]) for face in self.model.faces if is_at_rest(face))
        return math.nan if abs(uneven) > 2.0 * LARGEST_SPREAD * damping else damping

    def heat(self) -> FacesHeat:
        """Heat of all faces and the oil that they take in; it must be called before the model's next evaluation."""
        heat, inner, outer = 0.0, np.zeros(2), 0.0
        for face in self.model.faces:
            own, inner[(face.side + 1) // 2], back = face.heat()
            heat, outer = heat + own, outer + back
        return FacesHeat(heat, inner, outer)

    def require_film(self, where: str) -> None:
        """Raise `FilmError` in the name of ``where`` if a face has no film."""
        if self.status is not Status.CONVERGED:
            raise FilmError(no_film(self, where))

    def quantities(self) -> Mapping[str, float]:
        """Scalars by their names in histories, SI units.

        Force and torque act on the journal, along the bearing's axis and about it. The power loss becomes heat and work
        on the oil.
        """
        return {
            "axial_position": float(self.motion[PLACE]),
            "thrust_force": float(self.wrench[2]),
            "thrust_minimum_gap": self.minimum_gap,
            "thrust_peak_pressure": max(face.peak_pressure for face in self.states),
            "thrust_torque": float(self.wrench[5]),
            "thrust_power_loss": sum(face.power_loss for face in self.states),
            "thrust_contact_load": sum(face.contact_load for face in self.states),
        }


class ThrustModel:
    """Films on the end faces of a bearing that has ``thrust``.

    Parameters
    ----------
    bearing : JournalBearing
    """

    def __init__(self, bearing: JournalBearing) -> None:
        faces = bearing.thrust
        assert faces is not None
        self.bearing, self.serial = bearing, 0
        closure = place_line(faces.cavitation or bearing.cavitation, True)
        inner = bearing.end_pressures if faces.inner_pressures is None else faces.inner_pressures
        self.faces = [
            FaceFilm(
                faces,
                side,
                closure,
                bearing.lubricant,
                (inner[k], faces.outer_pressures[k]),
                bearing.squeeze,
                bearing.turbulence,
            )
            for k, (side, present) in enumerate(((-1, faces.lower), (1, faces.upper)))
            if present
        ]
        # changes of the tangent of faces at rest, stored because faces of aligned journals stay at rest
        self._changes: dict[tuple[float, ...], np.ndarray] = {}

    def height(self, face: FaceFilm) -> float:
        """z of a face, m."""
        return 0.5 * face.side * self.bearing.length

    def viscosities(self, history: History | None) -> np.ndarray:
        """Viscosity (2,) of the lower and of the upper face over that of the lubricant, by the bore film's history.

        If the bore's film has one temperature, the faces have the same. With a temperature field, a face has the
        temperature of the oil that leaves the bore at its end.
        """
        thermal, T = self.bearing.thermal, None
        if thermal is None:
            return np.ones(2)
        if history is not None:
            T = history.temperature if history.leaving is None else history.leaving
        if T is None or np.ndim(T) == 2:
            T = known_supply(thermal) if thermal.initial_temperature is None else thermal.initial_temperature
        return np.broadcast_to(viscosity_ratio(self.bearing.lubricant, np.asarray(T)), 2)

    def evaluate(self, motion: np.ndarray, history: History | None = None) -> ThrustEvaluation:
        """Evaluate the films at a motion (11,), with the bore film's history at the start of the step."""
        self.serial += 1
        motion = np.array(motion, dtype=float)
        if not np.isfinite(motion.sum()):
            state = FaceState(Status.NOT_FINITE, np.full(6, np.nan), np.nan)
            return ThrustEvaluation(state.status, motion, state.wrench, (state,), self, self.serial)
        ratios = self.viscosities(history)
        states = tuple(
            face.evaluate(face_motion(motion, self.height(face)), float(ratios[(face.side + 1) // 2]))
            for face in self.faces
        )
        wrench = np.zeros(6)
        for face, state in zip(self.faces, states, strict=True):
            wrench += about_origin(state.wrench, self.height(face))
        status = max((state.status for state in states), key=lambda found: found.value)
        return ThrustEvaluation(status, motion, wrench, states, self, self.serial)

    def change_at_rest(self, face: FaceFilm) -> np.ndarray:
        """Difference (6, 9) between the mean of one-sided derivatives and the tangent of the unbroken film.

        It is computed for a collar centred on the bearing's axis; its eccentricity would change it by clearance over
        radius.
        """
        motion, key = face.motion, (face.side, float(face.motion[0]), float(face.motion[6]), face.ratio)
        if key not in self._changes:
            still, spin = motion * np.eye(FACE_SIZE)[[0, 6]].sum(axis=0), abs(key[2]) or 1.0
            lengths = 1.0 / face.by_place
            steps = BESIDE * np.array([0.0, *lengths[1:], *(spin * lengths), spin, 0.0, 0.0])
            sides = quotients(lambda there: face.evaluate(there, key[3]).wrench, still, steps)
            face.evaluate(still, key[3])
            change = np.where(steps > 0.0, sides.mean(axis=0) - face.tangent(), 0.0)
            face.evaluate(motion, key[3])
            self._changes = {key: change} | {k: v for k, v in self._changes.items() if k[0] != face.side}
        return self._changes[key]


def faces_of(bearing: JournalBearing) -> ThrustModel | None:
    """Model of the films on the end faces of a bearing; None without ``thrust``."""
    return None if bearing.thrust is None else ThrustModel(bearing)


def quotients(wrench: Callable[[np.ndarray], np.ndarray], motion: np.ndarray, steps: np.ndarray) -> np.ndarray:
    """One-sided derivatives (2, 6, n) of a wrench to those entries of a motion (n,) that have a step, from both sides.

    Steps are `BESIDE` times a typical size of the entry. Changes of second order are set to zero.
    """
    out, middle = np.zeros((2, 6, motion.size)), wrench(motion)
    # above the square of the step and the round-off: larger changes are of first order in the step
    least = 10.0 * BESIDE**2 * np.abs(middle).max()
    for k in np.flatnonzero(steps):
        for side, step in zip(out, (steps[k], -steps[k]), strict=True):
            change = wrench(motion + step * np.eye(motion.size)[k]) - middle
            side[:, k] = np.where(np.abs(change) > least, change, 0.0) / step
    return out


def seen_by_faces(film: SolvedFilm | None, heat: OilTemperature | None) -> History:
    """Return the history of a steady film that sets the temperature of the films on end faces."""
    if film is None or film.temperature is None or heat is None:
        return History()
    return replace(film.history or History(), leaving=heat.leaving(film, film.temperature))


def is_at_rest(face: FaceFilm) -> bool:
    """Return whether a film that may rupture has no pressure, between parallel surfaces that are at rest."""
    source = ROUNDING * abs(float(face.motion[6]))
    if np.abs(face.pose[1:]).max() > ROUNDING or np.abs(face.rate).max() > source:
        return False
    cavity = float(face.known[2])
    return math.isfinite(cavity) and bool(np.abs(face.solver.pressure - cavity).max() <= source + 1e-12 * abs(cavity))


def no_film(found: ThrustEvaluation, where: str) -> str:
    """Return the message for an evaluation without a film at a given position; it begins with ``where``."""
    _, _, bx, by, *_, place = found.motion
    return (
        f"{where}: {found.status.name} on a thrust face at the axial position {place:.4g} m, tilt = "
        f"({bx:.3g}, {by:.3g}), smallest gap {found.minimum_gap:.3g} m: give the faces "
        "contact=RegularisedWall(onset=...), pads that carry (profile=TaperLand(...)), more clearance or less load, or "
        "take smaller steps."
    )


def face_motion(motion: np.ndarray, height: float) -> np.ndarray:
    """Motion (9,) of the collar at a face at z = ``height``, as in `exudyn_ehd.film.thrust.face`."""
    x, y, bx, by, x_t, y_t, bx_t, by_t, omega, w, z = motion.tolist()
    zeta, zeta_t = z + bx * x + by * y, w + bx_t * x + bx * x_t + by_t * y + by * y_t
    u_x, u_y = x_t + bx_t * height + omega * (y + by * height), y_t + by_t * height - omega * (x + bx * height)
    return np.array([zeta, bx, by, zeta_t, bx_t, by_t, omega, u_x, u_y])


def face_motion_map(motion: np.ndarray, height: float) -> np.ndarray:
    """Derivative (9, 11) of `face_motion` to the motion."""
    x, y, bx, by, x_t, y_t, bx_t, by_t, omega, _, _ = motion.tolist()
    out = np.zeros((FACE_SIZE, PLACE + 1))
    out[0, :4], out[0, PLACE] = (bx, by, x, y), 1.0
    out[1, 2] = out[2, 3] = out[4, 6] = out[5, 7] = out[6, 8] = 1.0
    out[3, :10] = bx_t, by_t, x_t, y_t, bx, by, x, y, 0.0, 1.0
    out[7, [1, 3, 4, 6, 8]] = omega, omega * height, 1.0, height, y + by * height
    out[8, [0, 2, 5, 7, 8]] = -omega, -omega * height, 1.0, height, -x - bx * height
    return out


def about_origin(wrench: np.ndarray, height: float) -> np.ndarray:
    """Convert a wrench (6, ...) about the face's centre at z = ``height`` to one about O."""
    out = wrench.copy()
    out[3] -= height * wrench[1]
    out[4] += height * wrench[0]
    return out
