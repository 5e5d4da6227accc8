"""Exudyn's implicit integrator with a sparse factorisation of this package: `SolveDynamicSparse`.

Exudyn does the time stepping (generalized-alpha predictor, step control, output, sensors); its Newton loop is replaced
through ``MainSolverImplicitSecondOrder.SetUserFunctionNewton``. The unknowns are increments d of displacements and
Lagrange multipliers; residual and Jacobian arrive scaled by beta h^2:

    [M / f + beta h^2 K + gamma h D   C^T] [d_q               ]   [r]
    [r C                              0  ] [beta h^2 d_lambda ] = [g],      f = (1 - alpha_f) / (1 - alpha_m),

with r = gamma / (beta h) in the rows of constraints that are solved for velocities and 1 in others, after which
q -= d, q_t -= gamma/(beta h) d, q_tt -= d / (f beta h^2). These formulas were derived from the matrices and steps of
Exudyn 1.13.6; tests compare whole runs. The Jacobian is assembled from the objects' Jacobians. The factor is reused
over iterations and steps until convergence slows down (modified Newton).

Films on nodal bushes are operators: their dense blocks over the bore would fill the factor, while a product with their
exact tangent costs one film solve. With F for the films and J0 for the rest, d = J0^-1 (r + z), where z solves
``(1 + F J0^-1) z = -F J0^-1 r`` by GMRES to a thousandth of r and is zero except at the films' coordinates. The bush
deflects little under short waves of the film, so that some seven products suffice. Newton's method then needs as many
iterations as with a full Jacobian, and the sparse factor of the bush, which hardly changes, can be reused. The other
coordinates, such as those of a turning journal, are few. If they are coupled to the bush by films only, they are
refactored in every iteration: sparse factors of the meshes, dense ones of the rest. The matrix is assembled in
`system_matrix`.

Matrices of meshes hardly change, those of turning bodies change in every step. If a mesh is coupled to the rest by
films only, the rest is refactored in each Newton iteration while the factor of the meshes is reused. Else there is one
factor of the whole matrix.

Only additive coordinates are supported, no Lie group nodes and first-order coordinates. Also not supported are items
whose Jacobian Exudyn does not return: sliding joints, `GeneralContact`, loads that depend on coordinates.
"""

from __future__ import annotations

import time
import warnings
import weakref
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any, ClassVar, TypeAlias

import exudyn as exu
import numpy as np
from scipy.linalg import LinAlgWarning, lu_factor, lu_solve
from scipy.sparse import csc_matrix

from exudyn_ehd.coupling.exudyn_solvers import StepControl, idle, require_control, require_time, user_function
from exudyn_ehd.coupling.run.newton import StartGuess, state_of
from exudyn_ehd.coupling.run.solve import joints_of, require_run, running
from exudyn_ehd.coupling.run.system_matrix import SystemMatrix
from exudyn_ehd.solid.total_lagrange import solve_by_products, sparse_factor
from exudyn_ehd.status import POSITIVE, Checked, InputError, require_integer

# Exudyn's stubs lack the self of its solvers' methods.
DynamicSolver: TypeAlias = Any
# Relative tolerance of the linear equations with films in a step of Newton's method, and largest number of products.
FILM_TOLERANCE, FILM_PRODUCTS = 1e-3, 60
# Largest number of coordinates and multipliers outside of the meshes for which a dense factor is used.
LARGEST_REST = 200


@dataclass(frozen=True, kw_only=True)
class FactorReuse(Checked):
    """Rules that say when `SolveDynamicSparse` computes a new factor of its Jacobian.

    Parameters
    ----------
    contractivity : float, default 0.5
        Refactor if the contraction rate of an iteration, its residual over the one before, exceeds this.
    maximum_iterations : int, default 10
        Refactor after this number of iterations of one step with the same factor.
    worth : int, default 40
        Number of iterations that cost as much as a new factor. Steps with an old factor take more iterations than its
        first step did: refactor when the additional iterations of all steps since add up to this number. It is a count,
        not a time, so that runs repeat exactly.

    Examples
    --------
    After the examples of `CreateLubricatedJoint` and `ConfigureSolver`:

    >>> mbs.Assemble()
    >>> run = ehd.SolveDynamicSparse(mbs, settings, reuse=ehd.FactorReuse(contractivity=0.3))
    """

    contractivity: float = 0.5
    maximum_iterations: int = 10
    worth: int = 40

    checks: ClassVar = {
        "contractivity": POSITIVE,
        "maximum_iterations": partial(require_integer, at_least=1),
        "worth": partial(require_integer, at_least=1),
    }


