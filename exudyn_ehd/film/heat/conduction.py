"""Heat in the wall of a bush or of a journal: rings of finite volumes around the axis, a column for each of the film's.

    rho c dT/dt = k (1/r d/dr (r dT/dr) + 1/r^2 d2T/dtheta2) - loss

Vertices lie evenly from the film's surface to the far one, with half a ring at either. The conductance between two of
them is that of the logarithmic profile, k times angle and length over ln(r2 / r1), so that what flows steadily and the
same all around is exact; the rest is of second order in radius and angle. Backward Euler in time, first order.

Around the axis the system is the same at every angle, so that its Fourier coefficients are independent: each is a
small system along the radius, condensed onto the film's surface.

Heat from a film's mean temperature through both of its surfaces.

Across the film lies a parabola with the mean T and the surfaces' s_1, s_2. It passes

    q_1 = kappa (6 T - 4 s_1 - 2 s_2),    q_2 = kappa (6 T - 4 s_2 - 2 s_1),    kappa = k / h,

as from T(y) = s_1 + b y + d y^2 with its mean T, q_1 = k T'(0) and q_2 = -k T'(h). Uniform heating makes this profile.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from exudyn_ehd.film.heat.options import Conduction


@dataclass(frozen=True, eq=False)
class Walls:
    """Temperatures of a bearing's walls, K, and what they make of the clearance.

    Attributes
    ----------
    bush : (n, k) array or None
        At every angle of the film, from the bore outward; None for a bush that does not conduct.
    journal : (k,) array or None
        From the surface inward; None for a journal that does not conduct.
    bush_radii, journal_radii : (k,) arrays or None
        Where, m.
    clearance : float
        Radial, with what the walls have grown by, m.
    across : (3, n, m) array or None
        Of a film with two temperatures across it: the tilt, half of what its straight part rises by from bush to
        journal, and the surfaces' temperatures, bush and journal, K.
    """

    bush: np.ndarray | None
    journal: np.ndarray | None
    bush_radii: np.ndarray | None
    journal_radii: np.ndarray | None
    clearance: float
    across: np.ndarray | None = None

    def across_film(self, temperature: float | np.ndarray) -> np.ndarray:
        """Temperatures of a film of these walls, K: its own (n, m), or (n, m, 4) at Lobatto's points across it."""
        if self.across is None:
            return np.asarray(temperature)
        # imported here: other films have no profile across them
        from exudyn_ehd.film.heat.across import at_points

        return at_points(np.array([temperature, *self.across]))

    def numbers(self, area: np.ndarray) -> dict[str, float]:
        """Mean temperatures at the film, whose vertices have areas (n, m), K, of walls that conduct; clearance, m."""
        out = {"clearance": self.clearance}
        if self.across is not None:
            means = np.tensordot(self.across[1:], area / area.sum(), 2)
            out["bush_temperature"], out["journal_temperature"] = means.tolist()
        if self.bush is not None:
            out["bush_temperature"] = float(np.mean(self.bush[:, 0]))
        if self.journal is not None:
            out["journal_temperature"] = float(self.journal[0])
        return out

    def at(self, bush: float, journal: float) -> Walls:
        """Walls of these temperatures throughout, K."""
        own, turning = (
            None if T is None else np.full_like(T, value) for T, value in ((self.bush, bush), (self.journal, journal))
        )
        across = self.across
        if across is not None:
            across = np.stack([np.full_like(across[0], T) for T in (0.5 * (journal - bush), bush, journal)])
        return replace(self, bush=own, journal=turning, across=across)

    def behind(self, temperature: float | np.ndarray) -> np.ndarray:
        """The film's temperatures (n, m) with those of the walls behind them, as a film remembers them."""
        T = [np.asarray(temperature)]
        T += [] if self.across is None else [T[0] + self.across[0], *self.across[1:]]
        T += [] if self.bush is None else [self.bush]
        if self.journal is not None:
            T.append(np.tile(self.journal, (len(T[0]), 1)))
        return np.hstack(T)


