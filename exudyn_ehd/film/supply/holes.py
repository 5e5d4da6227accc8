"""Round holes of any size: the vertices that they cover, and the conductances of links that end at a circle.

A row of the grid lies on the hole's centre. The grid is coarse compared with the circle, so that the flow on it differs
from that of the hole. In a film of one thickness the pressure is linear in the logarithm of the distance from the
centre, and the flow of the hole is

    Q = 2 pi H^3 (p_hole - p(s)) / ln(s / r),

So the links of the hole are multiplied by a factor with which the grid has this flow if the pressure some intervals
around is that of the logarithm. The factor acts in full at the innermost vertex and not at all at one on the circle, so
that the flow is continuous when vertices enter or leave the circle. A
vertex on a square grid with spacing h feeds, without a factor, like a hole of 0.198 h (D. W. Peaceman, SPE Journal 18
(1978) 183; 0.14 sqrt(dx^2 + dz^2) on a rectangular one, SPE Journal 23 (1983) 531).

A column of the grid lies on the first hole in the housing. Another hole that lies between two columns feeds the nearest
vertex, so that its oil enters up to half a column from its centre.
"""

from __future__ import annotations

import math
from functools import lru_cache
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import laplacian
from scipy.sparse.linalg import splu

from exudyn_ehd.status import ROUNDING

# Shortest link over its spacing (with it rounding errors of its flow are below 1e-11; a shorter one has larger errors),
# largest factor, and number of intervals around a hole in the calculation of the factor.
SHORTEST, LARGEST, AROUND = 1e-4, 4.0, 3


class Circle(NamedTuple):
    """Hole on a grid whose columns have the distance 1.

    Attributes
    ----------
    covered : (k, 2) int array
        Column and row of the covered vertices; columns count from the one nearest the hole's centre.
    links : (q, 3) int array
        Axis (0: theta, 1: z), column and row where its links to other vertices begin.
    lengths : (q,) array
        Length of the film on these links over their spacing.
    depths : (q,) array
        Depth of the links' covered vertex inside the circle in theta, from 0 on the circle to 1 at the innermost one.
    """

    covered: np.ndarray
    links: np.ndarray
    lengths: np.ndarray
    depths: np.ndarray

    def factors(self, strength: float) -> np.ndarray:
        """Conductances (q,) of the links over those of links from vertex to vertex."""
        return (1.0 + (strength - 1.0) * self.depths) / self.lengths


def circle(rows: tuple[float, ...], radius: float, offset: float) -> Circle:
    """Hole whose centre lies ``offset``, -0.5 to 0.5, columns from a column; ``rows``: axial distances from it."""
    spans: dict[int, tuple[int, int]] = {}
    links: list[tuple[int, int, int]] = []
    lengths: list[float] = []
    depths: list[float] = []
    for j, z in enumerate(rows):
        if abs(z) > radius and z != 0.0:
            continue
        half = math.sqrt(max(radius * radius - z * z, 0.0))
        first, last = math.ceil(offset - half - ROUNDING), math.floor(offset + half + ROUNDING)
        if z == 0.0 and first > last:
            first = last = 0
        if first <= last:
            spans[j] = first, last
            links += [(0, first - 1, j), (0, last, j)]
            lengths += [offset - half - first + 1.0, last + 1.0 - offset - half]
            depths += [half - abs(first - offset), half - abs(last - offset)]
    covered = [(i, j) for j, (first, last) in spans.items() for i in range(first, last + 1)]
    for i, j in covered:
        edge = math.sqrt(max(radius * radius - (i - offset) ** 2, 0.0))
        for side in (-1, 1):
            first, last = spans.get(j + side, (1, 0))
            if 0 <= j + side < len(rows) and not first <= i <= last:
                links.append((1, i, min(j, j + side)))
                lengths.append((abs(rows[j + side]) - edge) / abs(rows[j + side] - rows[j]))
                depths.append(math.sqrt(max(radius * radius - rows[j] ** 2, 0.0)) - abs(i - offset))
    inner = max(depths)
    depth = np.clip(np.array(depths) / inner, 0.0, 1.0) if inner > ROUNDING else np.ones(len(depths))
    return Circle(np.array(covered), np.array(links), np.maximum(lengths, SHORTEST), depth)


