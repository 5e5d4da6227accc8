"""Tilting-pad journal bearings: description, and the film of one pad as a function of journal and pad.

Frame of the bearing: origin O in its centre, z along its axis. The pivot of a pad lies at the angle phi, with the unit
vectors e_r towards it and e_t = e_z x e_r. With the assembled clearance c_b, the machined one c_p = c_b / (1 - m) and
the preload m, the pad's centre of curvature lies at ``O - m c_p e_r``, so that the gap at the pivot is c_b under a
concentric journal. The pivot P lies ``rho = R + c_p + t`` from the centre of curvature, with the pad's thickness t.

A pad tilts by delta about P and moves outward by eta on a flexible pivot. Its film is described in a frame fixed in the
pad, with the origin in the centre of curvature. With the rotation Q by delta, the journal at x has there the position

    p = Q^T (x - P - eta e_r) + rho e_r.

The film exerts the force F on the journal and the moment M about the pad's centre of curvature, in the pad's frame; the
opposites act on the pad. Virtual work gives the generalized forces

    Q_x = Q F,    Q_delta = -M + rho e_t . F,    Q_eta = -e_r . Q F - k eta.

The film of a ring omits the resultant of its shear, of the size c / R times the load. For an almost unloaded pad, the
moment of this force about the pivot determines the tilt. The shear stress on a pad, assumed uniform over its arc, has
the torque -M and the resultant ``-M / R`` times the mean of e_theta over the arc. `PadModel` adds it to the pad, and
its opposite to the journal.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial
from typing import ClassVar, NamedTuple

import numpy as np

from exudyn_ehd.bearing import Cavitation, JournalBearing
from exudyn_ehd.film.arcs import SMALLEST_ARC, Arc
from exudyn_ehd.film.cavitation.closures import SwiftStieber
from exudyn_ehd.film.heat.options import FilmEnergy, LumpedThermal
from exudyn_ehd.film.lubricant.lubricant import Lubricant
from exudyn_ehd.film.models import FiniteLength
from exudyn_ehd.film.reynolds.turbulence import Hirs, NgPan
from exudyn_ehd.film.surfaces.contact import RegularisedWall
from exudyn_ehd.joint.balance.steady_film import settled_history
from exudyn_ehd.joint.model.build import compile_kernels
from exudyn_ehd.joint.model.effects import collect_effects
from exudyn_ehd.joint.model.rigid import BearingModel, Evaluation
from exudyn_ehd.joint.solved_film import MOTION_SIZE, History
from exudyn_ehd.joint.static.dynamic_stiffness import LOADS, PLACES, FilmMemory, response_of
from exudyn_ehd.status import (
    NOT_NEGATIVE,
    POSITIVE,
    Checked,
    FilmError,
    InputError,
    Status,
    require_bool,
    require_count,
    require_number,
    require_vector,
)

# Angle from the pivot, rad, up to which the gap of an unloaded pad must widen along the pad.
STEEPEST = 1.4
# Largest overlap of surfaces with a contact, over the machined clearance. Smaller: pads rest less deep on the contact.
OVERLAP = 0.1


@dataclass(frozen=True, kw_only=True)
class TiltingPads(Checked):
    """Description of a journal bearing of equal pads that tilt, for `CreateTiltingPadBearing` and `equilibrium`.

    Pads tilt about lines through their pivots, parallel to the bearing's axis. Their centres of mass lie in the pivots.
    Every pad has a separate film, fed at its edges: `pad` returns it as a `JournalBearing` with an `Arc`.

    Parameters
    ----------
    journal_radius, length : float
        R and L of journal and pads, m.
    radial_clearance : float
        Assembled clearance c_b: gap at the pivots under a concentric journal, m. Pads are machined to
        c_p = c_b / (1 - preload).
    lubricant : Lubricant
        Oil.
    pads : int, default 5
        Number of pads, from 3 on.
    extent : float, default 1.0471975511965976
        Angle of a pad from its leading to its trailing edge, rad; by default 60 degrees.
    preload : float, default 0.0
        m = 1 - c_b / c_p, from 0 to below 1.
    pivot_offset : float, default 0.5
        Angle from the leading edge to the pivot over ``extent``, between 0 and 1; the leading edge is that of a
        positive spin.
    pad_thickness : float
        Distance t from the pad's surface to its pivot, m.
    pad_mass, pad_inertia : float, default 0.0
        Mass, kg, and moment of inertia about the axis of tilting through the pivot, kg m2. They may be 0 for
        `equilibrium` only.
    pivot_stiffness : float or None, default None
        Radial stiffness of a pivot, N/m; None: rigid.
    load_between_pads : bool, default True
        Position of the pads for a load along -y. True: it points between two pivots; False: onto a pivot.
    first_pivot : float or None, default None
        Angle of the first pivot from the joint's x about z, rad, in place of ``load_between_pads``. The others follow
        about z at equal distances.
    film : FiniteLength, default FiniteLength()
        Film model and grid; a pad gets its share of the columns of the whole circle.
    cavitation : FullSommerfeld, Gumbel, SwiftStieber, ElrodAdams or Closure, default SwiftStieber()
        Cavitation model. With `ElrodAdams` K and C of `equilibrium` are those of slow motions, see `TiltingPadResult`.
    contact : RegularisedWall or None, default None
        Smooth wall that carries load before the gap vanishes, as for `JournalBearing`.
    turbulence : NgPan, Hirs or None, default None
        Turbulent films; None: laminar.
    thermal : LumpedThermal, FilmEnergy or None, default None
        Temperature of the films, as for a `JournalBearing` with an ``arc``: oil that leaves a pad at its edges enters
        it again, as far as ``carry_over`` says; pads do not heat each other. `equilibrium` computes the temperature in
        balance with every film; K and C hold at constant temperature.
    end_pressures : (float, float), default (0.0, 0.0)
        Gauge pressures at both ends of the pads along the axis, Pa.
    edge_pressures : (float, float), default (0.0, 0.0)
        Gauge pressures at the leading and the trailing edges, Pa.

    Raises
    ------
    InputError
        For values outside their ranges, and for pads that overlap.

    Examples
    --------
    >>> pads = ehd.TiltingPads(
    ...     journal_radius=0.05, length=0.05, radial_clearance=60e-6, lubricant=ehd.Lubricant(viscosity=0.02),
    ...     preload=0.4, pad_thickness=0.015, pad_mass=0.3, pad_inertia=1e-4,
    ... )
    >>> np.degrees(pads.pivots).round()
    array([-54.,  18.,  90., 162., 234.])
    >>> round(1e6 * pads.pad(0).radial_clearance)  # um, machined
    100
    """

    journal_radius: float
    length: float
    radial_clearance: float
    lubricant: Lubricant
    pads: int = 5
    extent: float = math.pi / 3.0
    preload: float = 0.0
    pivot_offset: float = 0.5
    pad_thickness: float
    pad_mass: float = 0.0
    pad_inertia: float = 0.0
    pivot_stiffness: float | None = None
    load_between_pads: bool = True
    first_pivot: float | None = None
    film: FiniteLength = FiniteLength()
    cavitation: Cavitation = SwiftStieber()
    contact: RegularisedWall | None = None
    turbulence: NgPan | Hirs | None = None
    thermal: LumpedThermal | FilmEnergy | None = None
    end_pressures: tuple[float, float] = (0.0, 0.0)
    edge_pressures: tuple[float, float] = (0.0, 0.0)

    checks: ClassVar = {
        "journal_radius": partial(POSITIVE, hint="it is half the diameter."),
        "length": POSITIVE,
        "radial_clearance": partial(POSITIVE, hint="it is the gap at the pivots under a concentric journal."),
        "pads": partial(require_count, at_least=3, hint="a journal needs pads on all sides."),
        "extent": partial(
            require_number,
            at_least=SMALLEST_ARC,
            below=math.tau,
            hint="it is the angle of one pad; use math.radians for degrees.",
        ),
        "preload": partial(require_number, at_least=0.0, below=1.0, hint="it is 1 - c_b / c_p."),
        "pivot_offset": partial(require_number, above=0.0, below=1.0, hint="0.5 is the middle of the pad."),
        "pad_thickness": partial(NOT_NEGATIVE, hint="it is the distance from the pad's surface to its pivot."),
        "pad_mass": NOT_NEGATIVE,
        "pad_inertia": NOT_NEGATIVE,
        "pivot_stiffness": partial(POSITIVE, hint="None is a rigid pivot."),
        "load_between_pads": require_bool,
        "first_pivot": require_number,
    }

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.pads >= math.tau / self.extent:
            raise InputError(
                f"TiltingPads.extent: {self.pads} pads of {self.extent:g} rad overlap; take at most "
                f"{math.ceil(math.tau / self.extent) - 1} pads of this extent, or a smaller one."
            )
        edges = require_vector("TiltingPads.edge_pressures", self.edge_pressures, 2, "Pa")
        object.__setattr__(self, "edge_pressures", tuple(edges.tolist()))
        try:
            self.pad(0)
        except InputError as error:
            raise InputError(f"TiltingPads: a pad has no film: {error}") from None

    @property
    def pivots(self) -> np.ndarray:
        """Angles (n,) of the pivots, rad."""
        between = math.pi / self.pads if self.load_between_pads else 0.0
        first = between - 0.5 * math.pi if self.first_pivot is None else self.first_pivot
        return first + math.tau / self.pads * np.arange(self.pads)

    @property
    def machined_clearance(self) -> float:
        """Radius of the pad's surface less that of the journal, c_p, m."""
        return self.radial_clearance / (1.0 - self.preload)

    @property
    def arm(self) -> float:
        """Distance rho from a pad's centre of curvature to its pivot, m."""
        return self.journal_radius + self.machined_clearance + self.pad_thickness

    def pad(self, number: int) -> JournalBearing:
        """Film of a pad, counted from 0, in a frame whose origin is the pad's centre of curvature."""
        return JournalBearing(
            journal_radius=self.journal_radius,
            length=self.length,
            radial_clearance=self.machined_clearance,
            lubricant=self.lubricant,
            film=self.film,
            cavitation=self.cavitation,
            contact=self.contact,
            turbulence=self.turbulence,
            thermal=self.thermal,
            end_pressures=self.end_pressures,
            arc=Arc(
                start=math.fmod(self.pivots[number] - self.pivot_offset * self.extent, math.tau),
                extent=self.extent,
                leading_pressure=self.edge_pressures[0],
                trailing_pressure=self.edge_pressures[1],
            ),
        )


