"""Film-averaged energy equation on the film grid: heat sources, flows, and the system of the temperatures.

The temperatures act on the film through its viscosity, `ViscosityField`.

Scaling: flows are divided by c R^2 (1/s), heat by rho c_p c R^2 (K/s). The content m = fill H of a control volume
changes by its flows and by the inflow from outside, ``S = out - in + A dm/dt``. This inflow comes from the ends, from
supplies, and from a cavitation model that does not conserve mass and so adds or loses oil. The balance of energy minus
T times the balance of mass is

    A m* (T - T_old)/dt + sum over inflows F (T - T_link) + sum over outflows F (T_link - T)
        + S+ (T - T_source) + A walls (T - T_wall) = heat,

With backward Euler m* = m' + (dt / 2) dh/dt, m' = m - dt dm/dt. The rate dm/dt comes from the gap's rate, so that m' is
not the content m_old of the previous step but ``m_old - (dt^2 / 2) d2h/dt2``. With m* the storage of a step is

    m* (T - T_old) + dt T dm/dt = m T - m_old T_old + (dt^2 / 2) d(T dh/dt)/dt,

whose sum over a periodic cycle is zero. With m' or m in place of m* an error of up to 2 % of the power loss would
remain, for 64 steps a turn. With backward differences of second order (`exudyn_ehd.joint.heat.temperature`) the sum is
zero to second order with the gap at the end of the step and the mean void of the step: m* = m' + (dt / 2) (dh/dt +
dm/dt).

With the temperature upstream as T_link the transport would be of first order. That is too inaccurate where hot oil
turns past cold oil that enters at the ends, and where the hot side of the film moves: with a load that turns with the
oil, the smallest gap on 64 columns would be 2.6 times that on 256. So T_link is of second order, with a limiter that
reduces it to first order at extrema along a row or a column. The heat that leaves one vertex over a link enters the
other one, so that the heat balance holds.

Heat from a film's mean temperature through both of its surfaces
----------------------------------------------------------------
The temperature across the film is a parabola with the mean T and the surface temperatures s_1, s_2. Its heat flows into
the surfaces are

    q_1 = kappa (6 T - 4 s_1 - 2 s_2),    q_2 = kappa (6 T - 4 s_2 - 2 s_1),    kappa = k / h,

from T(y) = s_1 + b y + d y^2 with the mean T, q_1 = k T'(0) and q_2 = -k T'(h). Uniform heating gives this profile.

A film with two unknown temperatures across it has a cubic in place of the parabola, see `exudyn_ehd.joint.heat.across`.

Symbols: P true and q transformed scaled pressure, kx / kz conductances and fx / fz Couette fluxes with their metric, A
areas.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from exudyn_ehd.film.reynolds.gap import drop_weights, drops, following, to_ends
from exudyn_ehd.film.reynolds.links import FluxEffect, LinkFlux

# Heights of Lobatto's four points, over the gap.
LOBATTO = np.array([0.0, 0.5 - 0.5 / math.sqrt(5.0), 0.5 + 0.5 / math.sqrt(5.0), 1.0])


class ViscosityField(FluxEffect):
    """Viscosity ratio of a temperature field at vertices and links: flux effect and shear factor."""

    changes_carriers = False
    depends_on_speed = False

    def __init__(self) -> None:
        self.ratio = np.ones((1, 1))
        self.inverse_x = self.inverse_z = self.ratio

    def set(self, ratio: np.ndarray) -> None:
        """Set the viscosity ratio at the vertices (n, m); a link has the mean of its vertices."""
        self.ratio = ratio
        self.inverse_x = 2.0 / (ratio + np.roll(ratio, -1, axis=0))
        self.inverse_z = 1.0 / ratio
        self.inverse_z[:, :-1] = 2.0 / (ratio[:, :-1] + ratio[:, 1:])

    def apply(self, flux: LinkFlux, gap_x: np.ndarray, gap_z: np.ndarray, vx: float, vz: float) -> None:
        """Divide the conductances by the ratio on the link."""
        for x, z in ((flux.gx, flux.gz), (flux.gx_h, flux.gz_h), (flux.gx_v, flux.gz_v))[: 2 + flux.speeds]:
            x *= self.inverse_x
            z *= self.inverse_z

    def factor(
        self, H: np.ndarray, vx: float, ratio_out: np.ndarray, ratio_h_out: np.ndarray, ratio_v_out: np.ndarray
    ) -> None:
        """The ratio at the vertices; it depends neither on the gap nor on the speed."""
        ratio_out[:] = self.ratio
        ratio_h_out[:] = 0.0
        ratio_v_out[:] = 0.0


def cubic_at(at: np.ndarray) -> np.ndarray:
    """Coefficients (k, 4) of s, a, T_b and T_j in the temperatures at heights (k,)."""
    x = 2.0 * at - 1.0
    p2, p3 = 0.5 * (3.0 * x**2 - 1.0), 0.5 * (5.0 * x**3 - 3.0 * x)
    return np.column_stack((1.0 - p2, x - p3, 0.5 * (p2 - p3), 0.5 * (p2 + p3)))


_AT_LOBATTO = cubic_at(LOBATTO)


def at_points(fields: np.ndarray) -> np.ndarray:
    """Temperatures (n, m, 4) at Lobatto's points of mean, tilt and both surfaces (4, n, m)."""
    return np.moveaxis(fields, 0, -1) @ _AT_LOBATTO.T


