"""Balance of a journal in tilting pads under a steady load, with stiffness and damping of journal and pads.

Unknowns are the position x of the journal and, on flexible pivots, the shifts eta of the pads. For given unknowns, each
pad alone is brought into balance: at the largest tilt, in the sense of rotation, at which the moment about its pivot
falls through zero. A smaller tilt without moment is unstable. The film of the pad is solved for tilts between those at
which an edge touches. A pad without such a tilt is unloaded: it would tilt further until its leading edge rubs, which
is called spragging. It is held, without pressure, at the tilt from which on its gap widens all along the pad.

Shear tips a pad over if its load is below a small limit above zero. If a loaded pad would carry less than this limit,
and the journal moves closer to an unloaded pad, no position is found in either state. Then the pad that carries the
least is treated as tipped over for the rest of the search.

Newton's method uses the exact Jacobian with the tilts eliminated, ``K_aa - K_at K_tt^-1 K_ta``. Steps that do not
reduce the residual are damped after Levenberg and Marquardt (`exudyn_ehd.joint.newton`).

From a position on a single pad the films may push the journal away after a small slow displacement. The search then
goes on in this direction, until other pads carry too. If it finds nothing, the position is returned with a warning.

Small motions ``q exp(i nu t)`` of all coordinates q = (x, y, tilts, shifts) obey ``Z q = f``, Z = K + i nu C - nu^2 M.
Without forces on the pads, the dynamic stiffness of the journal is ``Z_jj - Z_jp Z_pp^-1 Z_pj``.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import partial

import numpy as np

from exudyn_ehd.joint.newton import ROUNDED, ROUNDS, SETTLED, DampedNewton, SearchState, damped_step
from exudyn_ehd.joint.static.dynamic_stiffness import FilmMemory
from exudyn_ehd.joint.static.pads import Pad, PadLoads, TiltingPads, open_tilts
from exudyn_ehd.joint.static.steady import SteadyResult, result_at
from exudyn_ehd.pictures.records import shown
from exudyn_ehd.status import SMALL, FilmError, InputError, require_number, warn_user

WHERE = "equilibrium"
# Force on a pad, over the load, above which the pad counts as carrying.
CARRIES = 0.01
# Positions between the tilts at which an edge touches (0 and 1), at which the moment is evaluated first. More: a
# balance is missed less often, slower.
PLACES = (0.98, 0.9, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3, 0.2, 0.1, 0.02)
# Eccentricities of initial guesses along the load, over the assembled clearance, and distances from an unstable
# position; more of them: a start nearer to the solution. If all fail, directions of further initial guesses from the
# load, because a load may push the journal of a bearing with few pads between two of them.
STARTS = np.array([0.0, 0.15, 0.3, 0.45, 0.6, 0.75, 0.9, 1.05, 1.3, 1.6, 1.9])
TURNS = np.exp(1j * np.array([0.0, 0.3, -0.3, 0.6, -0.6, 0.9, -0.9]))
# Number of initial guesses, those with the smallest unbalance, from which a search is made. After as many times
# `ROUNDS` positions no further search begins.
MOST_STARTS = 2


def settled(pad: Pad, journal: np.ndarray, shift: float, tipped: bool) -> PadLoads | None:
    """Loads of a pad at its tilt of balance, for a position of the journal (2,) and a shift of the pad.

    ``tipped``: the pad has tipped over and can be loaded at its leading edge only. None without a film.
    """
    tilts, sense = open_tilts(pad, journal, shift), math.copysign(1.0, pad.speed)
    if tilts is None:
        return None
    lower, upper, widening = tilts
    upper = widening if tipped else upper
    places, best = PLACES, (-math.inf, PLACES[0])
    for _ in range(2):
        above = upper
        for place in places:
            tilt = lower + place * (upper - lower)
            here = pad.at(journal, shift, tilt)
            if here is not None and sense * here.forces[2] > 0.0:
                return _between(pad, journal, shift, (tilt, above))
            if here is not None:
                best = max(best, (sense * float(here.forces[2]), place))
            above = tilt
        # a moment that is positive between two places only
        reach = PLACES[1] - PLACES[2]
        places = tuple(np.clip(np.linspace(best[1] + reach, best[1] - reach, len(PLACES)), 0.01, 0.99))
    resting = pad.at(journal, shift, widening)
    return None if resting is None else resting._replace(loaded=False)


def _between(pad: Pad, journal: np.ndarray, shift: float, ends: tuple[float, float]) -> PadLoads | None:
    """Loads at the tilt, between two tilts, at which the moment falls through zero; None if there is none.

    Newton's method with bisection, since only a bracket holds the search at a tilt where the moment falls: at the other
    tilts without a moment the pad is unstable.
    """
    (lower, upper), sense = ends, math.copysign(1.0, pad.speed)
    tilt = 0.5 * (lower + upper)
    finest = SETTLED * pad.model.bearing.radial_clearance / pad.arm
    for _ in range(ROUNDS):
        here = pad.at(journal, shift, tilt)
        rises = here is not None and sense * here.forces[2] > 0.0
        lower, upper = (tilt, upper) if rises else (lower, tilt)
        stiff = 0.0 if here is None else here.stiffness[2, 2]
        step = here.forces[2] / stiff if here is not None and stiff > 0.0 else math.inf
        if abs(step) <= finest:
            return here
        if abs(upper - lower) <= finest:
            return here if stiff > 0.0 else None
        tilt = tilt + step if (tilt + step - lower) * (tilt + step - upper) < 0.0 else 0.5 * (lower + upper)
    return None


@dataclass(eq=False)
class Balanced(SearchState[list[PadLoads]]):
    """A position of the journal with every pad in balance about its pivot.

    The unknowns ``x`` (2 + k,) are the position of the journal and the shifts of the pads, m; ``unbalance`` are the sum
    of forces on the journal, with the load, and the forces on the shifts, N; ``film`` are the loads of all pads.

    Attributes
    ----------
    slope : (2 + k, 2 + k) array
        Minus the derivative of ``unbalance``, N/m.
    """

    slope: np.ndarray

    @property
    def carried(self) -> np.ndarray:
        """Sizes of the forces on the journal (n,), N."""
        return np.array([np.hypot(*here.forces[:2]) for here in self.film])

    def falls(self) -> np.ndarray | None:
        """Direction in which the films push the journal away after a small slow displacement; None without one."""
        stiffness, directions = np.linalg.eig(self.slope)
        real = np.where(stiffness.imag == 0.0, stiffness.real, math.inf)
        least = int(real.argmin())
        return directions[:, least].real if real[least] < -SMALL * np.abs(stiffness).max() else None


class PadSearch(DampedNewton[Balanced]):
    """Search for the position of a journal in tilting pads under a load (2,), N.

    Parameters
    ----------
    bearing : TiltingPads
    speed : float
        rad/s.
    load : (2,) array
        Force on the journal, N.
    size : float
        Force over which the unbalance is measured, N.
    where : str
        Name of the caller, for error messages.
    """

    def __init__(self, bearing: TiltingPads, speed: float, load: np.ndarray, size: float, where: str = WHERE) -> None:
        self.bearing, self.load, self.size, self.where = bearing, load, size, where
        self.pads = [Pad(bearing, k, speed) for k in range(bearing.pads)]
        self.moves, self.tipped = bearing.pivot_stiffness is not None, np.zeros(bearing.pads, dtype=bool)

    def at(self, unknowns: np.ndarray) -> Balanced | None:
        """Return the state with every pad in balance, for given unknowns; None if a film is closed."""
        n, loads, self.count = unknowns.size, [], self.count + 1
        unbalance, slope = np.append(self.load, np.zeros(n - 2)), np.zeros((n, n))
        for k, pad in enumerate(self.pads):
            here = settled(pad, unknowns[:2], float(unknowns[2 + k]) if self.moves else 0.0, bool(self.tipped[k]))
            if here is None:
                return None
            K, own, places = here.stiffness, [0, 1, 3][: 2 + self.moves], [0, 1, 2 + k][: 2 + self.moves]
            unbalance[places] += here.forces[own]
            follows = np.outer(K[own, 2], K[2, own]) / K[2, 2] if here.loaded else 0.0
            slope[np.ix_(places, places)] += K[np.ix_(own, own)] - follows
            loads.append(here)
        return Balanced(unknowns, unbalance, self.size, partial(damped_step, slope, unbalance), loads, slope)

    def is_balanced(self, state: Balanced, tolerance: float) -> bool:
        """Return whether the unbalance is below a share of the load plus the round-off of the pads' forces."""
        return state.residual <= tolerance * state.size + SETTLED * float(state.carried.sum())

    def find(self) -> Balanced:
        """Find the position in which the films carry the load; `FilmError` without one."""
        along = complex(*self.load) / max(float(np.hypot(*self.load)), 1e-300) * self.bearing.radial_clearance
        unmoved, found = np.zeros(self.bearing.pads if self.moves else 0), []
        for k in range(self.bearing.pads + 1 if np.any(along) else 1):
            if self.count > MOST_STARTS * ROUNDS:
                break
            places = np.outer(TURNS if k == 1 else TURNS[:1], STARTS if np.any(along) else STARTS[:1]).ravel() * along
            tried = [self.at(np.array([place.real, place.imag, *unmoved])) for place in places]
            # in directions off the load, only positions at which two or more pads carry
            starts = [p for p in tried if p and (k != 1 or np.sum(p.carried > CARRIES * self.size) > 1)]
            starts.sort(key=lambda place: place.residual)
            for start in starts[:MOST_STARTS]:
                found.append(here := self._descend(start))
                if self.is_balanced(here, ROUNDED):
                    return self._stable(here)
            if k and found:
                here = min(found, key=lambda place: place.residual)
                self.tipped[np.argmin(np.where(self.tipped, math.inf, here.carried))] = True
        off = min((here.residual for here in found), default=math.inf) / self.size
        yields, soft = self.size / (self.bearing.pivot_stiffness or math.inf), ""
        if yields > self.bearing.radial_clearance:
            soft = (
                f"Under this load a pivot yields by {shown('length', yields)}, more than the clearance, which "
                "leaves the pads beside the load without any: give them a larger pivot_stiffness. "
            )
        raise FilmError(
            f"{self.where}: no position found in which the tilting pads carry {self.size:.4g} N; the nearest is off by "
            f"{off:.2g} of the load. {soft}Pads that hardly carry are tipped over by friction: give them more preload, "
            "contact=RegularisedWall(onset=...) to rest on, or more load; where films are thin, less load or a finer "
            "film grid."
        )

    def _stable(self, found: Balanced) -> Balanced:
        """Return a position to which the journal falls from the one that was found; this one, if it does not fall."""
        if (direction := found.falls()) is None:
            return found
        for length in np.outer(STARTS[1:8:2], (1.0, -1.0)).ravel() * self.bearing.radial_clearance:
            start = self.at(found.x + length * direction)
            here = found if start is None else self._descend(start)
            if self.is_balanced(here, ROUNDED) and here.falls() is None:
                return here
        x, y = found.x[:2].tolist()
        warn_user(
            f"{self.where}: the journal rests unstably at ({x:.3g}, {y:.3g}) m: after a small displacement the films "
            "push it further away, until other pads carry it; no stable position was found. Give the pads more "
            "preload, or let the load act between two pads.",
            UserWarning,
        )
        return found

    def _descend(self, start: Balanced) -> Balanced:
        """Search by full steps of Newton's method as long as they reduce the unbalance, then by damped steps."""
        found = self.search(start, halvings=0)
        if self.is_balanced(found, ROUNDED):
            return found
        return self.search(found, resistance=10.0 * self.size / self.bearing.radial_clearance)

    def step(self, state: Balanced, resistance: float) -> np.ndarray:
        """Newton's step of at most half of the machined clearance."""
        step, longest = state.newton_step(resistance), 0.5 * self.bearing.machined_clearance
        return step * min(1.0, longest / max(float(np.abs(step).max()), 1e-300))

    def moved(self, state: Balanced, step: np.ndarray) -> Balanced | None:
        """State after a step."""
        return self.at(state.x + step)


