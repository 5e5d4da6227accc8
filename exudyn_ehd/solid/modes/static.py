"""A bush reduced to what its bore does under an oil film: static modes of smooth pressures.

With the outer surface fixed and small strain, a pressure p on the bore displaces it by ``H K^-1 H^T A p`` (H: radial
bore displacement of the nodal displacements, A: areas, K: stiffness in the reference configuration). The modes are the
displacements under the pressures

    p = {1, cos(n theta), sin(n theta)} P_l(zeta) (1 - zeta^2),   n <= N, l <= L,   zeta = 2 z / length,

with Legendre's polynomials P_l, and under uniform and axially linear pressure, which pressurised ends need. N and L are
the smallest ones for which films of a bearing of finite length,

    p ~ -(dh/dtheta) / h^3 (1 - cosh(a zeta) / cosh(a)),   h = 1 + (eps + tau zeta) cos(theta - phi),

displace the reduced bore as they displace the mesh, within the tolerance in the root mean square. The sampled
eccentricity ratios are moderate: where a rigid bearing's pressure is sharper, an elastic bore flattens it.

Only pressure works on the modes. The film's shear, clearance over radius of it, and the pressure on the bore's own
slope displace the bore radially by 3e-4 of what pressure does in steel, 1e-3 at E = 1e9 Pa (5 mm on c / R = 1e-3), 8e-3
at 1e7 Pa and c / R = 3e-3, measured on meshes: less than the modes' tolerance. `ANCFBush` has them.

A quasi-static bush (the default) has modes without mass: it follows the film, and its mass belongs to the body that
carries it. With ``dynamics`` the modes Phi get the mesh's consistent mass M,

    Phi^T M Phi q_tt + Phi^T K Phi q = Q,

and on a housing that moves what its acceleration and rotation do to them; modes for that come from
`exudyn_ehd.solid.modes.dynamic`.

Static modes give the first inertial correction of the bore's compliance exactly, that of the square of the frequency,
but not the vibrations: in a thick bush the lowest ones shear the wall, which no static mode does (frequencies up to 1.9
times too high). Those of the mesh's lowest vibrations that pressure excites are therefore added, less their part in the
span of the static modes: the reduced bush then vibrates in them at the mesh's frequencies, and its static modes stay as
they are.

Source of the idea: static (attachment) modes and vibrations, R. R. Craig, J. Modal Analysis 2 (1987) 59; derived here
for pressures on a bore.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import ceil, log2

import numpy as np
from numpy.polynomial.legendre import legval
from scipy.linalg import eigh
from scipy.sparse import csr_matrix

from exudyn_ehd.solid.bush import ModalBush
from exudyn_ehd.solid.loads import Pressure, pressure_loads
from exudyn_ehd.solid.mesh import BushMesh, Surface, directed
from exudyn_ehd.solid.modes import dynamic
from exudyn_ehd.status import InputError
from exudyn_ehd.storage import Shapes, cached_arrays

# Of the algorithm: raise it with every change of the modes, so that files of older ones are not taken.
FORMAT = 3
LARGEST_WAVE, LARGEST_AXIAL = 24, 10
# Share of the energy below which a combination of pressures adds nothing but rounding.
DEPENDENT = 1e-9
# Eccentricity ratios, directions (rad) and tilts (share of the gap left at the loaded side) of the sampled films.
SAMPLE_ECCENTRICITIES = (0.5,)
SAMPLE_DIRECTIONS = (0.3, 1.1)
SAMPLE_TILTS = (0.3, -0.3)
# Decay of the sampled films towards the ends; 0 would be the short bearing's parabola, a long one's film is fuller.
SAMPLE_DECAY = 6.0
# Two axial orders for every halving of the tolerance from here: next to the ends, where a bush deflects most, an
# elastic film's pressure is fuller than the sampled ones and converges slowly with L (measured against nodal
# solutions).
AXIAL_FROM = 0.08


@dataclass(frozen=True, kw_only=True, eq=False)
class BoreModes:
    """Modes of a bore.

    Parameters
    ----------
    mesh : BushMesh
    displacements : ndarray, shape (k, n, 3)
        Nodal displacements of every mode on the whole mesh, bush frame; the largest radial bore displacement of a
        static mode is 1, so that its coordinate is in m. Modes of vibrations and of body forces follow the static ones;
        their largest displacement of all nodes is 1.
    stiffness : ndarray, shape (k,)
        Modal stiffness [N/m]; the modes are orthogonal in energy, the static ones also on the bore, of which the
        softest come first.
    error : float
        Error under the sampled films, as in `ModalBush`.
    mass : ndarray, shape (k, k), or None
        Modal mass Phi^T M Phi [kg]; None for a quasi-static bush.
    moments : ndarray, shape (n, 4), or None
        int rho N [kg] and int rho N X [kg m] of the nodes' shape functions, X in the bush frame; with ``mass``.
    """

    mesh: BushMesh
    displacements: np.ndarray
    stiffness: np.ndarray
    error: float
    mass: np.ndarray | None = None
    moments: np.ndarray | None = None

    @property
    def count(self) -> int:
        """Number of modes."""
        return self.stiffness.size

    @property
    def faces(self) -> Surface:
        """Of the bore."""
        return self.mesh.bore

    def vibrations(self) -> tuple[np.ndarray, np.ndarray]:
        """Undamped vibrations without a film, outer surface held; for a bush with ``dynamics``.

        Returns
        -------
        omega : ndarray, shape (k,)
            Angular eigenfrequencies [rad/s], ascending.
        shapes : ndarray, shape (k, k)
            One vibration per column in modal coordinates, of unit modal mass.

        Raises
        ------
        InputError
            If the modes have no mass.
        """
        if self.mass is None:
            raise InputError(
                "BoreModes.vibrations needs modes with mass; make them of a ModalBush(..., dynamics=True)."
            )
        square, shapes = eigh(np.diag(self.stiffness), self.mass)
        return np.sqrt(square), shapes

    def participation(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Inertia of a moving frame on the modes, bush frame.

        Returns
        -------
        P : ndarray, shape (3, k)
            int rho Phi [kg].
        Theta : ndarray, shape (3, k)
            int rho X x Phi [kg m].
        K : ndarray, shape (k, 3, 3)
            int rho (X . Phi 1 - Phi X^T) [kg m].
        """
        assert self.moments is not None
        mass, first = self.moments[:, 0], self.moments[:, 1:]
        # by node: int rho Phi X^T
        spread = np.einsum("kni,nj->kij", self.displacements, first)
        linear = np.einsum("kni,n->ik", self.displacements, mass)
        angular = np.stack([spread[:, b, a] - spread[:, a, b] for a, b in ((1, 2), (2, 0), (0, 1))])
        return linear, angular, np.trace(spread, axis1=1, axis2=2)[:, None, None] * np.eye(3) - spread

    def radial(self, theta: np.ndarray, z: np.ndarray) -> np.ndarray:
        """Radial displacement of the bore at the grid theta x z for unit coordinates, shape (len(theta), len(z), k)."""
        T, Z = np.meshgrid(theta, z, indexing="ij")
        values = self.faces.interpolation(T.ravel(), Z.ravel())
        return self.radial_of(values, T.ravel(), Z.ravel()).reshape(*T.shape, self.count)

    def radial_of(self, values: csr_matrix, theta: np.ndarray, z: np.ndarray) -> np.ndarray:
        """The same (p, k) at points (p,) whose ``values`` (p, nodes) of displacements come from those at the nodes."""
        H = directed(values, np.stack([np.cos(theta), np.sin(theta)], axis=1))
        bore = self.displacements[:, self.faces.nodes].reshape(self.count, -1)
        return np.ascontiguousarray(H @ bore.T)


