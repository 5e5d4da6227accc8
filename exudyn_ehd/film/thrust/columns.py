"""Sizes of a thrust face's grid, with columns on the edges of its pads.

Pressure has kinks at the edges of pads and decays from there as exp(-pi x / L), x = theta, over the ring's width
L = ln(r_o / r_i), and likewise from the radii over the length of a pad. Between two edges columns are stretched towards
both. Integrals over theta are sums over the control volumes, as the balances are. The load of the pressure about a step
then hardly depends on the distance of the columns.
"""

from __future__ import annotations

import math

import numpy as np

from exudyn_ehd.film.grid import rows_between
from exudyn_ehd.film.thrust.options import StepLand, TaperLand, ThrustFaces

# Of plane faces.
COLUMNS, ROWS = 96, 10
# Columns on the ring's width, and of a pad. More lower the error as their inverse square and take time in proportion:
# `ThrustFaces` states the errors of these.
ON_WIDTH, OF_PAD = 12.0, 16
# Columns between two edges; more are taken from a pad's longer part. Fewer miss the slope of short tapers.
LEAST = 6
# Columns in all beyond which narrow rings have fewer on their width.
MOST_COLUMNS = 320
# Rows besides one for every pad on the ring's width, of shorter tapers than this share of a pad for every such length.
# More lower the error of the flows at the radii, faster than their inverse square.
ROWS_BESIDES, SHORT, MOST_ROWS = 8.0, 0.45, 40
# Of `exudyn_ehd.film.grid.axial_vertices`, as of the rows: columns at an edge lie half as far apart as on the mean.
STRETCH = 0.75


def face_grid(faces: ThrustFaces) -> tuple[int, int, np.ndarray | None]:
    """``n_theta``, ``n_r`` and ``columns`` of the `exudyn_ehd.film.thrust.annulus.Annulus` of faces."""
    profile, n_theta, n_r = faces.profile, faces.n_theta, faces.n_r
    if profile is None:
        return n_theta or COLUMNS, n_r or ROWS, None
    width, turn = math.log(faces.outer_radius / faces.inner_radius), 2.0 * math.pi
    wanted = max(OF_PAD * profile.pads, min(ON_WIDTH * turn / width, MOST_COLUMNS)) if n_theta is None else n_theta
    layers = profile.pads * width * max(1.0, SHORT / profile.share)
    rows = min(max(ROWS, 2 * math.ceil(0.5 * (ROWS_BESIDES + layers))), MOST_ROWS)
    columns = pad_columns(profile, math.ceil(wanted / profile.pads))
    return columns.size, n_r or rows, columns


def pad_columns(profile: TaperLand | StepLand, count: int) -> np.ndarray:
    """Angles (n,), rad, of ``count`` columns a pad with one on every edge."""
    edges, pitch = profile.edges, 2.0 * math.pi / profile.pads
    least = min(LEAST, count // 2)
    first = min(max(round(count * edges[1]), least), count - least)
    counts = [count] if len(edges) == 2 else [first, count - first]
    theta, _ = rows_between([pitch * edge for edge in edges], counts, STRETCH)
    return (pitch * np.arange(profile.pads)[:, None] + theta[:-1]).ravel()
