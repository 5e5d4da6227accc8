"""Model from a bearing's description, and compilation of its kernels before a study or a run.

A description without an impedance map makes a model that solves films: of rigid surfaces, or a flexible one for a bush,
an elastic journal or both. The modes of an `FEJournal` turn with the journal under the film, see
`exudyn_ehd.solid.turning_journal`.

An impedance map makes a model of aligned plain bearings that reads forces from the map. Its interface is that of
`exudyn_ehd.joint.model.rigid`.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from exudyn_ehd.bearing import JournalBearing, MaximumGap
from exudyn_ehd.film.grid import FilmGrid
from exudyn_ehd.film.solvers.impedance_map import ImpedanceMap, impedance_nodes, impedance_wrench, places
from exudyn_ehd.joint.bore.equilibrium import Elasticity
from exudyn_ehd.joint.bore.shapes import Bore, ModalBore, NodalBore
from exudyn_ehd.joint.bore.solid import SolidElasticity
from exudyn_ehd.joint.model.effects import Effects, collect_effects
from exudyn_ehd.joint.model.flexible import ElasticBearingModel, ElasticEvaluation
from exudyn_ehd.joint.model.rigid import BearingModel
from exudyn_ehd.joint.solved_film import MOTION_SIZE, BoreState, History, JournalMotion, SolvedFilm
from exudyn_ehd.joint.tangent.bore import elastic_tangent
from exudyn_ehd.solid.bush import ANCFBush, ModalBush, bore_modes
from exudyn_ehd.solid.fe_bore import FEBore, ReducedBore
from exudyn_ehd.solid.journal import ElasticJournal, journal_modes
from exudyn_ehd.solid.turning_journal import FEJournal, TurningJournal
from exudyn_ehd.status import FilmError, InputError, Status, require_type

# Largest tilt that is ignored: reduction of the gap at the ends, over the minimum film thickness. Its effect on the
# force is of second order. Larger: tilted journals are evaluated with a larger error instead of an error message.
NEGLIGIBLE_TILT = 0.01
_OUTCOMES = (Status.CONVERGED, Status.NOT_FINITE, Status.OUTSIDE_MAP, Status.NO_FILM)


@dataclass(eq=False, slots=True)
class ImpedanceEvaluation:
    """One evaluation; see `exudyn_ehd.joint.model.rigid.Evaluation`."""

    bearing: JournalBearing
    status: Status
    motion: np.ndarray
    wrench: np.ndarray
    _tangent: np.ndarray
    iterations: int = 0

    def tangent(self) -> np.ndarray:
        """d wrench / d motion (6, 10), exact; columns and rows of the tilt are zero; nan without a film."""
        return self._tangent

    def quantities(self) -> dict[str, float]:
        """Scalars by name, SI units: gap and its place, eccentricity ratio, friction, power loss, contact load 0."""
        x, y, _, _, x_t, y_t, _, _, omega, w = self.motion.tolist()
        eps = math.hypot(x, y) / self.bearing.radial_clearance
        out = {
            "minimum_gap": self.bearing.radial_clearance * (1.0 - eps),
            "minimum_gap_angle": math.atan2(y, x) % (2.0 * math.pi),
            "minimum_gap_z": 0.0,
            "eccentricity_ratio": eps,
            "largest_eccentricity_ratio": eps,
        }
        if self.status is not Status.CONVERGED:
            return out
        fx, fy, fz, _, _, torque = self.wrench.tolist()
        friction = torque - (x * fy - y * fx)
        power = fx * x_t + fy * y_t + friction * omega + fz * w
        return out | {
            "friction_torque": friction,
            "friction_torque_bush": -torque,
            "power_loss": -power,
            "stored_power": 0.0,
            "contact_load": 0.0,
        }

    def history(self) -> None:
        """Return None: the map has no memory."""
        return None


class ImpedanceModel:
    """Force of a plain aligned bearing from its impedance map.

    Parameters
    ----------
    bearing : JournalBearing
        With ``film=ImpedanceMap(...)``.
    """

    remembers = False
    needs_spin = False

    def __init__(self, bearing: JournalBearing) -> None:
        assert isinstance(bearing.film, ImpedanceMap)
        self.bearing = bearing
        ratio = bearing.length / bearing.journal_radius
        self.nodes = impedance_nodes(bearing.film, bearing.closure, ratio)
        R, c, mu = bearing.journal_radius, bearing.radial_clearance, bearing.lubricant.viscosity
        self.parameters = np.array(
            [
                *(at[1] for at in places(bearing.film)),
                bearing.film.largest_eccentricity_ratio,
                c,
                R,
                0.5 * bearing.length,
                2.0 * R * bearing.length * mu * (R / c) ** 2,
                2.0 * math.pi * ratio * mu * R**2 / c,
                NEGLIGIBLE_TILT,
            ]
        )

    def forget(self) -> None:
        """Do nothing: there is no warm start."""

    def initial_history(self, motion: np.ndarray) -> None:
        """Return None: there is no memory."""
        return None

    def evaluate(
        self, motion: np.ndarray, history: None = None, step: float = 0.0, spin: float = 0.0
    ) -> ImpedanceEvaluation:
        """Force at a motion (10,) in the joint frame, SI units; the other arguments are not used.

        Raises
        ------
        FilmError
            If the journal is tilted by more than `NEGLIGIBLE_TILT`.
        """
        motion = np.array(motion, dtype=float)
        wrench, tangent = np.empty(6), np.empty((6, 10))
        code = impedance_wrench(self.nodes, self.parameters, motion, wrench, tangent)
        if code == len(_OUTCOMES):
            self._refuse_tilt(motion)
        return ImpedanceEvaluation(self.bearing, _OUTCOMES[code], motion, wrench, tangent)

    def _refuse_tilt(self, motion: np.ndarray) -> None:
        b = self.bearing
        slope = math.hypot(motion[2], motion[3])
        gap = b.radial_clearance - math.hypot(motion[0], motion[1])
        raise FilmError(
            f"ImpedanceMap: the journal is tilted by {slope:.3g} rad, which takes {0.5 * slope * b.length:.3g} m of "
            f"the {gap:.3g} m gap at the ends; the map is for aligned journals (up to {NEGLIGIBLE_TILT:.0%} of the "
            "gap): guide the journal's axis, or "
            "use film=FiniteLength(...)."
        )


@dataclasses.dataclass(eq=False)
class TurningEvaluation(ElasticEvaluation):
    """One film evaluation on a journal whose modes turn under it.

    ``wrench`` contains the moment of the pressure on the deflected journal about its axis. ``bore`` has the coordinates
    of the body's modes, ``film.bore`` those of standing waves, see `exudyn_ehd.solid.turning_journal`.

    Attributes
    ----------
    turn : (K, k) array, float, bool
        Matrix T from modes to waves; speed at which the shape turns, rad/s; whether this is the journal's spin.
    moment : float
        Moment of the pressure on the deflected journal about its axis, Nm.
    """

    model: TurningModel = dataclasses.field(repr=False)
    turn: tuple[np.ndarray, float, bool] = dataclasses.field(repr=False, default=(np.zeros((0, 0)), 0.0, True))
    moment: float = 0.0

    def quantities(self) -> dict[str, float]:
        """Return `ElasticEvaluation.quantities`, with the pressure's moment on the deflected journal in the torques."""
        found = super().quantities()
        if self.film is not None:
            found["friction_torque"] += self.moment
            found["friction_torque_bush"] = -float(self.wrench[5])
        return found

    @cached_property
    def derivatives(self) -> np.ndarray:
        """d (wrench, Q) / d (motion, angle of the journal) (6 + k, 10 + 2 k + 1); nan without a film."""
        film, k = self._current(), self.bore.coordinates.size
        if film is None or film.bore is None:
            return np.full((6 + k, MOTION_SIZE + 2 * k + 1), np.nan)
        turning, (T, omega, turns), M = self.model.turning, self.turn, MOTION_SIZE
        r, r_t, Q = film.bore.coordinates, film.bore.rates, film.bore.load
        turned, size = turning.turned(r), r.size
        change = np.zeros((M + 2 * size, M + 2 * k + 1))
        change[:M, :M], place, rate = np.eye(M), change[M : M + size], change[M + size :]
        place[:, M : M + k], place[:, -1] = T, turned
        rate[:, M : M + k], rate[:, M + k : -1], rate[:, -1] = omega * turning.turned(T), T, turning.turned(r_t)
        rate[:, 8] = turned * turns
        by_film = elastic_tangent(film, self.model.bore, (1.0, 0.0), (0.0, 1.0)) @ change
        back = turning.turned(Q)
        out = np.concatenate((by_film[:6], T.T @ by_film[6:]))
        out[6:, -1] -= T.T @ back
        axis, by_tilt = _axis(self.motion)
        out[3:6] += np.multiply.outer(axis, turned @ by_film[6:] - back @ place)
        out[3:6, 2:4] += self.moment * by_tilt
        return out

    def _tangent(self, *combinations: tuple[float, float]) -> np.ndarray:
        d, k, M = self.derivatives, self.bore.coordinates.size, MOTION_SIZE
        blocks = [a * d[:, M : M + k] + b * d[:, M + k : M + 2 * k] for a, b in combinations]
        return np.concatenate((d[:, :M], *blocks), axis=1)


