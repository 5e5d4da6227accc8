"""Forces of pressure and shear of a film on the nodes of a bore, and their exact tangent as matrix and as operator.

The forces per area on the bore, in the directions of theta and z of the undeformed bore, are

    t_theta = mu U / h share - h / 2 dp/dx - p d(delta)/dx + friction of contacts,

and the same for t_z. The third term is the pressure on the slope of the deviation delta from a cylinder (displacement,
profile, wear). Sums over the vertices times area agree with the bearing's friction torque and axial force
(`exudyn_ehd.film.loads`), except that slopes are differences here and integrals by parts there. Uneven drag between
rough surfaces is part of the difference that is spread over the nodes. The directions of the deformed bore would change
the forces by the bore's slope, displacement over radius, which is omitted.

The tangent has three forces per node, whereas `exudyn_ehd.joint.tangent.bore` has loads on the radial displacements.
The vertex forces change with the film's unknowns, and with motion and gap at fixed unknowns (`TractionChange`).

The nodal forces must balance the film's wrench. The difference between the wrench and the sum of pressure and shear
forces is spread over the nodes as ``a + b x r``, with a and b from force and moment.
"""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_matrix, diags, eye_array, kron

from exudyn_ehd.film.banded.substitution import TILE
from exudyn_ehd.film.grid import FilmGrid
from exudyn_ehd.film.reynolds.gap import Gradients
from exudyn_ehd.film.solvers.film import ends_of_cavities
from exudyn_ehd.joint.bore.shapes import NodalBore, dense
from exudyn_ehd.joint.solved_film import MOTION_SIZE, ContactFields, SolvedFilm
from exudyn_ehd.joint.tangent.bore import (
    Balances,
    at_unknowns,
    bore_tangent,
    contact_slope,
    pressures_by_unknowns,
)
from exudyn_ehd.joint.tangent.wrench import couette_field, motion_tangent, ratio_of, true_fills, wrench_rows


def complete(x: np.ndarray, wrench: np.ndarray, local: np.ndarray) -> np.ndarray:
    """Forces (count, 3, ...) at points x (count, 3) that balance a wrench (6, ...): ``local`` plus a spread rest."""
    rest = -wrench - np.tensordot(resultant(x), local.reshape(3 * len(x), *local.shape[2:]), 1)
    return local + np.tensordot(spread_matrix(x), rest, 1)


def resultant(x: np.ndarray) -> np.ndarray:
    """Force and moment about O (6, 3 count) of nodal forces at x (count, 3)."""
    out = np.zeros((6, len(x), 3))
    out[0, :, 0] = out[1, :, 1] = out[2, :, 2] = 1.0
    out[3, :, 1], out[3, :, 2] = -x[:, 2], x[:, 1]
    out[4, :, 0], out[4, :, 2] = x[:, 2], -x[:, 0]
    out[5, :, 0], out[5, :, 1] = -x[:, 1], x[:, 0]
    return out.reshape(6, -1)


def spread_matrix(x: np.ndarray) -> np.ndarray:
    """Map (count, 3, 6) from a force and a moment about O to forces with these resultants at points x (count, 3).

    The forces are ``(a + b x r) / count``. The map is the pseudo-inverse of `resultant`.
    """
    onto = resultant(x)
    return np.linalg.solve(onto @ onto.T, onto).T.reshape(-1, 3, 6)


class BoreForces:
    """Nodal forces of vertex forces on a nodal bore: E^T (f_r, f_theta, f_z).

    Parameters
    ----------
    bore : NodalBore
    """

    def __init__(self, bore: NodalBore) -> None:
        self.bore, grid = bore, bore.grid
        self.count, self.onto_nodes = bore.values.shape[1], bore.values.T.tocsr()
        self.cos = np.repeat(np.cos(grid.x), grid.shape[1])
        self.sin = np.repeat(np.sin(grid.x), grid.shape[1])
        self.slope_x, self.slope_z = slope_matrices(grid)

    def nodal(self, forces: np.ndarray) -> np.ndarray:
        """Forces (nodes, 3, ...) of vertex forces (3, n m, ...), joint frame."""
        along = np.moveaxis(forces, 0, 1).copy()
        cos, sin = (field.reshape(-1, *(1,) * (forces.ndim - 2)) for field in (self.cos, self.sin))
        along[:, 0], along[:, 1] = cos * forces[0] - sin * forces[1], sin * forces[0] + cos * forces[1]
        return (self.onto_nodes @ along.reshape(len(along), -1)).reshape(self.count, *along.shape[1:])


