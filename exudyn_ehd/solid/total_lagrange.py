"""The flexible bush as a total Lagrangian solid: force, tangent, mass, energy and stress; factors of its matrices.

Positions are absolute (the absolute nodal coordinate formulation): x = X + u with the displacement u in one fixed
frame, interpolated by the mesh's elements. Internal virtual work in first Piola-Kirchhoff form,

    delta W = int P : d(delta u)/dX dV0,   F = I + du/dX,   E = (F^T F - I)/2,

with the St. Venant-Kirchhoff material, P = F S and S = lam tr(E) I + 2 mu E, exact at any rotation and displacement and
meant for small strain, or the compressible Neo-Hooke one, P = mu (F - F^-T) + lam ln(det F) F^-T, for large strain.

Stress is that of Cauchy and of von Mises, at nodes and at any material point. The factors are those of scipy, for
sparse matrices of any mesh.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, partial
from typing import ClassVar

import numpy as np
import scipy
from scipy.sparse import bsr_matrix, csr_matrix, kron, spmatrix
from scipy.sparse.linalg import LinearOperator, SuperLU, gcrotmk, splu

from exudyn_ehd.solid.elements import blocks, kernels
from exudyn_ehd.solid.elements.element import Element, Quadrature
from exudyn_ehd.solid.mesh import BushMesh
from exudyn_ehd.status import POSITIVE, Checked, InputError, require_number


def sparse_factor(A: spmatrix, *, pivoting: float = 0.0) -> SuperLU:
    """SuperLU of a matrix with a symmetric pattern, which keeps its diagonal as pivots from that share of a column on.

    Raises
    ------
    RuntimeError
        If the matrix is singular.
    """
    options = {"SymmetricMode": True}
    return splu(A.tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=pivoting, options=options)


def held_solution(K: csr_matrix, nodes: np.ndarray) -> Callable[[np.ndarray], np.ndarray]:
    """Displacements of a body with three coordinates a node under nodal forces, both (n, k), with some nodes held.

    Raises
    ------
    RuntimeError
        If the stiffness matrix (n, n) of the rest is singular.
    """
    free = np.ones(K.shape[0], dtype=bool)
    free[(3 * nodes[:, None] + np.arange(3)).ravel()] = False
    factor = sparse_factor(K[free][:, free])

    def solve(loads: np.ndarray) -> np.ndarray:
        out = np.zeros_like(loads)
        out[free] = factor.solve(np.ascontiguousarray(loads[free]))
        return out

    return solve


def solve_by_products(
    product: Callable[[np.ndarray], np.ndarray],
    right: np.ndarray,
    tolerance: float,
    most: int,
) -> np.ndarray:
    """Return x (n,) with ``product(x) = right``: generalised minimal residual.

    Parameters
    ----------
    product : function
        A x, (n,) of an (n,) array.
    right : (n,) array
    tolerance : float
        Norm of ``right - A x`` to reach.
    most : int
        Products at most.
    """
    if not np.linalg.norm(right) > tolerance:
        return np.zeros_like(right)

    A = LinearOperator((right.size, right.size), matvec=product, dtype=float)
    x: np.ndarray = gcrotmk(A, right, rtol=0.0, atol=tolerance, m=most, k=0, maxiter=1)[0]
    return x


@dataclass(frozen=True, kw_only=True)
class SaintVenantKirchhoff(Checked):
    """Material of a bush or pin, such as steel: isotropic, linear in the Green-Lagrange strain.

    For small strain at any rotation: steel, bronze, polymers. Not for strong compression: it softens, has lost its
    stiffness at about half the length, and lets elements turn inside out. Take `NeoHooke` for soft bushes.

    Parameters
    ----------
    youngs_modulus : float
        Young's modulus [Pa].
    poisson_ratio : float
        Poisson's ratio, between -1 and 0.5; elements become too stiff (lock) above about 0.49.
    density : float
        Density of the undeformed material [kg/m^3].

    Examples
    --------
    >>> steel = ehd.SaintVenantKirchhoff(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7800)
    >>> [round(1e-9 * value, 1) for value in steel.lame]  # GPa
    [121.2, 80.8]
    """

    youngs_modulus: float
    poisson_ratio: float
    density: float

    checks: ClassVar = {
        "youngs_modulus": POSITIVE,
        "density": POSITIVE,
        "poisson_ratio": partial(require_number, above=-1.0),
    }

    def __post_init__(self) -> None:
        super().__post_init__()
        hint = "an incompressible bush needs another element, 0.49 is the sensible limit of this one."
        require_number(f"{type(self).__name__}.poisson_ratio", self.poisson_ratio, below=0.5, hint=hint)

    @property
    def lame(self) -> tuple[float, float]:
        """Lamé's constants (lam, mu) [Pa]."""
        E, nu = self.youngs_modulus, self.poisson_ratio
        return E * nu / ((1 + nu) * (1 - 2 * nu)), E / (2 * (1 + nu))

    def energy_density(self, H: np.ndarray) -> np.ndarray:
        """Strain energy per reference volume (...) [J/m^3] at displacement gradients H (..., 3, 3)."""
        lam, mu = self.lame
        E = green_lagrange(H)
        return 0.5 * lam * np.einsum("...ii->...", E) ** 2 + mu * np.einsum("...ij,...ij->...", E, E)

    def first_piola(self, H: np.ndarray) -> np.ndarray:
        """First Piola-Kirchhoff stress (..., 3, 3) [Pa] at displacement gradients H (..., 3, 3)."""
        lam, mu = self.lame
        E = green_lagrange(H)
        S = 2 * mu * E + lam * np.einsum("...ii->...", E)[..., None, None] * np.eye(3)
        return (H + np.eye(3)) @ S


