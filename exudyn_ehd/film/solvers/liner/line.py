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
from exudyn_ehd.film.cavitation.rupture_line import Line, LineGradients, RuptureLine, line_terms, to_true_gap
from exudyn_ehd.film.reynolds.links import LinkFlux
from exudyn_ehd.film.solvers.liner.line_kernels import add_yielding, see_line, weigh_yielding


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
        # where surfaces touch at the cavity's pressure; t of the module, and (compliance, vx, widths) of the liner
        self.touching, self.lean = np.zeros(shape, dtype=np.bool_), np.zeros(shape)
        self.liner = 0.0, 0.0, np.zeros(shape[1])

    def take(self, gaps: tuple[np.ndarray, np.ndarray], kx: np.ndarray, b: np.ndarray, fixed: np.ndarray) -> None:
        """f and k from the film's gaps, conductances and right-hand side (n, m) at the cavity's pressure."""
        self.gaps[:], self.s[:] = gaps, 1.0
        line_terms(kx, self.density * b, fixed, True, self.block)

    def see(
        self,
        gap_fields: np.ndarray,
        term_fields: np.ndarray,
        b: np.ndarray,
        squeeze: bool,
        widths: tuple[np.ndarray, np.ndarray],
        fixed: np.ndarray,
        beta: float,
        vx: float,
    ) -> None:
        """As `take` from the fields of `LinerFilm` at the cavity's pressure, on its liner of scaled compliance
        ``beta``; ``widths`` of the vertices in theta and z."""
        self.liner = beta, vx, widths[1]
        see_line(
            gap_fields, term_fields, self.touching, b, squeeze, widths, fixed, self.density, (beta, vx), self.block,
            self.gaps, self.lean,
        )  # fmt: skip

    def settle(self, active: np.ndarray) -> None:
        """The line of the film that is solved, among its ``active`` vertices (n, m)."""
        self.s[~active] = 1.0

    def weights(self, places: np.ndarray) -> np.ndarray:
        """As `RuptureLine.weights`, of a film with this density, on its liner."""
        out = super().weights(places)
        weigh_yielding(places, self.f, self.k, self.lean, out)
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
        add_yielding(line.places, self.block, self.lean, self.gaps[1], self.liner, line.by)
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
