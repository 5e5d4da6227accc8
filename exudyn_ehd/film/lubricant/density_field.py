"""Density at the vertices of a film from transformed pressures; the law is in `density`.

The iterations of a film, and one film after the other, ask for the law at nearly the same pressures again and again. So
every vertex remembers a pressure at which the law is known, ``known`` (9, size): transformed pressure q, density ratio,
s = dp/dq and its derivative, the four further coefficients of the density's Taylor polynomial about q, and the change
of q up to which that polynomial is the law, in loops that the compiler vectorises.

Symbols: P scaled transformed pressures (n, m), ``scale`` Pa per unit of P, ``floor`` the scaled pressure below which
the density stays.
"""

from numba import njit

from exudyn_ehd.film.kernels import FAST
from exudyn_ehd.film.lubricant.density import law_at

# Change of dp/dq, and an eighth of that of the density's slope, as shares, up to which Taylor's polynomial about a
# known value is the law: to 1e-14 in the density, which the balance is solved with, and 1e-10 in its slope.
NEAR = 5e-4


@njit(cache=True)
def density_at(P, scale, floor, law, known, rho_out):
    """Density ratio (n, m); what is not known near by is looked up. Beyond the law's range it is that at its end."""
    x, rho = P.reshape(-1), rho_out.reshape(-1)
    lowest, highest = max(floor, law.lowest / scale), law.highest / scale
    if _ratio_near(x, scale, lowest, highest, known, rho) > 0.0:
        look_up(x, scale, lowest, highest, law, 1.0, known)
        _ratio_near(x, scale, lowest, highest, known, rho)


@njit(cache=True)
def know_at(P, scale, floor, law, known):
    """Know the law at the pressures (n, m) of a solution, so that tangents do not depend on the film before."""
    look_up(P.reshape(-1), scale, max(floor, law.lowest / scale), law.highest / scale, law, 0.0, known)


# Where a law is straight, its polynomial reaches to infinity.
@njit(cache=True, error_model="numpy")
def look_up(x, scale, lowest, highest, law, near, known):
    """Know the law at all x (size,), cut at ``lowest`` and ``highest``, that are farther from what is known than
    ``near`` times its reach."""
    for c in range(x.size):
        q = _within(x[c], lowest, highest) * scale
        if abs(q - known[0, c]) <= near * known[8, c] and (q > 0.0) == (known[0, c] > 0.0):
            continue
        _, rho, s, s_q, r1, r2, r3, r4 = law_at(q, law)
        known[0, c], known[1, c], known[2, c], known[3, c] = q, rho, s, s_q
        known[4, c], known[5, c], known[6, c], known[7, c] = r1, r2, r3, r4
        known[8, c] = NEAR * min(s / abs(s_q), 4.0 * r1 / abs(r2))


@njit(cache=True, inline="always")
def _within(x, lowest, highest):
    if not x > lowest:
        return lowest
    return x if x < highest else highest


@njit(cache=True, fastmath=FAST)
def _ratio_near(x, scale, lowest, highest, known, rho_out):
    """Density ratio by what is known; returns how many pressures are far from it."""
    at, rho, r1, r2, r3, r4, reach = known[0], known[1], known[4], known[5], known[6], known[7], known[8]
    far = 0.0
    for c in range(rho_out.size):
        y = x[c] if x[c] > lowest else lowest
        q = (y if y < highest else highest) * scale
        d = q - at[c]
        far += 0.0 if (abs(d) <= reach[c]) & ((q > 0.0) == (at[c] > 0.0)) else 1.0
        rho_out[c] = rho[c] + d * (r1[c] + d * (r2[c] + d * (r3[c] + d * r4[c])))
    return far


@njit(cache=True, fastmath=FAST)
def density_slope_at(P, scale, floor, law, known, rho_P_out):
    """Derivative (n, m) of the density ratio to P at the pressures of the last `density_at`; 0 where it stays."""
    x, slope = P.reshape(-1), rho_P_out.reshape(-1)
    lowest, highest = max(floor, law.lowest / scale), law.highest / scale
    at, r1, r2, r3, r4 = known[0], known[4], known[5], known[6], known[7]
    for c in range(slope.size):
        y = x[c] if x[c] > lowest else lowest
        d = (y if y < highest else highest) * scale - at[c]
        by_pressure = scale * (r1[c] + d * (2.0 * r2[c] + d * (3.0 * r3[c] + 4.0 * d * r4[c])))
        slope[c] = by_pressure if (x[c] >= lowest) & (x[c] < highest) else 0.0
