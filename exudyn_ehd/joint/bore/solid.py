"""Bore of a nodal bush in balance with its film: static equilibrium of the bush's solid, at any strain.

With the displacements u of the mesh, its internal forces f(u) and the film's forces F on the nodes of the bore

    f(u) = F(u)    with the outer surface held,

F as on the same nodes in a joint. The solid is linearised about a state u0, ``f(u0) + K (u - u0)``. Condensed on the x
and y displacements q of the bore's nodes, it resists the film's pressure by ``K_c (q - q_free)``.
`exudyn_ehd.joint.bore.equilibrium` finds the balance of this linear solid with the film. From there the same K, with
the film's derivative S = dF/du, corrects u by ``(K - S) du = F - f(u)``; each correction costs one film. If the
corrections contract too slowly, the solid is linearised again about the state that they have reached.
"""

from __future__ import annotations

import numpy as np
from numpy.linalg import LinAlgError
from scipy.linalg import lu_factor, lu_solve
from scipy.sparse.linalg import SuperLU

from exudyn_ehd.film.banded.substitution import TILE
from exudyn_ehd.joint.bore.equilibrium import BoreSearch, Elasticity, FilmOnBore, NodalEvaluation
from exudyn_ehd.joint.newton import HALVINGS, PATIENCE, ROUNDED, SETTLED, continued
from exudyn_ehd.joint.solved_film import MOTION_SIZE, History
from exudyn_ehd.solid.total_lagrange import TotalLagrange, sparse_factor
from exudyn_ehd.status import SMALL, Status

# Contraction rates of the corrections: above the first the solid is linearised again, above the second for an exact
# tangent. Smaller: more factors, more accurate tangents.
SLOWEST, EXACT = 0.3, 1e-3
NO_BALANCE = (
    "the solid finds no balance with the film's load, which may lie above a limit point; take NeoHooke(...) for "
    "strains beyond a few per cent, a finer mesh, a thicker wall, or less load."
)


FilmInput = tuple[History | None, float, float]


