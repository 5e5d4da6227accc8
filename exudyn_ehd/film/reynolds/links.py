"""Finite-volume Reynolds equation in scaled form: coefficients of the links, right-hand side, residual of the vertices.

With H = h/c, lengths over R and P = p c^2 / (12 mu R^2) in 1/s, the balance of a control volume reads

    sum over its links of (V H - H^3 dP/ds) + d(H)/dt area = 0,      V = (U_x, U_z) / (2 R) in 1/s,

which is the conservative form of Eq. (4) of Flores' paper (Poiseuille and Couette flux of a thin film, squeeze). Links
in theta use the gap on the link itself, ``HF``; links in z the mean of both vertices, which is exact for a tilted
journal.

With an effect (flow factors of rough surfaces, shear thinning, a temperature field) the flow over a link is
``V carrier - conductance dP/ds``. A plain film has the carrier H, the conductance H^3 and no `LinkFlux`.

Symbols: H (n, m) gap at vertices, HF (n, m) gap on the link i -> i+1, kx / kz link conductances with their metric, fx /
fz Couette fluxes with their metric, b right-hand side of ``A P = b``, P scaled pressure.

Couette flows out of a cavity: transport of second order along theta
--------------------------------------------------------------------
With the void ``v = H - fill H`` and the transport speed U, the mass balance of a film reads

    dv/dt + div (U v) = dH/dt + div (U H) + div (pressure flow).

Backward Euler in v is of first order, and damps or excites whirl. Here the right side is taken at the end of a step,
and the void in ``div (U v)`` is averaged over the step. Both sides are then consistent to second order, for any change
of the gap. Averaged fills would not be: where the gap moves they cause the error ``U (1 - fill) dH/dt h / 2``, which is
more than that of backward Euler. So the flow out of a vertex, with the flux f of a full film, is

    f (1 - ((1 - w) v + w v_old) / H) = f ((1 - w) fill + w late),    late = 1 - v_old / H,

with the same factor for all links of the vertex: mass is conserved to round-off. H is extrapolated from gap and rate at
the start of the step. This is of the same order, and makes ``late`` and w known before the step: the film's equations
stay linear, and its derivatives exact.

If a step carries C times the content of a vertex away, a void without inflow is multiplied by
``(1 - w C) / (1 + (1 - w) C)``. For ``w C < 1`` this lies between 0 and 1, so that the void decays without a change of
sign. For any C, w ``late`` carries less than half of the content away. w is 0 in gaps that open or close by more than
the oil in them.

The fill of a vertex would carry the oil with an error of first order in the length of a link. In time it would smooth
the oil content along theta, most where the oil moves slowly against the cavity, as in whirl at half of the speed. So
``late`` also holds the rise of the fill from the vertex to the middle of the link downstream in theta, extrapolated
from the vertex upstream (upwind differences of second order: R. F. Warming, R. M. Beam, AIAA J. 14 (1976) 1241). It is
the rise at the start of the step, so that the equations stay linear, and the error in time is of first order. If a step
carries C times the content away, no wave grows for any C. The rise in the middle of the step, extrapolated by its rate,
would be of second order, but lets coarse steps ring.

Fills have a kink at a rupture line, and jump at a reformation line. The void of the vertex in whose cell such a line
lies shrinks while the line crosses the cell. Where the void on either side of a vertex is below half of its own, the
rise is therefore reduced in proportion, to 0 beside a full vertex. Elsewhere it is linear in the fills. With a limiter
of total variation, stiffness and damping of small motions would differ between directions. Between -0.45 late and
0.45 (1 - late) the rise leaves the fill of the flow between 0 and 1. Along z the order is the first.

The equations of a steady film contain only the fills of its flows. Those of the vertices follow from them
(`move_upstream`), so that a run which begins with a steady film stays there. The shear in a cavity has the fills of the
flows in both cases.
"""

from __future__ import annotations

from typing import NamedTuple, Protocol

import numpy as np
from numba import njit

from exudyn_ehd.compilation import FAST, I0, I1, TOLERANCE
from exudyn_ehd.film.grid import FilmGrid
from exudyn_ehd.film.reynolds.balance import next_values


