"""Exudyn's implicit integrator with an own sparse factorisation: `SolveDynamicSparse`.

Exudyn keeps the time stepping (generalized-alpha predictor, step control, output, sensors); its Newton loop is replaced
through ``MainSolverImplicitSecondOrder.SetUserFunctionNewton``. The unknowns are increments d of displacements and
Lagrange multipliers; residual and Jacobian arrive scaled by beta h^2:

    [M / f + beta h^2 K + gamma h D   C^T] [d_q               ]   [r]
    [C                                0  ] [beta h^2 d_lambda ] = [g],      f = (1 - alpha_f) / (1 - alpha_m),

after which q -= d, q_t -= gamma/(beta h) d, q_tt -= d / (f beta h^2): read off Exudyn 1.13.6's own matrices and steps,
and held by the tests, which compare whole runs. The Jacobian is assembled from the objects' own analytic Jacobians. The
factor is kept over iterations and steps until convergence slows down (modified Newton).

Films on nodal bushes take part as operators: their dense blocks over the bore would fill the factor, while a product with their exact
tangent costs one film solve. With J0 everything else and F the films, every iteration solves ``(1 + F J0^-1) y = r``, d = J0^-1 y, by GMRES
(Saad and Schultz, SIAM J. Sci. Stat. Comput. 7 (1986) 856) to a thousandth of r. The bush answers a film's short waves weakly, so that
some eight products do. Newton then takes the iterations it takes with a full Jacobian, and the factor of the bush alone, sparse and
hardly changing, lasts.

Additive coordinates only: Lie group nodes and first-order coordinates are refused.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import exudyn
import numpy as np
from scipy.sparse import coo_matrix, csc_matrix, issparse
from scipy.sparse.linalg import LinearOperator, SuperLU, gmres, splu

from exudyn_ehd.coupling.nodal_film import NodalFilmElement
from exudyn_ehd.coupling.run import own_errors, start_guess
from exudyn_ehd.coupling.start_guess import StartGuess
from exudyn_ehd.status import InputError, require_integer, require_number

# the index types exist at run time, but not in the type stubs
exu: Any = exudyn
# Residual that a step of Newton's method leaves in its linear equations with films, relative, and the largest number of products.
FILM_TOLERANCE, FILM_PRODUCTS = 1e-3, 60


@dataclass(frozen=True, kw_only=True)
class FactorReuse:
    """When the sparse factor is renewed.

    Parameters
    ----------
    contractivity : float
        Renew if an iteration reduces the residual by less than this factor.
    maximum_iterations : int
        Renew after so many iterations of one step.
    worth : int
        Number of iterations that cost as much as a factor. Renew at the start of a step when the iterations spent
        beyond those of the factor's first step add up to this; a count, not a clock, so that runs repeat exactly.
    """

    contractivity: float = 0.5
    maximum_iterations: int = 10
    worth: int = 40

    def __post_init__(self) -> None:
        require_number("FactorReuse.contractivity", self.contractivity, above=0.0)
        require_integer("FactorReuse.maximum_iterations", self.maximum_iterations, at_least=1)
        require_integer("FactorReuse.worth", self.worth, at_least=1)


@dataclass(kw_only=True)
class SparseRun:
    """What a run cost.

    Attributes
    ----------
    success : bool
    steps, rejected : int
        Newton solutions that converged, and those that did not (Exudyn then halves the step).
    iterations, jacobians : int
        Of Newton's method.
    products : int
        Products with the tangents of films on nodal bushes.
    seconds, seconds_jacobian, seconds_solve : float
        Wall clock of the run, of Jacobians with factorisations, of back substitutions.
    factor_bytes : int
        Memory of the last factor.
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
        """Return one line for people."""
        steps = max(self.steps, 1)
        return (
            f"{self.steps} steps in {self.seconds:.2f} s = {1e3 * self.seconds / steps:.1f} ms per step, "
            f"{self.iterations / steps:.2f} iterations and {self.jacobians / steps:.3f} Jacobians per step, "
            f"{self.rejected} rejected, factor {self.factor_bytes / 1e6:.0f} MB"
        )


