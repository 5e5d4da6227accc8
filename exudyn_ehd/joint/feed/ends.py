"""Derivatives of the flows out of both ends of a journal's film to the motion and to the ends' pressures.

An end's vertices have its pressure p_e; symbols of `exudyn_ehd.film.loads.end_flows`, whose flows these are, with the
conductance k to the next vertex, q = k (p_e - p_1). By the adjoint solutions lam of the film's sums S over its
pressures, ``dS/dp_e = sum lam_1 k`` of the next vertices plus what the end's own pressure does. Films between rigid
surfaces of an oil of constant viscosity, with `FullSommerfeld` or `SwiftStieber`.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

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


class _Edge(NamedTuple):
    """Vertices of an end (n,): k, q, and derivatives of what they take to q and B."""

    k: np.ndarray
    q: np.ndarray
    by_q: np.ndarray
    by_B: np.ndarray


def _edges(film: SolvedFilm) -> list[_Edge]:
    s, out = film.solver, []
    P, full = s.pressure, s.work.active | film.grid.fixed
    for end, at, link in ENDS:
        k, B = s.system.kz[:, link], s.system.fx[:, end] - np.roll(s.system.fx[:, end], 1)
        q = k * (P[:, end] - P[:, at])
        if s.squeeze:
            B = B + s.H_t[:, end] * s.area[:, end]
        near = ~full[:, at] & (q >= 0.0) & (q < B)
        share = np.sqrt(np.where(near, q, 1.0) / np.where(near, B, 1.0))
        # no slope where nothing flows: there a search goes on as from a film up to the next vertex
        by_q = 1.0 / np.where(share > 0.0, share, 1.0)
        out.append(_Edge(k, q, by_q, np.where(full[:, at] | (q > 0.0), share, 0.0)))
    return out


def end_derivatives(film: SolvedFilm) -> EndDerivatives:
    """Derivatives of a solved film that still is its model's last."""
    s, p, scales = film.solver, film.parts, film.scales
    edges = _edges(film)
    links = np.array([edge.k for edge in edges])
    lam = s.adjoint(np.concatenate((_flow_rows(film, links), adjoint_rows(film))))
    # (k, 2): through the pressures inside the film
    inside = np.stack([lam[:, :, at] @ k for (_, at, _), k in zip(ENDS, links, strict=True)], axis=1)
    flows = inside[:2] - np.diag([float(edge.by_q @ edge.k) for edge in edges])
    by_motion = np.zeros((2, MOTION_SIZE))
    sens = s.sensitivities(lam[:2])
    _add_direct(film, edges, sens)
    add_by_motion(film, sens, by_motion)
    scale = p.flow_scale
    return EndDerivatives(
        (_weights(film) @ inside[2:] + _own_loads(film)) / scales.pressure,
        scale / scales.pressure * flows,
        scale * by_motion * p.motion_scale,
    )


def _flow_rows(film: SolvedFilm, links: np.ndarray) -> np.ndarray:
    """Weights (2, count) of the unknown pressures in the flows."""
    w, fields = film.solver.work, np.zeros((2, *film.grid.shape))
    unknown = w.order[: w.count]
    for q, (_, at, _) in enumerate(ENDS):
        fields[q, :, at] = links[q]
    return np.asarray(fields.reshape(2, -1)[:, unknown] * w.active.reshape(-1)[unknown])


def _add_direct(film: SolvedFilm, edges: list[_Edge], sens: Sensitivities) -> None:
    """Add the flows' derivatives at fixed pressure."""
    s, g = film.solver, film.grid
    for q, ((end, at, _), edge) in enumerate(zip(ENDS, edges, strict=True)):
        side, width = 1.0 if end else -1.0, float(g.width_z[end])
        gap, turned = 0.5 * (s.H[:, end] + s.H[:, at]), s.HF[:, end] - np.roll(s.HF[:, end], 1)
        half = 0.5 * (side * s.vz * g.width_x - 3.0 * edge.by_q * edge.q / gap)
        sens.cell[q, :, end] += half
        sens.cell[q, :, at] += half
        sens.face[q, :, end] += s.vx * width * (np.roll(edge.by_B, -1) - edge.by_B)
        sens.speed[q] += -width * float(edge.by_B @ turned), side * float(gap @ g.width_x)
        if s.squeeze:
            sens.rate[q, :, end] -= edge.by_B * s.area[:, end]


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