class TurningModel(ElasticBearingModel):
    """Film on a journal whose modes turn under it.

    ``motion`` (10 + 2 k,) contains the coordinates and rates of the modes; ``spin`` is the journal's angle.

    Parameters
    ----------
    bearing : JournalBearing
    turning : TurningJournal
    start_angle, effects
        As in `BearingModel`.

    Attributes
    ----------
    turns : bool
        True: the shape turns with the journal. False: it stands in the joint's frame, as in `evaluate_steady`.
    """

    def __init__(
        self, bearing: JournalBearing, turning: TurningJournal, start_angle: float = 0.0, effects: Effects | None = None
    ) -> None:
        self.turning, self.turns = turning, True
        super().__init__(
            bearing,
            lambda grid: ModalBore(None, grid, turning.waves),
            elasticity=Elasticity(turning.surface.stiffness_matrix),
            start_angle=start_angle,
            effects=effects,
        )
        self.needs_spin, self.size = True, turning.count
        self._coordinates = np.zeros(self.size)

    def _journal(self, motion: np.ndarray, spin: float) -> JournalMotion:
        """Set the motion (10 + 2 k,), transformed to waves; with (10,) the journal is undeformed at rest."""
        given, k = np.zeros(MOTION_SIZE + 2 * self.size), self.size
        given[: np.size(motion)] = motion
        q, q_t = given[MOTION_SIZE : MOTION_SIZE + k], given[MOTION_SIZE + k :]
        T, omega = self.turning.map(spin), float(given[8]) * self.turns
        r = T @ q
        journal = super()._journal(
            np.concatenate((given[:MOTION_SIZE], r, T @ q_t + omega * self.turning.turned(r))), spin
        )
        self._coordinates, self._turn, self._given = q, (T, omega, self.turns), given
        return journal

    def _result(
        self, status: Status, journal: JournalMotion, iterations: int, gap: float, film: SolvedFilm | None = None
    ) -> TurningEvaluation:
        found = super()._result(status, journal, iterations, gap, film)
        waves, (T, _, _), given, k = found.bore, self._turn, self._given, self.size
        moment, whole = float(waves.load @ self.turning.turned(waves.coordinates)), found.wrench.copy()
        whole[3:] += moment * _axis(given)[0]
        q, q_t = given[MOTION_SIZE : MOTION_SIZE + k], given[MOTION_SIZE + k :]
        turned = {"motion": given, "wrench": whole, "bore": BoreState(q, q_t, waves.displacement, T.T @ waves.load)}
        return TurningEvaluation(**vars(found) | turned, turn=self._turn, moment=moment)

    def evaluate_steady(
        self, motion: np.ndarray, history: History | None = None, step: float = 0.0, spin: float = 0.0
    ) -> ElasticEvaluation:
        """Call `ElasticBearingModel.evaluate_steady` with a deflection that stands while the journal turns."""
        turns, self.turns = self.turns, False
        try:
            return super().evaluate_steady(motion, history, step, spin)
        finally:
            self.turns = turns