def SolveDynamicSparse(
    mbs: Any,
    simulationSettings: Any | None = None,
    *,
    reuse: FactorReuse | None = None,
) -> SparseRun:
    """Integrate an assembled model in time like ``mbs.SolveDynamic``, with an own sparse factorisation.

    Newton's method starts at lasting accelerations, as in `exudyn_ehd.SolveDynamic`.

    Parameters
    ----------
    mbs : exudyn.MainSystem
        Assembled.
    simulationSettings : exudyn.SimulationSettings, optional
        Tolerances, steps and spectral radius are taken from ``timeIntegration``.
    reuse : FactorReuse, optional

    Returns
    -------
    SparseRun

    Raises
    ------
    InputError
        The model holds coordinates that this solver can't update.
    FilmError, RunError
        As `SolveDynamic`; ``joint.history`` holds all accepted steps.
    """
    settings = exu.SimulationSettings() if simulationSettings is None else simulationSettings
    run = SparseRun()
    loop = _Newton(
        matrix=SystemMatrix.of(mbs), guess=start_guess(mbs), reuse=FactorReuse() if reuse is None else reuse, run=run
    )
    solver = exu.MainSolverImplicitSecondOrder()
    solver.SetUserFunctionNewton(mbs, loop)
    # where Exudyn's own SolveDynamic leaves its solver; objects of a model look there for the one at work
    mbs.sys["dynamicSolver"] = solver
    start = time.perf_counter()
    chosen = settings.linearSolver.solverType
    # the initial accelerations still come from Exudyn's own solver, which must not fill a dense matrix
    settings.linearSolver.solverType = exu.LinearSolverType.EigenSparse
    try:
        with own_errors(mbs, "SolveDynamicSparse"):
            run.success = bool(solver.SolveSystem(mbs, settings))
            if not run.success:
                raise exu.SolverError("SolveDynamicSparse: SolveSystem returned False")
    finally:
        settings.linearSolver.solverType = chosen
    run.seconds = time.perf_counter() - start
    return run


@dataclass(kw_only=True, eq=False)
class _Newton:
    """The Newton loop of one step; called by Exudyn as f(solver, mbs, settings)."""

    matrix: SystemMatrix
    guess: StartGuess
    reuse: FactorReuse
    run: SparseRun
    factor: SuperLU | None = None
    step_size: float = 0.0
    baseline: int = 0
    excess: int = 0

    def __call__(self, solver: Any, mbs: Any, settings) -> bool:
        newton = settings.timeIntegration.newton
        solver.ComputeNewtonUpdate(mbs, settings, True)
        self.guess(mbs, mbs.systemData.GetTime(), 0, 0)
        error = first = solver.ComputeNewtonResidual(mbs, settings)
        if solver.it.currentStepSize != self.step_size:
            self.factor = None
            self.step_size = solver.it.currentStepSize
        if self.excess >= self.reuse.worth:
            self.factor = None
        age, renewable = 0, True
        for iteration in range(1, newton.maxIterations + 1):
            if not np.isfinite(error):
                break
            if self.factor is None or age >= self.reuse.maximum_iterations:
                if not self._factorise(solver, mbs):
                    break
                # the films' tangents follow every iteration: a factor of this very step is not to blame for slow ones
                age, renewable = 0, False
            self._update(solver, mbs)
            age += 1
            previous, error = error, solver.ComputeNewtonResidual(mbs, settings)
            if error <= max(newton.absoluteTolerance, newton.relativeTolerance * first):
                self.run.steps += 1
                self.baseline = self.baseline or iteration
                self.excess += iteration - self.baseline
                return True
            if iteration == 1 and newton.adaptInitialResidual:
                first = max(first, error)
            if error > self.reuse.contractivity * previous and (renewable or not self.matrix.films):
                self.factor = None
        self.factor = None
        self.run.rejected += 1
        return False

    def _factorise(self, solver, mbs) -> bool:
        """Renew the factor; False if the matrix is singular, upon which the step is rejected."""
        start = time.perf_counter()
        self.factor = None
        system = self.matrix.assemble(mbs, solver)
        constraints = self.matrix.constraints
        try:
            self.factor = splu(
                system,
                permc_spec="MMD_AT_PLUS_A",
                diag_pivot_thresh=0.01 if constraints else 0.0,
                options={"SymmetricMode": True},
            )
        except RuntimeError:
            return False
        self.baseline = self.excess = 0
        self.run.jacobians += 1
        self.run.factor_bytes = 12 * (self.factor.nnz)
        self.run.seconds_jacobian += time.perf_counter() - start
        return True

    def _solve(self, solver: Any, mbs: Any, residual: np.ndarray) -> np.ndarray:
        """Newton's step: with the factor, or with it and the films' operators."""
        assert self.factor is not None
        films = self.matrix.film_operators(mbs, solver)
        if not films:
            return self.factor.solve(residual)
        factor = self.factor

        def product(v: np.ndarray) -> np.ndarray:
            d, out = factor.solve(v), v.copy()
            for places, film in films:
                out[places] += film(d[places])
            self.run.products += 1
            return out

        operator = LinearOperator((residual.size, residual.size), matvec=product, dtype=float)
        y, _ = gmres(operator, residual, rtol=FILM_TOLERANCE, atol=0.0, restart=FILM_PRODUCTS, maxiter=1)
        return factor.solve(y)

    def _update(self, solver, mbs) -> None:
        start = time.perf_counter()
        assert self.factor is not None
        d = self._solve(solver, mbs, np.array(solver.GetSystemResidual()))
        self.run.seconds_solve += time.perf_counter() - start
        self.run.iterations += 1
        data, n, h = mbs.systemData, self.matrix.coordinates, self.step_size
        square = solver.newmarkBeta * h * h
        dq = d[:n]
        data.SetODE2Coordinates(data.GetODE2Coordinates() - dq)
        data.SetODE2Coordinates_t(data.GetODE2Coordinates_t() - solver.newmarkGamma * h / square * dq)
        data.SetODE2Coordinates_tt(data.GetODE2Coordinates_tt() - dq / (solver.factJacAlgorithmic * square))
        if len(d) > n:
            data.SetAECoordinates(data.GetAECoordinates() - d[n:] / square)