class PadEvaluation(Evaluation):
    """One evaluation of a `PadModel`."""

    model: PadModel

    def tangent(self, slow_motion: bool = False) -> np.ndarray:
        """d wrench / d motion (6, 10), including the resultant of the shear."""
        return self.model.with_shear @ super().tangent(slow_motion)


class PadModel(BearingModel):
    """Film between a journal and a pad, with the resultant of its shear; see the module's docstring.

    Parameters
    ----------
    pads : TiltingPads
    number : int
        Number of the pad, from 0.

    Attributes
    ----------
    with_shear : (6, 6) array
        Map from the wrench without the resultant of the shear to the wrench with it.
    """

    def __init__(self, pads: TiltingPads, number: int) -> None:
        bearing, self.pads, self.number = pads.pad(number), pads, number
        super().__init__(bearing, effects=collect_effects(bearing))
        assert bearing.arc is not None
        first, last = bearing.arc.start, bearing.arc.start + bearing.arc.extent
        mean = np.array([math.cos(last) - math.cos(first), math.sin(last) - math.sin(first)]) / bearing.arc.extent
        self.with_shear = np.eye(6)
        self.with_shear[:2, 5] = mean / bearing.journal_radius
        compile_kernels(self)

    def evaluate(
        self, motion: np.ndarray, history: History | None = None, step: float = 0.0, spin: float = 0.0
    ) -> PadEvaluation:
        """Evaluate the film like `BearingModel.evaluate`, with the resultant of the shear in the wrench."""
        found = super().evaluate(motion, history, step, spin)
        wrench = self.with_shear @ found.wrench
        return PadEvaluation(found.status, found.motion, wrench, found.iterations, found.minimum_gap, found.film, self)


