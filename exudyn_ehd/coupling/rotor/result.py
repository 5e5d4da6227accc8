"""Results for rotors in their films: positions, coefficients, eigenvalues, and the response to unbalance."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import exudyn as exu
import numpy as np

from exudyn_ehd.coupling.contract import INITIAL, Index, NodeIndex, ObjectIndex, require_system
from exudyn_ehd.coupling.rotor.vibrations import vibrations, vibrations_in_films_that_follow
from exudyn_ehd.coupling.run.restart import settle
from exudyn_ehd.coupling.run.solve import joints_of
from exudyn_ehd.joint.static.dynamic_stiffness import FilmMemory
from exudyn_ehd.pictures.records import Axes, Figure, Target
from exudyn_ehd.status import FilmError, InputError, require_number


@dataclass(frozen=True, kw_only=True, eq=False)
class Layout:
    """Map of the system's nodes and bodies to its N directions: displacements and rotations of nodes in space.

    Attributes
    ----------
    nodes : dict
        First of the six directions of a rigid node, by its number.
    bodies : dict
        Node of a rigid body, by its number.
    frames : dict
        Axes (3, 3) in space of the rotor of a node that spins, the spin's last, by its number.
    ratios : dict
        Speed of that rotor over that of the first one.
    length : float
        Length of the longest bearing, which scales rotations to displacements, m.
    """

    nodes: Mapping[int, int]
    bodies: Mapping[int, int]
    frames: Mapping[int, np.ndarray]
    ratios: Mapping[int, float]
    length: float

    def spinning(self, where: str, item: Index) -> int:
        """The node of a body or node of a rotor."""
        node = int(item) if isinstance(item, NodeIndex) else self.bodies.get(int(item), -1)
        if not isinstance(item, (NodeIndex, ObjectIndex)) or node not in self.frames:
            raise InputError(
                f"{where} must be the number of a rigid body or a node that spins, as Exudyn gave it, got {item!r}; "
                f"nodes {sorted(self.frames)} do."
            )
        return node


@dataclass(frozen=True, kw_only=True, eq=False)
class RotorResult:
    """Result of `SolveEquilibrium` at k speeds: places, films, vibrations; j films, N directions, n of them free.

    Attributes
    ----------
    speeds : (k,) array
        Speeds of the first rotor, rad/s.
    joints : tuple of str
        Names of the films' joints.
    motion : (k, j, 10) array
        x, y (m) and slopes bx, by (rad) of the journals in the joints' frames, then their four rates, relative spin
        (rad/s) and axial velocity (m/s), as in `JointHistory`.
    wrench : (k, j, 6) array
        Force (N) and moment (N m) of the films on the journals, joint frame.
    eccentricity_ratio, attitude_angle, minimum_gap, peak_pressure, power_loss : (k, j) arrays
        Of every film: e/c; angle from the load on the journal to its eccentricity in the sense of rotation, rad;
        minimum film thickness, m; peak pressure, Pa; power loss, W.
    stiffness, damping : (k, j, 4, 4) arrays
        K and C of every film in its joint's frame: minus the derivative of (F_x, F_y, M_y, -M_x) on the journal, N and
        N m, with respect to (x, y, bx, by), m and rad, and to their rates. With `ElrodAdams`, liners, flexible bushes
        and journals they hold for slow motions.
    mass_matrix, damping_matrix, stiffness_matrix : (k, n, n) arrays
        M, D, K of small motions of the whole system, ``M y_tt + D y_t + K y = 0``, with gyroscopic terms in D. The
        motion of all bodies in space is ``directions @ y``; spins of the driven nodes are prescribed, constraints are
        satisfied. With films that follow with a delay the matrices hold for slow motions; eigenvalues and responses
        also include ``memories``.
    directions : (k, N, n) array
        Map from y to displacements (m) and rotations (rad) in space of all nodes of rigid bodies, and to other
        coordinates.
    film_directions : (k, j, 2, N) array
        Map from these displacements to x and y of the journals in their joints.
    coordinates, rates : (k, c) arrays
        The states in Exudyn's coordinates.
    residual : (k,) array
        Largest unbalanced force divided by the films' loads.
    evaluations : (k,) array
        Number of films solved for each speed.
    clearances : (j,) array
        Radial clearances, m.
    layout : Layout
        Map of bodies to the directions.
    memories : tuple of k tuples of FilmMemory
        Dynamic stiffness of films that follow with a delay, minus that of slow motions.

    Examples
    --------
    After the example of `SolveEquilibrium`:

    >>> result.stiffness.shape, result.eigenvalues.shape  # speeds, films, ...
    ((2, 2, 4, 4), (2, 8))
    >>> result.is_stable
    array([ True, False])
    """

    speeds: np.ndarray
    joints: tuple[str, ...]
    motion: np.ndarray = field(repr=False)
    wrench: np.ndarray = field(repr=False)
    eccentricity_ratio: np.ndarray
    attitude_angle: np.ndarray = field(repr=False)
    minimum_gap: np.ndarray = field(repr=False)
    peak_pressure: np.ndarray = field(repr=False)
    power_loss: np.ndarray = field(repr=False)
    stiffness: np.ndarray = field(repr=False)
    damping: np.ndarray = field(repr=False)
    mass_matrix: np.ndarray = field(repr=False)
    damping_matrix: np.ndarray = field(repr=False)
    stiffness_matrix: np.ndarray = field(repr=False)
    directions: np.ndarray = field(repr=False)
    film_directions: np.ndarray = field(repr=False)
    coordinates: np.ndarray = field(repr=False)
    rates: np.ndarray = field(repr=False)
    residual: np.ndarray = field(repr=False)
    evaluations: np.ndarray = field(repr=False)
    clearances: np.ndarray = field(repr=False)
    layout: Layout = field(repr=False)
    memories: tuple[tuple[FilmMemory, ...], ...] = field(repr=False)

    def __repr__(self) -> str:
        stable = f"{int(self.is_stable.sum())} of {self.speeds.size} stable"
        return (
            f"<RotorResult: {len(self.joints)} films, {self.mass_matrix.shape[1]} degrees of freedom, speeds "
            f"{self.speeds[0]:.4g} to {self.speeds[-1]:.4g} rad/s, {stable}>"
        )

    @cached_property
    def _modes(self) -> tuple[np.ndarray, np.ndarray]:
        """Eigenvalues (k, m), sorted by imaginary and real part, and modes (k, N, m) in the directions."""
        matrices = self.mass_matrix, self.damping_matrix, self.stiffness_matrix
        found = [vibrations(*parts) for parts in zip(*matrices, strict=True)]
        for k, memories in enumerate(self.memories):
            if memories:
                M, D, K = (part[k] for part in matrices)
                found[k] = vibrations_in_films_that_follow(M, D, K, memories)
                if found[k][0].size < 2 * len(M):
                    raise FilmError(
                        f"RotorResult: the vibrations at {self.speeds[k]:.6g} rad/s are not all found, because the "
                        "films follow them with a delay; look at speeds beside it, or run it in time."
                    )
        size = max(len(values) for values, _ in found)
        values = np.full((len(found), size), np.nan, dtype=complex)
        vectors = np.full((len(found), matrices[0].shape[1], size), np.nan, dtype=complex)
        for k, (some, shapes) in enumerate(found):
            values[k, : some.size], vectors[k, :, : some.size] = some, shapes
        order = np.lexsort((values.real, values.imag))
        values = np.take_along_axis(values, order, axis=1)
        return values, self.directions @ np.take_along_axis(vectors, order[:, None, :], axis=2)

    def _beyond(self, k: int, s: complex) -> np.ndarray:
        """Dynamic stiffness (n, n) of motions exp(s t) at speed number k, minus that of slow motions."""
        return sum((film.beyond(s) for film in self.memories[k]), np.zeros(self.mass_matrix.shape[1:]))

    @property
    def eigenvalues(self) -> np.ndarray:
        """Eigenvalues (k, m), complex: growth rate (1/s) + i frequency (rad/s), sorted by signed frequency; m = 2n.

        In films that follow a vibration with a delay (`ElrodAdams`, liners, compressible volumes, flexible bushes and
        journals) oil content and surfaces vibrate too. Then there are more: the 2n motions in which the bodies have the
        largest part, those in which it is above a tenth, and all that grow. Speeds with fewer motions than others have
        nan in some entries, here and in ``modes``.
        """
        return self._modes[0]

    @property
    def modes(self) -> np.ndarray:
        """Mode shapes (k, N, m), complex: motion of all bodies in space for each eigenvalue."""
        return self._modes[1]

    @property
    def growth(self) -> np.ndarray:
        """Largest real part (k,) of the eigenvalues, 1/s; positive: unstable, small motions grow."""
        return np.nanmax(self.eigenvalues.real, axis=1)

    @property
    def is_stable(self) -> np.ndarray:
        """Stability (k,): True if every small motion decays."""
        return self.growth < 0.0

    def campbell(self) -> dict[str, np.ndarray]:
        """Frequencies over the speed, for a Campbell diagram.

        Returns
        -------
        dict
            ``speed`` (k,), rad/s; then (k, m) arrays with one row per speed and one vibration per column, sorted by
            frequency, nan in empty places. ``frequency``, rad/s; ``growth``, 1/s, positive: unstable;
            ``damping_ratio`` = -growth / abs(eigenvalue); ``log_decrement`` = -2 pi growth / frequency; ``whirl``, the
            sense of the orbits of all nodes that spin: 1 circles in the sense of the spin, 0 straight lines or
            torsion, -1 circles against the spin.
        """
        values, k = self.eigenvalues, self.speeds.size
        count = (values.imag > 0.0).sum(axis=1)
        # vibrations stand last
        shown = values[:, values.shape[1] - max(int(count.max()), 1) :]
        frequency = np.where(shown.imag > 0.0, shown.imag, np.nan)
        growth = np.where(shown.imag > 0.0, shown.real, np.nan)
        turned = moved = np.zeros(shown.shape)
        for node, frame in self.layout.frames.items():
            first = self.layout.nodes[node]
            for part, scale in ((slice(first, first + 3), 1.0), (slice(first + 3, first + 6), self.layout.length)):
                x, y, z = np.moveaxis(scale * frame.T @ self.modes[:, part, -shown.shape[1] :], 1, 0)
                turned = turned - 2.0 * np.sign(self.layout.ratios[node]) * np.imag(np.conj(x) * y)
                moved = moved + np.abs(x) ** 2 + np.abs(y) ** 2 + np.abs(z) ** 2
        whirl = np.sign(self.speeds)[:, None] * turned / np.maximum(moved, 1e-300)
        table = {
            "frequency": frequency,
            "growth": growth,
            "damping_ratio": -growth / np.hypot(growth, frequency),
            "log_decrement": -2.0 * math.pi * growth / frequency,
            "whirl": np.where(shown.imag > 0.0, whirl, np.nan),
        }
        # nan first: turned to stand last
        order = np.argsort(frequency, axis=1)
        return {"speed": self.speeds} | {
            name: np.take_along_axis(column, order, axis=1).reshape(k, -1) for name, column in table.items()
        }

    def unbalance_response(self, unbalance: Mapping[Index, complex]) -> UnbalanceResponse:
        """Steady whirl of the rotor under unbalance, by the linear equations about each equilibrium.

        The force of an unbalance U = mass x distance is U Omega^2 and turns with the rotor; displacements solve
        ``(K - Omega^2 M + i Omega D) y = f``. They are valid while they are small against the film thickness, and only
        at speeds at which the equilibrium is stable (``is_stable``): at others the whirl grows.

        Parameters
        ----------
        unbalance : dict
            U in kg m (1e-6 for 1 g mm) by body or node number; all on one rotor. The argument of a complex U is the
            angle of the unbalance in the sense of rotation: 1j is 90 degrees ahead of 1.

        Returns
        -------
        UnbalanceResponse

        Raises
        ------
        InputError
            For bodies that do not spin, of several rotors, or values that are not finite.
        """
        where = "RotorResult.unbalance_response: unbalance"
        if not isinstance(unbalance, Mapping) or not unbalance or not np.all(np.isfinite(list(unbalance.values()))):
            raise InputError(f"{where} must be a dict of finite kg m by the number of a body, got {unbalance!r}.")
        force = np.zeros(self.directions.shape[1], dtype=complex)
        nodes = [self.layout.spinning(where, item) for item in unbalance]
        frame, ratio = self.layout.frames[nodes[0]], self.layout.ratios[nodes[0]]
        for node, value in zip(nodes, unbalance.values(), strict=True):
            if self.layout.frames[node] is not frame:
                raise InputError(f"{where} must be on bodies of one rotor, got nodes {nodes}.")
            first = self.layout.nodes[node]
            # cos(w t) e_1 + sin(w t) e_2 with the time factor e^(i w t), w < 0 for a spin against the joint's axis
            turned = value if ratio * self.speeds[0] > 0.0 else np.conj(value)
            force[first : first + 3] += turned * (frame[:, 0] - 1j * frame[:, 1])
        w = (ratio * self.speeds)[:, None, None]
        dynamic = self.stiffness_matrix - w**2 * self.mass_matrix + 1j * w * self.damping_matrix
        dynamic = dynamic + [self._beyond(k, 1j * nu) for k, nu in enumerate(w.flat)]
        y = np.linalg.solve(dynamic, w**2 * (self.directions.transpose(0, 2, 1) @ force)[:, :, None])
        x = (self.directions @ y)[:, :, 0]
        return UnbalanceResponse(
            speeds=self.speeds,
            spin=ratio * self.speeds,
            is_stable=self.is_stable,
            joints=self.joints,
            films=np.einsum("kjan,kn->kja", self.film_directions, x),
            displacement=x,
            clearances=self.clearances,
            layout=self.layout,
        )

    def place(self, mbs: exu.MainSystem, speed: float) -> None:
        """Let the next run of the system start in the equilibrium of one of the speeds.

        Sets Exudyn's initial coordinates and rates, and the memory of the films: oil content, temperature and
        deflection of the steady films there.

        Parameters
        ----------
        mbs : exudyn.MainSystem
            System of the result, or one like it, assembled.
        speed : float
            One of ``speeds``, rad/s.

        Raises
        ------
        InputError
            For another system or speed.
        """
        require_system("RotorResult.place", mbs)
        require_number("RotorResult.place: speed", speed, "rad/s")
        k = int(np.argmin(np.abs(self.speeds - speed)))
        if abs(self.speeds[k] - speed) > 1e-9 * abs(speed):
            raise InputError(f"RotorResult.place: speed must be one of the result's, got {speed!r}; see .speeds.")
        size = len(mbs.systemData.GetODE2Coordinates())
        if size != self.coordinates.shape[1]:
            raise InputError(
                f"RotorResult.place: mbs must be the system of the result, of {self.coordinates.shape[1]} coordinates, "
                f"got one of {size}."
            )
        mbs.systemData.SetODE2Coordinates(self.coordinates[k].tolist(), INITIAL)
        mbs.systemData.SetODE2Coordinates_t(self.rates[k].tolist(), INITIAL)
        for joint in joints_of(mbs):
            settle(mbs, joint.element)

    def plot_campbell(self, *, ax: Axes | None = None, path: Target = None) -> Figure:
        """Campbell diagram: frequencies over the speed, coloured by the sense of whirl; crosses mark growth."""
        from exudyn_ehd.pictures.curves import plot_campbell

        return plot_campbell(self.campbell(), ax=ax, path=path)

    def plot_stability(self, *, ax: Axes | None = None, path: Target = None) -> Figure:
        """Plot the logarithmic decrements of the vibrations over the speed; below zero the rotor is unstable."""
        from exudyn_ehd.pictures.curves import plot_stability

        return plot_stability(self.campbell(), ax=ax, path=path)

    def plot_positions(self, *, ax: Axes | None = None, path: Target = None) -> Figure:
        """Plot the journals' positions over the speed in the circle of the clearance, each over its own clearance."""
        from exudyn_ehd.pictures.curves import plot_positions

        places = self.motion[:, :, :2] / self.clearances[:, None]
        return plot_positions(self.speeds, places, self.joints, ax=ax, path=path)


