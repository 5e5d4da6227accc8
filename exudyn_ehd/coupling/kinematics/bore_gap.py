"""Smallest gap between a journal and its rigid bore, circular or not.

With the journal's axis at (x, y) + z (b_x, b_y) the gap is c - (x + z b_x) cos theta - (y + z b_y) sin theta and what
the bore's profiles add. Its smallest value in a circular bore is c less the larger eccentricity of the two ends.
"""

from __future__ import annotations

import math

import numpy as np

from exudyn_ehd.bearing import JournalBearing

# Points around and along a bore that is no circular cylinder.
AROUND, ALONG = 180, 9


class BoreGap:
    """Gap of one bearing's rigid surfaces.

    Parameters
    ----------
    bearing : JournalBearing

    Attributes
    ----------
    widest : float
        Largest gap of a journal in the bore's axis, m.
    """

    def __init__(self, bearing: JournalBearing) -> None:
        self.clearance, self.half = bearing.radial_clearance, 0.5 * bearing.length
        self.widest, self.depth = self.clearance, np.empty(0)
        profiles = getattr(bearing, "profiles", ())
        if profiles:
            theta = np.linspace(0.0, 2.0 * math.pi, AROUND, endpoint=False)
            z = np.linspace(-self.half, self.half, ALONG)
            self.depth = sum((profile.depth(theta, z, bearing.length) for profile in profiles), np.zeros(1))
            self.widest += float(self.depth.max())
            ones = np.ones(ALONG)
            c, s = np.cos(theta)[:, None], np.sin(theta)[:, None]
            self.normals = np.stack((c * ones, s * ones, c * z, s * z), axis=-1)
        # what is no cylinder knows its own
        own = getattr(bearing, "gap_normals", None)
        if own is not None:
            self.normals = own()
            self.depth = np.zeros(len(self.normals))

    def smallest(self, motion: np.ndarray) -> float:
        """Smallest gap [m] at a motion (10,) of the journal's axis; negative where the surfaces overlap."""
        if self.depth.size:
            return float(self.values(motion).min())
        x, y, bx, by = motion[:4].tolist()
        half = self.half
        ends = max((x + bx * half) ** 2 + (y + by * half) ** 2, (x - bx * half) ** 2 + (y - by * half) ** 2)
        return self.clearance - math.sqrt(ends)

    def values(self, motion: np.ndarray) -> np.ndarray:
        """Gaps [m] all over a bore with profiles."""
        return self.clearance + self.depth - self.normals @ motion[:4]