class SolidElasticity(Elasticity):
    """Stiffness of the bore's coordinates in a steady state by a solid, linear about a state near its last balance.

    Parameters
    ----------
    solid : TotalLagrange
        Bush frame = joint frame.

    Attributes
    ----------
    displacements : (n, 3) array
        u of the last balance, m.
    """

    def __init__(self, solid: TotalLagrange) -> None:
        super().__init__(np.zeros((0, 0)))
        mesh = solid.mesh
        self.solid = solid
        free = np.ones(mesh.nodes.shape, dtype=bool)
        free[mesh.outer.nodes] = False
        self._free = free.ravel()
        # which x and y of the bore's nodes are free, and their indices among the free coordinates
        self._moves = free[mesh.bore.nodes, :2].ravel()
        self._places = (np.cumsum(self._free) - 1)[(3 * mesh.bore.nodes[:, None] + np.arange(2)).ravel()][self._moves]
        self.displacements, self._beside = np.zeros(free.shape), np.zeros(free.shape)
        self._contraction, self._linearised, self._pose = 0.0, 0, np.zeros(4)
        self._q_free = np.zeros(self._moves.size)
        self._factor: SuperLU | None = None

    def force(self, q: np.ndarray) -> np.ndarray:
        """Generalised force (k,) that holds the bore of the linear solid at q, N."""
        return self.stiffness @ (q - self._q_free)

    def tangent(self, evaluation: NodalEvaluation, exact: bool) -> np.ndarray:
        """Return `Elasticity.tangent`.

        Not ``exact``: with radial loads only, and with the stiffness of the last search. ``exact``: with all forces on
        the bore's nodes, and with the solid linearised about the last balance or close to it. Forces along z are
        replaced by loads on q that displace the bore equally.
        """
        if not exact:
            return evaluation.tangent()
        if self._contraction > EXACT:
            self._renew()
        bore, moves = self.solid.mesh.bore, self._moves
        wrench, nodal = evaluation.tangent_at(bore.positions + self.displacements[bore.nodes])
        loads = nodal[:, :2].reshape(-1, nodal.shape[2])
        loads[moves] += (self.stiffness[np.ix_(moves, moves)] @ self._by_axial.T) @ nodal[:, 2]
        return np.concatenate((wrench, loads))

    def settle(
        self, model: FilmOnBore[NodalEvaluation], motion: np.ndarray, film: FilmInput, start: np.ndarray
    ) -> NodalEvaluation | None:
        """Find the balance of bore and film from the last balance, or else from the undeformed bush."""
        self.failure, self._linearised, self.reached = "", 0, (0.0, start)
        if self._factor is None:
            self._renew()
        last, pose, rest = self.displacements, self._pose, np.zeros_like(self.displacements)
        found = self._approach(model, motion, film, start)
        if found is None and last.any():
            self._return(rest)
            self._pose = np.zeros(4)
            found = self._approach(model, motion, film, np.zeros_like(start))
        if found is None:
            self._return(last)
            self._pose = pose
        else:
            self.failure, self._pose = "", motion[:4].copy()
        return found

    def _approach(
        self, model: FilmOnBore[NodalEvaluation], motion: np.ndarray, film: FilmInput, start: np.ndarray
    ) -> NodalEvaluation | None:
        """Find the balance directly, else by continuation of the pose from that of the present displacements."""
        between = motion.copy()

        def reach(share: float, here: NodalEvaluation | None, final: bool) -> NodalEvaluation | None:
            if self._linearised >= 3 * PATIENCE:
                return None
            between[:4] = (1.0 - share) * self._pose + share * motion[:4]
            before, q = self.displacements, start if here is None else here.bore.coordinates.copy()
            if (near := self._balance(model, between, film, q)) is None:
                self._return(before)
            return near

        share, found = continued(reach)
        return found if share == 1.0 else None

    def _balance(
        self, model: FilmOnBore[NodalEvaluation], motion: np.ndarray, film: FilmInput, start: np.ndarray
    ) -> NodalEvaluation | None:
        """Find film and bush in balance, starting from the present displacements; None if the search fails."""
        try:
            while True:
                self._release()
                evaluation = self._settled(model, motion, film, start)
                if evaluation is None:
                    return None
                if self._follow(evaluation):
                    balanced = self._correct(model, film, evaluation)
                    if balanced is not None:
                        self.failure = self.solid.inversion(self.displacements)
                        return None if self.failure else balanced
                if self._linearised >= 3 * PATIENCE:
                    break
                self._renew()
                start = self._coordinates(self.displacements)
        except (RuntimeError, LinAlgError):
            pass
        self.failure = self.solid.inversion(self.displacements) or NO_BALANCE
        return None

    def _settled(
        self, model: FilmOnBore[NodalEvaluation], motion: np.ndarray, film: FilmInput, start: np.ndarray
    ) -> NodalEvaluation | None:
        """Find the bore of the linear solid in balance with the film; None if the search fails.

        From the undeformed state the full search of `Elasticity.settle` is used. About a deformed state the linear
        solid is valid nearby only: full Newton steps are used, and a failure ends the search.
        """
        if not self.displacements.any():
            return super().settle(model, motion, film, start)
        return BoreSearch(model, motion, film).find(start, 1.0, straight=True)

    def _follow(self, evaluation: NodalEvaluation) -> bool:
        """Move the linear solid under the film's loads; return whether the full step was made.

        The step is halved while the residual of the nonlinear solid grows too much.
        """
        u, nodes = self.displacements, self.solid.mesh.bore.nodes
        load = self._beside.copy()
        load[nodes, :2] += evaluation.bore.load.reshape(-1, 2)
        lack = self._free_part(load - self.solid.force(u))
        step, before, part = self._answer(lack), float(np.linalg.norm(lack)), 1.0
        for _ in range(HALVINGS):
            self.displacements = u + part * step
            after = float(np.linalg.norm(self._free_part(load - self.solid.force(self.displacements))))
            if after < 2.0 * before or after <= ROUNDED * np.linalg.norm(load):
                return part == 1.0
            part *= 0.5
        raise LinAlgError

    def _correct(
        self, model: FilmOnBore[NodalEvaluation], film: FilmInput, evaluation: NodalEvaluation
    ) -> NodalEvaluation | None:
        """Find the balance by corrections with the present K and the film's derivative; None if they are slow.

        These are chord steps, which `DampedNewton` does not make: a new K takes far longer than a film.
        """
        full, k, nodes = evaluation.motion.copy(), self._q_free.size, self.solid.mesh.bore.nodes
        S = evaluation.combined_tangent(1.0, 0.0)[6:, MOTION_SIZE:]
        factor = lu_factor(self.stiffness - S)
        lack, size = self._lack(self.displacements, evaluation)
        error, last = float(np.linalg.norm(lack)), np.inf
        for _ in range(PATIENCE):
            rounded = error <= ROUNDED * size
            if error <= SETTLED * size or (rounded and error > 0.5 * last):
                return evaluation
            if not rounded and error > SLOWEST * last:
                break
            step, load = self._answer(lack), np.zeros_like(lack)
            moved = lu_solve(factor, self.stiffness @ self._coordinates(step))
            load[nodes, :2] = (S @ moved).reshape(-1, 2)
            u = self.displacements + step + self._answer(load)
            full[MOTION_SIZE : MOTION_SIZE + k] = self._coordinates(u)
            evaluation = model.evaluate(full, *film)
            if evaluation.status is not Status.CONVERGED:
                break
            lack, size = self._lack(u, evaluation)
            error, last = float(np.linalg.norm(lack)), error
            if not (error < last or rounded):
                break
            self.displacements = u
            if not rounded:
                self._contraction = error / last
        return None

    def _lack(self, u: np.ndarray, evaluation: NodalEvaluation) -> tuple[np.ndarray, float]:
        """Residual F - f(u) (n, 3) at the free coordinates, and the size of F, N.

        The part of F that is not in the radial loads of the bore is stored.
        """
        mesh, load = self.solid.mesh, np.zeros_like(u)
        load[mesh.bore.nodes] = evaluation.forces_at(mesh.bore.positions + u[mesh.bore.nodes])
        self._beside = load.copy()
        self._beside[mesh.bore.nodes, :2] -= evaluation.bore.load.reshape(-1, 2)
        return self._free_part(load - self.solid.force(u)), float(np.linalg.norm(load))

    def _linearise(self) -> np.ndarray:
        """Factor K about the present displacements, and return K_c (k, k), N/m."""
        free = self._free
        self._factor = factor = sparse_factor(self.solid.tangent(self.displacements)[free][:, free])
        self._contraction, self._linearised = 0.0, self._linearised + 1
        places = self._places
        bore = np.empty((places.size, places.size))
        axial = 3 * self.solid.mesh.bore.nodes + 2
        self._by_axial = np.zeros((axial.size, places.size))
        # in blocks: for a fine mesh all solutions together take gigabytes
        for first in range(0, places.size, TILE):
            some = places[first : first + TILE]
            unit = np.zeros((int(free.sum()), some.size))
            unit[some, np.arange(some.size)] = 1.0
            answer = factor.solve(unit)
            bore[:, first : first + some.size] = answer[places]
            self._by_axial[free[axial], first : first + some.size] = answer[(np.cumsum(free) - 1)[axial[free[axial]]]]
        inner = np.linalg.inv(bore)
        if self._moves.all():
            return 0.5 * (inner + inner.T)
        # held nodes get a large stiffness that is not coupled to the others: they move by a `SMALL` share of these
        stiffness = np.diag(np.where(self._moves, 0.0, np.abs(np.diag(inner)).max() / SMALL))
        stiffness[np.ix_(self._moves, self._moves)] = 0.5 * (inner + inner.T)
        return stiffness

    def _renew(self) -> None:
        self.stiffness = self._linearise()
        self._release()

    def _return(self, u: np.ndarray) -> None:
        """Go back to displacements u, and linearise the solid about them if it was linearised in this search."""
        self.displacements, self._beside = u, np.zeros_like(u)
        if self._linearised:
            self._renew()

    def _release(self) -> None:
        """Store the coordinates at which the bore of the linear solid has no pressure."""
        unloaded = self._answer(self._free_part(self._beside - self.solid.force(self.displacements)))
        self._q_free = self._coordinates(self.displacements + unloaded)

    def _answer(self, force: np.ndarray) -> np.ndarray:
        """Displacements (n, 3) of the linear solid under forces (n, 3)."""
        assert self._factor is not None
        u = np.zeros(force.size)
        u[self._free] = self._factor.solve(force.ravel()[self._free])
        return u.reshape(-1, 3)

    def _free_part(self, force: np.ndarray) -> np.ndarray:
        return np.where(self._free.reshape(-1, 3), force, 0.0)

    def _coordinates(self, u: np.ndarray) -> np.ndarray:
        return u[self.solid.mesh.bore.nodes, :2].ravel()