def bore_modes(bush: ModalBush) -> BoreModes:
    """The modes of a bush from the disk (see `exudyn_ehd.storage`), or computed and stored there.

    Raises
    ------
    InputError
        If the tolerance takes more waves than the search allows.
    """
    mesh = bush.build_mesh()

    def compute() -> dict[str, np.ndarray]:
        modes = compute_modes(bush, mesh)
        return {"displacements": modes.displacements, "stiffness": modes.stiffness, "error": np.array(modes.error)}

    shapes: Shapes = {"displacements": ("k", len(mesh.nodes), 3), "stiffness": ("k",)}
    data = cached_arrays("bush_modes", _content(bush, mesh), {**shapes, "error": ()}, compute)
    static = BoreModes(
        mesh=mesh, displacements=data["displacements"], stiffness=data["stiffness"], error=float(data["error"])
    )
    if not bush.dynamics:
        return static
    content = _content(bush, mesh) + repr((bush.material.density, *dynamic.VIBRATION_SETTINGS)).encode()
    data = cached_arrays(
        "bush_vibrations",
        content,
        {**shapes, "mass": ("m", "m"), "moments": (len(mesh.nodes), 4)},
        lambda: dynamic.vibration_modes(bush.solid(mesh), static.displacements, static.stiffness),
    )
    modes = BoreModes(
        mesh=mesh,
        displacements=np.concatenate((static.displacements, data["displacements"])),
        stiffness=np.concatenate((static.stiffness, data["stiffness"])),
        error=static.error,
        mass=data["mass"],
        moments=data["moments"],
    )
    return _with_body_forces(bush, modes, content) if bush.body_forces else modes