def slope_matrices(grid: FilmGrid) -> tuple[csr_matrix, csr_matrix]:
    """Slopes in theta and scaled z of fields (n m,).

    The differences of `exudyn_ehd.film.reynolds.gap.gap_slopes`.
    """
    ring, line = np.eye(grid.x.size), np.eye(grid.z.size)
    around = (np.roll(ring, 1, axis=1) - np.roll(ring, -1, axis=1)) / (2.0 * grid.width_x[0])
    return csr_matrix(kron(around, line)), csr_matrix(kron(ring, grid.differences_z))


def traction(film: SolvedFilm, forces: BoreForces) -> np.ndarray:
    """Forces of a solved film and its contacts along theta and z on the bore at every vertex (2, n m), N."""
    g, R, w = film.grid, film.grid.reference_length, film.journal
    P, H, W = film.oil.P.ravel(), film.solver.H.ravel(), g.weight.ravel()
    couette = _density(film) / R
    slope_x, slope_z = _extra_slopes(film)
    out = np.empty((2, P.size))
    out[0] = R * w.omega * couette - 6.0 * W * (H * (forces.slope_x @ P) + 2.0 * P * slope_x)
    out[1] = w.axial_speed * couette - 6.0 * W * (H * (forces.slope_z @ P) + 2.0 * P * slope_z)
    out *= film.scales.shear * R
    if film.pressing is not None:
        for (friction, transition), P_c in zip(film.pressing.friction, film.pressing.P, strict=True):
            (a, b), _ = film.slip(transition)
            weight = friction * R**2 * W * P_c.ravel()
            out[0] += a * weight
            out[1] += b * weight
    return out


class TractionChange:
    """Derivatives of all vertex forces (3, n m) on the bore (radial, theta, z) of a solved film, SI units.

    Attributes
    ----------
    pressure, shear : sparse matrices (n m, count)
        Derivatives of the pressures, and of the density of Couette shear, to the unknowns; None if the shear does not
        depend on them.
    gap : (3, n m) array
        Derivatives of the forces to the scaled true gap at the same vertex.
    load : (n m,) array
        Derivative of the radial force to the pressure.
    slope : (n m,) array
        Derivative of the force along theta to the bore's scaled slope in theta, and of that along z to the slope in z.
    speed : (3, n m, 2) array
        Derivatives of the forces to omega and w.
    line : ShearOfLine or None
    """

    def __init__(self, film: SolvedFilm, forces: BoreForces) -> None:
        g, R, s, w, oil = film.grid, film.grid.reference_length, film.solver, film.solver.work, film.oil
        self.forces = forces
        P, H, W = oil.P.ravel(), s.H.ravel(), g.weight.ravel()
        scale = film.scales.shear * R
        speeds = np.array([film.journal.omega, film.journal.axial_speed / R])
        self.places, self.speeds = w.order[: w.count], speeds
        sheared = scale * g.shear_weight.ravel() / H
        self.pressure = pressures_by_unknowns(film)
        share = _share_by_unknowns(film, self.pressure)
        self.shear = None if share is None else diags(sheared) @ share
        if oil.P_q is not None:
            self.pressure = diags(oil.P_q.ravel()) @ self.pressure
        self.load = W * film.scales.force
        self.by_slope = -6.0 * scale * W * H
        self.by_pressure = -12.0 * scale * W * np.stack(_extra_slopes(film))
        self.gap, self.speed = np.zeros((3, P.size)), np.zeros((3, P.size, 2))
        self.slope = -12.0 * scale * W * P
        limited = np.ones(P.size) if film.limited is None else film.limited.slope.ravel()
        for c, along in enumerate((forces.slope_x, forces.slope_z)):
            self.gap[1 + c] = scale * (speeds[c] * couette_field(film)[0].ravel() - 6.0 * W * limited * (along @ P))
        density = scale * _density(film)
        self.speed[1, :, 0] = density
        self.speed[2, :, 1] = density / R
        if oil.ratio_v is not None:
            # the shear factor depends on the scaled speed omega / 2
            thinning = 0.5 * sheared * (film.share() * oil.ratio_v).ravel()
            self.speed[1:, :, 0] += speeds[:, None] * thinning
        if film.loads.recess is not None:
            self.speed[1:, :, 0] += speeds[:, None] * (scale * film.loads.recess.by_spin.ravel())
        self.line = None if film.solver.oil_line is None else ShearOfLine(film, scale)
        if film.pressing is not None:
            self._add_contacts(film, film.pressing)

    def _add_contacts(self, film: SolvedFilm, fields: ContactFields) -> None:
        area = film.grid.reference_length**2 * film.grid.weight.ravel()
        self.gap[0] += contact_slope(film, fields).ravel()
        for (coefficient, transition), P, slope in zip(fields.friction, fields.P, fields.slope, strict=True):
            directions, by_speed = film.slip(transition)
            for c, direction in enumerate(directions):
                friction = coefficient * area
                self.gap[1 + c] += direction * friction * slope.ravel()
                self.speed[1 + c] += np.outer(friction * P.ravel(), by_speed[c])

    def vertex_forces(self, unknowns: np.ndarray, gap: np.ndarray, moved: np.ndarray, speed: np.ndarray) -> np.ndarray:
        """Changes (3, n m, r) of the vertex forces by r given changes.

        These are changes of the unknowns (count, r), of the scaled gap and of the bore's scaled displacement ``moved``
        (n m, r), and of the speeds (2, r).
        """
        out = self.gap[:, :, None] * gap + self.speed @ speed
        pressure = self.pressure @ unknowns
        out[0] += self.load[:, None] * pressure
        for c, along in enumerate((self.forces.slope_x, self.forces.slope_z)):
            out[1 + c] += self.by_slope[:, None] * (along @ pressure) + self.by_pressure[c][:, None] * pressure
            out[1 + c] += self.slope[:, None] * (along @ moved)
        if self.shear is not None:
            out[1:] += np.multiply.outer(self.speeds, self.shear @ unknowns)
        return out


