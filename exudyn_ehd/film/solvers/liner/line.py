"""Rupture line inside the cells of a film whose gap, density or conductances follow its pressure.

Symbols of `exudyn_ehd.film.cavitation.rupture_line`. At the line the pressure is the cavity pressure, with zero
gradient and zero rate. So f and k are those of a film at the cavity pressure everywhere: of its density, of its
conductances without pressure flow, and of its liner at rest. They do not follow the pressure. N therefore depends on
the pressure of its own vertex alone, and the balances stay as monotone as they are.

A liner of compliance beta lifts the bore from the line on. The Couette flow that its deflection adds is counted as
conductance, ``k + beta |vx| width / 2``. With it, a vertex joins the film exactly when the vertex before it is full.
Where the pressures within one cell change the gap h itself, by ``t h`` with ``t = beta f / (2 k h)``, the grid is too
coarse for the parabola. There f becomes ``f / (1 + t^2)``, and the line moves to the vertices as h vanishes.

A film that conserves mass has the curve of `exudyn_ehd.film.cavitation.oil_line`, with f, k and o of the same film at
the cavity pressure. In front of the line its flow over the middle of the link is ``o + f (s - 1/2)``. The scheme's flow
there is ``fill (o + beta |vx| width p / 2) + k p``, since the pressure p of the vertex deflects the liner by
``beta p / 2``. With ``K = k + beta |vx| width / 2`` the equations are those between rigid surfaces,

    p = f s^2 / (2 K),    fill = 1 - (f / (2 o)) (1 - s)^2,

up to the deflection times the missing fill, which is of third order of the cell. As f is bounded by o, p deflects the
liner by less than the gap, and no bound by t is needed. Where the density follows the pressure, f and o are mass flows
with the density of the cavity, and k is that of the transformed pressure.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from exudyn_ehd.film.banded.workspace import Workspace
from exudyn_ehd.film.cavitation.oil_line import Curve, OilLine, curve_terms, straight
from exudyn_ehd.film.cavitation.rupture_line import Line, LineGradients, RuptureLine, line_terms, to_true_gap
from exudyn_ehd.film.cavitation.system import FilmSystem
from exudyn_ehd.film.reynolds.balance import terms_of
from exudyn_ehd.film.reynolds.links import LinkFlux, add_squeeze, right_hand_side
from exudyn_ehd.film.solvers.liner.line_kernels import add_yielding, see_line, weigh_yielding


class GapChain(NamedTuple):
    """Derivatives of the gaps that the film sees, (n, m) each: ``slope`` to the true gap, ``bend`` second derivative to
    it times its rate, ``face_slope`` to it on links in theta. ``follow``: of the deflection to the gap of the
    undeformed surfaces."""

    slope: np.ndarray
    bend: np.ndarray
    face_slope: np.ndarray
    follow: np.ndarray


class OilFilmLine(OilLine):
    """Rupture line of a mass-conserving film on a liner; further attributes as for `FilmLine`.

    Attributes
    ----------
    kept : (n, m) array
        ``late`` of the film without curves.
    """

    def __init__(self, shape: tuple[int, int]) -> None:
        super().__init__(shape)
        self.gaps, self.kept = np.ones((2, *shape)), np.zeros(shape)
        self.flux: LinkFlux | None = None
        self.chain: GapChain | None = None
        self.touching = np.zeros(shape, dtype=np.bool_)

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
        """Set the curves from the fields of `LinerFilm` at the cavity pressure; parameters as for `FilmLine.see`."""
        self.lift_by_speed = 0.5 * beta * np.sign(vx) * widths[1]
        film, c = terms_of(term_fields, fixed), self.fields
        self.gaps[:], film.kx[self.touching] = gap_fields[:2], 0.0
        right_hand_side(film.fx, film.fz, b)
        if squeeze:
            add_squeeze(gap_fields[4], *widths, b)
        curve_terms(film, b, c)
        c.k[:] += np.tile(self.lift_by_speed * vx, len(b))
        c.f[:], c.out[:] = self.density * c.f, self.density * c.out
        np.divide(0.5 * c.f, c.k, out=c.whole, where=c.f > 0.0)

    def straighten(self, s: FilmSystem) -> None:
        """Remove the curves of all vertices, and take over ``late`` of the flows."""
        np.multiply(s.late, s.prompt < 1.0, out=self.kept)
        self.late[:], self.fields.s[:] = self.kept, 1.0
        self.fields.slope[:] = self.fields.rise[:] = 0.0

    def gradients(
        self,
        gaps: tuple[np.ndarray, np.ndarray],
        flux: LinkFlux | None,
        speeds: tuple[float, float],
        flow_x: float,
        squeeze: bool,
        mesh: tuple[np.ndarray, ...],
    ) -> tuple[LineGradients, LineGradients]:
        """Return `OilLine.gradients` to the undeformed gaps, with the stored gaps and flux of the cavity."""
        carried, held = super().gradients((self.gaps[0], self.gaps[1]), self.flux, speeds, flow_x, squeeze, mesh)
        if self.chain is None:
            return carried, held
        return undeformed(carried, self.chain), undeformed(held, self.chain)


class FilmLine(RuptureLine):
    """Rupture line of a film on a liner, or of one whose conductances or density follow the pressure.

    Attributes
    ----------
    curve : (9, n m) array
        Fields of the `Curve` of its vertices, as kernels take them.
    gaps : (2, n, m) array
        Gaps at vertices and links, at the cavity pressure.
    flux : LinkFlux or None
        Coefficients of the links there; None of a plain film.
    chain : GapChain or None
        Derivatives of the gaps there; None without contact and gap limiter.
    """

    def __init__(self, shape: tuple[int, int]) -> None:
        super().__init__(shape)
        self.curve = straight(shape)
        self.gaps = np.ones((2, *shape))
        self.flux: LinkFlux | None = None
        self.chain: GapChain | None = None
        self.density = 1.0
        # where surfaces touch at the cavity's pressure; t of the module, and (compliance, vx, widths) of the liner
        self.touching, self.lean = np.zeros(shape, dtype=np.bool_), np.zeros(shape)
        self.liner = 0.0, 0.0, np.zeros(shape[1])

    def take(self, gaps: tuple[np.ndarray, np.ndarray], kx: np.ndarray, b: np.ndarray, fixed: np.ndarray) -> None:
        """Set f and k from the film's gaps, conductances and right-hand side (n, m) at the cavity pressure."""
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
        """Set f, k, t and the gaps from the fields of `LinerFilm` at the cavity pressure.

        ``beta``: scaled compliance of the liner; ``widths`` of the vertices in theta and z.
        """
        self.liner = beta, vx, widths[1]
        see_line(
            gap_fields, term_fields, self.touching, b, squeeze, widths, fixed, self.density, (beta, vx), self.block,
            self.gaps, self.lean,
        )  # fmt: skip
        line, curve = Line(*self.block), Curve(*self.curve)
        curve.f[:], curve.k[:], curve.whole[:] = line.f, line.k, line.whole

    def settle(self, active: np.ndarray) -> None:
        """Set s of the ``active`` vertices (n, m) from the curves of the solved film, 1 elsewhere."""
        np.copyto(self.s, np.where(active, Curve(*self.curve).s.reshape(active.shape), 1.0))

    def weights(self, places: np.ndarray) -> np.ndarray:
        """Derivatives as of `RuptureLine.weights`, for a film of this density on its liner."""
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
        """Return `RuptureLine.gradients` to the undeformed gaps, with the stored gaps and flux of the cavity."""
        line = super().gradients(work, (self.gaps[0], self.gaps[1]), self.flux, speeds, flow_x, squeeze, mesh)
        add_yielding(line.places, self.block, self.lean, self.gaps[1], self.liner, line.by)
        return line if self.chain is None else undeformed(line, self.chain)


def undeformed(line: LineGradients, chain: GapChain) -> LineGradients:
    """Convert gradients to the film's gap to gradients to the undeformed gap, with a contact or a limiter."""
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