class Rings:
    """One wall on the columns of a film; temperatures are rises over the ambient, K.

    Parameters
    ----------
    wall : Conduction
    radius, length : float
        Of the film's surface, m.
    columns : int
        Around the axis; 1: a wall that turns fast against the heat, with the same temperature at every angle.
    inward : bool
        Whether it is a journal, which gives its heat off all over its section; a bush does so at its far surface.

    Attributes
    ----------
    radii : (k,) array
        Of the vertices, from the film's surface on, m.
    share : (k,) array
        Of each ring in the section.
    loss : (k,) array
        To the ambient, W/K for a column.
    stiffness : (columns // 2 + 1,) array
        Heat into the surface per kelvin of its temperature, W/K for a column, by Fourier coefficient.
    """

    def __init__(self, wall: Conduction, radius: float, length: float, columns: int, inward: bool) -> None:
        self.columns, far = columns, radius - wall.thickness if inward else radius + wall.thickness
        self.radii = r = np.linspace(radius, max(far, 0.0), wall.rings + 1)
        bounds = np.concatenate((r[:1], 0.5 * (r[1:] + r[:-1]), r[-1:]))
        angle = 2.0 * math.pi / columns
        section = np.abs(np.diff(bounds**2))
        self.share = section / section.sum()
        self.capacity = wall.density * wall.specific_heat * length * 0.5 * angle * section
        with np.errstate(divide="ignore"):
            self.radial = wall.conductivity * length * angle / np.abs(np.diff(np.log(r)))
            around = wall.conductivity * length / angle * np.abs(np.diff(np.log(bounds)))
        if r[-1] == 0.0:  # the innermost pair by the radius between them
            self.radial[-1] = 0.5 * wall.conductivity * length * angle
        self.loss = wall.conductance / columns * (self.share if inward else np.eye(r.size)[-1])
        waves = 2.0 - 2.0 * np.cos(angle * np.arange(columns // 2 + 1))
        # of one column there is nothing to conduct around
        self.around = np.outer(waves, around) if columns > 1 else np.zeros((1, r.size))
        self.step = math.nan

    def bring_to(self, step: float) -> None:
        """Condense the system of a step, s; 0: of the steady wall."""
        if step == self.step:
            return
        self.step, self.store = step, self.capacity / step if step > 0.0 else np.zeros_like(self.capacity)
        size, k = self.radii.size, np.arange(self.radii.size - 1)
        radial = np.zeros((size, size))
        radial[k, k + 1] = radial[k + 1, k] = -self.radial
        np.fill_diagonal(radial, -radial.sum(axis=1))
        matrix = radial + np.eye(size) * (self.around + self.store + self.loss)[:, None, :]
        self.inner = np.linalg.inv(matrix[:, 1:, 1:])
        self.stiffness = matrix[:, 0, 0] - self.radial[0] ** 2 * self.inner[:, 0, 0]

    def matrix(self) -> np.ndarray:
        """Heat into every column's surface, W, per kelvin of the surface's temperatures (columns, columns)."""
        row = np.fft.irfft(self.stiffness, self.columns) if self.columns > 1 else self.stiffness
        k = np.arange(self.columns)
        return row[(k[:, None] - k) % self.columns]

    def remembered(self, old: np.ndarray) -> np.ndarray:
        """Heat out of the surface (columns,), W, that old temperatures (columns, k) give at a surface of no rise."""
        known = np.fft.rfft(self.store * old, axis=0)
        first = known[:, 0] + self.radial[0] * np.einsum("pk,pk->p", self.inner[:, 0], known[:, 1:])
        return np.fft.irfft(first, self.columns) if self.columns > 1 else first.real

    def behind(self, surface: np.ndarray, old: np.ndarray) -> np.ndarray:
        """Temperatures (columns, k) at the end of the step with those of the surface (columns,)."""
        known = np.fft.rfft(self.store * old, axis=0)
        known[:, 1] += self.radial[0] * np.fft.rfft(surface)
        inner = np.einsum("pij,pj->pi", self.inner, known[:, 1:])
        inside = np.fft.irfft(inner, self.columns, axis=0) if self.columns > 1 else inner.real
        return np.column_stack((surface, inside))


def through_surfaces(
    kappa: np.ndarray | None, area: np.ndarray, outward: tuple[float | None, float | None]
) -> np.ndarray:
    """Heat into both surfaces (2, n, m, 3), W, per kelvin of the mean temperature and of those outside.

    A surface of a given coefficient has ``q = U (s - T_outside)``, one that conducts by itself ``s = T_outside``.

    Parameters
    ----------
    kappa, area : (n, m) arrays
        k / h, W/(m2 K), and m2 of the vertices; without a kappa the film has one temperature over its height.
    outward : (float or None, float or None)
        U of both surfaces, W/(m2 K); None: the surface has the temperature outside.
    """
    if kappa is None or outward == (0.0, 0.0):
        rows = np.array([[1.0, -1.0, 0.0], [1.0, 0.0, -1.0]])[..., None, None]
        return np.moveaxis(np.array([U or 0.0 for U in outward])[:, None, None, None] * rows * area, 1, -1)
    meets = [0.0 if U is None else 1.0 for U in outward]
    given = [1.0 if U is None else U for U in outward]
    # rows of both surfaces: own s_a + 2 kappa meets s_b = known
    own = [4.0 * kappa * meet + U for meet, U in zip(meets, given, strict=True)]
    known = np.zeros((2, 3, *kappa.shape))
    for side in (0, 1):
        known[side, 0] = 6.0 * kappa * meets[side]
        known[side, 1 + side] = given[side]
    determinant = own[0] * own[1] - 4.0 * kappa * kappa * meets[0] * meets[1]
    s = np.array([(own[1 - a] * known[a] - 2.0 * kappa * meets[a] * known[1 - a]) / determinant for a in (0, 1)])
    through = -4.0 * s - 2.0 * s[::-1]
    through[:, 0] += 6.0
    return np.moveaxis(kappa * area * through, 1, -1)
