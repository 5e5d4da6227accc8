"""Average gap of rough surfaces: what a film sees between asperities, positive and smooth wherever surfaces touch.

Two rough surfaces with a nominal gap h and Gaussian combined roughness s of standard deviation sigma leave, where peaks
that would overlap are flattened, the average gap (Patir and Cheng, J. Lubrication Technology 100 (1978) 12, with a
Gaussian)

    h_T = E[max(h + s, 0)] = h Phi(h / sigma) + sigma phi(h / sigma),      dh_T/dh = Phi(h / sigma).

Here touching spots keep a residual film a sigma, so that pockets that close do not shear without bound:

    h_T = E[max(h + s, a sigma)] = a sigma + sigma t(h / sigma - a),       t(x) = x Phi(x) + phi(x).

The two agree for a = 0; at h = 0 the film is 0.399 sigma, and 0.409 sigma with a = 0.02.

Symbols: H gap over the clearance, sigma roughness over the clearance, Phi and phi the normal distribution and its
density.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from scipy.special import ndtr

from exudyn_ehd.film.surfaces.contact import GapLimiter

# Beyond this many sigma the average gap equals the nominal one (to 2e-13 sigma).
SMOOTH_BEYOND = 7.0
# Beginning of the hint on a composite roughness that can't be meant.
ROUGHNESS = "it is the standard deviation of both surfaces' heights together; leave smooth surfaces out with"
_INVERSE_ROOT_2 = 1.0 / math.sqrt(2.0)
_INVERSE_ROOT_2_PI = 1.0 / math.sqrt(2.0 * math.pi)


class AverageGap(GapLimiter):
    """Gap limiter of rough surfaces.

    Parameters
    ----------
    sigma : float
        Combined roughness divided by the clearance.
    residual : float
        Residual film a, share of sigma.
    """

    def __init__(self, sigma: float, residual: float) -> None:
        self.sigma = sigma
        self.residual = residual
        self.limits_below = SMOOTH_BEYOND * sigma

    def film_gap(self, gaps: np.ndarray, slopes: np.ndarray, bends: np.ndarray) -> None:
        """Average gap with its derivatives; as `GapLimiter`."""
        average_gap(gaps, self.sigma, self.residual, slopes, bends)


def average_gap_ratio(x: np.ndarray, residual: float) -> np.ndarray:
    """h_T / sigma for x = h / sigma."""
    y = np.asarray(x, dtype=float) - residual
    return residual + y * ndtr(y) + np.exp(-0.5 * y * y) * _INVERSE_ROOT_2_PI


@njit(cache=True)
def average_gap(gaps, sigma, residual, slopes, bends):
    """Average gaps of rough surfaces with their first two derivatives, in place."""
    g, slope, bend = gaps.reshape(-1), slopes.reshape(-1), bends.reshape(-1)
    for k in range(g.size):
        if g[k] <= SMOOTH_BEYOND * sigma:
            y = g[k] / sigma - residual
            density = _INVERSE_ROOT_2_PI * math.exp(-0.5 * y * y)
            # erfc keeps its relative accuracy deep below the mean line, where y Phi(y) + phi(y) cancels.
            slope[k] = 0.5 * math.erfc(-y * _INVERSE_ROOT_2)
            bend[k] = density / sigma
            g[k] = sigma * (residual + max(y * slope[k] + density, 0.0))