@lru_cache(maxsize=4096)
def strength(rows: tuple[float, ...], radius: float, offset: float) -> float:
    """Factor of the links of a `circle` at its innermost vertex."""
    hole, z = circle(rows, radius, offset), np.array(rows)
    at = rows.index(0.0)
    reach = radius + AROUND * max(1.0, z[at + 1], -z[at - 1])
    low = max(int(np.searchsorted(z, -reach)) - 1, 0)
    z = z[low : int(np.searchsorted(z, reach)) + 1]
    out, m = math.ceil(reach) + 1, z.size
    n = 2 * out + 1
    here = (out, -low)
    kx = np.tile(np.convolve(np.diff(z), (0.5, 0.5)), (n, 1))
    kz = np.tile(np.append(1.0 / np.diff(z), 0.0), (n, 1))
    links = hole.links + (0, *here)
    own = np.array([(kx if axis == 0 else kz)[i, j] for axis, i, j in links])
    free = np.zeros((n, m), dtype=np.bool_)
    free[1:-1, 1:-1] = True
    covered = np.zeros_like(free)
    covered[tuple((hole.covered + here).T)] = True
    free &= ~covered
    distance = (np.arange(n) - out - offset)[:, None] ** 2 + z**2
    given = 0.5 * np.log(np.where(covered, 1.0, distance / radius**2))
    # Laplace's equation at the free vertices, without the hole's own links
    place, film = np.arange(n * m).reshape(n, m), ~covered.ravel()
    one, other = np.append(place[:-1], place[:, :-1]), np.append(place[1:], place[:, 1:])
    k = np.append(kx[:-1], kz[:, :-1]) * (film[one] & film[other])
    links_of = coo_matrix((k, (one, other)), shape=(n * m, n * m))
    balance = laplacian((links_of + links_of.T).tocsr()).tocsr()[free.ravel()]
    source = -balance[:, ~free.ravel()] @ given[~free][:, None]
    number = (np.cumsum(free) - 1).reshape(n, m)
    others = [number[i + (axis == 0), j + (axis == 1)] if covered[i, j] else number[i, j] for axis, i, j in links]
    ends, where = np.unique(others, return_inverse=True)
    unit = np.eye(len(source))[:, ends]
    answer = splu(balance[:, free.ravel()].tocsc()).solve(np.hstack((source, unit)))[ends]
    least, most = 0.0, LARGEST
    for _ in range(40):
        factor = 0.5 * (least + most)
        k = np.bincount(where, own * hole.factors(factor))
        fed = k @ np.linalg.solve(np.eye(k.size) + answer[:, 1:] * k, answer[:, 0])
        least, most = (factor, most) if fed < 2.0 * math.pi else (least, factor)
    return factor


@lru_cache(maxsize=64)
def strengths(rows: tuple[float, ...], radius: float) -> tuple[np.ndarray, np.ndarray]:
    """Offsets from -0.5 to 0.5 and factors for interpolation, with steps where vertices enter or leave the circle."""
    halves = {math.sqrt(radius * radius - z * z) % 1.0 for z in rows if abs(z) <= radius}
    steps = {0.0, 0.5, *(x for half in halves for x in (half, 1.0 - half) if x < 0.5)}
    offsets: list[float] = []
    edges = sorted(steps)
    for low, high in pairwise(edges):
        if high - low > 1e-6:
            offsets += [low + 1e-7, 0.5 * (low + high), high - 1e-7]
    found = [strength(rows, radius, x) for x in offsets]
    return np.array([-x for x in reversed(offsets)] + offsets), np.array(found[::-1] + found)