@dataclass(kw_only=True)
class SparseRun:
    """Cost of a run of `SolveDynamicSparse`.

    Attributes
    ----------
    success : bool
    steps, rejected : int
        Newton solutions that converged, and those that did not (Exudyn then halves the step).
    iterations, jacobians : int
        Iterations and Jacobians of Newton's method.
    products : int
        Products with the tangents of films on nodal bushes.
    seconds, seconds_jacobian, seconds_solve : float
        Wall-clock time of the run, of Jacobians with factorisations, and of back substitutions, s.
    factor_bytes : int
        Memory of the last factor, bytes.
    """

    success: bool = False
    steps: int = 0
    rejected: int = 0
    iterations: int = 0
    jacobians: int = 0
    products: int = 0
    seconds: float = 0.0
    seconds_jacobian: float = 0.0
    seconds_solve: float = 0.0
    factor_bytes: int = 0

    def report(self) -> str:
        """Return a summary of one line."""
        steps = max(self.steps, 1)
        return (
            f"{self.steps} steps in {self.seconds:.2f} s = {1e3 * self.seconds / steps:.1f} ms per step, "
            f"{self.iterations / steps:.2f} iterations and {self.jacobians / steps:.3f} Jacobians per step, "
            f"{self.rejected} rejected, factor {self.factor_bytes / 1e6:.0f} MB"
        )


def SolveDynamicSparse(
    mbs: exu.MainSystem,
    simulationSettings: exu.SimulationSettings | None = None,
    *,
    reuse: FactorReuse | None = None,
    stepControl: StepControl | None = None,
    threads: int | None = 1,
) -> SparseRun:
    """Integrate in time like ``mbs.SolveDynamic``, with a sparse solver of the package: for large meshes.

    Newton's method starts at the accelerations of the steps before, as in `exudyn_ehd.SolveDynamic`. User functions of
    the system are called: before and after steps, before residuals, after Newton's method, and for terms of the
    Jacobian. In ``mbs.sys['dynamicSolver'].it`` they find ``newtonStepsCount`` and ``newtonJacobiCount`` of the run;
    ``newtonSteps`` stays 0, since Exudyn's step control reads it and would judge it by the cost of full Newton.

    Parameters
    ----------
    mbs : exudyn.MainSystem
        The system; it is assembled if it is not yet.
    simulationSettings : exudyn.SimulationSettings or None, default None
        Tolerances, steps, spectral radius, Newmark and index 2 are taken from ``timeIntegration``. None: Exudyn's
        defaults; use `ConfigureSolver`.
    reuse : FactorReuse or None, default None
        Rules for new factors; None: ``FactorReuse()``.
    stepControl : StepControl or None, default None
        As in `SolveDynamic`.
    threads : int or None, default 1
        As in `SolveDynamic`.

    Returns
    -------
    SparseRun

    Raises
    ------
    InputError
        If the model has coordinates that this solver can't update or constraints that it does not know, or if the
        settings ask for something that it does not offer; the message names it.
    FilmError, RunError
        As `SolveDynamic`; ``joint.history`` holds all accepted steps.

    Examples
    --------
    After the examples of `CreateLubricatedJoint` and `ConfigureSolver`:

    >>> mbs.Assemble()
    >>> run = ehd.SolveDynamicSparse(mbs, settings)
    >>> joint.history.time.shape
    (21,)
    """
    settings = exu.SimulationSettings() if simulationSettings is None else simulationSettings
    require_run("SolveDynamicSparse", mbs, settings)
    require_time("SolveDynamicSparse", settings)
    _require_offered(settings.timeIntegration)
    require_control("SolveDynamicSparse", settings, stepControl)
    if not mbs.systemIsConsistent:
        mbs.Assemble()
    run = SparseRun()
    start = StartGuess([joint.element for joint in joints_of(mbs)], settings)
    before = user_function(mbs, "PreNewtonResidual") or idle("PreNewtonResidual")
    loop = _SparseNewton(
        matrix=SystemMatrix(mbs),
        guess=partial(start.begin, before),
        reuse=FactorReuse() if reuse is None else reuse,
        run=run,
    )
    solver: DynamicSolver = exu.MainSolverImplicitSecondOrder()
    # weak reference: loop, films and solver refer to each other, and Python cannot see this cycle
    solver.SetUserFunctionNewton(mbs, weakref.proxy(loop))
    # where Exudyn's own SolveDynamic leaves its solver; objects of a model look there for the one at work
    mbs.sys["dynamicSolver"] = solver
    began = time.perf_counter()
    chosen = settings.linearSolver.solverType
    # initial accelerations come from Exudyn's solver, which must not use a dense matrix
    settings.linearSolver.solverType = exu.LinearSolverType.EigenSparse
    try:
        with running("SolveDynamicSparse", mbs, settings, stepControl, threads):
            run.success = bool(solver.SolveSystem(mbs, settings))
            if not run.success:
                raise exu.SolverError("SolveDynamicSparse: SolveSystem returned False")
    finally:
        settings.linearSolver.solverType = chosen
    run.seconds = time.perf_counter() - began
    return run


