"""Density at the vertices of a film from transformed pressures; the law is in `density`.

The iterations of a film, and one film after the other, ask for the law at nearly the same pressures again and again. So
every vertex remembers a pressure at which the law is known with its derivatives, ``known`` (6, size): transformed
pressure q, p, s = dp/dq and s's first three derivatives; Taylor's polynomial about it is the law near by, in loops that
the compiler vectorises.

Symbols: P scaled transformed pressures (n, m), ``scale`` Pa per unit of P, ``floor`` the scaled pressure below which
the density stays.
"""

from numba import njit

from exudyn_ehd.film.lubricant.density import density_ratio
from exudyn_ehd.film.lubricant.pressure_viscosity import hermite_fourth_at

# Change of dp/dq, as a share, up to which Taylor's polynomial about a known value is the law: to 1e-14 in the density,
# which the balance is solved with, and 1e-10 in its slope.
NEAR = 5e-4
# Tension times the density's coefficient, of a p, up to which five terms of exp(a p) are the exponential to rounding.
WEAK = 1e-3
_FAST = {"reassoc", "contract", "nsz", "arcp"}


@njit(cache=True)
def density_at(P, scale, floor, law, known, rho_out):
    """Density ratio (n, m); what is not known near by is looked up. Beyond the law's range it is that at its end."""
    x, rho = P.reshape(-1), rho_out.reshape(-1)
    lowest, highest = max(floor, law.lowest / scale), law.highest / scale
    far, tense = _ratio_near(x, scale, lowest, highest, law.a, law.b, known, rho)
    if far > 0.0:
        look_up(x, scale, lowest, highest, law, NEAR, known)
        far, tense = _ratio_near(x, scale, lowest, highest, law.a, law.b, known, rho)
    if tense > 0.0:
        for c in range(rho.size):
            p, _ = _taylor(x[c], scale, lowest, highest, known, c)
            rho[c] = density_ratio(p, law.a, law.b)[0]


@njit(cache=True)
def density_slope_at(P, scale, floor, law, known, rho_P_out):
    """Derivative (n, m) of the density ratio to P at the pressures of the last `density_at`; 0 where it stays."""
    x, slope = P.reshape(-1), rho_P_out.reshape(-1)
    lowest, highest = max(floor, law.lowest / scale), law.highest / scale
    tense = _slope_near(x, scale, lowest, highest, law.a, law.b, known, slope)
    if tense > 0.0:
        for c in range(slope.size):
            p, s = _taylor(x[c], scale, lowest, highest, known, c)
            inside = lowest <= x[c] < highest
            slope[c] = scale * s * density_ratio(p, law.a, law.b)[1] if inside else 0.0


@njit(cache=True)
def know_at(P, scale, floor, law, known):
    """Know the law at the pressures (n, m) of a solution, so that tangents do not depend on the film before."""
    look_up(P.reshape(-1), scale, max(floor, law.lowest / scale), law.highest / scale, law, 0.0, known)


@njit(cache=True)
def look_up(x, scale, lowest, highest, law, near, known):
    """Know the law at all x (size,), cut at ``lowest`` and ``highest``, that are not ``near`` what is known."""
    for c in range(x.size):
        q = _within(x[c], lowest, highest) * scale
        if not _is_near(q, known, c, near):
            known[0, c] = q
            known[1, c], known[2, c], known[3, c], known[4, c], known[5, c] = hermite_fourth_at(
                q, law.exponent, law.q, law.table, law.bucket, law.bucket_scale
            )


@njit(cache=True, inline="always")
def _within(x, lowest, highest):
    if not x > lowest:
        return lowest
    return x if x < highest else highest


@njit(cache=True, inline="always")
def _is_near(q, known, c, near):
    return abs((q - known[0, c]) * known[3, c]) <= near * known[2, c] and (q > 0.0) == (known[0, c] > 0.0)


@njit(cache=True, inline="always")
def _taylor(x, scale, lowest, highest, known, c):
    """p and s at x."""
    d = _within(x, lowest, highest) * scale - known[0, c]
    p, s, s_q, s_qq, s_3 = known[1, c], known[2, c], known[3, c], known[4, c], known[5, c]
    return (
        p + d * (s + d * (0.5 * s_q + d * (s_qq / 6.0 + d * s_3 / 24.0))),
        s + d * (s_q + d * (0.5 * s_qq + d * s_3 / 6.0)),
    )


# Checks for a division by zero would keep the compiler from vectorising the next ones.
@njit(cache=True, fastmath=_FAST, error_model="numpy")
def _ratio_near(x, scale, lowest, highest, a, b, known, rho_out):
    """Density ratio, strong tension excepted; counts what is far from known pressures, and what is in such tension."""
    at, p, s, s_q, s_qq, s_3 = known[0], known[1], known[2], known[3], known[4], known[5]
    far = 0.0
    tense = 0.0
    for c in range(rho_out.size):
        y = x[c] if x[c] > lowest else lowest
        q = (y if y < highest else highest) * scale
        d = q - at[c]
        value = p[c] + d * (s[c] + d * (0.5 * s_q[c] + d * (s_qq[c] * (1.0 / 6.0) + d * s_3[c] * (1.0 / 24.0))))
        far += 0.0 if (abs(d * s_q[c]) <= NEAR * s[c]) & ((q > 0.0) == (at[c] > 0.0)) else 1.0
        e = a * value
        tense += 0.0 if e >= -WEAK else 1.0
        # 1 / (1 + b p), or what follows from exp(a p) for p < 0
        less = 1.0 / (1.0 + (b * value if e >= 0.0 else 0.0))
        more = 1.0 + e * (0.5 + e * (1.0 / 6.0 + e * (1.0 / 24.0 + e * (1.0 / 120.0))))
        rho_out[c] = 1.0 + e * (less if e >= 0.0 else more)
    return far, tense


@njit(cache=True, fastmath=_FAST, error_model="numpy")
def _slope_near(x, scale, lowest, highest, a, b, known, rho_P_out):
    """Derivative of the density ratio, strong tension excepted; returns how many are in it."""
    at, p, s, s_q, s_qq, s_3 = known[0], known[1], known[2], known[3], known[4], known[5]
    tense = 0.0
    for c in range(rho_P_out.size):
        y = x[c] if x[c] > lowest else lowest
        d = (y if y < highest else highest) * scale - at[c]
        value = p[c] + d * (s[c] + d * (0.5 * s_q[c] + d * (s_qq[c] * (1.0 / 6.0) + d * s_3[c] * (1.0 / 24.0))))
        slope = s[c] + d * (s_q[c] + d * (0.5 * s_qq[c] + d * s_3[c] * (1.0 / 6.0)))
        e = a * value
        tense += 0.0 if e >= -WEAK else 1.0
        less = 1.0 / (1.0 + (b * value if e >= 0.0 else 0.0))
        more = 1.0 + e * (1.0 + e * (0.5 + e * (1.0 / 6.0 + e * (1.0 / 24.0))))
        by_pressure = a * scale * slope * (less * less if e >= 0.0 else more)
        rho_P_out[c] = by_pressure if (x[c] >= lowest) & (x[c] < highest) else 0.0
    return tense
