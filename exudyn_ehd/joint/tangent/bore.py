"""Exact tangent of a film on a flexible bore.

Derivatives of the journal's wrench and the bore's loads to motion, q and q_t. With the balances
r(u, m, delta, delta_t) = 0 of the film's unknowns u, each column needs one film solve,

    A du = -(dr/dm dm + dr/d delta S dq + dr/d delta_t S dq_t),

all in one sweep over the factor. Wrench and loads are sums over the unknowns, ``dQ = S^T W du``, plus terms that depend
on the motion at fixed u, such as contacts. The balances' derivatives to delta are a five-point stencil, since the gap
on a link is the mean of its two columns; those to the motion are ten columns. An integrator needs one combination of
the derivatives to q and q_t, which costs as much as one of them.
"""

from __future__ import annotations

import numpy as np
from scipy.sparse import csc_matrix, csr_matrix, diags_array

from exudyn_ehd.film.cavitation.linear_film import pressures_by_linear
from exudyn_ehd.film.reynolds.gap import transposed_slopes
from exudyn_ehd.film.surfaces.contact import contact_weights
from exudyn_ehd.joint.bore.shapes import Bore, dense
from exudyn_ehd.joint.solved_film import MOTION_SIZE, ContactFields, SolvedFilm
from exudyn_ehd.joint.tangent.wrench import (
    adjoint_rows,
    boundary_fields,
    couette_field,
    drag_by_gap,
    integrals_in_wrench,
    motion_tangent,
    shear_of_fills,
    true_fills,
    true_gradients,
    wrench_weights,
)


def elastic_tangent(film: SolvedFilm, bore: Bore, *combinations: tuple[float, float]) -> np.ndarray:
    """Tangent of wrench and bore loads of a solved film, SI units.

    Parameters
    ----------
    film : SolvedFilm
    bore : Bore
    combinations : pairs of float
        Factors (a, b); for each pair the k columns ``a d/dq + b d/dq_t`` are returned.

    Returns
    -------
    (6 + k, 10 + k * combinations) array
        Derivatives to the motion, then the combinations.
    """
    k, size = bore.size, MOTION_SIZE
    change, (by_q, by_rate) = Balances(film).changes(bore.shapes, *combinations), bore_tangent(film, bore)
    wrench = wrench_weights(film) @ (adjoint_rows(film) @ change)
    out = np.concatenate((wrench, load_columns(film, bore).T @ change))
    out[:6, :size] += motion_tangent(film)
    contact: np.ndarray | float = 0.0
    if film.pressing is not None:
        slope = contact_slope(film, film.pressing)
        contact = bore.product(slope) / film.parts.bearing.radial_clearance
        out[6:, :4] -= bore.load(slope * film.grid.moments[:4]).T * film.parts.pose_scale
    for i, (a, b) in enumerate(combinations):
        part = out[:, size + i * k : size + (i + 1) * k]
        part[:6] += a * by_q + b * by_rate
        part[6:] += a * contact
    if bore.twist is not None:
        out[6:] -= np.multiply.outer(bore.twist, out[5])
    return out


def storage_tangent(film: SolvedFilm, bore: Bore) -> np.ndarray:
    """Return the part of the tangent (6 + k, 10 + 2 k) by the storage of oil in supply areas, for slow motions.

    It is to be added to `elastic_tangent` by q and q_t. With the storage S u_t in the balances, and u_t = du/dx x_t, it
    needs a second film solve: ``A du = -S du/dx x_t``.
    """
    k, size = bore.size, MOTION_SIZE
    change, out = Balances(film).changes(bore.shapes, (1.0, 0.0)), np.zeros((6 + k, size + 2 * k))
    stored = np.ascontiguousarray(-film.solver.surroundings()[:, None] * np.delete(change, np.arange(4, size), axis=1))
    film.solver.direct(stored)
    rates = [*range(4, 8), *range(size + k, size + 2 * k)]
    out[:6, rates] = wrench_weights(film) @ (adjoint_rows(film) @ stored)
    out[6:, rates] = load_columns(film, bore).T @ stored
    if bore.twist is not None:
        out[6:] -= np.multiply.outer(bore.twist, out[5])
    return out


class Balances:
    """Derivatives of a film's balances at its unknowns.

    Attributes
    ----------
    count : int
        Number of the unknowns.
    gradients : Gradients
        Derivatives to the scaled true gap.
    motion : (10, count) array
        Derivatives to (scaled pose, scaled rates, vx, vz).
    """

    def __init__(self, film: SolvedFilm) -> None:
        self.film, self.clearance = film, film.parts.bearing.radial_clearance
        self.count, self.gradients = film.solver.unknowns, true_gradients(film)
        self.motion = self.gradients.columns(film.grid.gap_shapes, self.count)

    def matrix(self, by_place: float, by_rate: float) -> csr_matrix:
        """``by_place d/d delta + by_rate d/d delta_t`` (count, n m) of the bore's displacement delta, SI units."""
        factors = by_place / self.clearance, by_rate / self.clearance
        return self.gradients.matrix(self.film.grid.shape, self.count, *factors)

    def times(self, shapes: np.ndarray | csr_matrix, by_place: float, by_rate: float) -> np.ndarray:
        """Return `matrix` times the shapes (n m, k) of a bore."""
        return dense(self.matrix(by_place, by_rate) @ shapes)

    def changes(self, shapes: np.ndarray | csr_matrix, *combinations: tuple[float, float]) -> np.ndarray:
        """Changes (count, 10 + k * combinations) of the unknowns with the motion, and with coordinates of the shapes.

        ``combinations`` as for `elastic_tangent`; SI units.
        """
        size, k = MOTION_SIZE, shapes.shape[1]
        out = np.empty((self.count, size + k * len(combinations)))
        out[:, :size] = self.motion.T * -self.film.parts.motion_scale
        for i, (by_place, by_rate) in enumerate(combinations):
            out[:, size + i * k : size + (i + 1) * k] = self.times(shapes, -by_place, -by_rate)
        self.film.solver.direct(out)
        return out