@dataclass(frozen=True, kw_only=True)
class NeoHooke(SaintVenantKirchhoff):
    """Isotropic material of a soft bush: compressible Neo-Hooke, for large strain.

    Energy per volume ``mu/2 (tr(F^T F) - 3) - mu ln J + lam/2 (ln J)^2`` with J = det F: infinite where an element
    would turn inside out; at small strain that of `SaintVenantKirchhoff`. J. Bonet and R. D. Wood, Nonlinear Continuum
    Mechanics for Finite Element Analysis, 2nd ed., 2008, section 6.4.3.

    Parameters
    ----------
    youngs_modulus, poisson_ratio, density
        As in `SaintVenantKirchhoff`, for small strain.

    Examples
    --------
    >>> rubber = ehd.NeoHooke(youngs_modulus=5e6, poisson_ratio=0.45, density=1100)
    >>> rubber.density  # kg/m^3
    1100
    """

    def energy_density(self, H: np.ndarray) -> np.ndarray:
        """Strain energy per reference volume (...) [J/m^3] at displacement gradients H (..., 3, 3)."""
        lam, mu = self.lame
        log = np.log(np.linalg.det(H + np.eye(3)))
        return mu * (np.einsum("...ii->...", green_lagrange(H)) - log) + 0.5 * lam * log**2

    def first_piola(self, H: np.ndarray) -> np.ndarray:
        """First Piola-Kirchhoff stress (..., 3, 3) [Pa] at displacement gradients H (..., 3, 3)."""
        lam, mu = self.lame
        F = H + np.eye(3)
        inverse = np.linalg.inv(F).swapaxes(-1, -2)
        return mu * (F - inverse) + lam * np.log(np.linalg.det(F))[..., None, None] * inverse


def green_lagrange(H: np.ndarray) -> np.ndarray:
    """Green-Lagrange strain (..., 3, 3) of displacement gradients H (..., 3, 3)."""
    return 0.5 * (H + H.swapaxes(-1, -2) + np.einsum("...ki,...kj->...ij", H, H))


