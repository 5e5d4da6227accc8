"""Heat from a film's mean temperature through both of its surfaces.

Across the film lies a parabola with the mean T and the surfaces' s_1, s_2. It passes

    q_1 = kappa (6 T - 4 s_1 - 2 s_2),    q_2 = kappa (6 T - 4 s_2 - 2 s_1),    kappa = k / h,

as from T(y) = s_1 + b y + d y^2 with its mean T, q_1 = k T'(0) and q_2 = -k T'(h). Uniform heating makes this profile.
"""

from __future__ import annotations

import numpy as np


class Passage:
    """Linear in the mean temperature and in what both sides have: ``q_a = to[a] T - sum over b of by[a][b] T_b``.

    A side of a given coefficient has ``q = U (s - T_wall)``, one that conducts by itself ``s = T_wall``.

    Parameters
    ----------
    kappa, area : (n, m) arrays
        k / h, W/(m2 K), and m2 of the vertices.
    coefficients : (float or None, float or None)
        U of both sides, W/(m2 K); None: the surface has the wall's temperature.

    Attributes
    ----------
    to, by : lists of (n, m) arrays, lists of such lists
        W/K.
    transfer : (n, m) array
        Of both sides together, W/K.
    """

    def __init__(self, kappa: np.ndarray, area: np.ndarray, coefficients: tuple[float | None, float | None]) -> None:
        # rows of both surfaces: own s_a + 2 kappa meets s_b = 6 kappa meets T + given T_a
        own = [np.ones_like(kappa) if U is None else 4.0 * kappa + U for U in coefficients]
        meets = [0.0 if U is None else 1.0 for U in coefficients]
        given = [1.0 if U is None else U for U in coefficients]
        determinant = own[0] * own[1] - 4.0 * kappa**2 * meets[0] * meets[1]
        self.to, self.by = [], []
        surface, mean = [], []
        for a, b in ((0, 1), (1, 0)):
            mean.append(6.0 * kappa * (own[b] * meets[a] - 2.0 * kappa * meets[a] * meets[b]) / determinant)
            parts = [own[b] * given[a] / determinant, -2.0 * kappa * meets[a] * given[b] / determinant]
            surface.append(parts if a == 0 else parts[::-1])
        for a, b in ((0, 1), (1, 0)):
            self.to.append(area * kappa * (6.0 - 4.0 * mean[a] - 2.0 * mean[b]))
            self.by.append([area * kappa * (4.0 * surface[a][k] + 2.0 * surface[b][k]) for k in (0, 1)])
        self.transfer = self.to[0] + self.to[1]

    def gain(self, at: list[np.ndarray]) -> np.ndarray:
        """What both sides give at their temperatures to a film of none (n, m), W."""
        return sum((self.by[0][k] + self.by[1][k]) * at[k] for k in (0, 1))

    def heat(self, T: np.ndarray, at: list[np.ndarray]) -> list[np.ndarray]:
        """Heat into both sides (n, m), W."""
        return [self.to[a] * T - self.by[a][0] * at[0] - self.by[a][1] * at[1] for a in (0, 1)]