def _with_body_forces(bush: ModalBush, modes: BoreModes, content: bytes) -> BoreModes:
    """The modes with mass, which ``content`` determines, and what they lack of the responses to body forces."""
    mesh, mass = modes.mesh, modes.mass
    assert mass is not None
    data = cached_arrays(
        "bush_body_forces",
        content + repr(dynamic.BODY_FORCE_SETTINGS).encode(),
        {"displacements": ("k", len(mesh.nodes), 3), "stiffness": ("k",), "mass": ("k", "m")},
        lambda: dynamic.body_force_modes(bush.solid(mesh), modes.displacements, modes.stiffness, bush.tilted),
    )
    rows = data["mass"]
    return replace(
        modes,
        displacements=np.concatenate((modes.displacements, data["displacements"])),
        stiffness=np.concatenate((modes.stiffness, data["stiffness"])),
        mass=np.block([[mass, rows[:, : len(mass)].T], [rows]]),
    )


def _content(bush: ModalBush, mesh: BushMesh) -> bytes:
    """Everything that determines the modes."""
    material, quadrature = bush.material, bush.quadrature
    assert quadrature is not None
    described = (FORMAT, material.youngs_modulus, material.poisson_ratio, bush.tolerance, bush.tilted)
    search = (LARGEST_WAVE, LARGEST_AXIAL, DEPENDENT)
    samples = (SAMPLE_ECCENTRICITIES, SAMPLE_DIRECTIONS, SAMPLE_TILTS, SAMPLE_DECAY, AXIAL_FROM)
    surfaces = (mesh.bore.nodes, mesh.bore.faces, mesh.outer.nodes)
    arrays = (mesh.nodes, mesh.elements, *surfaces, quadrature.points, quadrature.weights)
    stored = (repr(a.shape).encode() + np.ascontiguousarray(a).tobytes() for a in arrays)
    return b"".join([repr((*described, *search, *samples)).encode(), *stored])


def compute_modes(bush: ModalBush, mesh: BushMesh) -> BoreModes:
    """Compute the modes of a bush on its mesh: one factorisation of its stiffness, one solve per pressure."""
    bore, size = mesh.bore, len(mesh.nodes)
    free, _, factor = dynamic.held_stiffness(bush.solid(mesh))
    pressures, orders = candidate_pressures(bush.tilted)
    samples = sample_pressures(bush.tilted)
    loads = pressure_loads(bore, size, [*pressures, *samples])
    solutions = np.zeros((loads.shape[1], free.size))
    solutions[:, free] = factor.solve(np.ascontiguousarray(loads[free])).T
    radial = bore.radial(solutions)
    compliance = solutions @ loads
    chosen, error = enough_modes(compliance, radial, orders, bush.tolerance, bush.tilted)
    coefficients = orthogonal_modes(compliance[np.ix_(chosen, chosen)], radial[chosen])
    shape = coefficients @ radial[chosen]
    peak = shape[np.arange(len(shape)), np.argmax(np.abs(shape), axis=1)]
    coefficients /= peak[:, None]
    return BoreModes(
        mesh=mesh,
        displacements=(coefficients @ solutions[chosen]).reshape(len(peak), -1, 3),
        stiffness=1.0 / peak**2,
        error=error,
    )


