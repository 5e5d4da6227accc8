"""Flows out of both ends of a journal's film, with their derivatives to the motion and to the ends' pressures.

With an end's vertices, which have its pressure p_e, and their half control volumes A, out of the film flows

    Q = sum k (p_1 - p_e) +- carried along z - A dh/dt,

k of the links to the next vertices; what the turn carries along the end cancels over the ring. By the adjoint solutions
lam of the film's sums S over its pressures, ``dS/dp_e = sum lam_1 k`` of the next vertices plus what the end's own
pressure does. Films between rigid surfaces of an oil of constant viscosity.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from exudyn_ehd.film.cavitation.active_set import rows_of_linear
from exudyn_ehd.film.reynolds.link_derivatives import Sensitivities
from exudyn_ehd.film.sensitivity.rigid import integral_weights
from exudyn_ehd.joint.model.loads import film_loads
from exudyn_ehd.joint.solved_film import MOTION_SIZE, OilFields, SolvedFilm
from exudyn_ehd.joint.tangent.fields import add_by_motion
from exudyn_ehd.joint.tangent.wrench import adjoint_rows, has_extra_rows

# Of lower and upper end: their column, the next one, and that of the links between them.
ENDS = ((0, 1, 0), (-1, -2, -2))


class EndDerivatives(NamedTuple):
    """Derivatives about the ends of a film, SI units.

    wrench : (6, 2) array, of the wrench to the ends' pressures
    flows : (2, 2) array, of the flows out of the ends to these
    by_motion : (2, 10) array, of the flows to the motion
    """

    wrench: np.ndarray
    flows: np.ndarray
    by_motion: np.ndarray


def end_flows(film: SolvedFilm) -> np.ndarray:
    """Flows (2,) out of lower and upper end, m3/s."""
    inflow = film.solver.inflow()
    return np.asarray(-film.parts.flow_scale * inflow[:, [0, -1]].sum(axis=0))


def end_derivatives(film: SolvedFilm) -> EndDerivatives:
    """Derivatives of a solved film that still is its model's last."""
    s, p, scales = film.solver, film.parts, film.scales
    links = np.array([s.system.kz[:, link] for _, _, link in ENDS])
    lam = s.adjoint(np.concatenate((_flow_rows(film, links), adjoint_rows(film))))
    # (k, 2): through the pressures inside the film
    inside = np.stack([lam[:, :, at] @ k for (_, at, _), k in zip(ENDS, links, strict=True)], axis=1)
    flows = inside[:2] - np.diag(links.sum(axis=1))
    by_motion = np.zeros((2, MOTION_SIZE))
    sens = s.sensitivities(lam[:2])
    _add_direct(film, sens)
    add_by_motion(film, sens, by_motion)
    scale = p.flow_scale
    return EndDerivatives(
        (_weights(film) @ inside[2:] + _own_loads(film)) / scales.pressure,
        scale / scales.pressure * flows,
        scale * by_motion * p.motion_scale,
    )


def _flow_rows(film: SolvedFilm, links: np.ndarray) -> np.ndarray:
    """Weights (2, count) of the unknown pressures in the flows."""
    s, w, y = film.solver, film.solver.work, film.solver.system
    fields, unknown = np.zeros((2, *film.grid.shape)), w.order[: w.count]
    for q, (_, at, _) in enumerate(ENDS):
        fields[q, :, at] = links[q]
    rows = fields.reshape(2, -1)[:, unknown] * w.active.reshape(-1)[unknown]
    if s.closure.clips and s.closure.line_in_cells:
        rows_of_linear(y.linear_pressure, y.fixed, y.linked, y.cavity_pressure, w.active, w.number, rows)
    return rows


def _add_direct(film: SolvedFilm, sens: Sensitivities) -> None:
    """Add the flows' derivatives at fixed pressure."""
    s, g = film.solver, film.grid
    for q, (end, at, link) in enumerate(ENDS):
        side = 1.0 if end else -1.0
        gap = 0.5 * (s.H[:, end] + s.H[:, at])
        driven = 3.0 * s.system.kz[:, link] / gap * (s.pressure[:, at] - s.pressure[:, end])
        half = 0.5 * (driven + side * s.vz * g.width_x)
        sens.cell[q, :, end] += half
        sens.cell[q, :, at] += half
        sens.speed[q, 1] += side * float(gap @ g.width_x)
        if s.squeeze:
            sens.rate[q, :, end] -= s.area[:, end]


def _weights(film: SolvedFilm) -> np.ndarray:
    """Weights (6, k) of the integrals of `adjoint_rows` in the wrench."""
    own, w, scales = np.empty((6, 8)), film.journal, film.scales
    integral_weights(w.pose, film.grid.reference_length, scales.force, scales.shear, w.omega, w.axial_speed, own)
    return own[:, [0, 1, 2, 3, *([5, 6] if has_extra_rows(film) else [])]]


def _own_loads(film: SolvedFilm) -> np.ndarray:
    """Wrench (6, 2) of a scaled pressure of 1 at the vertices of either end alone."""
    still, out = film.journal._replace(omega=0.0, axial_speed=0.0), np.empty((6, 2))
    for q, (end, _, _) in enumerate(ENDS):
        P, ends = np.zeros(film.grid.shape), np.zeros(2)
        P[:, end] = ends[q] = 1.0
        scales = film.scales._replace(ends=ends)
        out[:, q] = film_loads(film.parts, scales, still, OilFields(P), film.extra, None, film.limited).wrench
    return out