def _require_offered(integration: Any) -> None:
    """Raise `InputError` for settings of Exudyn's Newton method that are not supported here."""
    for name, value, only in (
        ("newton.active", integration.newton.active, True),
        ("newton.residualMode", integration.newton.residualMode, 0),
        ("computeLoadsJacobian", integration.computeLoadsJacobian, 0),
    ):
        if value != only:
            raise InputError(
                f"SolveDynamicSparse.simulationSettings.timeIntegration.{name} must be {only}, got {value}; this "
                "solver offers no other, use exudyn_ehd.SolveDynamic."
            )


class SystemFactor:
    """Factor of an iteration matrix.

    Parameters
    ----------
    system : csc_matrix
    mesh : (n,) array of bool
        Coordinates of meshes. If there are none, if other coordinates are coupled to them, or if those are many, there
        is one factor of the whole matrix.
    pivoting : float
        As in `sparse_factor`, for the factor of the whole matrix.

    Raises
    ------
    RuntimeError
        If the matrix is singular.
    """

    def __init__(self, system: csc_matrix, mesh: np.ndarray, *, pivoting: float) -> None:
        self.places, self.rest = np.flatnonzero(mesh), np.flatnonzero(~mesh)
        # columns first: rows of compressed columns take twenty times as long
        own, beside = (system[:, part][part] for part in (self.places, self.rest))
        is_split = len(self.places) > 0 and len(self.rest) <= LARGEST_REST
        self.coupled = not is_split or own.nnz + beside.nnz < system.nnz
        self.factor = sparse_factor(system, pivoting=pivoting) if self.coupled else sparse_factor(own)
        self.nbytes = 12 * self.factor.nnz
        if not self.coupled:
            self.renew_rest(system)

    def renew_rest(self, system: csc_matrix) -> None:
        """Refactor the coordinates outside of the meshes, which are not coupled to them."""
        own = system[:, self.rest][self.rest].toarray()
        with warnings.catch_warnings():
            warnings.simplefilter("error", LinAlgWarning)
            try:
                self.own = lu_factor(own) if len(own) else None
            except (LinAlgWarning, ValueError) as error:
                raise RuntimeError("singular") from error

    def solve(self, right: np.ndarray) -> np.ndarray:
        """Solution (n,) for a right-hand side (n,)."""
        if self.coupled:
            return self.factor.solve(right)
        out = np.empty(len(right))
        out[self.places] = self.factor.solve(right[self.places])
        if self.own is not None:
            out[self.rest] = lu_solve(self.own, right[self.rest])
        return out


