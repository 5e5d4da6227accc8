"""Record of one solved film: its input state, its fields and its loads.

The parts are grouped by lifetime. `FilmParts` lasts as long as a model, `Scales` as long as the temperature is the
same. `SolvedFilm` is valid until the next evaluation, because links, factor and most fields are in the film solver's
buffers. Functions that need a film take this record as their only argument for it.

Joint frame: origin O on the bearing's mid-plane, z = bearing axis, fixed in the housing. The motion of the journal in
it is

    motion = [x, y, bx, by, dx/dt, dy/dt, dbx/dt, dby/dt, omega, w]

with the journal axis (x + bx z, y + by z), the relative spin omega about it and the relative axial speed w.

Fields are (n, m) arrays on the film grid in scaled form: gaps divided by c, film pressures by ``Scales.pressure``;
contact pressures are in Pa.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.sparse import csr_matrix, diags

from exudyn_ehd.bearing import JournalBearing, MaximumGap
from exudyn_ehd.film.grid import FilmGrid
from exudyn_ehd.film.heat.options import Walls
from exudyn_ehd.film.loads import Scales
from exudyn_ehd.film.lubricant.shear_thinning import ShearThinning
from exudyn_ehd.film.solvers.answers import OilFields
from exudyn_ehd.film.solvers.film import shear_share
from exudyn_ehd.film.solvers.liner import LinerFilm
from exudyn_ehd.film.solvers.solver import FilmSolver
from exudyn_ehd.film.supply.cuts import RecessShear, SupplyMap
from exudyn_ehd.film.surfaces.contact import Contact, slip
from exudyn_ehd.status import ROUNDING

# Entries of the motion of two rigid surfaces; the coordinates and rates of a flexible bore follow them.
MOTION_SIZE = 10
# Eccentricity over the clearance of the films slightly off the centre that replace a central one; relative error of
# their K and C. A journal counts as central up to an eccentricity ratio of `ROUNDING`, which is larger than the
# round-off of a position of 1 m in a clearance of 1 um.
BESIDE = 1e-6
# Largest difference between K or C in one direction and their mean over directions, over the mean, up to which the mean
# counts as stiffness and damping at the centre; on n columns at least 2 / n. Larger: bearings that are not the same in
# all directions pass. Measured: bearings that are the same in all directions at most 0.12 on 17 columns, 0.057 on 31,
# 0.023 on 48 and more; an axial groove of 0.3 rad at the cavity pressure over two thirds of the length 0.16.
LARGEST_SPREAD = 0.05


@dataclass(frozen=True, eq=False)
class History:
    """State of a bearing that is kept from one accepted step to the next; None for absent effects.

    Attributes
    ----------
    void : (n, m) array or None
        Scaled gap less content (fill times gap / c) at the vertices (mass-conserving closures).
    mass : (n, m) array or None
        Scaled oil at the vertices as the sum of all flows. It balances the flows to round-off and differs from the
        content as `exudyn_ehd.film.solvers.solver.FilmSolver.keep` explains. No film depends on it.
    outflow : (4, n, m) array or None
        Fields of `exudyn_ehd.film.reynolds.links.outflow_of` for the step (mass-conserving closures).
    wear : (n, m) array or None
        Scaled wear depth of the bore.
    temperature : float, (n, m) array or None
        Film temperature, K; (n, m + k) followed by those of conducting walls, see `exudyn_ehd.joint.heat.walls`;
        (n, 4 m + k) with two temperatures across the film, see `exudyn_ehd.joint.heat.across`.
    heating : (2, k, ...) array or None
        Rates of k temperatures across the film, K/s: the mean rates in the last step; and the rates by which the next
        step extrapolates, 0 where the first one has changed its sign.
    last_step : float
        Size of that step, s; 0 at the start of a motion.
    deflection : (n, m) array or None
        Scaled deflection of an elastic liner.
    pockets : (k,) array or None
        Pressure of every supply area with a restrictor, Pa (restrictors with a compressible volume).
    sump : float or None
        Temperature of the sump that feeds the film, K.
    leaving : (2,) array or None
        Temperature of the oil that leaves at the lower and at the upper end, K; only with a temperature field and films
        on end faces.
    growth : (n, m) array or None
        Scaled rate, 1/s, by which wear and growing walls have changed the gap in the last step (mass-conserving
        closures). The next step squeezes or draws in oil at this rate.
    """

    void: np.ndarray | None = None
    mass: np.ndarray | None = None
    outflow: np.ndarray | None = None
    wear: np.ndarray | None = None
    temperature: float | np.ndarray | None = None
    heating: np.ndarray | None = None
    last_step: float = 0.0
    deflection: np.ndarray | None = None
    pockets: np.ndarray | None = None
    sump: float | None = None
    leaving: np.ndarray | None = None
    growth: np.ndarray | None = None


class ContactFields:
    """Pressures of the contacts and their integrals; allocated only if there are contacts.

    Parameters
    ----------
    shape : (int, int)
    laws : list of Contact

    Attributes
    ----------
    friction : list of (float, float)
        Boundary friction coefficient and transition speed (m/s) of every contact.
    presses_below : float
        Scaled gap above which no contact has a pressure.
    P, slope : lists of (n, m) arrays
        Pressure of every contact, Pa, and its derivative with respect to the scaled gap.
    integrals : (contacts, 5) array
        Integrals of every contact's pressure times `FilmGrid.moments`.
    """

    def __init__(self, shape: tuple[int, int], laws: list[Contact]) -> None:
        self.laws = laws
        self.P = [np.zeros(shape) for _ in laws]
        self.slope = [np.zeros(shape) for _ in laws]
        self.integrals = np.zeros((len(laws), 5))
        self.friction = [(float(f.friction_coefficient), float(f.transition_speed)) for f in laws]
        self.presses_below = max(f.presses_below for f in laws)
        self.acting = False

    def press(self, H: np.ndarray, smallest: float) -> ContactFields | None:
        """Set the pressures at the true gap H (n, m), scaled; return None if the smallest gap is too large for any."""
        if smallest < self.presses_below:
            self.acting = True
            for law, P, slope in zip(self.laws, self.P, self.slope, strict=True):
                law.pressure(H, P, slope)
            return self
        if self.acting:
            for known in (*self.P, *self.slope, self.integrals):
                known[:] = 0.0
            self.acting = False
        return None


class LimiterFields:
    """Derivatives of the film's gap to the true gap, at vertices and links, from `GapLimiter.limit`.

    ``gap`` and ``rate`` (n, m) are the true gap and its rate at the vertices, ``link`` the true gap on the links.
    """

    def __init__(self, shape: tuple[int, int]) -> None:
        self.slope, self.bend = np.zeros(shape), np.zeros(shape)
        self.face_slope = np.zeros(shape)
        self.gap, self.link, self.rate = np.zeros((3, *shape))


@dataclass(eq=False, kw_only=True)
class FilmParts:
    """Parts of a bearing model that are the same objects in all evaluations.

    Attributes
    ----------
    bearing : JournalBearing
    grid : FilmGrid
    solver : FilmSolver
        Film solver, whose buffers contain gaps, links, factor and active set of the last evaluation.
    liner : LinerFilm or None
        The solver's elements on an elastic liner.
    supply : SupplyMap or None
    mixing : list of (n, m) bool arrays
        Vertices of the areas in which oil mixes: supply areas, or grooves between arcs.
    grooves : (n, m) array
        1 on the edges of arcs. If the film is Swift and Stieber's: at vertices of grooves and pockets in the bore that
        have a given pressure, the share of the row's width that they cover. 0 elsewhere.
    contacts, limiter : buffers or None
    half_length : float
        Half the bearing's length over the reference length.
    pose_scale, motion_scale : (4,), (10,) arrays
        Factors from pose to scaled pose, and from motion to (scaled pose, scaled rates, vx, vz).
    flow_scale : float
        m3/s per scaled flow.
    uneven_drag : bool
        True if a pressure gradient exerts different shear forces on both surfaces; see
        `exudyn_ehd.film.surfaces.roughness`.
    evaluations : int
        Number of the model's evaluations; by it a record detects that the buffers contain another film.
    """

    bearing: JournalBearing
    grid: FilmGrid
    solver: FilmSolver
    liner: LinerFilm | None
    supply: SupplyMap | None
    mixing: list[np.ndarray]
    grooves: np.ndarray
    contacts: ContactFields | None
    limiter: LimiterFields | None
    half_length: float
    pose_scale: np.ndarray
    motion_scale: np.ndarray
    flow_scale: float
    uneven_drag: bool
    evaluations: int = 0


class JournalMotion(NamedTuple):
    """Motion (10,) in SI units, followed by the coordinates and rates of a flexible bore.

    Also the scaled pose (4,) and rates (4,), the spin, rad/s, and the axial speed, m/s. The motion of a ball is that of
    `exudyn_ehd.joint.spherical.model`, with the scaled place (3,) and velocity (3,).
    """

    motion: np.ndarray
    pose: np.ndarray
    rate: np.ndarray
    omega: float
    axial_speed: float


class ExtraGap(NamedTuple):
    """Gap terms (n, m): their sum, its slopes along theta and z, and the single terms of the undeformed surfaces."""

    height: np.ndarray
    slope_x: np.ndarray
    slope_z: np.ndarray
    surfaces: list[np.ndarray]


class BoreState(NamedTuple):
    """State of a flexible bore.

    Coordinates (k,) and rates, scaled displacement (n, m), and loads (k,) on the bore, N, nan without a film. With an
    elastic journal the displacement is the opening of the gap by both surfaces.
    """

    coordinates: np.ndarray
    rates: np.ndarray
    displacement: np.ndarray
    load: np.ndarray


class GapState(NamedTuple):
    """Gaps of a motion: the smallest one, scaled; gap terms, contacts and limiter as in `SolvedFilm`."""

    smallest: float
    extra: ExtraGap | None
    pressing: ContactFields | None
    limited: LimiterFields | None


class Loads(NamedTuple):
    """Loads of a film on the journal.

    wrench : (6,) array, N and Nm, force and moment about O, contacts included
    contact : (6,) array, part of the wrench by friction of the contacts
    integrals : (4,) array, scaled pressure times cos, sin, z cos, z sin
    couette : scaled integral of the Couette shear
    s_theta : scaled integral of the pressure flow's shear along theta
    recess : shear of the oil in supply areas, which is part of the Couette shear; None without any
    drag : weights (2, n, m) of the pressures in the integrals of uneven drag; None if both surfaces have equal shares
    """

    wrench: np.ndarray
    contact: np.ndarray
    integrals: np.ndarray
    couette: float
    s_theta: float
    recess: RecessShear | None = None
    drag: np.ndarray | None = None


class FacesHeat(NamedTuple):
    """Heat of the films on end faces, W, and oil that they take in, m3/s.

    inner : (2,) array, intake at the inner radius of the lower and of the upper face, 0 without a face
    outer : intake at the outer radii
    """

    heat: float
    inner: np.ndarray
    outer: float


class SolvedFilm(NamedTuple):
    """Solved film of one evaluation; a tuple, because tuples are made fast and every evaluation makes one.

    Attributes
    ----------
    parts : FilmParts
    grid, solver : FilmGrid, FilmSolver
        Grid and solver of ``parts``; the solver's buffers contain gaps, links and factor of this film.
    scales : Scales
    journal : JournalMotion
    history, step : History or None, float
        History at the start of the step, and the time since then, s.
    temperature : float, (n, m) array or None
        Temperature, K, with whose viscosity the film was solved.
    extra : ExtraGap or None
    pressing, limited : buffers or None
        Buffers of ``parts`` for contacts and limiter; None if the gaps are too large for them to act.
    oil : OilFields
    loads : Loads
    minimum_gap : float
        m.
    bore : BoreState or None
        None for a rigid bore.
    serial : int
        Value of ``parts.evaluations`` at this evaluation.
    walls : Walls or None
        None if no wall conducts.
    beside : FacesHeat or None
        Heat of films on end faces, which takes part in the heat balance.
    """

    parts: FilmParts
    grid: FilmGrid
    solver: FilmSolver
    scales: Scales
    journal: JournalMotion
    history: History | None
    step: float
    temperature: float | np.ndarray | None
    extra: ExtraGap | None
    pressing: ContactFields | None
    limited: LimiterFields | None
    oil: OilFields
    loads: Loads
    minimum_gap: float
    bore: BoreState | None
    serial: int
    walls: Walls | None = None
    beside: FacesHeat | None = None

    @property
    def pressure(self) -> np.ndarray:
        """Pressure (n, m), Pa."""
        return self.oil.P * self.scales.pressure

    def require_current(self) -> None:
        """Raise RuntimeError if the buffers contain the film of a later evaluation."""
        if self.parts.evaluations != self.serial:
            raise RuntimeError("Evaluation: the model has evaluated another state since; evaluate this state again.")

    def shear_by_unknowns(self) -> csr_matrix | None:
        """Derivative (n m, n m) of the viscosity ratio to the unknowns of nearby vertices; None if it is zero."""
        if self.oil.ratio_g is None:
            return None
        along, across = (
            diags(g.ravel()) @ d for g, d in zip(self.oil.ratio_g, self._thinning().operators, strict=True)
        )
        return csr_matrix((along + across) @ diags(self._pressures().ravel()))

    def gather_shear(self, weights: np.ndarray) -> np.ndarray:
        """Transpose of `shear_by_unknowns`: sums (n, m) for the unknowns; weights (2, n, m) include ``ratio_g``."""
        return self._thinning().gather(weights) * self._pressures()

    def _thinning(self) -> ShearThinning:
        return next(e for e in self.solver.flux_effects if isinstance(e, ShearThinning))

    def _pressures(self) -> np.ndarray:
        """Field (n, m): 1 where the unknown is a pressure, 0 where it is a fill."""
        s = self.solver
        return (s.work.active | self.grid.fixed).astype(float) if s.closure.conserves_mass else s.ones

    def share(self) -> np.ndarray:
        """Shear at each vertex over that of a full film (n, m)."""
        return shear_share(self.solver.system, self.solver.work.active, self.solver.closure)

    def slip(self, transition_speed: float) -> tuple[np.ndarray, np.ndarray]:
        """Regularised slip direction (theta, z) and its derivatives (2, 2) to (omega, w): v / sqrt(|v|^2 + v0^2)."""
        return slip(self.journal.motion, self.grid.reference_length, transition_speed)

    @property
    def is_central(self) -> bool:
        """Return whether the journal is at the exact centre of a film that may rupture, with no pressure anywhere."""
        w, cavity, source = self.journal, self.scales.cavity, ROUNDING * abs(self.journal.omega)
        # most films return here
        if abs(w.pose[0]) > ROUNDING or np.abs(w.pose).max() > ROUNDING or np.abs(w.rate).max() > source:
            return False
        if not self.solver.ruptures or isinstance(self.parts.bearing.inlet, MaximumGap) or self.grid.edges.size:
            return False
        return bool(np.abs(self.oil.P - cavity).max() <= source + 1e-12 * abs(cavity))
