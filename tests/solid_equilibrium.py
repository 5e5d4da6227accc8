"""Equilibrium of a solid on its own, without a multibody model: Newton's method with loads that follow."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_matrix

from exudyn_ehd.solid.loads import BushLoad, FollowerPressure, dead_forces
from exudyn_ehd.solid.total_lagrange import TotalLagrange, sparse_factor
from exudyn_ehd.status import EHDError, require_integer


class EquilibriumError(EHDError, RuntimeError):
    """No equilibrium was found; names the load step and the remedy."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Equilibrium:
    """A static solution.

    Attributes
    ----------
    displacements : ndarray, shape (n, 3)
        [m]
    iterations : int
        Newton iterations of all load steps.
    reactions : ndarray, shape (n, 3)
        Support forces on the solid [N]; zero up to the tolerance at free coordinates.
    """

    displacements: np.ndarray
    iterations: int
    reactions: np.ndarray


def equilibrium(
    solid: TotalLagrange,
    *,
    held: np.ndarray,
    loads: Sequence[BushLoad],
    steps: int = 1,
    tolerance: float = 1e-10,
    start: np.ndarray | None = None,
) -> Equilibrium:
    """Solve f_int(u) = f_load(u) by Newton's method with proportional loading; quadratic convergence.

    Parameters
    ----------
    solid : TotalLagrange
    held : ndarray of bool, shape (n, 3)
        Supported coordinates.
    loads : sequence of loads
        Taken at history = 1.
    steps : int
        Equal load steps.
    tolerance : float
        On the residual over the norm of the loads; slender parts, whose rounding exceeds it, end on the correction.
    start : ndarray, shape (n, 3), optional
        Initial displacement, for ``steps=1``.

    Raises
    ------
    EquilibriumError
        A load step did not converge in 30 iterations, or an element has turned inside out.
    """
    require_integer("equilibrium steps", steps, at_least=1)
    free = np.flatnonzero(~held.ravel())
    dead = np.zeros(held.shape)
    followers = [load for load in loads if isinstance(load, FollowerPressure)]
    for load in loads:
        if not isinstance(load, FollowerPressure):
            dead += dead_forces(load, solid)
    u = np.zeros(held.shape) if start is None else np.array(start, dtype=float)
    count = 0
    for step in range(1, steps + 1):
        part = step / steps
        settled = False
        for _ in range(30):
            positions = solid.mesh.nodes + u
            external = part * (dead + sum((load.forces(positions) for load in followers), np.zeros_like(dead)))
            residual = solid.force(u) - external
            scale = np.linalg.norm(external.ravel()[free])
            error = np.linalg.norm(residual.ravel()[free])
            if settled or error <= tolerance * scale:
                break
            K = solid.tangent(u)
            for load in followers:
                K = K + part * _follower_matrix(load, positions)
            K = K[free][:, free]
            try:
                factor = sparse_factor(K)
            except RuntimeError:
                raise _failure(step, steps, float("inf")) from None
            correction = factor.solve(residual.ravel()[free])
            u.ravel()[free] -= correction
            count += 1
            # after a correction of 1e-8 the quadratic convergence has left nothing but rounding
            settled = bool(np.linalg.norm(correction) <= 1e-8 * np.linalg.norm(u))
            if not np.all(np.isfinite(u)):
                raise _failure(step, steps, float("nan"))
        else:
            raise _failure(step, steps, float(error / scale))
    if turned := solid.inversion(u):
        raise EquilibriumError(f"equilibrium: {turned}")
    return Equilibrium(displacements=u, iterations=count, reactions=np.where(held, residual, 0.0))


def _follower_matrix(load: FollowerPressure, positions: np.ndarray) -> csr_matrix:
    places = tuple(place.ravel() for place in load.places())
    return csr_matrix((load.stiffness(positions).ravel(), places), shape=(positions.size, positions.size))


def _failure(step: int, steps: int, error: float) -> EquilibriumError:
    return EquilibriumError(
        f"equilibrium: load step {step} of {steps} did not converge, relative residual {error:.2e}; give more steps, "
        "check that the supports hold all rigid motions, or follow the motion dynamically: the load may lie above a "
        "limit point."
    )
