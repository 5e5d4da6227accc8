"""The journal's film and those on its end faces at the edge pressures at which their flows are the same.

For the edges with a face, p_0 <= p the pressures, r = Q_face(p) - Q_film(p) what faces take more than the film gives:

    p >= p_0,    r >= 0,    (p - p_0) r = 0.

A higher pressure gives a face more, and lets less leave the film at its own end and more at the other: dr/dp is an
M-matrix, and there is one solution. Newton's method finds it on the edges with p > p_0 or r < 0; a step that does not
bring it nearer is halved. By the implicit function theorem the pressures of the balanced edges b follow the state
x = (motion, axial position) as

    dp_b/dx = -(dr_b/dp_b)^-1 dr_b/dx.

Derivatives of the flows out of both ends of a journal's film to the motion and to the ends' pressures.

An end's vertices have its pressure p_e; symbols of `exudyn_ehd.film.loads.end_flows`, whose flows these are, with the
conductance k to the next vertex, q = k (p_e - p_1). By the adjoint solutions lam of the film's sums S over its
pressures, ``dS/dp_e = sum lam_1 k`` of the next vertices plus what the end's own pressure does. Films between rigid
surfaces of an oil of constant viscosity, with `FullSommerfeld` or `SwiftStieber`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from typing import NamedTuple

import numpy as np

from exudyn_ehd.film.reynolds.link_derivatives import Sensitivities
from exudyn_ehd.film.sensitivity.rigid import integral_weights
from exudyn_ehd.joint.model.loads import film_loads
from exudyn_ehd.joint.model.quantities import leakages
from exudyn_ehd.joint.model.rigid import BearingModel, Evaluation
from exudyn_ehd.joint.solved_film import MOTION_SIZE, History, OilFields, SolvedFilm
from exudyn_ehd.joint.tangent.line import add_by_motion
from exudyn_ehd.joint.tangent.wrench import adjoint_rows, has_extra_rows
from exudyn_ehd.joint.thrust import ThrustEvaluation, ThrustModel, about_origin, face_motion_map
from exudyn_ehd.status import Status

# Of lower and upper end: their column, the next one, and that of the links between them.
ENDS = ((0, 1, 0), (-1, -2, -2))
LARGEST_STEPS, HALVINGS = 60, 8
# Flow that is left, over the flows, and over that which a change of the pressure by a Pascal makes.
FLOW_TOLERANCE, PRESSURE_TOLERANCE = 1e-12, 1e-7


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


@dataclass(frozen=True, eq=False)
class FedEvaluation(ThrustEvaluation):
    """The films on the faces at one state, the last of their model, and the journal's film that feeds them.

    Attributes
    ----------
    journal : Evaluation
        The last of its model; NOT_CONVERGED where there are both films, but no pressures of equal flows.
    pressures : (2,) array
        At lower and upper end, Pa.
    taken, given : (k,) arrays
        Flows into every face and out of the film at its end, m3/s.
    balanced : (k,) bool array
        Whether they are to be the same.
    edges : EdgeDerivatives or None
        About the edges; None unless these flows are the same.
    """

    journal: Evaluation
    pressures: np.ndarray
    taken: np.ndarray
    given: np.ndarray
    balanced: np.ndarray
    films: FedFilms
    edges: EdgeDerivatives | None = None

    @property
    def settled(self) -> bool:
        """Whether the flows of balanced edges are the same."""
        return self.edges is not None

    @property
    def found(self) -> bool:
        """Whether both films were found at these pressures."""
        return self.journal.status is Status.CONVERGED is self.status

    def tangent(self) -> np.ndarray:
        """d wrench / d (motion, position) (6, 11) of both films but for ``journal.tangent()``, whose ends are held."""
        journal, faces = self.with_feed()
        return journal + faces

    def with_feed(self) -> tuple[np.ndarray, np.ndarray]:
        """Two (6, 11): what the feed adds to ``journal.tangent()``, and the tangent of the faces with their feed."""
        journal, faces, b, to = np.zeros((6, MOTION_SIZE + 1)), super().tangent(), self.balanced, self.edges
        if to is not None and b.any():
            followed = -np.linalg.solve(to.slope[np.ix_(b, b)], to.by_state[b])
            journal += to.journal[:, b] @ followed
            faces += to.faces[:, b] @ followed
        return journal, faces

    def derivatives(self) -> EdgeDerivatives:
        """Derivatives about the edges; of the last evaluation only."""
        film, at, motion, model = self.journal.film, self.films.ends, self.motion, self.model
        assert film is not None
        ends = end_derivatives(film)
        heights, feeds = [model.height(face) for face in model.faces], [face.feed() for face in model.faces]
        both = list(zip(feeds, heights, strict=True))
        taken = np.array([feed.by_motion @ face_motion_map(motion, height) for feed, height in both])
        return EdgeDerivatives(
            ends.wrench[:, at],
            np.stack([about_origin(feed.wrench, height) for feed, height in both], axis=1),
            np.diag([feed.flow for feed in feeds]) - ends.flows[np.ix_(at, at)],
            taken - np.pad(ends.by_motion[at], ((0, 0), (0, 1))),
        )


class EdgeDerivatives(NamedTuple):
    """Derivatives about the edges of k faces, SI units.

    journal, faces : (6, k) arrays, of both wrenches to the edge pressures
    slope : (k, k) array, of r to these
    by_state : (k, 11) array, of r to motion and axial position
    """

    journal: np.ndarray
    faces: np.ndarray
    slope: np.ndarray
    by_state: np.ndarray


class FedFilms:
    """A journal's film that feeds the films on its end faces.

    Parameters
    ----------
    model : BearingModel
        Of the journal's film; its ends have other pressures from here on.
    faces : ThrustModel
    """

    def __init__(self, model: BearingModel, faces: ThrustModel) -> None:
        self.model, self.faces = model, faces
        self.ends = np.array([0 if face.side < 0 else 1 for face in faces.faces])
        self.lowest = np.array(model.bearing.end_pressures)
        self._pressures = self.lowest.copy()

    def evaluate(
        self, motion: np.ndarray, position: float, history: History | None = None, step: float = 0.0, spin: float = 0.0
    ) -> FedEvaluation:
        """The films at a motion (10,) and an axial position; the rest as for `BearingModel.evaluate`."""
        at = partial(self._at, motion, position, (history, step, spin))
        found = at(np.maximum(self._pressures, self.lowest))
        if not found.found:
            found = at(self.lowest)
        for _ in range(LARGEST_STEPS):
            if not found.found:
                break
            edges = found.derivatives()
            slope = edges.slope
            unit, missed, b = np.diag(slope), found.taken - found.given, np.flatnonzero(found.balanced)
            left = FLOW_TOLERANCE * (np.abs(found.taken) + np.abs(found.given)) + PRESSURE_TOLERANCE * unit
            if np.all(np.abs(missed[b]) <= left[b]):
                self._pressures = found.pressures
                return replace(found, edges=edges)
            change = np.zeros(2)
            change[self.ends[b]] = -np.linalg.solve(slope[np.ix_(b, b)], missed[b])
            found = self._nearer(at, found, change, unit)
        return replace(found, journal=replace(found.journal, status=Status.NOT_CONVERGED)) if found.found else found

    def _nearer(
        self, at: Callable[[np.ndarray], FedEvaluation], found: FedEvaluation, change: np.ndarray, unit: np.ndarray
    ) -> FedEvaluation:
        """The films a change (2,) of the pressures on, halved until it leaves less of `evaluate`'s conditions."""
        for _ in range(HALVINGS):
            near = at(np.maximum(found.pressures + change, self.lowest))
            if near.found and self._error(near, unit) < self._error(found, unit):
                break
            change = 0.5 * change
        return near

    def _error(self, found: FedEvaluation, unit: np.ndarray) -> float:
        """The largest of what is left of the conditions, Pa."""
        above = (found.pressures - self.lowest)[self.ends]
        return float(np.abs(np.minimum(above, (found.taken - found.given) / unit)).max())

    def _at(
        self, motion: np.ndarray, position: float, since: tuple[History | None, float, float], pressures: np.ndarray
    ) -> FedEvaluation:
        """The films at given pressures (2,) of the ends; ``since``: history, step and spin."""
        self.model.set_end_pressures(pressures)
        for face, end in zip(self.faces.faces, self.ends, strict=True):
            face.set_inner_pressure(float(pressures[end]))
        journal, faces = self.model.evaluate(motion, *since), self.faces.evaluate(motion, position)
        taken, given, balanced = (
            np.zeros(self.ends.size),
            np.zeros(self.ends.size),
            np.zeros(self.ends.size, dtype=bool),
        )
        if journal.film is not None and faces.status is Status.CONVERGED:
            taken = np.array([face.fed for face in self.faces.faces])
            given = journal.film.parts.flow_scale * np.array(leakages(journal.film))[self.ends]
            balanced = (pressures > self.lowest)[self.ends] | (taken < given)
        return FedEvaluation(
            **vars(faces),
            journal=journal,
            pressures=pressures,
            taken=taken,
            given=given,
            balanced=balanced,
            films=self,
        )