@dataclass(frozen=True, kw_only=True, eq=False)
class TotalLagrange:
    """A mesh with a material: the nonlinear solid.

    Parameters
    ----------
    mesh : BushMesh
    material : SaintVenantKirchhoff or NeoHooke
    quadrature : Quadrature, optional
        As in `ANCFBush`. The mass always takes 27 points, of tetrahedra 14.
    viscosity_time : float
        beta [s] of the Kelvin-Voigt law S = C : (E + beta dE/dt). In the small it is the stiffness-proportional part
        of Rayleigh damping, D = beta K; unlike that, it does no work in a rigid motion. `NeoHooke` gets its part beta
        C : dE/dt.
    parallel : bool
        Run the loops over elements on numba's threads; the results are the same to rounding.
    """

    mesh: BushMesh
    material: SaintVenantKirchhoff
    quadrature: Quadrature | None = None
    viscosity_time: float = 0.0
    parallel: bool = False

    def __post_init__(self) -> None:
        object.__setattr__(self, "quadrature", own_rule("TotalLagrange", self.mesh.element, self.quadrature))
        require_number("TotalLagrange.viscosity_time", self.viscosity_time, "s", at_least=0.0)

    @cached_property
    def _geometry(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Elements (m, n), G (m, nq, 3, n) and w (m, nq)."""
        assert self.quadrature is not None
        elements = np.ascontiguousarray(self.mesh.elements)
        gradient, weight = self.mesh.element.reference_gradients(self.mesh.nodes[elements], self.quadrature)
        if (inverted := np.flatnonzero(weight.min(axis=1) <= 0)).size:
            raise InputError(
                "TotalLagrange.mesh must have elements of positive volume, got a non-positive Jacobian in element "
                f"{inverted[0]}; check the node order and the mid-edge nodes of the mesh."
            )
        return elements, np.ascontiguousarray(gradient.transpose(0, 1, 3, 2)), weight

    @cached_property
    def _blocks(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Natural gradients (3 q, n), their transpose, and the geometry of blocks of elements."""
        assert self.quadrature is not None
        natural = self.mesh.element.shapes(self.quadrature.points)[1]
        inverse, weight = self.mesh.element.inverse_jacobians(self.mesh.nodes[self.mesh.elements], self.quadrature)
        N = np.ascontiguousarray(natural.transpose(0, 2, 1)).reshape(-1, natural.shape[1])
        return N, np.ascontiguousarray(N.T), blocks.blocks_of(inverse, weight)

    @cached_property
    def _pattern(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Fixed sparsity pattern of the tangent, of 3 x 3 node blocks, and the place of every element's blocks in it.

        CSR structure, ``indptr`` and ``indices``; entries in each of the three rows of a node (n,); entry (3 I, 3 J) of
        every node pair of every element (m, a, a).
        """
        elements, n = self._geometry[0].astype(np.int64), len(self.mesh.nodes)
        pairs, place = np.unique(elements[:, :, None] * n + elements[:, None, :], return_inverse=True)
        row, column = np.divmod(pairs, n)
        start = np.searchsorted(row, np.arange(n + 1))
        whole = bsr_matrix((np.zeros((len(pairs), 3, 3)), column, start), shape=(3 * n, 3 * n)).tocsr()
        # behind the nine entries of every pair of earlier nodes, and three of every earlier pair of this one
        slot = (9 * start[row] + 3 * (np.arange(len(pairs)) - start[row])).astype(np.int32)
        stride = np.diff(whole.indptr)[::3].astype(np.int64)
        return whole.indptr, whole.indices, stride, slot[place].reshape(*elements.shape, -1)

    def force(self, u: np.ndarray, v: np.ndarray | None = None) -> np.ndarray:
        """Return the internal force, shape (n, 3) [N], of displacements u [m] and velocities v [m/s], shape (n, 3)."""
        u, v, law = self._state(u, v)
        f = np.empty_like(u)
        kernel = blocks.force_parallel if self.parallel else blocks.force_serial
        kernel(*self._blocks, self._geometry[0], u, v, law, f)
        return f

    def tangent(
        self, u: np.ndarray, v: np.ndarray | None = None, *, position_factor: float = 1.0, velocity_factor: float = 0.0
    ) -> csr_matrix:
        """Return position_factor df/du + velocity_factor df/dv, shape (3 n, 3 n) [N/m], on the fixed pattern.

        Symmetric and exact without damping; with a viscosity time the term beta dF/dt of the strain rate's variation
        is left out, which is of the size of strain rate times beta.
        """
        elements, G, w = self._geometry
        indptr, indices, stride, slot = self._pattern
        u, v, law = self._state(u, v)
        data = np.empty(len(indices))
        factors = (position_factor, position_factor + self.viscosity_time * velocity_factor)
        state = ((0,) * self.mesh.element.size, u, v, law, *factors, stride, slot, data)
        kernel = kernels.tangent_parallel if self.parallel else kernels.tangent_serial
        kernel(G, w, elements, *state)
        return csr_matrix((data, indices, indptr), shape=(u.size, u.size), copy=False)

    def energy(self, u: np.ndarray) -> float:
        """Return the strain energy [J]."""
        elements, G, w = self._geometry
        H = np.einsum("eai,eqja->eqij", np.asarray(u)[elements], G)
        return float(np.sum(w * self.material.energy_density(H)))

    def inversion(self, u: np.ndarray) -> str:
        """Return a message on an element that displacements u (n, 3) turn inside out, with a remedy; empty if none."""
        elements, G, _ = self._geometry
        F = np.eye(3) + np.asarray(u)[elements].swapaxes(1, 2)[:, None] @ G.swapaxes(2, 3)
        # points with a nan are omitted
        with np.errstate(invalid="ignore"):
            ratios = np.fmin.reduce(np.linalg.det(F), axis=1)
        least = np.fmin.reduce(ratios)
        if not least <= 0.0:
            return ""
        # the first one of values that differ by round-off alone, as in symmetric meshes
        element = int(np.argmax(ratios <= least + 1e-3 * abs(least)))
        ratio = ratios[element]
        place = self.mesh.nodes[self.mesh.elements[element]].mean(axis=0)
        return (
            f"element {element} at {place[0]:.4g}, {place[1]:.4g}, {place[2]:.4g} m has turned inside out (det F = "
            f"{ratio:.3g}): {type(self.material).__name__} softens under compression; take NeoHooke(...) for strains "
            "beyond a few per cent, a finer mesh, or less load."
        )

    @cached_property
    def scalar_mass(self) -> csr_matrix:
        """Consistent mass int rho N_a N_b dV0 of one direction, shape (n, n) [kg]; the same for x, y and z."""
        elements, element = self.mesh.elements, self.mesh.element
        N = element.shapes(element.exact.points)[0]
        _, w = element.reference_gradients(self.mesh.nodes[elements], element.exact)
        blocks = self.material.density * np.einsum("eq,qa,qb->eab", w, N, N)
        rows, columns = np.repeat(elements, element.size, axis=1).ravel(), np.tile(elements, (1, element.size)).ravel()
        n = len(self.mesh.nodes)
        return csr_matrix((blocks.ravel(), (rows, columns)), shape=(n, n))

    @cached_property
    def mass(self) -> csr_matrix:
        """Constant consistent mass, shape (3 n, 3 n) [kg], coordinates ordered node by node as x, y, z."""
        return csr_matrix(kron(self.scalar_mass, np.eye(3), format="csr"))

    def _state(self, u: np.ndarray, v: np.ndarray | None) -> tuple[np.ndarray, np.ndarray, kernels.Law]:
        beta = 0.0 if v is None else self.viscosity_time
        given = (u, u if v is None else v)
        u, v = (np.ascontiguousarray(x, dtype=float).reshape(self.mesh.nodes.shape) for x in given)
        return u, v, kernels.Law(*self.material.lame, beta, isinstance(self.material, NeoHooke))


def own_rule(where: str, element: Element, rule: Quadrature | None) -> Quadrature:
    """The quadrature of a stiffness, by default the element's usual one.

    Raises
    ------
    InputError
        If it is none, or one of another element.
    """
    if rule is None:
        return element.default
    if not isinstance(rule, Quadrature) or not element.accepts(rule):
        raise InputError(
            f"{where}.quadrature of a mesh of {element.name} must be {', '.join(element.rules)} or None, got {rule!r}."
        )
    return rule


@dataclass(frozen=True, kw_only=True, eq=False)
class MaterialPoints:
    """Points of the solid by element and natural coordinates.

    Parameters
    ----------
    element : ndarray of int, shape (n,)
    natural : ndarray, shape (n, 3)
    gradient : ndarray, shape (n, nodes of an element, 3)
        Of the shape functions along the reference positions [1/m].
    """

    element: np.ndarray
    natural: np.ndarray
    gradient: np.ndarray


@dataclass(frozen=True, kw_only=True, eq=False)
class StressRecovery:
    """Stress of a mesh of one material.

    Parameters
    ----------
    mesh : BushMesh
        Reference positions.
    material : SaintVenantKirchhoff
    """

    mesh: BushMesh
    material: SaintVenantKirchhoff

    def cauchy_at(self, points: MaterialPoints, u: np.ndarray) -> np.ndarray:
        """Return sigma = F S F^T / det F, shape (n, 3, 3) [Pa], at material points; u has a row per mesh node [m]."""
        values = np.asarray(u)[self.mesh.elements[points.element]]
        return _cauchy(np.einsum("nai,naj->nij", values, points.gradient), self.material)

    def von_mises_at(self, points: MaterialPoints, u: np.ndarray) -> np.ndarray:
        """Return the von Mises stress, shape (n,) [Pa], at material points."""
        return von_mises(self.cauchy_at(points, u))

    def cauchy_at_nodes(self, u: np.ndarray) -> np.ndarray:
        """Return the Cauchy stress at all nodes, shape (mesh nodes, 3, 3) [Pa].

        Sampled at the 2 x 2 x 2 Gauss points, where the derivatives of the quadratic element are one order more
        accurate than elsewhere, extrapolated trilinearly to the nodes, and averaged over the elements that share a
        node; of tetrahedra at four points, linearly.
        """
        elements, gradient = self.mesh.elements, self.mesh.sample_gradients
        samples = _cauchy(np.einsum("eai,eqaj->eqij", np.asarray(u)[elements], gradient), self.material)
        at_nodes = np.einsum("aq,eqij->eaij", self.mesh.element.extrapolation, samples)
        total = np.zeros((len(self.mesh.nodes), 3, 3))
        np.add.at(total, elements, at_nodes)
        count = np.bincount(elements.ravel(), minlength=len(total))
        return total / count[:, None, None]

    def von_mises_at_nodes(self, u: np.ndarray) -> np.ndarray:
        """Return the von Mises stress of the averaged Cauchy stress at all nodes, shape (mesh nodes,) [Pa]."""
        return von_mises(self.cauchy_at_nodes(u))

    def locate(self, positions: np.ndarray) -> MaterialPoints:
        """Find the material points at reference positions, shape (n, 3) [m].

        Raises
        ------
        InputError
            A position lies outside the solid.
        """
        positions = np.atleast_2d(np.asarray(positions, dtype=float))
        corners, kind = self.mesh.nodes[self.mesh.elements], self.mesh.element
        _, near = scipy.spatial.cKDTree(corners.mean(axis=1)).query(positions, k=min(27, len(corners)))
        count = near.size // len(positions)
        nodes, target = corners[near.ravel()], np.repeat(positions, count, axis=0)
        natural = kind.solve(nodes, lambda x, slope, own: (x - target[own], slope))
        outside = kind.outside(natural).reshape(-1, count)
        best = outside.argmin(axis=1)
        if (lost := outside.min(axis=1) > 1e-6).any():
            raise InputError(
                f"StressRecovery.locate positions must lie inside the solid, got {positions[lost][0].tolist()} m in "
                "the reference configuration; a point on the cylinder between two nodes may lie a little outside the "
                "quadratic faces: move it inward."
            )
        chosen = np.arange(len(positions)) * count + best
        along, element = kind.shapes(natural[chosen])[1], near.ravel()[chosen]
        jacobian = np.einsum("nar,nai->nir", along, corners[element])
        gradient = np.einsum("nar,nri->nai", along, np.linalg.inv(jacobian))
        return MaterialPoints(element=element, natural=natural[chosen], gradient=gradient)


def von_mises(stress: np.ndarray) -> np.ndarray:
    """Return sqrt(3/2 s:s), shape (...) [Pa], of stresses (..., 3, 3) with s their deviator."""
    deviator = stress - np.einsum("...ii->...", stress)[..., None, None] / 3 * np.eye(3)
    return np.sqrt(1.5 * np.einsum("...ij,...ij->...", deviator, deviator))


def _cauchy(H: np.ndarray, material: SaintVenantKirchhoff) -> np.ndarray:
    """Cauchy stress of displacement gradients H (..., 3, 3)."""
    F = H + np.eye(3)
    return material.first_piola(H) @ F.swapaxes(-1, -2) / np.linalg.det(F)[..., None, None]