def load_columns(film: SolvedFilm, bore: Bore) -> np.ndarray | csr_matrix:
    """Weights (count, k) of the unknowns in the film's loads on the bore, one column per coordinate, N.

    The matrix is sparse if the bore's shapes are.
    """
    s, weight = film.solver, film.scales.force * film.grid.weight
    if film.oil.P_q is not None:
        weight = weight * film.oil.P_q
    if not isinstance(bore.shapes, np.ndarray):
        return pressures_by_unknowns(film).T @ (diags_array(weight.ravel()) @ bore.shapes)
    if s.system.continued is not None or s.reservoirs is not None:
        return pressures_by_unknowns(film).T @ (weight.reshape(-1, 1) * bore.shapes)
    places = s.work.order[: s.work.count]
    return (weight * s.work.active).ravel()[places, None] * bore.shapes[places]


def pressures_by_unknowns(film: SolvedFilm) -> csr_matrix | csc_matrix:
    """Derivatives (n m, count) of the pressures, before the oil's pressure law is applied, to the unknowns."""
    w, y = film.solver.work, film.solver.system
    if y.continued is None:
        return at_unknowns(film, (w.active | y.fixed).astype(float))
    by_linear = pressures_by_linear(y.continued, y.fixed, y.linked, y.cavity_pressure, w.active)
    return (by_linear + diags_array(y.fixed.ravel().astype(float))) @ at_unknowns(film, film.solver.ones)


def at_unknowns(film: SolvedFilm, field: np.ndarray) -> csc_matrix:
    """Matrix (n m, count) with the value of a field (n, m) at each unknown, in the row of its vertex.

    The column of a supply area with an unknown pressure has values at all vertices of the area, times the derivative of
    the film's unknown to this pressure.
    """
    s, values = film.solver, field.reshape(-1)
    rows = s.work.order[: s.work.count]
    starts, entries, shape = np.arange(rows.size + 1), values[rows], (field.size, s.unknowns)
    if (r := s.reservoirs) is not None:
        area, at = np.nonzero(r.within().T)
        by_pressure = r.transformed()[1][r.live] / s.pressure_scale
        starts = np.append(starts, rows.size + np.cumsum(r.sizes[r.live]))
        entries, rows = np.append(entries, values[r.at[at]] * by_pressure[area]), np.append(rows, r.at[at])
    return csc_matrix((entries, rows, starts), shape=shape)


def bore_tangent(film: SolvedFilm, bore: Bore) -> np.ndarray:
    """Derivatives (2, 6, k) of the wrench to q and q_t at fixed unknowns: gap, slopes, fills and contacts."""
    g = film.grid
    # force and moment across the axis do not depend on the gap
    factors = integrals_in_wrench(film)[2::3, 4:] / film.parts.bearing.radial_clearance
    slopes = transposed_slopes(film.oil.P * g.weight, g)
    rows = np.tensordot(factors, np.stack((couette_field(film)[0], *slopes, boundary_fields(film)[0])), 1)
    if film.loads.drag is not None:
        face, cell = drag_by_gap(film)
        # the gap on a link is the mean of its two columns
        rows += factors[:, 1, None, None] * (0.5 * (face[0] + np.roll(face[0], 1, axis=0)))
        rows += factors[:, 2, None, None] * cell[-1]
    out = np.zeros((2, 6, bore.size))
    fills = true_fills(film)
    if fills is not None:
        shear = fills.weighed(shear_of_fills(film))
        by_gap, by_rate = shear.matrix(g.shape, 1, 1.0, 0.0), shear.matrix(g.shape, 1, 0.0, 1.0)
        rows += factors[:, 0, None, None] * by_gap.toarray().reshape(g.shape)
        out[1, 2::3] = np.outer(factors[:, 0], bore.load(by_rate.toarray().reshape(g.shape)))
    out[0, 2::3] = bore.load(rows)
    if film.pressing is not None:
        out[0] += _contact_wrench(film, bore, film.pressing)
    return out


def _contact_wrench(film: SolvedFilm, bore: Bore, f: ContactFields) -> np.ndarray:
    """Gradient (6, k) of the contacts' wrench, pressures and friction, to q."""
    motion, R = film.journal.motion, film.grid.reference_length
    out = np.zeros((6, bore.size))
    for law, by_gap in zip(f.friction, f.slope, strict=True):
        rows = bore.load(by_gap * film.grid.weight * film.grid.moments) / film.parts.bearing.radial_clearance
        out += contact_weights(motion, *law, R) @ rows
    return out


def contact_slope(film: SolvedFilm, f: ContactFields) -> np.ndarray:
    """Derivative of the contacts' force at every vertex to the scaled gap (n, m), N."""
    g = film.grid
    return np.sum(f.slope, axis=0) * g.weight * g.reference_length**2
