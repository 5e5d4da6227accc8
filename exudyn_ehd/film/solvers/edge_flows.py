"""Flows at prescribed vertices, where the film beside them ends within a link; shear at the ends beside a cavity."""

from __future__ import annotations

import numpy as np
from numba import njit

from exudyn_ehd.film.cavitation.closures import Closure
from exudyn_ehd.film.cavitation.system import FilmSystem
from exudyn_ehd.film.grid import FilmGrid


def flow_pressures(s: FilmSystem, active: np.ndarray, clips: bool) -> tuple[np.ndarray, np.ndarray]:
    """Pressures (n, m) whose differences drive the flows at prescribed vertices, and where the film is full.

    Next to a prescribed pressure above the cavity's a film that is cut off has the linear film's gradient, up to a line
    that may lie in front of the next vertex: that vertex counts with its linear pressure, and as full.
    """
    if not clips:
        return s.linear_pressure, active
    near, pressed = np.zeros(active.shape, dtype=bool), s.fixed & (s.pressure > s.cavity_pressure)
    for axis, links in enumerate((s.kx > 0.0, s.kz > 0.0)):
        # nothing flows over the last links in z
        near |= links & np.roll(pressed, -1, axis) | np.roll(links & pressed, 1, axis)
    near &= ~s.fixed
    return np.where(near, s.linear_pressure, s.pressure), active | near


def ends_of_cavities(s: FilmSystem, conserves_mass: bool) -> list[tuple[int, int, np.ndarray]]:
    """Columns of the ends and of the vertices beside them, and where (n,) an end holds what the film beside it does.

    An end's half control volume is as empty as the cavity beside it, though its pressure is prescribed. Where a film
    conserves mass under an end pressure above the cavity's, a full band lies along the end.
    """
    m = s.fixed.shape[1]
    out = []
    for end, beside in ((0, 1), (m - 1, m - 2)) if m > 2 else ():
        at = s.fixed[:, end] & ~s.fixed[:, beside]
        if conserves_mass:
            at &= s.pressure[:, end] <= s.cavity_pressure
        out.append((end, beside, at))
    return out


def shear_share(s: FilmSystem, active: np.ndarray, closure: Closure) -> np.ndarray:
    """Share of a full film's shear that acts at each vertex (n, m)."""
    out = np.empty(s.fixed.shape)
    _share(s.fill, active, s.fixed, s.pressure, s.cavity_pressure, closure.conserves_mass, closure.cavity_shear, out)
    return out


@njit(cache=True)
def _share(fill, active, fixed, P, pc, conserves, cavity_shear, out):
    n, m = out.shape
    for i in range(n):
        for j in range(m):
            out[i, j] = fill[i, j] if conserves else (1.0 if active[i, j] | fixed[i, j] else cavity_shear)
        for end, beside in ((0, 1), (m - 1, m - 2)):
            if m > 2 and fixed[i, end] and not fixed[i, beside] and not (conserves and P[i, end] > pc):
                out[i, end] = out[i, beside]


def at_beside_ends(s: FilmSystem, field: np.ndarray) -> np.ndarray:
    """A field (n, m) of the ends at the vertices beside them, where a film that conserves mass shares its fill with
    them; 0 elsewhere."""
    out = np.zeros(field.shape)
    _move_beside(field, s.fixed, s.pressure, s.cavity_pressure, out)
    return out


@njit(cache=True)
def _move_beside(field, fixed, P, pc, out):
    n, m = out.shape
    for i in range(n):
        for end, beside in ((0, 1), (m - 1, m - 2)):
            if m > 2 and fixed[i, end] and not fixed[i, beside] and P[i, end] <= pc:
                out[i, beside] += field[i, end]


def end_films_of_areas(s: FilmSystem, active: np.ndarray, grid: FilmGrid, balance_out: np.ndarray) -> None:
    """Let the films between supply areas and a cavity end where they do, in the balances (n, m)."""
    cuts = np.ones((2, *grid.shape)) if grid.cuts is None else grid.cuts
    widths = grid.width_x, grid.width_z
    _end_films((s.kx, s.kz), s.b, active, grid.fixed, cuts, widths, np.diff(grid.z), balance_out)


@njit(cache=True)
def _end_films(links, b, active, fixed, cuts, widths, length_z, balance_out):
    """Let the film between a supply area and a cavity end where its parabola of pressure does.

    What the turn carries away and the squeeze takes, B per length, leaves the area's edge up to the middle of the link,
    where the control volumes meet, ``B (d - l / 2)`` with the link's length l and the distance d from the edge to the
    cavity's first vertex. A film that begins with no more than the cavity's pressure ends at once and takes none of it;
    one whose flow q takes the share of ``sqrt(2 q B l)`` in ``q + B l / 2``, up to the flow at which it reaches the
    vertex, of what the vertex receives in all.

    Parameters
    ----------
    links : conductances (n, m) in theta and z
    b, active, fixed : (n, m), right-hand side of the balances, vertices of the film and prescribed ones
    cuts : (2, n, m), of the links in theta and z, see `exudyn_ehd.film.grid.FilmGrid`
    widths : control volumes' widths (n,) and (m,)
    length_z : (m - 1,), of the links in z
    balance_out : (n, m)
        Balances, at prescribed vertices what these feed, which is changed in place.
    """
    n, m = b.shape
    for axis in range(2):
        for i in range(n):
            for j in range(1, m - 1):
                if not fixed[i, j]:
                    continue
                for way in (-1, 1):
                    u, v = ((i + way) % n, j) if axis == 0 else (i, j + way)
                    at = (i, j) if way > 0 else (u, v)
                    if fixed[u, v] or active[u, v] or b[u, v] >= 0.0 or links[axis][at] <= 0.0:
                        continue
                    received = max(0.0, 2.0 * (1.0 + balance_out[u, v] / b[u, v]))
                    width = widths[0][u] if axis == 0 else widths[1][v]
                    length = widths[0][0] if axis == 0 else length_z[at[1]]
                    d = length * min(1.0, 1.0 / cuts[axis][at])
                    if received < 1.0:
                        balance_out[i, j] += b[u, v] / width * (d - 0.5 * length) * (1.0 - np.sqrt(received)) ** 2