def orthogonal_modes(compliance: np.ndarray, radial: np.ndarray) -> np.ndarray:
    """Combinations (k, candidates) of unit strain energy, orthogonal also on the bore; dependent ones are dropped."""
    size = np.sqrt(np.diag(compliance))
    values, vectors = eigh(compliance / np.outer(size, size))
    keep = values > DEPENDENT * values[-1]
    basis = (vectors[:, keep] / np.sqrt(values[keep])).T / size
    part = basis @ radial
    compliant, turn = eigh(part @ part.T)
    # waves that a coarse mesh can't show strain it and leave its bore nodes where they are
    return turn[:, compliant > DEPENDENT * compliant[-1]][:, ::-1].T @ basis


def enough_modes(
    compliance: np.ndarray,
    radial: np.ndarray,
    orders: np.ndarray,
    tolerance: float,
    tilted: bool,
    scale: np.ndarray | None = None,
) -> tuple[np.ndarray, float]:
    """Indices of the candidates of the smallest orders (N, L) that meet the tolerance, and their error."""
    count, size = len(orders), np.sqrt(np.diag(compliance))
    exact = radial[count:]
    scale = np.linalg.norm(exact, axis=1) if scale is None else scale
    best: tuple[np.ndarray, float] | None = None
    least = 2 * max(0, ceil(log2(AXIAL_FROM / tolerance) - 1e-9))
    for axial in range(min(least, LARGEST_AXIAL), LARGEST_AXIAL + 1, 1 if tilted else 2):
        for wave in range(2, LARGEST_WAVE + 1):
            chosen = np.flatnonzero((orders[:, 0] <= wave) & (orders[:, 1] <= axial))
            if best is not None and len(chosen) >= len(best[0]):
                break
            # of more waves than the mesh has nodes for some depend on others
            matrix = compliance[np.ix_(chosen, chosen)] / np.outer(size[chosen], size[chosen])
            part = np.linalg.lstsq(matrix, compliance[chosen, count:] / size[chosen, None], rcond=DEPENDENT)[0]
            part /= size[chosen, None]
            error = float((np.linalg.norm(part.T @ radial[chosen] - exact, axis=1) / scale).max())
            if error <= tolerance:
                best = chosen, error
                break
    if best is None:
        raise InputError(
            f"the modes' tolerance {tolerance:g} can't be met with {LARGEST_WAVE} waves around the bore and axial "
            f"order {LARGEST_AXIAL} (error {error:.2g}); raise it, or take an ANCFBush."
        )
    return best


def candidate_pressures(tilted: bool) -> tuple[list[Pressure], np.ndarray]:
    """Pressures of the modes and their orders (k, 2) in theta and z; the axially linear and uniform ones come first."""

    def wave(n: int, axial: int, phase: float) -> Pressure:
        unit = np.eye(LARGEST_AXIAL + 1)[axial]
        return lambda theta, zeta: np.cos(n * theta - phase) * legval(zeta, unit) * (1.0 - zeta**2)

    pressures: list[Pressure] = [lambda theta, zeta: np.ones_like(zeta)]
    orders = [(0, 0)]
    if tilted:
        pressures.append(lambda theta, zeta: zeta)
        orders.append((0, 1))
    for axial in range(0, LARGEST_AXIAL + 1, 1 if tilted else 2):
        for n in range(LARGEST_WAVE + 1):
            for phase in (0.0, 0.5 * np.pi)[: 2 if n else 1]:
                pressures.append(wave(n, axial, phase))
                orders.append((n, axial))
    return pressures, np.array(orders)


def sample_pressures(tilted: bool) -> list[Pressure]:
    """Films that judge the modes."""

    def film(eps: float, share: float, phi: float) -> Pressure:
        def pressure(theta: np.ndarray, zeta: np.ndarray) -> np.ndarray:
            local = eps + share * (1.0 - eps) * zeta
            h = 1.0 + local * np.cos(theta - phi)
            return (
                np.maximum(local * np.sin(theta - phi), 0.0)
                / h**3
                * (1.0 - np.cosh(SAMPLE_DECAY * zeta) / np.cosh(SAMPLE_DECAY))
            )

        return pressure

    tilts = (0.0, *SAMPLE_TILTS) if tilted else (0.0,)
    return [film(e, t, d) for e in SAMPLE_ECCENTRICITIES for t in tilts for d in SAMPLE_DIRECTIONS]