@dataclass(frozen=True, kw_only=True, eq=False)
class SystemMatrix:
    """The system's iteration matrix, assembled object by object.

    Parameters
    ----------
    coordinates, constraints : int
        Second-order coordinates and algebraic equations.
    parts : tuple
        One function (mbs, M factor, K factor, D factor) -> (rows, columns, values) per object.
    """

    coordinates: int
    constraints: int
    parts: tuple[Callable, ...]
    films: tuple[tuple[Any, np.ndarray], ...]

    @classmethod
    def of(cls, mbs: Any) -> SystemMatrix:
        """Look up the objects of an assembled model."""
        data = mbs.systemData
        for number in range(data.NumberOfNodes()):
            kind = mbs.GetNode(exu.NodeIndex(number))["nodeType"]
            if "LG" in kind or "LieGroup" in kind:
                raise InputError(
                    f"SolveDynamicSparse mbs must have additive coordinates only, got node {number} of type {kind}; "
                    "create rigid bodies with nodeType=exu.NodeType.RotationEulerParameters or RotationRxyz, or use "
                    "mbs.SolveDynamic."
                )
        n = len(data.GetODE2Coordinates())
        films: list[tuple[Any, np.ndarray]] = []
        parts: list[Callable] = [
            _euler_parameters(mbs, exu.NodeIndex(number), n)
            for number in range(data.NumberOfNodes())
            if mbs.GetNode(exu.NodeIndex(number))["nodeType"] == "RigidBodyEP"
        ]
        if len(data.GetODE1Coordinates()):
            raise InputError(
                "SolveDynamicSparse mbs must have second-order coordinates only, got "
                f"{len(data.GetODE1Coordinates())} of first order; use mbs.SolveDynamic."
            )
        for number in range(data.NumberOfObjects()):
            item = exu.ObjectIndex(number)
            places = np.array(data.GetObjectLTGODE2(item), dtype=np.int32)
            if len(places) == 0:
                continue
            film = _nodal_film(mbs, item)
            if film is not None:
                films.append((film, places))
            elif mbs.GetObject(item)["objectType"] == "GenericODE2":
                parts.append(_generic(mbs, item, places))
            else:
                parts.append(_standard(mbs, item, places, n + np.array(data.GetObjectLTGAE(item), dtype=np.int32)))
        return cls(coordinates=n, constraints=len(data.GetAECoordinates()), parts=tuple(parts), films=tuple(films))

    def film_operators(self, mbs: Any, solver: Any) -> list[tuple[np.ndarray, Callable]]:
        """Places and operators of the films on nodal bushes at the current state, scaled by beta h^2."""
        if not self.films:
            return []
        h, data = solver.it.currentStepSize, mbs.systemData
        q, q_t, t = (np.asarray(data.GetODE2Coordinates()), np.asarray(data.GetODE2Coordinates_t()), data.GetTime())
        factors = solver.newmarkBeta * h * h, solver.newmarkGamma * h
        made = ((places, film.operator(mbs, t, q[places], q_t[places], *factors)) for film, places in self.films)
        return [(places, operator) for places, operator in made if operator is not None]

    def assemble(self, mbs: Any, solver: Any) -> csc_matrix:
        """Return the iteration matrix of the current state, scaled by beta h^2."""
        h = solver.it.currentStepSize
        factors = (1 / solver.factJacAlgorithmic, solver.newmarkBeta * h * h, solver.newmarkGamma * h)
        triplets = [part(mbs, *factors) for part in self.parts]
        rows, columns, values = (np.concatenate(x) for x in zip(*triplets, strict=True))
        size = self.coordinates + self.constraints
        system = coo_matrix((values, (rows, columns)), shape=(size, size)).tocsc()
        if self.constraints:
            # rows of inactive constraints are lambda = 0
            empty = np.flatnonzero(np.asarray(abs(system).sum(axis=1)).ravel() == 0)
            system = (system + coo_matrix((np.ones(len(empty)), (empty, empty)), shape=(size, size))).tocsc()
        return system