def film_heat(P: np.ndarray, q: np.ndarray, k: np.ndarray) -> np.ndarray:
    """Heat (n, m) of the pressure flow, half of a link's heat at each of its vertices; k (2, n, m): conductances."""
    x, z = k * drops(q) * drops(P)
    return to_ends(x, 0) + to_ends(z, 1)


def film_flows(q: np.ndarray, fill: np.ndarray, k: np.ndarray, f: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Flows (2, n, m) over the links, and the net outflow (n, m) of every vertex; k, f (2, n, m)."""
    flows = k * drops(q) + f * np.where(f >= 0.0, fill, following(fill))
    return flows, drop_weights(flows).sum(axis=0)


@njit(cache=True)
def end_flows_around(turned, pressed, stored, squeezed, full, flow_out, entering_out):
    """Flows along an end's half control volumes and their inflow from outside, (n,), in a film that conserves mass.

    A half control volume next to a cavity receives oil along theta and oil that the film presses out. It passes this
    oil on along theta up to the flow of a full film; the excess leaves the bearing. Its inflow from outside is limited
    to the flow that an end pressure above the cavity pressure can drive. With the link's flow q and the divergence B of
    a full film, as in `exudyn_ehd.film.loads.end_flows`, the limit is ``q + B`` next to a full film or for ``q >= B``,
    ``2 sqrt(q B)`` for a smaller q, and zero for q <= 0.

    Parameters
    ----------
    turned : (n,) array
        Couette flow of a full film over the links i -> i+1, of one sign.
    pressed : (n,) array
        Flow from the end's vertices to their neighbours inside.
    stored, squeezed : (n,) arrays
        Rates of the content: of the half control volumes, and of full half control volumes.
    full : (n,) bool array
        Where the end pressure is above the cavity pressure and the film next to it is full.
    """
    n, way = turned.size, 1 if turned.sum() >= 0.0 else -1
    least, largest, change = 0.0, np.inf, 0.0
    for k in range(2 * n):
        i = way * k % n
        out, into = (i, i - 1) if way > 0 else (i - 1, i)
        whole, q = abs(turned[out]), pressed[i]
        B = whole - abs(turned[into]) + squeezed[i]
        most = 0.0
        if full[i] or (q > 0.0 and q >= B):
            most = max(q + B, 0.0)
        elif q > 0.0:
            most = 2.0 * np.sqrt(q * B)
        if k < n:
            # a turn adds the same to every flow, but for the limits
            gain = most - q - stored[i]
            change += gain
            least, largest = min(max(least + gain, 0.0), whole), min(max(largest + gain, 0.0), whole)
            continue
        if k == n:
            # a loss per turn below the span of possible flows leaves one between them, continuous in the loss
            begin = carried = largest + max(min(change, 0.0), least - largest)
        needed = whole - carried + q + stored[i]
        entering = min(needed, most)
        carried = whole - needed + entering
        if carried < 0.0:
            entering -= carried
            carried = 0.0
        flow_out[out], entering_out[i] = way * carried, entering
    # what such a flow misses after a turn enters everywhere
    for k in range(n):
        i = way * k % n
        entering_out[i] += (begin - carried) / n
        flow_out[i if way > 0 else i - 1] += way * (begin - carried) * (k + 1) / n


@njit(cache=True)
def pass_on(x, couette, found, shares, walls, spin):
    """Make cavities pass on along theta what they receive, not more, and at most the flow of a full film.

    A cavitation model that does not conserve mass keeps a cavity full while its gap widens along theta. The oil that it
    makes there would be fresh and cold, and would enter the groove behind the cavity in place of the feed.

    Parameters
    ----------
    x, couette : (n, m) arrays
        Flows over the links i -> i+1, changed in place, and those of a full film by sliding alone.
    found : (n, m) array
        Oil that the cavitation model makes, below 0 where it loses oil; changed in place.
    shares : (n, m) array
        Share of the flow's reduction that a vertex passes on: 1 in cavities, less in the film that a cavity feeds.
    walls : (n, m) array
        Shares of the rows' width that are covered by the wall of a groove or by the edge of an arc, 0 elsewhere. Rows
        without a wall stay as they are.
    spin : float
        Its sign is that of the sliding.

    Returns
    -------
    (2, n, m) array
        Oil that the walls receive less, and all oil that is made between a wall and the one before.
    """
    less, way, n = np.zeros((2, *x.shape)), 1 if spin > 0.0 else -1, len(x)
    for j in range(x.shape[1]):
        first, cut, made = walls[:, j].argmax(), 0.0, 0.0
        for k in range(n + 1 if walls[first, j] > 0.0 else 0):
            i = (first + way * k) % n
            if walls[i, j] > 0.0:
                less[0, i, j] += walls[i, j] * cut
                less[1, i, j] += walls[i, j] * made
                found[i, j] += (1.0 - walls[i, j]) * cut
                cut = made = 0.0
            else:
                made += found[i, j]
                found[i, j] += cut
                link = i if way > 0 else i - 1
                flow = way * x[link, j]
                least, most = min(flow, 0.0), max(flow, way * couette[link, j])
                cut = shares[i, j] * (flow - min(max(flow - found[i, j], least), most))
                x[link, j] -= way * cut
                found[i, j] -= cut
    return less


def content_rate(
    H: np.ndarray, H_t: np.ndarray, fill: np.ndarray, mass_old: np.ndarray, inverse_step: float, squeeze: bool
) -> np.ndarray:
    """Rate of the content fill H: from the old content if ``inverse_step`` > 0, else from H_t if ``squeeze``, or 0."""
    if inverse_step > 0.0:
        return (fill * H - mass_old) * inverse_step
    return fill * H_t if squeeze else np.zeros_like(H)


def outside_flows(qz: np.ndarray, balance: np.ndarray, fixed: np.ndarray, unbroken: np.ndarray) -> np.ndarray:
    """Inflow at fixed vertices (n, m): their balance, or next to a ruptured film only the flow over the end's link.

    ``qz`` (n, m): flows over the links in z; ``balance`` (n, m): outflow of `film_flows` plus storage. ``unbroken``
    (n, m) is all True for cavitation models that conserve mass.
    """
    out = np.where(fixed, balance, 0.0)
    for end, beside, over in ((0, 1, qz[:, 0]), (-1, -2, -qz[:, -2])):
        alone = fixed[:, end] & ~unbroken[:, beside]
        out[alone, end] = over[alone]
    return out


@njit(cache=True)
def transport_slopes(qx, qz, diagonal, T, links, held, slopes_out):
    """Derivatives (5, n m) of the energy equation's system, in the layout of `exudyn_ehd.film.banded.workspace`.

    The heat over a link is its flow times the temperature upstream plus a share of the difference to the temperature
    downstream. T times the balance of mass is subtracted from the balance of energy: the net outflow of a vertex is
    therefore subtracted from ``diagonal`` (n, m), which holds all other terms of its own temperature. ``qz`` is zero in
    the last column, where there is no link. ``links``: inverse lengths (n,) and (m,) of the links in theta and z.

    A limiter gives the shares from given temperatures ``T`` (n, m): those extrapolated to the end of a step, or those
    of the last round of a steady search. With shares up to a half the solution does not grow. The storage term ``held``
    (n, m) upstream limits the flow that a share multiplies. Without this limit shares and temperatures would alternate
    from step to step if the steps are long.
    """
    n, m = qx.shape
    for i in range(n):
        prv = i - 1 if i > 0 else n - 1
        for j in range(m):
            k = i * m + j
            x, z = qx[i, j], qz[i, j]
            share_x = weight_along(T[:, j], links[0], i, x) * min(abs(x), held[(i + 1) % n if x < 0.0 else i, j])
            share_z = weight_across(T[i], links[1], j, z) * min(abs(z), held[i, j + 1 if z < 0.0 else j])
            slopes_out[0, k], slopes_out[1, k] = max(x, 0.0) - share_x, min(x, 0.0) + share_x
            slopes_out[2, k], slopes_out[3, k] = max(z, 0.0) - share_z, min(z, 0.0) + share_z
            into = qx[prv, j] + (qz[i, j - 1] if j > 0 else 0.0)
            slopes_out[4, k] = diagonal[i, j] - (x + z - into)


@njit(cache=True, inline="always")
def weight_along(T, link_x, i, flow):
    """Return `downstream_weight` on the link i -> i+1 in theta, for the temperatures T (n,) of a row.

    It is zero if there is no link upstream, as at the edge of an arc.
    """
    n = len(T)
    up = (i - 1 if flow > 0.0 else i + 1) % n
    own, before = (T[(i + 1) % n] - T[i]) * link_x[i], (T[(up + 1) % n] - T[up]) * link_x[up]
    return downstream_weight(own, before)


@njit(cache=True, inline="always")
def weight_across(T, link_z, j, flow):
    """Return `downstream_weight` on the link j -> j+1 in z, for the temperatures T (m,) of a column.

    It is zero if the link upstream would lie outside the film.
    """
    up, weight = j - 1 if flow > 0.0 else j + 1, 0.0
    if flow != 0.0 and 0 <= up < len(T) - 1:
        weight = downstream_weight((T[j + 1] - T[j]) * link_z[j], (T[up + 1] - T[up]) * link_z[up])
    return weight


@njit(cache=True, inline="always")
def downstream_weight(own, before):
    """Weight of the temperature downstream of a link, from the slopes on the link and on the one upstream.

    With the ratio r of the slope upstream to the slope on the link, the weight is a half for r >= 1 and
    ``2 r / (1 + r)^2`` for a smaller r, with a continuous slope at r = 1. It is zero at extrema, where r < 0.
    """
    weight = 0.0
    if own * before > 0.0:
        weight = 0.5 if abs(before) >= abs(own) else 2.0 * own * before / (own + before) ** 2
    return weight


def passed(
    kappa: np.ndarray,
    area: np.ndarray,
    outward: tuple[float | None, float | None],
    inside: np.ndarray,
    own: float,
    other: float,
) -> tuple[np.ndarray, np.ndarray]:
    """Temperatures of both surfaces, and heat into them, W, (2, f, n, m) each.

    They are linear in f temperatures, of which the last two are those outside both surfaces. The heat flow from the
    film into surface a is ``q_a = kappa (inside[a] . temperatures - own s_a - other s_b)``. For a surface with a heat
    transfer coefficient ``q_a = U (s_a - T_a)``, for the surface of a wall with conduction ``s_a = T_a``.

    Parameters
    ----------
    kappa, area : (n, m) arrays
        k / h, W/(m2 K), and areas of the vertices, m2.
    outward : (float or None, float or None)
        U of both surfaces, W/(m2 K); None: the surface has the wall's temperature.
    inside : (2, f) array
        Zero for the temperatures outside.
    own, other : float
    """
    meets = [0.0 if U is None else 1.0 for U in outward]
    given = [1.0 if U is None else U for U in outward]
    diagonal = [own * kappa * meet + U for meet, U in zip(meets, given, strict=True)]
    inner = inside[:, :, None, None]
    known = kappa * (np.array(meets)[:, None, None, None] * inner)
    known[0, -2], known[1, -1] = given
    determinant = diagonal[0] * diagonal[1] - (other * kappa) ** 2 * (meets[0] * meets[1])
    near, far = [d / determinant for d in diagonal[::-1]], other * kappa / determinant
    s = np.array([near[a] * known[a] - (meets[a] * far) * known[1 - a] for a in (0, 1)])
    return s, kappa * area * (inner - own * s - other * s[::-1])


def through_surfaces(
    kappa: np.ndarray | None, area: np.ndarray, outward: tuple[float | None, float | None]
) -> np.ndarray:
    """Heat into both surfaces (2, n, m, 3), W, per kelvin of the film's mean temperature and of both outside ones.

    Parameters as for `passed`; ``kappa`` None: the coefficients act on the mean temperature.
    """
    if kappa is not None and outward != (0.0, 0.0):
        through = passed(kappa, area, outward, np.array([[6.0, 0.0, 0.0]] * 2), 4.0, 2.0)[1]
    else:
        rows = np.array([[1.0, -1.0, 0.0], [1.0, 0.0, -1.0]])[..., None, None]
        through = np.array([U or 0.0 for U in outward])[:, None, None, None] * rows * area
    return np.moveaxis(through, 1, -1)