class ShearOfLine:
    """Derivatives of the density of Couette shear through the fills at a rupture line inside its cells.

    They hold at fixed unknowns.

    Attributes
    ----------
    motion : (10, n m) array
        Derivatives to (scaled pose, scaled rates, vx, vz).
    gap, rate : csr matrices (n m, n m)
        Derivatives to the scaled displacement of the bore and its rate.
    """

    def __init__(self, film: SolvedFilm, scale: float) -> None:
        g, fills = film.grid, true_fills(film)
        assert fills is not None
        spread = _share_by_fills(film)[:, fills.places].tocoo()
        density = scale * (g.shear_weight / film.solver.H).ravel()[spread.row] * spread.data
        shear = Gradients(spread.row, fills.places[spread.col], fills.by[:, spread.col] * density)
        self.motion = shear.columns(g.gap_shapes, g.fixed.size)
        self.gap, self.rate = (shear.matrix(g.shape, g.fixed.size, *factors) for factors in ((1.0, 0.0), (0.0, 1.0)))


def _share_by_unknowns(film: SolvedFilm, pressure: csr_matrix) -> csr_matrix | None:
    """Derivatives (n m, count) of the shear share times viscosity ratio to the unknowns; None if they are zero.

    ``pressure``: derivatives of the pressures before the oil's pressure law is applied.
    """
    s, oil, w = film.solver, film.oil, film.solver.work
    parts = []
    if oil.ratio_q is not None:
        parts.append(diags((oil.ratio_q * (s.fill if s.closure.conserves_mass else 1.0)).ravel()) @ pressure)
    by_others = film.shear_by_unknowns()
    if by_others is not None:
        parts.append(diags(film.share().ravel()) @ (by_others @ at_unknowns(film, film.solver.ones)))
    if s.closure.conserves_mass:
        rise = 0.0 if s.oil_line is None else s.oil_line.rise
        parts.append(_share_by_fills(film) @ at_unknowns(film, np.where(w.active, rise, ~film.grid.fixed)))
    return sum(parts[1:], parts[0]) if parts else None


def _share_by_fills(film: SolvedFilm) -> csr_matrix:
    """Derivatives (n m, n m) of the shear share times viscosity ratio to the fills; at ends, to neighbouring fills."""
    fills = np.arange(film.grid.fixed.size).reshape(film.grid.shape)
    for end, beside, at_cavity in ends_of_cavities(film.solver.system, True):
        fills[at_cavity, end] = fills[at_cavity, beside]
    return csr_matrix((ratio_of(film).ravel(), fills.ravel(), np.arange(fills.size + 1)), shape=(fills.size,) * 2)