class LinkFlux(NamedTuple):
    """Coefficients of all links of a film with flux effects, (n, m) arrays that the effects write.

    Attributes
    ----------
    carriers, speeds : bool
        Whether an effect changes the carriers, or lets conductances depend on the speed. If not, the carriers are the
        gaps, and the derivatives keep their initial values.
    gap_x, gap_z : arrays
        Gaps of the links in theta (the film solver's own array) and in z.
    gx, gx_h, gx_v, gz, gz_h, gz_v : arrays
        Conductances per unit metric, their derivatives to the link's gap and to the scaled circumferential speed vx.
    cx, cx_h, cz, cz_h : arrays
        Carriers and their derivatives to the link's gap.
    """

    carriers: bool
    speeds: bool
    gap_x: np.ndarray
    gap_z: np.ndarray
    gx: np.ndarray
    gx_h: np.ndarray
    gx_v: np.ndarray
    gz: np.ndarray
    gz_h: np.ndarray
    gz_v: np.ndarray
    cx: np.ndarray
    cx_h: np.ndarray
    cz: np.ndarray
    cz_h: np.ndarray

    @property
    def flow(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Conductances and carriers alone."""
        return self.gx, self.gz, self.cx, self.cz

    @property
    def laws(self) -> tuple[tuple[np.ndarray, ...], ...]:
        """Conductances with their derivatives to gap and speed, carriers with theirs to the gap, in theta and in z."""
        x = self.gx, self.gx_h, self.gx_v, self.cx, self.cx_h
        return x, (self.gz, self.gz_h, self.gz_v, self.cz, self.cz_h)

    @property
    def slopes(self) -> tuple[np.ndarray, ...]:
        """Conductances' derivatives, carriers and their derivatives, each in theta and z."""
        return self.gx_h, self.gz_h, self.cx, self.cz, self.cx_h, self.cz_h

    @property
    def by_speed(self) -> tuple[np.ndarray, np.ndarray] | None:
        """Conductances' derivatives to the speed; None if they have none."""
        return (self.gx_v, self.gz_v) if self.speeds else None

    def reset(self) -> None:
        """Reset the carriers to those of a plain film, and the derivatives to the speed to 0, if effects change
        them."""
        if self.carriers:
            self.cx[:], self.cz[:] = self.gap_x, self.gap_z
            self.cx_h[:] = self.cz_h[:] = 1.0
        if self.speeds:
            self.gx_v[:] = self.gz_v[:] = 0.0


class Fluidity(Protocol):
    """Viscosity ratio that varies with the temperature, at the vertices, and its inverse on the links, (n, m) or
    (1, 1)."""

    ratio: np.ndarray
    inverse_x: np.ndarray
    inverse_z: np.ndarray


class FluxEffect(Protocol):
    """Effect that changes `LinkFlux` in place.

    Attributes
    ----------
    changes_carriers, depends_on_speed : bool
        Whether the effect changes the carriers, and whether its conductances depend on the speed.
    """

    changes_carriers: bool
    depends_on_speed: bool

    def apply(self, flux: LinkFlux, gap_x: np.ndarray, gap_z: np.ndarray, vx: float, vz: float) -> None:
        """Change conductances and carriers for the links' gaps (n, m) and scaled speeds, with their derivatives."""

    def start(self, flux: LinkFlux, H: np.ndarray, vx: float, vz: float) -> None:
        """Overwrite ``flux`` with a plain film of the gaps H (n, m) at the vertices, changed by this effect.

        Sets the links' gap in z.
        """
        plain_flux(H, flux.gap_x, flux.gap_z, flux.gx, flux.gx_h, flux.gz, flux.gz_h)
        flux.reset()
        self.apply(flux, flux.gap_x, flux.gap_z, vx, vz)


class ShearFactor(Protocol):
    """Viscosity factor of Couette shear, a function of the gap, of the sliding speed, and possibly of pressure
    gradients."""

    def factor(
        self, H: np.ndarray, vx: float, ratio_out: np.ndarray, ratio_h_out: np.ndarray, ratio_v_out: np.ndarray
    ) -> np.ndarray | None:
        """Set mu/mu_0 at the vertices and its derivatives to H and vx.

        Returns its derivatives (2, n, m) to the gradients of the solver's unknown along theta and z; None if it does
        not depend on them.
        """


class ShearProduct:
    """Two shear factors that act together: their product, with the product rule for the derivatives."""

    def __init__(self, first: ShearFactor, second: ShearFactor) -> None:
        self.first, self.second = first, second

    def factor(
        self, H: np.ndarray, vx: float, ratio_out: np.ndarray, ratio_h_out: np.ndarray, ratio_v_out: np.ndarray
    ) -> np.ndarray | None:
        """Set the product of both factors and its derivatives, as for `ShearFactor`; at most one of them depends on
        gradients."""
        other, other_h, other_v = np.empty_like(H), np.empty_like(H), np.empty_like(H)
        slopes = self.first.factor(H, vx, ratio_out, ratio_h_out, ratio_v_out)
        others = self.second.factor(H, vx, other, other_h, other_v)
        if slopes is not None:
            slopes *= other
        elif others is not None:
            slopes = others * ratio_out
        for out, by in ((ratio_h_out, other_h), (ratio_v_out, other_v)):
            out *= other
            out += ratio_out * by
        ratio_out *= other
        return slopes


class LinkLaw(FluxEffect, ShearFactor, Protocol):
    """Law of the oil that changes the flows over links and the shear.

    Attributes
    ----------
    field : Fluidity or None
        Viscosity over the reference viscosity, set by the bearing's model if it varies over the film.
    """

    field: Fluidity | None = None


def link_flux(gap_x: np.ndarray, effects: tuple[FluxEffect, ...]) -> LinkFlux:
    """Return buffers for these effects; ``gap_x`` (n, m) as in `LinkFlux`."""
    carriers = any(effect.changes_carriers for effect in effects)
    speeds = any(effect.depends_on_speed for effect in effects)
    gap_z, gx, gx_h, gx_v, gz, gz_h, gz_v = np.zeros((7, *gap_x.shape))
    cx, cz = np.zeros((2, *gap_x.shape)) if carriers else (gap_x, gap_z)
    cx_h, cz_h = np.ones((2, *gap_x.shape))
    return LinkFlux(carriers, speeds, gap_x, gap_z, gx, gx_h, gx_v, gz, gz_h, gz_v, cx, cx_h, cz, cz_h)


@njit(cache=True, fastmath=FAST)
def plain_flux(H, HF, gap_z_out, gx, gx_h, gz, gz_h):
    """Set the conductances of a plain film with their derivatives, and the gap of the links in z."""
    n, m = H.shape
    for i in range(n):
        for j in range(m):
            h = HF[i, j]
            gx[i, j] = h * h * h
            gx_h[i, j] = 3.0 * h * h
        for j in range(m):
            h = 0.5 * (H[i, j] + H[i, j + 1]) if j + 1 < m else H[i, j]
            gap_z_out[i, j] = h
            gz[i, j] = h * h * h
            gz_h[i, j] = 3.0 * h * h


def link_metric(grid: FilmGrid, flow_x: float) -> np.ndarray:
    """Metric (4, n, m) of the links, 0 where there is none.

    First width over length in theta and in z, times the grid's ``cuts``, then the width for the Couette flows in theta
    and in z. ``flow_x`` = 0 drops the circumferential pressure flow.
    """
    along_z, across_z = np.append(grid.link_z, 0.0), np.append(np.ones(grid.link_z.size), 0.0)
    x = flow_x * grid.link_x, grid.width_x, grid.link_x != 0.0, grid.width_x
    metric = np.stack([np.outer(a, b) for a, b in zip(x, (grid.width_z, along_z, grid.width_z, across_z), strict=True)])
    if grid.cuts is not None:
        metric[:2] *= grid.cuts
    return metric


@njit(cache=True, fastmath=FAST)
def _set_along(axis, h_a, h_b, flow, metric, v, terms):
    """Set the results of `set_links` for the links along one axis, flat."""
    k, f = terms[axis], terms[axis + 2]
    if flow is not None:
        conductances, carriers = flow[axis].reshape(-1), flow[axis + 2].reshape(-1)
    for c in range(k.size):
        h = 0.5 * (h_a[c] + h_b[c])
        conducts, carried = h * h * h, h
        if flow is not None:
            conducts, carried = conductances[c], carriers[c]
        k[c], f[c] = metric[axis, c] * conducts, v * metric[axis + 2, c] * carried


@njit(cache=True)
def set_links(H, HF, flow, metric, vx, vz, terms):
    """Set conductances and Couette flows of the links in ``terms``, the first four fields (n, m) of a `FilmTerms`.

    ``flow``: `LinkFlux.flow`, None for a plain film; ``metric``: `link_metric`.
    """
    by, out = metric.reshape(4, H.size), terms.reshape(len(terms), H.size)
    h, h_x = H.reshape(-1), HF.reshape(-1)
    _set_along(I0, h_x, h_x, flow, by, vx, out)
    _set_along(I1, h, next_values(h, I1), flow, by, vz, out)


# Largest w, largest part of a vertex's content that ``late`` without the rise may carry away in a step, and largest
# rise over its bounds. With w = 0.5 the void would be averaged to second order, but short waves not damped; smaller
# values damp more and are less accurate.
LARGEST_LAG = 0.45


@njit(cache=True, inline="always")
def _leaves(fx, fz, i, j):
    """Return the Couette flow of a full film out of a vertex; nothing flows over the last row's links in z."""
    out_x, out_z = max(fx[i, j], 0.0) - min(fx[i - 1, j], 0.0), max(fz[i, j], 0.0) - min(fz[i, j - 1], 0.0)
    return out_x + out_z


@njit(cache=True, inline="always")
def _share_of_rise(fx, fz, fill, links, i, j):
    """Return the rise of a vertex per change of the fill from the column upstream, this column, and the one whose void
    reduces the rise, else -1.

    The rise is weighted by the part of the outflow that flows along theta. It is 0 at full vertices, and where the
    flows of both links differ in sign.
    """
    last, on, goes_on = (i - 1 if i > 0 else len(fx) - 1), (i + 1 if i + 1 < len(fx) else 0), fx[i, j] > 0.0
    before, to, away = (last, links[last], links[i]) if goes_on else (on, links[i], links[last])
    if fx[last, j] * fx[i, j] <= 0.0 or fill[i, j] >= 1.0:
        return 0.0, before, -1
    outflow, fuller = (fx[i, j] if goes_on else -fx[last, j]), (last if fill[last, j] > fill[on, j] else on)
    share, left = 0.5 * outflow / _leaves(fx, fz, i, j) * to / away, 2.0 * (1.0 - fill[fuller, j]) / (1.0 - fill[i, j])
    return share * min(left, 1.0), before, fuller if left < 1.0 else -1


@njit(cache=True)
def outflow_of(fx, fz, H, H_t, area, links, fill):
    """Return fields (4, n, m) for the next step: fill; rate of the gap over the gap, 1/s; Couette outflow of a full
    film over its volume, 1/s; rise of the fill to the middles of the links downstream.

    ``links`` (n,): inverse lengths of the links in theta. A vertex with a line has the fill 1.
    """
    n, m = fill.shape
    out = np.empty((4, n, m))
    for i in range(n):
        for j in range(m):
            volume, own = area[i, j] * H[i, j], fill[i, j]
            out[0, i, j] = own
            out[1, i, j] = H_t[i, j] / H[i, j]
            out[2, i, j] = _leaves(fx, fz, i, j) / volume if volume > 0.0 else 0.0
            share, before, _ = _share_of_rise(fx, fz, fill, links, i, j)
            rise = share * (own - fill[before, j])
            out[3, i, j] = min(max(rise, -LARGEST_LAG * own), LARGEST_LAG * (1.0 - own))
    return out


@njit(cache=True)
def move_upstream(fx, fz, links, out):
    """Change fill and rise in the result (4, n, m) of `outflow_of`, from the fills of a steady film, which are those
    of its flows, to fills of the vertices; their sum is kept.

    Sweeps go with the flow. On equal columns each one reduces the error to a third per column.
    """
    fill, rise, flows, change, goes_on = out[0], out[3], out[0].copy(), 1.0, fx[0, 0] > 0.0
    n, m = fill.shape
    for _ in range(n):
        if change <= TOLERANCE:
            break
        change = 0.0
        for k in range(n):
            i = k if goes_on else n - 1 - k
            for j in range(m):
                if flows[i, j] < 1.0:
                    share, before, _ = _share_of_rise(fx, fz, fill, links, i, j)
                    own = (flows[i, j] + share * fill[before, j]) / (1.0 + share)
                    if flows[i, j] - own < -LARGEST_LAG * own:
                        own = flows[i, j] / (1.0 - LARGEST_LAG)
                    elif flows[i, j] - own > LARGEST_LAG * (1.0 - own):
                        own = (flows[i, j] - LARGEST_LAG) / (1.0 - LARGEST_LAG)
                    change = max(change, abs(own - fill[i, j]))
                    fill[i, j], rise[i, j] = own, flows[i, j] - own


@njit(cache=True)
def rise_slopes(fx, fz, fill, rise, links):
    """Return derivatives (3, n m) of the rises to the fills upstream, of the vertex that reduces them and to the own
    one, and the flat indices (3, n m) of these fills."""
    m, out, places = fill.shape[1], np.zeros((3, fill.size)), np.zeros((3, fill.size), dtype=np.int64)
    for c in range(fill.size):
        i, j = c // m, c % m
        share, before, fuller = _share_of_rise(fx, fz, fill, links, i, j)
        own, places[0, c], places[1, c], places[2, c] = fill[i, j], before * m + j, c, c
        if min(rise[i, j] + LARGEST_LAG * own, LARGEST_LAG * (1.0 - own) - rise[i, j]) <= TOLERANCE:
            out[2, c] = -LARGEST_LAG
            continue
        out[0, c], out[2, c] = -share, share
        if fuller >= 0 and fill[fuller, j] < 1.0:
            places[1, c] = fuller * m + j
            out[1, c] = -rise[i, j] / (1.0 - fill[fuller, j])
            out[2, c] += rise[i, j] / (1.0 - own)
    return out, places


@njit(cache=True)
def hold_back(fields, content, late, rise):
    """Set ``prompt`` to 1, ``late`` and ``rise`` to 0 where ``late`` without the rise would carry away more than the
    content at the start of the step, since flows have grown; ``content`` (n, m): over the step, 1/s."""
    fx, fz, area, prompt = fields[2], fields[3], fields[7], fields[8]
    for i in range(late.shape[0]):
        for j in range(late.shape[1]):
            held = late[i, j] - rise[i, j]
            if held > 0.0 and held * _leaves(fx, fz, i, j) > area[i, j] * content[i, j]:
                prompt[i, j], late[i, j], rise[i, j] = 1.0, 0.0, 0.0


@njit(cache=True)
def lag_void(outflow, step, fixed, prompt_out, late_out, rise_out):
    """Set ``prompt = 1 - w``, ``late`` and the rise of the fill in it (n, m) for a step, from the result of
    `outflow_of` at its start; 1, 0 and 0 at vertices that were full."""
    n, m = fixed.shape
    for i in range(n):
        for j in range(m):
            fill, grows, drains = outflow[0, i, j], step * outflow[1, i, j], step * outflow[2, i, j]
            prompt_out[i, j], late_out[i, j], rise_out[i, j] = 1.0, 0.0, 0.0
            if fixed[i, j] or fill >= 1.0 or not min(fill, fill + grows) > 0.0:
                continue
            late = (fill + grows) / (1.0 + grows)
            w = min(LARGEST_LAG, late / fill, fill / late * min(1.0, LARGEST_LAG / max(drains, LARGEST_LAG)))
            rise_out[i, j] = min(max(outflow[3, i, j], -LARGEST_LAG * late), LARGEST_LAG * (1.0 - late))
            prompt_out[i, j], late_out[i, j] = 1.0 - w, w * late + rise_out[i, j]
