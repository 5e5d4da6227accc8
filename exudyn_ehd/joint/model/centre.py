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
from collections.abc import Iterator

import numpy as np

from exudyn_ehd.bearing import MaximumGap
from exudyn_ehd.film.cavitation.closures import FullSommerfeld
from exudyn_ehd.joint.solved_film import MOTION_SIZE, SolvedFilm
from exudyn_ehd.status import FilmError

# Shares of the clearance. Eccentricity up to which a journal is at the centre: larger than the round-off of a position
# of 1 m in a clearance of 1 um. Eccentricity of the films beside it, by which K and C differ from their limits.
CENTRE, BESIDE = 1e-9, 1e-6
# Angle of the first of four directions, rad; along a column of the grid, Gumbel's linear pressure would be zero there,
# and its set undecided.
FIRST = 1.0
# Largest difference of K or C between a direction and the mean of all, over the mean, up to which that is given; on few
# columns n 2 / n. Bearings that are the same in all directions have at most 0.12 on 17 columns, 0.057 on 31, 0.023 from
# 48 on; an axial groove of 0.3 rad at the cavity pressure over two thirds of the length has 0.16.
LARGEST_SPREAD = 0.05


def is_central(film: SolvedFilm) -> bool:
    """Return whether a film that may rupture lies at the exact centre and presses nowhere."""
    w, bearing, cavity = film.journal, film.parts.bearing, film.scales.cavity
    if abs(w.motion[0]) > CENTRE * bearing.radial_clearance or isinstance(film.solver.closure, FullSommerfeld):
        return False
    source = CENTRE * abs(w.omega)
    if np.abs(w.pose).max() > CENTRE or np.abs(w.rate).max() > source or isinstance(bearing.inlet, MaximumGap):
        return False
    return bool(np.abs(film.oil.P - cavity).max() <= source + 1e-12 * abs(cavity))


def motions_beside(film: SolvedFilm) -> Iterator[np.ndarray]:
    """Motions (10,) a little off the centre in four directions; without spin moving that way."""
    motion = film.journal.motion
    for k in range(4):
        angle = FIRST + 0.5 * math.pi * k
        beside = np.concatenate((np.zeros(8), motion[8:MOTION_SIZE]))
        beside[:2] = BESIDE * film.parts.bearing.radial_clearance * np.array([math.cos(angle), math.sin(angle)])
        beside[4:6] = beside[:2] if motion[8] == 0.0 else 0.0
        yield beside


def require_derivatives(tangents: np.ndarray, columns: int, where: str) -> None:
    """Raise `FilmError` if tangents (4, 6, 10) beside the centre, on a grid of some columns, depend on the direction."""
    for block in (tangents[:, :2, :2], tangents[:, :2, 4:6]):
        mean = block.mean(axis=0)
        spread = float(np.abs(block - mean).max()) / max(float(np.abs(mean).max()), 1e-300)
        if spread > max(LARGEST_SPREAD, 2.0 / columns):
            raise FilmError(
                f"{where}: at the exact centre this film has no stiffness and damping: it ruptures on the side that "
                f"opens, and its force differs by {spread:.0%} between the directions of a displacement, because a "
                "supply area, a profile or a soft surface breaks the symmetry; give a small load across the axis, "
                "which sets the direction, or a supply pressure above the cavity pressure."
            )