@dataclass(frozen=True, eq=False, kw_only=True)
class TiltingPadResult:
    """Result of `equilibrium` for tilting pads: position of the journal, tilts of the pads, stiffness and damping.

    Attributes
    ----------
    position : (2,) array
        x, y of the journal axis, m.
    eccentricity_ratio : float
        Distance of the journal axis from the bearing's centre over the assembled clearance.
    tilts : (n,) array
        Angles of the pads about their pivots, rad, positive about z; 0 as built.
    pivot_displacements : (n,) array
        Outward displacements of the pads at their pivots, m; 0 with rigid pivots.
    loaded : (n,) bool array
        False for an unloaded pad: no tilt balances the moment about its pivot. Without friction it would float; with
        friction it tilts until its leading edge rubs (spragging). Its tilt here is the one from which on its gap widens
        along the pad, so that its film has no pressure; `reduced` holds it at this tilt.
    pad_forces : (n,) array
        Radial forces of the films on the pads, N.
    minimum_gaps, peak_pressures : (n,) arrays
        Minimum film thickness of every pad, m, and its largest film pressure, Pa.
    minimum_gap, peak_pressure, power_loss : float
        Values of the whole bearing, m, Pa, W.
    coordinates : tuple of str
        Names of the coordinates of the matrices: ``x``, ``y``, ``tilt 1`` ..., ``shift 1`` ...
    stiffness, damping, mass : (k, k) arrays
        K, C and M of small motions of all coordinates, SI units: minus the derivatives of the forces on the journal and
        the generalized forces on the pads to coordinates and rates. M contains the pads, but not the journal.
    residual : float
        Largest component of the unbalance over the size of the load.
    iterations : int
        Number of positions of the journal that were tried.
    films : tuple of SteadyResult
        Film of every pad in the pad's frame, with its pictures.
    speed : float
        Spin, rad/s.
    memories : tuple of FilmMemory
        Frequency-dependent stiffness of films with `ElrodAdams`, which follow motions with a delay. It is the
        difference to slow motions, for which ``stiffness`` and ``damping`` hold. `reduced` and `SolveEquilibrium` use
        it.

    Examples
    --------
    After the example of `TiltingPads`:

    >>> rest = ehd.equilibrium(pads, speed=300.0, load=(0.0, -4000.0))
    >>> rest.loaded.tolist(), round(rest.eccentricity_ratio, 2)
    ([True, True, True, True, True], 0.44)
    >>> K, C = rest.reduced()
    >>> (1e-6 * np.diag(K)).round()  # N/um, x and y
    array([123., 190.])
    """

    position: np.ndarray
    eccentricity_ratio: float
    tilts: np.ndarray
    pivot_displacements: np.ndarray
    loaded: np.ndarray
    pad_forces: np.ndarray
    minimum_gaps: np.ndarray
    peak_pressures: np.ndarray
    minimum_gap: float
    peak_pressure: float
    power_loss: float
    coordinates: tuple[str, ...]
    stiffness: np.ndarray = field(repr=False)
    damping: np.ndarray = field(repr=False)
    mass: np.ndarray = field(repr=False)
    residual: float
    iterations: int
    films: tuple[SteadyResult, ...] = field(repr=False)
    speed: float
    memories: tuple[FilmMemory, ...] = field(repr=False)

    def __repr__(self) -> str:
        idle = ", ".join(str(k + 1) for k in np.flatnonzero(~self.loaded))
        unloaded = f", unloaded pads {idle}" if idle else ""
        gap, peak = shown("length", self.minimum_gap), shown("pressure", self.peak_pressure)
        return (
            f"<TiltingPadResult: eccentricity ratio {self.eccentricity_ratio:.4f}, minimum film thickness {gap}, peak "
            f"pressure {peak}, power loss {shown('power', self.power_loss)}{unloaded}>"
        )

    def reduced(self, frequency: float | None = None) -> tuple[np.ndarray, np.ndarray]:
        """Stiffness and damping (2, 2) of the journal, with pads that follow its motion at a frequency.

        Damping of motions much slower than the spin may be negative. A pad that carries hardly any load follows with a
        delay and is driven by the spin, because its film has coupled stiffnesses of opposite signs. Example: a pad with
        4 % of a bearing's load, in its weakest direction, had -5.1e6 N s/m at 2 rad/s, -2e5 at 100 and 1.7 at the spin
        of 263 rad/s. Cycles of its film in time gave the same within 3 %.

        Parameters
        ----------
        frequency : float or None, default None
            Frequency of the motion, rad/s, not 0; None: that of the spin.

        Returns
        -------
        stiffness, damping : (2, 2) arrays
            N/m and N s/m.

        Raises
        ------
        InputError
            For a frequency that is not finite, or 0.
        """
        nu = abs(self.speed) if frequency is None else require_number("reduced: frequency", frequency, "rad/s")
        if nu == 0.0:
            raise InputError("reduced: frequency must not be 0, got 0; take a small one for slow motions.")
        count = self.loaded.size
        follows = 2 + np.flatnonzero(np.append(self.loaded, np.ones(self.stiffness.shape[0] - 2 - count, dtype=bool)))
        Z = self.stiffness + 1j * nu * self.damping - nu**2 * self.mass
        Z = Z + sum(memory.beyond(1j * nu) for memory in self.memories)
        answer = np.linalg.solve(Z[np.ix_(follows, follows)], Z[follows, :2])
        own = Z[:2, :2] - Z[:2, follows] @ answer
        return own.real, own.imag / nu