def _density(film: SolvedFilm) -> np.ndarray:
    """Density of the Couette shear (n m,): W share ratio / H on the lands, plus the shear in recesses."""
    field = film.grid.shear_weight * film.share() / film.solver.H
    field = field if film.oil.ratio is None else field * film.oil.ratio
    return (field if film.loads.recess is None else field + film.loads.recess.density).ravel()


def _extra_slopes(film: SolvedFilm) -> tuple[np.ndarray, np.ndarray]:
    """Slopes (n m,) along theta and z of the surfaces' deviation from cylinders."""
    assert film.extra is not None
    return film.extra.slope_x.ravel(), film.extra.slope_z.ravel()


class NodalTangent:
    """Tangent of a solved film's wrench and nodal forces, by one film solve per change of the motion.

    It is valid until the model's next evaluation.

    Attributes
    ----------
    wrench : (6, 10) array
        d wrench / d motion.
    """

    def __init__(self, film: SolvedFilm, bore: NodalBore, forces: BoreForces) -> None:
        balances = Balances(film)
        self.film, self.bore, self.forces = film, bore, forces
        self.by_motion = np.multiply(balances.motion.T, film.parts.motion_scale, order="C")
        self.by_place, self.by_rate = balances.matrix(1.0, 0.0), balances.matrix(0.0, 1.0)
        self.rows, self.fixed, self.of_bore = wrench_rows(film), motion_tangent(film), bore_tangent(film, bore)
        self.change = TractionChange(film, forces)
        self.columns = film.grid.gap_shapes[0].reshape(-1, 4) * film.parts.pose_scale
        unknowns = -self.by_motion
        film.solver.direct(unknowns)
        self.wrench = self.rows @ unknowns + self.fixed

    def changes(
        self, motion: np.ndarray, place: np.ndarray | csr_matrix, rate: np.ndarray | csr_matrix
    ) -> tuple[np.ndarray, np.ndarray]:
        """Changes (6, r) of the wrench and (nodes, 3, r) of the nodal forces by r changes of the motion.

        These are changes of the motion of the rigid surfaces (10, r), of q (k, r) and of q_t (k, r).

        Raises
        ------
        RuntimeError
            If the model has evaluated another state since.
        """
        self.film.require_current()
        tiles = [slice(start, start + TILE) for start in range(0, motion.shape[1], TILE)]
        wrenches, nodal = zip(*(self._changes(motion[:, at], place[:, at], rate[:, at]) for at in tiles), strict=True)
        return np.concatenate(wrenches, axis=1), np.concatenate(nodal, axis=2)

    def _changes(
        self, motion: np.ndarray, place: np.ndarray | csr_matrix, rate: np.ndarray | csr_matrix
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return `changes` for a number of columns whose data fit into the processor's cache."""
        p, line = self.film.parts, self.change.line
        moved, speed = dense(self.bore.shapes @ place), dense(self.bore.shapes @ rate)
        unknowns = -(self.by_motion @ motion + self.by_place @ moved + self.by_rate @ speed)
        self.film.solver.direct(unknowns)
        scaled = moved / p.bearing.radial_clearance
        forces = self.change.vertex_forces(unknowns, scaled + self.columns @ motion[:4], scaled, motion[8:])
        if line is not None:
            shear = line.gap @ scaled + line.rate @ (speed / p.bearing.radial_clearance)
            shear += line.motion.T @ (p.motion_scale[:, None] * motion)
            forces[1:] += np.multiply.outer(self.change.speeds, shear)
        wrench = self.rows @ unknowns + self.fixed @ motion + self.of_bore[0] @ place + self.of_bore[1] @ rate
        return wrench, self.forces.nodal(forces)

    def whole(self) -> tuple[np.ndarray, np.ndarray]:
        """d wrench (6, 10 + 2 k) and d nodal forces (nodes, 3, 10 + 2 k) to the motion, q and q_t."""
        size, k = MOTION_SIZE, self.bore.size
        unit = eye_array(size + 2 * k, format="csr")
        return self.changes(unit[:size].toarray(), unit[size : size + k], unit[size + k :])