class PadLoads(NamedTuple):
    """Loads of a pad on the coordinates (x, y, delta, eta).

    Parameters
    ----------
    tilt : float
        delta, rad.
    motion, wrench : (10,), (6,) arrays
        Motion of the journal and loads on it in the pad's frame.
    forces : (4,) array
        Generalized forces, N and Nm.
    stiffness, damping : (4, 4) arrays
        Minus the derivatives of the forces to the coordinates and to the rates.
    history : History or None
        Memory of the film with its temperature; None for an isothermal film.
    loaded : bool
        True: the film balances the pad at this tilt. False: the pad is unloaded and held.
    """

    tilt: float
    motion: np.ndarray
    wrench: np.ndarray
    forces: np.ndarray
    stiffness: np.ndarray
    damping: np.ndarray
    history: History | None
    loaded: bool = True


class Pad:
    """One pad with its film under a spinning journal.

    Parameters
    ----------
    bearing : TiltingPads
    number : int
        Number of the pad, from 0.
    speed : float
        Spin of the journal, rad/s.

    Attributes
    ----------
    columns : (n,) array
        Angles of the film's columns from the pivot, rad.
    """

    def __init__(self, bearing: TiltingPads, number: int, speed: float) -> None:
        self.model, self.speed = PadModel(bearing, number), speed
        angle, self.arm = float(bearing.pivots[number]), bearing.arm
        self.radial = np.array([math.cos(angle), math.sin(angle)])
        self.across = np.array([-self.radial[1], self.radial[0]])
        self.pivot = (self.arm - bearing.preload * bearing.machined_clearance) * self.radial
        self.stiffness = bearing.pivot_stiffness or 0.0
        self.columns = self.model.grid.x - self.model.grid.x[0] - bearing.pivot_offset * bearing.extent
        self.near: History | None = None

    def place(self, journal: np.ndarray, shift: float, tilt: float) -> np.ndarray:
        """Position p (2,) of the journal in the pad's frame, m."""
        c, s = math.cos(tilt), math.sin(tilt)
        x, y = journal - self.pivot - shift * self.radial
        return np.array([c * x + s * y, c * y - s * x]) + self.arm * self.radial

    def at(self, journal: np.ndarray, shift: float, tilt: float) -> PadLoads | None:
        """Loads of the steady film at a position of the journal (2,), a shift and a tilt of the pad.

        None if there is no film.
        """
        motion = np.zeros(MOTION_SIZE)
        motion[:2], motion[8] = self.place(journal, shift, tilt), self.speed
        if self.model.effects.thermal is not None:
            try:
                self.near = settled_history(self.model, motion, self.near, "equilibrium")
            except FilmError:
                return None
        found = self.model.evaluate_steady(motion, self.near)
        if found.status is not Status.CONVERGED:
            return None
        to_forces, by_place = self._maps(tilt, motion)
        by_rate = np.roll(by_place, 4, axis=0)
        by_rate[8, 2] = -1.0
        changes = to_forces @ found.steady_tangent(exact=True)
        stiffness, (fx, fy) = -changes @ by_place, to_forces[:2, :2] @ found.wrench[:2]
        # the forces turn with the pad
        turned = np.array([-fy, fx])
        stiffness[:, 2] -= [*turned, 0.0, -self.radial @ turned]
        stiffness[3, 3] += self.stiffness
        forces = to_forces @ found.wrench
        forces[3] -= self.stiffness * shift
        return PadLoads(tilt, motion, found.wrench, forces, stiffness, -changes @ by_rate, self.near)

    def _maps(self, tilt: float, motion: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Map (4, 6) from a wrench to generalized forces, and derivatives (10, 4) of a motion to the coordinates."""
        c, s = math.cos(tilt), math.sin(tilt)
        turn, lever = np.array([[c, -s], [s, c]]), motion[:2] - self.arm * self.radial
        to_forces, by_place = np.zeros((4, 6)), np.zeros((MOTION_SIZE, 4))
        to_forces[:2, :2], to_forces[3, :2] = turn, -self.radial @ turn
        to_forces[2, 5], to_forces[2, :2] = -1.0, self.arm * self.across
        by_place[:2] = np.column_stack((turn.T, [lever[1], -lever[0]], -turn.T @ self.radial))
        return to_forces, by_place

    def memory(self, own: PadLoads) -> FilmMemory | None:
        """Response of the film at a position to motions of all coordinates at any frequency; None without a memory."""
        slow, response = response_of(self.model.evaluate_steady(own.motion, own.history))
        if response is None:
            return None
        to_forces, by_place = self._maps(own.tilt, own.motion)
        return FilmMemory(response, slow, to_forces @ LOADS.T, by_place[:PLACES])


def open_tilts(pad: Pad, journal: np.ndarray, shift: float) -> tuple[float, float, float] | None:
    """Two tilts between which the film of a pad is open, and the tilt from which on the film widens.

    The gap is ``c - a cos psi - b sin psi`` at the angles psi of the columns from the pivot, with the journal's place
    (a, b) in the pad's frame; b grows by the pivot's distance times the tilt. The tilts are in ascending order of the
    sense of rotation. None if the gap is closed at the pivot.
    """
    a, b = np.array((pad.radial, pad.across)) @ pad.place(journal, shift, 0.0)
    sense, psi = math.copysign(1.0, pad.speed), pad.columns
    room = pad.model.bearing.radial_clearance * (1.0 + (OVERLAP if pad.model.effects.contacts else 0.0)) - a * np.cos(
        psi
    )
    if room.min() <= 0.0:
        return None
    lever = sense * np.sin(psi)
    before, behind = lever < 0.0, lever > 0.0
    lowest, highest = np.max(room[before] / lever[before]), np.min(room[behind] / lever[behind])
    # the gap's slope along the motion, a sin psi - b cos psi, is positive all over the pad
    widening = max(float(np.min(sense * a * np.tan(psi[np.abs(psi) < STEEPEST]))), 0.9 * lowest)
    lower, upper, widening = ((sense * value - b) / (pad.arm - a) for value in (lowest, highest, widening))
    return lower, upper, widening