def pad_equilibrium(
    bearing: TiltingPads, speed: float, load: np.ndarray, size: float, parallel: bool
) -> TiltingPadResult:
    """Equilibrium of a journal in tilting pads under a load (2,), N; `equilibrium` has checked the arguments.

    ``size``: force over which the residual is measured, N; ``parallel``: True without tilt, axial position and axial
    load.
    """
    if not parallel:
        raise InputError(
            f"{WHERE}: tilt, axial_position and axial_load are not for TiltingPads(...), whose pads follow a parallel "
            "journal only and hold nothing along the axis; leave them out."
        )
    search = PadSearch(bearing, speed, load, size)
    found = search.find()
    n, loads = bearing.pads, found.film
    names = ("x", "y", *(f"tilt {k + 1}" for k in range(n)), *(f"shift {k + 1}" for k in range(n * search.moves)))
    (K, C, M), memories = np.zeros((3, len(names), len(names))), list[FilmMemory]()
    for k, own in enumerate(loads):
        places = [0, 1, 2 + k, 2 + n + k][: 3 + search.moves]
        part = np.ix_(places, places)
        K[part] += own.stiffness[: len(places), : len(places)]
        C[part] += own.damping[: len(places), : len(places)]
        M[places[2:], places[2:]] = (bearing.pad_inertia, bearing.pad_mass)[: len(places) - 2]
        if (memory := search.pads[k].memory(own)) is not None:
            unit, count = np.eye(len(names))[places], len(places)
            maps = {"loads": unit.T @ memory.loads[:count], "places": memory.places[:, :count] @ unit}
            memories.append(memory._replace(**maps))
    pairs = zip(search.pads, loads, strict=True)
    films = tuple(result_at(pad.model, own.motion, WHERE, own.history) for pad, own in pairs)
    loaded, position = np.array([own.loaded for own in loads]), found.x[:2]
    if not loaded.any():
        warn_user(
            f"{WHERE}: no pad is loaded: without load and preload the pads lie at no definite tilt, and stiffness and "
            "damping are about zero; give the pads a preload, or the journal a load.",
            UserWarning,
        )
    shifts = found.x[2:] if search.moves else np.zeros(n)
    return TiltingPadResult(
        position=position,
        eccentricity_ratio=float(np.hypot(*position)) / bearing.radial_clearance,
        tilts=np.array([own.tilt for own in loads]),
        pivot_displacements=shifts,
        loaded=loaded,
        pad_forces=np.array([own.forces[3] for own in loads]) + shifts * (bearing.pivot_stiffness or 0.0),
        minimum_gaps=np.array([film.minimum_gap for film in films]),
        peak_pressures=np.array([film.peak_pressure for film in films]),
        minimum_gap=min(film.minimum_gap for film in films),
        peak_pressure=max(film.peak_pressure for film in films),
        power_loss=sum(film.power_loss for film in films),
        coordinates=names,
        stiffness=K,
        damping=C,
        mass=M,
        residual=float(np.abs(found.unbalance).max()) / size,
        iterations=search.count,
        films=films,
        speed=speed,
        memories=tuple(memories),
    )