@dataclass(kw_only=True, eq=False)
class _SparseNewton:
    """The Newton loop of one step; called by Exudyn as f(solver, mbs, settings)."""

    matrix: SystemMatrix
    guess: Callable[[exu.MainSystem, float, int, int], None]
    reuse: FactorReuse
    run: SparseRun
    factor: SystemFactor | None = None
    step_size: float = 0.0
    baseline: int = 0
    excess: int = 0

    def __call__(self, solver: DynamicSolver, mbs: exu.MainSystem, settings: exu.SimulationSettings) -> bool:
        newton, data, turn = settings.timeIntegration.newton, mbs.systemData, solver.it.discontinuousIteration
        # Exudyn's Newton method resets the multipliers at the start of a step, too
        state_of(mbs)[3][:] = 0.0
        solver.ComputeNewtonUpdate(mbs, settings, True)
        self.guess(mbs, data.GetTime(), 0, turn)
        error = first = solver.ComputeNewtonResidual(mbs, settings)
        step, self.step_size = self.step_size, solver.it.currentStepSize
        # in a further pass a contact has opened or closed
        if turn > 0 or step != self.step_size or self.excess >= self.reuse.worth:
            self.factor = None
        age, renewable = 0, True
        for iteration in range(1, newton.maxIterations + 1):
            if not np.isfinite(error):
                break
            if age >= self.reuse.maximum_iterations:
                self.factor = None
            if self.factor is None:
                age, renewable = 0, False
            if not self._factorise(solver, mbs, settings):
                break
            self._update(solver, mbs)
            solver.it.newtonStepsCount += 1
            self.guess(mbs, data.GetTime(), iteration, turn)
            age += 1
            previous, error = error, solver.ComputeNewtonResidual(mbs, settings)
            if error <= max(solver.newton.absoluteTolerance, solver.newton.relativeTolerance * first):
                self.run.steps += 1
                self.baseline = self.baseline or iteration
                self.excess += iteration - self.baseline
                return True
            if iteration == 1 and newton.adaptInitialResidual:
                first = max(first, error)
            # films with new tangents in every iteration also slow convergence: one new factor a step
            if error > self.reuse.contractivity * previous and (renewable or not self.matrix.films):
                self.factor = None
        self.factor = None
        self.run.rejected += 1
        return False

    def _factorise(self, solver: DynamicSolver, mbs: exu.MainSystem, settings: exu.SimulationSettings) -> bool:
        """Make the factor if there is none; else refactor the rest, if only films couple it to the meshes.

        Return False if the matrix is singular, so that the step is rejected.
        """
        kept = self.factor
        if kept is not None and (kept.coupled or not self.matrix.films):
            return True
        start = time.perf_counter()
        index2 = settings.timeIntegration.generalizedAlpha.useIndex2Constraints
        system = self.matrix.assemble(mbs, solver, index2=index2, meshes=kept is None)
        try:
            if kept is not None:
                kept.renew_rest(system)
                return True
            self.factor = SystemFactor(system, self.matrix.mesh, pivoting=0.01 if self.matrix.constraints else 0.0)
        except RuntimeError:
            return False
        finally:
            self.run.seconds_jacobian += time.perf_counter() - start
        self.baseline = self.excess = 0
        self.run.jacobians += 1
        solver.it.newtonJacobiCount += 1
        self.run.factor_bytes = self.factor.nbytes
        return True

    def _solve(self, solver: DynamicSolver, mbs: exu.MainSystem, residual: np.ndarray) -> np.ndarray:
        """Solve for Newton's step with the factor and, if there are any, the films' operators."""
        assert self.factor is not None
        films = self.matrix.film_operators(mbs, solver)
        factor, d = self.factor, self.factor.solve(residual)
        if not films:
            return d
        touched = np.unique(np.concatenate([places for places, _ in films]))
        load = np.zeros(len(d))

        def forces(d: np.ndarray) -> np.ndarray:
            out = np.zeros(len(d))
            for places, film in films:
                out[places] += film(d[places])
            self.run.products += 1
            return out[touched]

        def product(z: np.ndarray) -> np.ndarray:
            load[touched] = z
            return z + forces(factor.solve(load))

        wanted = FILM_TOLERANCE * float(np.linalg.norm(residual))
        load[touched] = solve_by_products(product, -forces(d), wanted, FILM_PRODUCTS)
        return d + factor.solve(load)

    def _update(self, solver: DynamicSolver, mbs: exu.MainSystem) -> None:
        start = time.perf_counter()
        d = self._solve(solver, mbs, np.array(solver.GetSystemResidual()))
        self.run.seconds_solve += time.perf_counter() - start
        self.run.iterations += 1
        n, h = self.matrix.coordinates, self.step_size
        square = solver.newmarkBeta * h * h
        dq = d[:n]
        places, velocities, accelerations, multipliers = state_of(mbs)
        places -= dq
        velocities -= solver.newmarkGamma * h / square * dq
        accelerations -= dq / (solver.factJacAlgorithmic * square)
        multipliers -= d[n:] / square