@dataclass(frozen=True, kw_only=True, eq=False)
class UnbalanceResponse:
    """Whirl of a rotor under unbalance at k speeds, forward and backward part of every orbit.

    A point moves by ``z = x + i y = forward exp(i w t) + conj(backward) exp(-i w t)`` with w = abs(spin), x and y
    transverse to the axis and counted so that the rotor turns from x to y; the unbalance of 1 kg m pulls along
    ``exp(i w t)``.

    Attributes
    ----------
    speeds, spin : (k,) arrays
        Speeds of the first rotor and of the rotor with the unbalance, rad/s.
    is_stable : (k,) array
        True where the equilibrium is stable.
    joints : tuple of str
    films : (k, j, 2) array
        Complex amplitudes of x and y of the journals, joint frame, time factor exp(i spin t), m.
    displacement : (k, N) array
        Displacements in all directions of the system.
    clearances : (j,) array
        m.
    layout : Layout

    Examples
    --------
    After the example of `SolveEquilibrium`, 40 g mm in the middle of the shaft:

    >>> response = result.unbalance_response({shaft: 4e-5})
    >>> (1e6 * response.amplitude("held")).round(4)  # um
    array([0.0004, 0.0298])
    """

    speeds: np.ndarray
    spin: np.ndarray
    is_stable: np.ndarray
    joints: tuple[str, ...]
    films: np.ndarray = field(repr=False)
    displacement: np.ndarray = field(repr=False)
    clearances: np.ndarray = field(repr=False)
    layout: Layout = field(repr=False)

    def orbit(self, item: str | Index) -> tuple[np.ndarray, np.ndarray]:
        """Forward and backward amplitude (k,) of a journal, by the name of its joint, or of a body or node, m."""
        if isinstance(item, str):
            if item not in self.joints:
                raise InputError(f"UnbalanceResponse: no joint '{item}', there are {list(self.joints)}.")
            x, y = self.films[:, self.joints.index(item)].T
        else:
            node = self.layout.spinning("UnbalanceResponse: item", item)
            first, frame = self.layout.nodes[node], self.layout.frames[node]
            x, y = (self.displacement[:, first : first + 3] @ frame[:, :2]).T
        if self.spin[0] < 0.0:
            x, y = np.conj(x), -np.conj(y)
        return 0.5 * (x + 1j * y), 0.5 * (x - 1j * y)

    def amplitude(self, item: str | Index) -> np.ndarray:
        """Largest distance (k,) from the equilibrium in an orbit, m: its major semi-axis."""
        forward, backward = self.orbit(item)
        return np.abs(forward) + np.abs(backward)

    def phase(self, item: str | Index) -> np.ndarray:
        """Angle (k,) of the forward part relative to the unbalance, rad; negative where it lags behind."""
        return np.angle(self.orbit(item)[0])

    def plot(
        self, items: Sequence[str | Index] | Mapping[str, str | Index] | None = None, *, path: Target = None
    ) -> Figure:
        """Amplitude and phase of journals, bodies or nodes over the speed, ``{text: item}``; by default all joints.

        Dotted where the rotor is unstable.
        """
        from exudyn_ehd.pictures.curves import plot_response

        chosen = self.joints if items is None else items
        named = chosen if isinstance(chosen, Mapping) else {str(item): item for item in chosen}
        curves = [(text, self.amplitude(item), self.phase(item)) for text, item in named.items()]
        return plot_response(self.speeds, curves, self.is_stable, path=path)