def _nodal_film(mbs: Any, item: Any) -> NodalFilmElement | None:
    """The film element behind an object, if its bore is that of a nodal bush."""
    if mbs.GetObject(item)["objectType"] != "GenericODE2":
        return None
    jacobian = mbs.GetObjectParameter(item, "jacobianUserFunction")
    element = getattr(jacobian["function"], "__self__", None) if isinstance(jacobian, dict) else None
    return element if isinstance(element, NodalFilmElement) else None


def _generic(mbs: Any, item: Any, places: np.ndarray) -> Callable:
    """Triplets of an ObjectGenericODE2 through its own functions and matrices."""

    def function(name: str) -> Callable | None:
        value = mbs.GetObjectParameter(item, name)
        return value["function"] if isinstance(value, dict) else None

    def constant(name: str) -> coo_matrix | None:
        matrix = _as_sparse(mbs.GetObjectParameter(item, name))
        return None if matrix is None or matrix.nnz == 0 else matrix

    jacobian, mass_function = function("jacobianUserFunction"), function("massMatrixUserFunction")
    if jacobian is None and function("forceUserFunction") is not None:
        raise InputError(
            f"SolveDynamicSparse: object {int(item)} has a forceUserFunction, so it must have a jacobianUserFunction, "
            "got none; add one, or use mbs.SolveDynamic, which differentiates numerically."
        )
    mass, stiffness, damping = (constant(name) for name in ("massMatrix", "stiffnessMatrix", "dampingMatrix"))

    def part(mbs, fM, fK, fD):
        data = mbs.systemData
        q = np.asarray(data.GetODE2Coordinates())[places]
        q_t = np.asarray(data.GetODE2Coordinates_t())[places]
        t = data.GetTime()
        terms = [(f, m) for f, m in ((fM, mass), (fK, stiffness), (fD, damping)) if m is not None]
        if jacobian is not None:
            terms.append((1.0, _as_sparse(jacobian(mbs, t, int(item), q, q_t, fK, fD))))
        if mass_function is not None:
            terms.append((fM, _as_sparse(mass_function(mbs, t, int(item), q, q_t))))
        return tuple(
            np.concatenate(x)
            for x in (
                [places[m.row] for _, m in terms],
                [places[m.col] for _, m in terms],
                [f * m.data for f, m in terms],
            )
        )

    return part


