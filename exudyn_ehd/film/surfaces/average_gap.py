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

# Beyond this many sigma the average gap equals the nominal one (to 2e-13 sigma).
SMOOTH_BEYOND = 7.0
_INVERSE_ROOT_2 = 1.0 / math.sqrt(2.0)
_INVERSE_ROOT_2_PI = 1.0 / math.sqrt(2.0 * math.pi)


class AverageGap:
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

    def limit(
        self,
        H: np.ndarray,
        HF: np.ndarray,
        H_t: np.ndarray,
        slope_out: np.ndarray,
        bend_out: np.ndarray,
        face_slope_out: np.ndarray,
    ) -> None:
        """Replace scaled gaps and the rate (n, m) by those of the average gap; as `seams.GapLimiter`."""
        average_gap(H, HF, H_t, self.sigma, self.residual, slope_out, bend_out, face_slope_out)


def average_gap_ratio(x: np.ndarray, residual: float) -> np.ndarray:
    """h_T / sigma for x = h / sigma."""
    y = np.asarray(x, dtype=float) - residual
    return residual + y * ndtr(y) + np.exp(-0.5 * y * y) * _INVERSE_ROOT_2_PI


@njit(cache=True)
def average_gap(H, HF, H_t, sigma, residual, slope_out, bend_out, face_slope_out):
    """Replace gaps at vertices and links by their average gaps and H_t by their rate, in place.

    First derivatives at both and the second one times the gap's rate come back, all (n, m).
    """
    n, m = H.shape
    limit = SMOOTH_BEYOND * sigma
    last = math.nan
    mean = share = curvature = 0.0
    for i in range(n):
        for j in range(m):
            h = H[i, j]
            if h > limit:
                slope_out[i, j] = 1.0
                bend_out[i, j] = 0.0
                continue
            if h != last:  # an aligned journal has one gap per column
                last = h
                mean, share, curvature = average_of(h, sigma, residual)
            H[i, j] = mean
            slope_out[i, j] = share
            bend_out[i, j] = curvature * H_t[i, j]
            H_t[i, j] *= share
        for j in range(m):
            h = HF[i, j]
            if h > limit:
                face_slope_out[i, j] = 1.0
                continue
            if h != last:
                last = h
                mean, share, curvature = average_of(h, sigma, residual)
            HF[i, j] = mean
            face_slope_out[i, j] = share


@njit(cache=True)
def average_of(h, sigma, residual):
    """Average gap of one gap h, with its first two derivatives; all scaled."""
    y = h / sigma - residual
    density = _INVERSE_ROOT_2_PI * math.exp(-0.5 * y * y)
    # erfc keeps its relative accuracy deep below the mean line, where y Phi(y) + phi(y) cancels.
    share = 0.5 * math.erfc(-y * _INVERSE_ROOT_2)
    return sigma * (residual + max(y * share + density, 0.0)), share, density / sigma
