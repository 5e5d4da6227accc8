"""The exact centre of a bearing, at which a film that ruptures has one-sided derivatives only.

The gap is the same all around there, nothing presses, and the whole film is at its cavity pressure. A small motion of
the aligned journal has one source in Reynolds' equation, the velocity V relative to the mean motion of the oil::

    div(h^3 / (12 mu) grad p) = -V . n,        V = dx/dt - (omega / 2) e_z x x,

and the film ruptures where V opens the gap, however small V is. The pressure is homogeneous of degree one in V. In a
bearing that is the same in all directions the force therefore is ``F = -c V`` with one coefficient (with a liner one
matrix that commutes with rotations), and K and C are those of films a little off the centre, in any direction. The film
at the centre itself has an unbroken solution, with twice the coefficient.

In a bearing that is not the same in all directions, as with a groove at the cavity pressure, F is not linear in V, and
no stiffness or damping exists. Tilts and displacements together are not linear either: derivatives to the tilt here are
the mean over the directions of V.
"""

from __future__ import annotations

import math
from typing import Protocol

import numpy as np

from exudyn_ehd.bearing import MaximumGap
from exudyn_ehd.joint.solved_film import MOTION_SIZE, History, SolvedFilm
from exudyn_ehd.joint.tangent.wrench import BESIDE, CENTRE, LARGEST_SPREAD
from exudyn_ehd.status import FilmError

# Angle of the first of four directions, rad; along a column of the grid, Gümbel's linear pressure would be zero there,
# and its set undecided.
FIRST = 1.0


class FilmModel(Protocol):
    """A film on rigid or flexible surfaces."""

    needs_spin: bool

    def evaluate_steady(self, motion: np.ndarray, history: History | None, step: float) -> FilmEvaluation:
        """Evaluate the steady film, see `exudyn_ehd.joint.model.rigid.BearingModel`."""


class FilmEvaluation(Protocol):
    """One evaluation of it."""

    motion: np.ndarray

    @property
    def film(self) -> SolvedFilm | None: ...
    @property
    def model(self) -> FilmModel: ...
    def steady_tangent(self, exact: bool = False) -> np.ndarray:
        """Return the steady tangent, see `exudyn_ehd.joint.model.rigid.Evaluation`."""


def is_central(evaluation: FilmEvaluation) -> bool:
    """Return whether a film that may rupture lies at the exact centre and presses nowhere."""
    film, motion = evaluation.film, evaluation.motion
    if film is None or abs(motion[0]) > CENTRE * film.parts.bearing.radial_clearance or evaluation.model.needs_spin:
        return False
    bearing = film.parts.bearing
    if not film.solver.ruptures or isinstance(bearing.inlet, MaximumGap) or film.grid.edges.size:
        return False
    w, source, cavity = film.journal, CENTRE * abs(float(motion[8])), film.scales.cavity
    if np.abs(w.pose).max() > CENTRE or np.abs(w.rate).max() > source:
        return False
    return bool(np.abs(film.oil.P - cavity).max() <= source + 1e-12 * abs(cavity))


def evaluate_beside(evaluation: FilmEvaluation, direction: int = 0) -> FilmEvaluation:
    """Evaluate the film a little off the centre in one of four directions, without spin moving that way."""
    film, motion = evaluation.film, np.append(np.zeros(8), evaluation.motion[8:MOTION_SIZE])
    assert film is not None
    angle = FIRST + 0.5 * math.pi * direction
    motion[:2] = BESIDE * film.parts.bearing.radial_clearance * np.array([math.cos(angle), math.sin(angle)])
    motion[4:6] = motion[:2] if motion[8] == 0.0 else 0.0
    return evaluation.model.evaluate_steady(motion, film.history, film.step)


def tangents_beside(evaluation: FilmEvaluation, exact: bool) -> np.ndarray:
    """Steady tangents (4, 6, 10) a little off the centre in four directions, ``exact`` or not.

    Buffers and records of the evaluation stay as they are.
    """
    film, model, tangents = evaluation.film, evaluation.model, []
    assert film is not None
    for direction in range(4):
        tangents.append(evaluate_beside(evaluation, direction).steady_tangent(exact))
    # the same film into the model's buffers again
    model.evaluate_steady(evaluation.motion[:MOTION_SIZE], film.history, film.step)
    film.parts.evaluations.count = film.serial
    return np.array(tangents)


def require_derivatives(evaluation: FilmEvaluation, where: str) -> None:
    """Raise `FilmError` in the name of ``where`` if K and C beside the centre depend on the direction."""
    tangents, film = tangents_beside(evaluation, exact=True), evaluation.film
    assert film is not None
    for block in (tangents[:, :2, :2], tangents[:, :2, 4:6]):
        mean = block.mean(axis=0)
        spread = float(np.abs(block - mean).max()) / max(float(np.abs(mean).max()), 1e-300)
        if spread > max(LARGEST_SPREAD, 2.0 / film.grid.x.size):
            raise FilmError(
                f"{where}: at the exact centre this film has no stiffness and damping: it ruptures on the side that "
                f"opens, and its force differs by {spread:.0%} between the directions of a displacement, because a "
                "supply area, a profile or a soft surface breaks the symmetry; give a small load across the axis, "
                "which sets the direction, or a supply pressure above the cavity pressure."
            )