def _axis(motion: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Axis (3,) of the journal and its derivative (3, 2) to the slopes of the axis."""
    slope = np.array([motion[2], motion[3], 1.0])
    size = float(np.linalg.norm(slope))
    return slope / size, (np.eye(3) - np.multiply.outer(slope, slope) / size**2)[:, :2] / size


def elastic_model(bearing: JournalBearing, start_angle: float, effects: Effects) -> ElasticBearingModel:
    """Model of a bearing with a ``bush`` or a ``journal``."""
    bush = bearing.bush
    if isinstance(bush, FEBore):
        raise InputError(
            "JournalBearing.bush=FEBore(...) takes its modes from the body that is the joint's housing: give "
            "CreateLubricatedJoint an ObjectFFRFreducedOrder as itemNumbers[0]; for other bodies, and for a bearing by "
            "itself, take a ModalBush(...)."
        )
    if isinstance(bearing.journal, FEJournal):
        raise InputError(
            "JournalBearing.journal=FEJournal(...) takes its modes from the body that is the joint's journal: give "
            "CreateLubricatedJoint an ObjectFFRFreducedOrder as itemNumbers[1]; for other bodies, and for a bearing by "
            "itself, take an ElasticJournal(...)."
        )
    if isinstance(bearing.journal, TurningJournal):
        return TurningModel(bearing, bearing.journal, start_angle, effects)
    bore, elasticity = _bore_and_elasticity(bearing)
    return ElasticBearingModel(bearing, bore, elasticity=elasticity, start_angle=start_angle, effects=effects)


def _bore_and_elasticity(bearing: JournalBearing) -> tuple[Callable[[FilmGrid], Bore], Elasticity]:
    """Return a function that makes the bore on a film's grid, and the elasticity that resists its coordinates."""
    bush, pin = bearing.bush, bearing.journal
    if isinstance(bush, ModalBush | None):
        assert isinstance(pin, ElasticJournal | None)
        modes = None if bush is None else bore_modes(bush, bearing.length)
        journal = None if pin is None else journal_modes(pin, bearing.journal_radius, bearing.length)
        stiffness = np.concatenate([part.stiffness for part in (modes, journal) if part is not None])
        return lambda grid: ModalBore(modes, grid, journal), Elasticity(np.diag(stiffness))
    if isinstance(bush, ReducedBore):
        return lambda grid: ModalBore(bush, grid), Elasticity(bush.stiffness_matrix)
    assert isinstance(bush, ANCFBush)
    mesh = bush.build_mesh()
    return lambda grid: NodalBore(mesh.bore, grid), SolidElasticity(bush.solid(mesh))


def compile_kernels(model: BearingModel) -> None:
    """Evaluate one film, so that kernels are compiled before a run; the warm start is dropped."""
    motion = np.zeros(MOTION_SIZE)
    motion[0] = 0.1 * model.bearing.radial_clearance
    motion[8] = 1.0
    history = model.initial_history(motion)
    evaluation = model.evaluate(motion, history, 1.0)
    if evaluation.film is not None:
        evaluation.tangent()
        evaluation.quantities()
        evaluation.history()
    model.forget()


def build_study_model(bearing: JournalBearing, start_angle: float) -> BearingModel:
    """Model of a bearing, with its kernels compiled; ``start_angle``: start of a film with `MaximumGap`, rad."""
    effects = collect_effects(bearing, start_angle)
    if (bearing.bush is None and bearing.journal is None) or effects.liner is not None:
        model = BearingModel(bearing, start_angle=start_angle, effects=effects)
    else:
        model = elastic_model(bearing, start_angle, effects)
    compile_kernels(model)
    return model


def build_model(bearing: JournalBearing) -> BearingModel | ImpedanceModel:
    """Model of a bearing for a moving journal.

    Raises
    ------
    InputError
        If the bearing is described by something else, or by an option that only a prescribed position allows.
    """
    require_type(
        "CreateLubricatedJoint.bearing",
        bearing,
        JournalBearing,
        hint="pads and balls have functions of their own, CreateTiltingPadBearing, CreateLubricatedSphericalJoint ...",
    )
    if isinstance(bearing.inlet, MaximumGap):
        raise InputError(
            "JournalBearing.inlet=MaximumGap() is for prescribed positions only: the line of maximum gap is "
            "undefined for a concentric journal and jumps with a moving one; use inlet=Periodic()."
        )
    if isinstance(bearing.film, ImpedanceMap):
        return ImpedanceModel(bearing)
    return build_study_model(bearing, 0.0)
