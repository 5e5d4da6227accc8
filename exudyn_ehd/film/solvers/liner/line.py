"""Rupture line inside the cells of a film that `exudyn_ehd.film.solvers.newton` solves.

Symbols of `exudyn_ehd.film.cavitation.rupture_line`. On the line the pressure is the cavity's, it does not rise, and it
stays: f and k are those of a film that has the cavity's pressure everywhere, with its density, its conductances without
pressure flow, and its liner, which rests. They do not follow the pressure, so that N depends on that of its own vertex
alone and balances stay as monotone as they are.

A liner of compliance beta lifts the bore from the line on. What its deflection adds to the Couette flow counts as
conductance, ``k + beta |vx| width / 2``, with which a vertex joins just where the one before it is full. Where
pressures of one cell change the gap h itself, by ``t h`` with ``t = beta f / (2 k h)``, grids are too coarse to see the
parabola: there f becomes ``f / (1 + t^2)``, and the line lies on the vertices as h vanishes.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from exudyn_ehd.film.banded.workspace import Workspace
from exudyn_ehd.film.cavitation.rupture_line import LEAST, Line, LineGradients, RuptureLine, line_terms, to_true_gap
from exudyn_ehd.film.reynolds.links import LinkFlux
from exudyn_ehd.film.solvers.newton import RULE


class GapChain(NamedTuple):
    """Derivatives of the gaps that the film sees, (n, m) each: to the true gap, twice to it times its rate, on links
    in theta; ``follow``: of the deflection to the gap of the undeformed surfaces."""

    slope: np.ndarray
    bend: np.ndarray
    face_slope: np.ndarray
    follow: np.ndarray


class FilmLine(RuptureLine):
    """The rupture line of a film on a liner, or of one whose conductances or density follow the pressure.

    Attributes
    ----------
    state : tuple of arrays
        As `exudyn_ehd.film.solvers.liner.line_kernels` takes it.
    gaps : (2, n, m) array
        At vertices and links, at the cavity's pressure.
    flux : LinkFlux or None
        There; None of a plain film.
    chain : GapChain or None
        There; None where nothing but the film presses on the liner.
    """

    def __init__(self, shape: tuple[int, int]) -> None:
        super().__init__(shape)
        a = Line(*self.block)
        self.state = a.f, a.k, a.s, a.whole, a.shift, a.share
        self.gaps = np.ones((2, *shape))
        self.flux: LinkFlux | None = None
        self.chain: GapChain | None = None
        self.density = 1.0
        # derivatives of f to itself without a liner, to k, to the mean gap of the links, and of k to vx; None without
        self.yields: np.ndarray | None = None

    def take(self, gaps: tuple[np.ndarray, np.ndarray], kx: np.ndarray, b: np.ndarray, fixed: np.ndarray) -> None:
        """f and k from the film's gaps, conductances and right-hand side (n, m) at the cavity's pressure."""
        self.gaps[:], self.s[:] = gaps, 1.0
        line_terms(kx, self.density * b, fixed, True, self.block)

    def yield_to(self, beta: float, vx: float, width: np.ndarray) -> None:
        """f and k on a liner of scaled compliance ``beta``; ``width`` (m,) of the vertices."""
        f, k, whole = self.f, self.k, Line(*self.block).whole.reshape(self.f.shape)
        k += 0.5 * beta * abs(vx) * width
        there = f > 0.0
        k_there, gap = np.where(there, k, 1.0), 0.5 * (self.gaps[1] + np.roll(self.gaps[1], 1, axis=0))
        t = 0.5 * beta * f / (k_there * gap)
        held = 1.0 / (1.0 + t * t)
        turned = 2.0 * (t * held) ** 2
        by_speed = np.broadcast_to(0.5 * beta * np.sign(vx) * width, f.shape)
        self.yields = np.stack((held - turned, turned * f / k_there, turned * f / gap, by_speed))
        f *= held
        np.divide(0.5 * f, k_there, out=whole)

    def settle(self, active: np.ndarray) -> None:
        """The line of the film that is solved, among its ``active`` vertices (n, m)."""
        self.s[~active] = 1.0

    @property
    def factored(self) -> bool:
        """Whether the factor holds the line of the film that is solved."""
        a = Line(*self.block)
        k, s, shift, c = a.k, a.s, a.shift, np.flatnonzero(a.s < 1.0)
        place = np.maximum(s[c], LEAST)
        own = k[c] * (1.0 - place) / place
        return bool(np.all(np.abs(shift[c] - own) <= RULE.exact * (k[c] + own)) and np.count_nonzero(shift) == c.size)

    def weights(self, places: np.ndarray) -> np.ndarray:
        """As `RuptureLine.weights`, of a film with this density, on its liner."""
        out = super().weights(places)
        if self.yields is not None:
            by_f, by_k, _, _ = self.yields.reshape(4, -1)[:, places]
            out[1] -= out[0] * by_k
            out[0] *= by_f
        out[0] *= self.density
        return out

    def gradients(
        self,
        work: Workspace,
        gaps: tuple[np.ndarray, np.ndarray],
        flux: LinkFlux | None,
        speeds: tuple[float, float],
        flow_x: float,
        squeeze: bool,
        mesh: tuple[np.ndarray, ...],
    ) -> LineGradients:
        """As `RuptureLine.gradients`, to the gaps of the undeformed surfaces; gaps and flux are those of the cavity."""
        line = super().gradients(work, (self.gaps[0], self.gaps[1]), self.flux, speeds, flow_x, squeeze, mesh)
        if self.yields is not None:
            _, _, by_gap, by_speed = self.yields.reshape(4, -1)[:, line.places]
            line.by[:2] -= 0.25 * (1.0 - self.s.reshape(-1)[line.places]) * by_gap
            line.by[6] += self.weights(line.places)[1] * by_speed
        return line if self.chain is None else undeformed(line, self.chain)


def undeformed(line: LineGradients, chain: GapChain) -> LineGradients:
    """From the film's gap to that of the undeformed surfaces, of a liner that a contact presses as well."""
    n, m = chain.slope.shape
    out = to_true_gap(line, chain.slope, chain.bend, chain.face_slope)
    i, j = np.divmod(line.places, m)
    nxt, prv, here = (i + 1) % n, (i - 1) % n, chain.follow[i, j]
    # a link's deflection is the mean of its ends'
    around = 0.5 * np.stack((out.by[0] * chain.follow[nxt, j], out.by[1] * chain.follow[prv, j]))
    out.by[2] += out.by[2] * here + 0.5 * (out.by[0] + out.by[1]) * here
    out.by[3] *= 1.0 + chain.follow[i, (j + 1) % m]
    out.by[4] *= 1.0 + chain.follow[i, (j - 1) % m]
    return out._replace(by=np.concatenate((out.by, around)))