def _standard(mbs: Any, item: Any, places: np.ndarray, equations: np.ndarray) -> Callable:
    """Triplets of a body, connector or constraint through Exudyn's own matrices."""
    kind = exu.ComputeItemType
    offered = mbs.ComputeItem(item)
    terms = [(k, i) for i, k in enumerate((kind.MassMatrix, kind.JacobianODE2, kind.JacobianODE2_t)) if k in offered]
    constrained = kind.ConstraintJacobian in offered and len(equations) > 0
    object_type = mbs.GetObject(item)["objectType"]
    own_mass: Callable | None = None
    if object_type.startswith("MassPoint") or object_type == "RigidBody2D":
        # Exudyn keeps these mass matrices sparse and can't return them
        terms = [(what, i) for what, i in terms if what is not kind.MassMatrix]
        own_mass = _planar_mass(mbs, item) if object_type == "RigidBody2D" else _point_mass(mbs, item, len(places))
    for what, _ in terms:
        try:
            mbs.ComputeItem(item, what)
        except exu.ExudynError as error:
            raise InputError(
                f"SolveDynamicSparse mbs must hold objects whose matrices Exudyn returns, got object {int(item)} of "
                f"type {object_type} without {what.name}; use mbs.SolveDynamic for this model."
            ) from error
    rows, columns = (x.ravel() for x in np.meshgrid(places, places, indexing="ij"))

    def part(mbs, *factors):
        values = np.zeros((len(places), len(places))) if own_mass is None else factors[0] * own_mass(mbs)
        for what, i in terms:
            matrix = np.asarray(mbs.ComputeItem(item, what))
            if matrix.size:
                values += factors[i] * matrix
        if not constrained:
            return rows, columns, values.ravel()
        C = coo_matrix(np.asarray(mbs.ComputeItem(item, kind.ConstraintJacobian)))
        a, q = equations[C.row], places[C.col]
        return (
            np.concatenate([rows, a, q]),
            np.concatenate([columns, q, a]),
            np.concatenate([values.ravel(), C.data, C.data]),
        )

    return part


def _point_mass(mbs: Any, item: Any, size: int) -> Callable:
    """Mass matrix of a mass point: density times position Jacobian."""
    mass = np.asarray(mbs.ComputeItem(item, exu.ComputeItemType.MassWeightedPositionJacobian))[:size]
    return lambda mbs: mass


def _planar_mass(mbs: Any, item: Any) -> Callable:
    """Mass matrix of a planar rigid body; density times position Jacobian are its first two rows, centre of mass off the node included."""
    inertia = float(mbs.GetObjectParameter(item, "inertia"))

    def mass(mbs: Any) -> np.ndarray:
        out = np.zeros((3, 3))
        out[:2] = np.asarray(mbs.ComputeItem(item, exu.ComputeItemType.MassWeightedPositionJacobian))[:2]
        out[2, :2], out[2, 2] = out[:2, 2], inertia
        return out

    return mass


def _euler_parameters(mbs: Any, node: Any, n: int) -> Callable:
    """Triplets of a node's norm condition theta.theta - 1 = 0, which no object returns."""
    data = mbs.systemData
    columns = np.array(data.GetNodeLTGODE2(int(node)), dtype=np.int32)[3:]
    rows = np.full(4, n + data.GetNodeLTGAE(int(node))[0], dtype=np.int32)
    reference = np.array(mbs.GetNode(node)["referenceCoordinates"], dtype=float)[3:]

    def part(mbs, *factors):
        slope = 2 * (reference + np.asarray(mbs.systemData.GetODE2Coordinates())[columns])
        return np.concatenate([rows, columns]), np.concatenate([columns, rows]), np.concatenate([slope, slope])

    return part


def _as_sparse(value) -> coo_matrix | None:
    """A matrix that a user function or an object holds, as triplets."""
    if isinstance(value, exu.MatrixContainer):
        value = value.GetPythonObject()
    if isinstance(value, dict):
        shape = (value["numberOfRows"], value["numberOfColumns"])
        triplets = np.asarray(value["triplets"]).reshape(-1, 3)
        return coo_matrix((triplets[:, 2], (triplets[:, 0].astype(int), triplets[:, 1].astype(int))), shape=shape)
    if issparse(value):
        return value.tocoo()
    dense = np.atleast_2d(np.asarray(value, dtype=float))
    return None if dense.size == 0 else coo_matrix(dense)
