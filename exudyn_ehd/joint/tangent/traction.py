"""Tangential forces of film and contacts on the bore, vertex by vertex, and their change with film, gap and speeds.

On the bore act, per area, in the directions of theta and z of the undeformed bore,

    t_theta = mu U / h share - h / 2 dp/dx - p d(delta)/dx + friction of contacts,

the last but one the pressure on the slope of what departs from a cylinder (delta: displacement, profile, wear); t_z likewise. Sums over the
vertices times area are, but for the differences that stand for the slopes, the bearing's own friction torque and axial force, whose parts
are summed by parts (`exudyn_ehd.film.loads`); uneven drag between rough surfaces is left to what spreads the difference. What the deformed
bore's directions would change is smaller by the bore's slope, displacement over radius.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.sparse import csr_matrix, diags, vstack

from exudyn_ehd.joint.tangent.bore import contact_slope, couette_field, load_weights

if TYPE_CHECKING:
    from exudyn_ehd.film.grid import FilmGrid
    from exudyn_ehd.joint.model.flexible import ElasticBearingModel


class BoreForces:
    """Nodal forces of vertex forces on a nodal bore: E^T (f_r, f_theta, f_z).

    Parameters
    ----------
    values : csr matrix (n m, nodes)
        Shape functions at the film's vertices.
    grid : FilmGrid
    """

    def __init__(self, values: csr_matrix, grid: FilmGrid) -> None:
        self.transposed = values.T.tocsr()
        self.count = values.shape[1]
        self.cos = np.repeat(np.cos(grid.x), grid.shape[1])
        self.sin = np.repeat(np.sin(grid.x), grid.shape[1])
        self.slope_x, self.slope_z = slope_matrices(grid)

    def nodal(self, forces: np.ndarray) -> np.ndarray:
        """Forces (nodes, 3) of vertex forces (3, n m), joint frame."""
        f, t, z = forces
        return self.transposed @ np.column_stack((self.cos * f - self.sin * t, self.sin * f + self.cos * t, z))

    def rows(self, forces: list[csr_matrix]) -> csr_matrix:
        """E^T (3 nodes, r) of three sparse maps (n m, r) to vertex forces; rows by direction x, y, z."""
        f, t, z = forces
        cos, sin = diags(self.cos), diags(self.sin)
        along = (cos @ f - sin @ t, sin @ f + cos @ t, z)
        return vstack([self.transposed @ part for part in along]).tocsr()

    def by_node(self, rows: np.ndarray) -> np.ndarray:
        """Rows (3 nodes, ...) of `rows` as (nodes, 3, ...)."""
        return rows.reshape(3, self.count, *rows.shape[1:]).swapaxes(0, 1)


def slope_matrices(grid: FilmGrid) -> tuple[csr_matrix, csr_matrix]:
    """Slopes in theta and scaled z of fields (n m,): the differences of `exudyn_ehd.film.sensitivity.bore_stencil.gap_slopes`."""
    n, m = grid.shape
    at = np.arange(n * m).reshape(n, m)
    half = np.full(n * m, 0.5 / grid.width_x[0])
    nxt, prv = np.roll(at, -1, axis=0).ravel(), np.roll(at, 1, axis=0).ravel()
    rows = np.tile(at.ravel(), 2)
    along = csr_matrix((np.concatenate((half, -half)), (rows, np.concatenate((nxt, prv)))), shape=(n * m, n * m))
    line = np.asarray(np.gradient(np.eye(m), grid.z, axis=0))
    j, k = np.nonzero(line)
    across = csr_matrix((np.tile(line[j, k], n), (at[:, j].ravel(), at[:, k].ravel())), shape=(n * m, n * m))
    return along, across


def traction(model: ElasticBearingModel, forces: BoreForces) -> np.ndarray:
    """Forces of film and contacts along theta and z on the bore at every vertex (2, n m), N, for the last evaluation of ``model``."""
    g, R = model.grid, model.grid.reference_length
    P, H, W = model.P.ravel(), model.solver.H.ravel(), g.weight.ravel()
    couette = _density(model) / R
    out = np.empty((2, P.size))
    # fmt: off
    out[0] = R * model.omega * couette - 6.0 * W * (H * (forces.slope_x @ P) + 2.0 * P * _extra(model.extra_slope_x, P))
    out[1] = model.axial_speed * couette - 6.0 * W * (H * (forces.slope_z @ P) + 2.0 * P * _extra(model.extra_slope_z, P))
    # fmt: on
    out *= model.shear_scale * R
    if model.pressing is not None:
        for contact, P_c in zip(model.effects.contacts, model.pressing.P, strict=True):
            a, b, _ = model.slip(contact)
            weight = contact.friction_coefficient * R**2 * W * P_c.ravel()
            out[0] += a * weight
            out[1] += b * weight
    return out


class TractionChange:
    """Derivatives of all vertex forces (3, n m) on the bore (radial, theta, z) for the last evaluation of ``model``, SI units.

    Attributes
    ----------
    gap : (3, n m) array
        To the true gap at the same vertex, scaled.
    slope : (n m,) array
        Of the force along theta to the bore's scaled slope in theta, and along z to that in z.
    speed : (3, n m, 2) array
        To omega and w.
    """

    def __init__(self, model: ElasticBearingModel, forces: BoreForces) -> None:
        g, R, s, w = model.grid, model.grid.reference_length, model.solver, model.solver.work
        self.forces = forces
        P, H, W = model.P.ravel(), s.H.ravel(), g.weight.ravel()
        scale = model.shear_scale * R
        speeds = np.array([model.omega, model.axial_speed / R])
        self.places = w.order[: w.count]
        active = w.active.ravel()[self.places]
        # of pressure and of the density of Couette shear to the unknown at their vertex
        self.pressure = np.where(active, 1.0 if model.P_q is None else model.P_q.ravel()[self.places], 0.0)
        couette = self._share_slope(model, active) * (scale * W / H)[self.places]
        self.couette = speeds[:, None] * couette
        self.load = load_weights(model) * model.force_scale
        self.by_slope = -6.0 * scale * W * H
        extra = np.stack([_extra(e, P) for e in (model.extra_slope_x, model.extra_slope_z)])
        self.by_pressure = -12.0 * scale * W * extra
        self.gap, self.speed = np.zeros((3, P.size)), np.zeros((3, P.size, 2))
        self.slope = -12.0 * scale * W * P
        limited = np.ones(P.size) if model.limited is None else model.limited.slope.ravel()
        for c, along in enumerate((forces.slope_x, forces.slope_z)):
            self.gap[1 + c] = scale * (speeds[c] * couette_field(model).ravel() - 6.0 * W * limited * (along @ P))
        density = scale * _density(model)
        self.speed[1, :, 0] = density
        self.speed[2, :, 1] = density / R
        if model.ratio_v is not None:
            # the shear factor knows the scaled speed omega / 2
            thinning = 0.5 * scale * W / H * (model.share() * model.ratio_v).ravel()
            self.speed[1:, :, 0] += speeds[:, None] * thinning
        if model.pressing is not None:
            self._add_contacts(model)

    @staticmethod
    def _share_slope(model: ElasticBearingModel, active: np.ndarray) -> np.ndarray:
        """Derivative of share times viscosity ratio to the unknown at its vertex (count,)."""
        at = model.solver.work.order[: active.size]
        by_pressure = np.zeros(at.size) if model.ratio_q is None else model.ratio_q.ravel()[at]
        by_fill = np.zeros(at.size)
        if model.solver.closure.conserves_mass:
            by_fill = np.ones(at.size) if model.ratio is None else model.ratio.ravel()[at]
        return np.where(active, by_pressure, by_fill)

    def _add_contacts(self, model: ElasticBearingModel) -> None:
        area = model.grid.reference_length**2 * model.grid.weight.ravel()
        fields = model.pressing
        assert fields is not None
        self.gap[0] += contact_slope(model).ravel()
        for contact, P, slope in zip(model.effects.contacts, fields.P, fields.slope, strict=True):
            a, b, by_speed = model.slip(contact)
            for c, direction in enumerate((a, b)):
                friction = contact.friction_coefficient * area
                self.gap[1 + c] += direction * friction * slope.ravel()
                self.speed[1 + c] += np.outer(friction * P.ravel(), by_speed[c])

    def by_unknown(self) -> list[csr_matrix]:
        """Derivatives of the three vertex forces to the unknowns, each (n m, count)."""
        size, count = self.slope.size, self.places.size

        def at_own(values: np.ndarray) -> csr_matrix:
            return csr_matrix((values, (self.places, np.arange(count))), shape=(size, count))

        pressure = at_own(self.pressure)
        out = [at_own(self.load)]
        for c, along in enumerate((self.forces.slope_x, self.forces.slope_z)):
            own = at_own(self.couette[c] + self.by_pressure[c][self.places] * self.pressure)
            out.append(diags(self.by_slope) @ (along @ pressure) + own)
        return out

    def vertex_forces(self, unknowns: np.ndarray, gap: np.ndarray, moved: np.ndarray, speed: np.ndarray) -> np.ndarray:
        """Change (3, n m) with changes of the unknowns (count,), of the scaled gap and of the bore's scaled displacement (n m,), and of the
        speeds (2,)."""
        out = self.gap * gap + self.speed @ speed
        pressure = np.zeros(gap.size)
        pressure[self.places] = self.pressure * unknowns
        for c, along in enumerate((self.forces.slope_x, self.forces.slope_z)):
            out[1 + c] += (
                self.by_slope * (along @ pressure) + self.by_pressure[c] * pressure + self.slope * (along @ moved)
            )
            out[1 + c, self.places] += self.couette[c] * unknowns
        out[0, self.places] += self.load * unknowns
        return out


def _density(model: ElasticBearingModel) -> np.ndarray:
    """W share ratio / H (n m,)."""
    field = model.grid.weight * model.share() / model.solver.H
    return (field if model.ratio is None else field * model.ratio).ravel()


def _extra(slope: np.ndarray | None, like: np.ndarray) -> np.ndarray:
    return np.zeros_like(like) if slope is None else slope.ravel()
