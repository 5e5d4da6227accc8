"""Results of a solved film: pressure and viscosity by the oil's laws, factor, derivatives of its balances, and flows at
prescribed vertices."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.sparse import block_array, csc_matrix, diags_array

from exudyn_ehd.film.banded.substitution import solve_columns, solve_ldl, solve_lu, solve_lu_transposed
from exudyn_ehd.film.banded.workspace import dense_band
from exudyn_ehd.film.cavitation.rupture_line import AtLine, undeformed
from exudyn_ehd.film.lubricant.pressure_viscosity import PressureTransform
from exudyn_ehd.film.lubricant.shear_thinning import ShearThinning
from exudyn_ehd.film.reynolds.balance import FilmTerms, film_balance, linear_residual, link_derivatives
from exudyn_ehd.film.reynolds.gap import Gradients, join, link_rows
from exudyn_ehd.film.reynolds.links import ShearFactor
from exudyn_ehd.film.solvers.film import FilmArrays, end_films_of_areas
from exudyn_ehd.film.solvers.liner import LinerFilm
from exudyn_ehd.film.solvers.sets import factor_solution
from exudyn_ehd.film.supply.restrictors import Reservoirs, add_border

# Largest pressure over the largest one of the oil's law, if the solution lies beyond the end of the law. Larger values
# give first forces so large that solvers, which measure residuals relative to them, accept wrong states. Force and
# tangent are reduced by the same factor, so that Newton's step is unchanged.
LARGEST_OVERSHOOT = 10.0


class OilFields(NamedTuple):
    """Pressure, and viscosity ratio for the shear stress; fields (n, m).

    P : scaled pressure
    P_q : its derivative to the solver's unknown, the transformed pressure; None if they are the same
    ratio : viscosity over the reference; None if it is 1 everywhere
    ratio_q, ratio_h, ratio_v : derivatives to the unknown, H and vx; None where the ratio does not depend on it
    ratio_g : (2, n, m), derivatives to the unknown's gradients along theta and z, for a shear-thinning oil
    beyond : whether pressures lie beyond the end of the pressure law, where it is continued by a straight line; all
        fields are then reduced, see `LARGEST_OVERSHOOT`
    """

    P: np.ndarray
    P_q: np.ndarray | None = None
    ratio: np.ndarray | None = None
    ratio_q: np.ndarray | None = None
    ratio_h: np.ndarray | None = None
    ratio_v: np.ndarray | None = None
    beyond: bool = False
    ratio_g: np.ndarray | None = None


class FilmAnswers(FilmArrays):
    """Results of a solved film with its matrix A; attributes as for `FilmSolver`.

    With ``reservoirs``, A is the whole matrix of `exudyn_ehd.film.supply.restrictors`. Rows (., count + k) of unknowns
    or balances then hold the count vertices first, followed by the k areas.
    """

    elements: LinerFilm | None
    reservoirs: Reservoirs | None = None
    # cached result of `fill_gradients`
    _fills: tuple[Gradients, Gradients] | None = None
    # cached result of `reduced`: areas with a balance, B^T, C A^-1 and S
    _reduced: tuple[np.ndarray, ...] | None = None

    def oil_fields(self, law: PressureTransform | None, shear: ShearFactor | None) -> OilFields | None:
        """Pressure and viscosity ratio of the last solution; None if it lies beyond the range of a density law."""
        shape, scale = self.grid.shape, self.pressure_scale
        if law is None and shear is None:
            return OilFields(self.pressure)
        P, P_q, ratio, ratio_q, beyond = self.pressure, self.ones, self.ones, self.ones, False
        if law is not None:
            P, ratio, ratio_q = np.empty((3, *shape))
            beyond = not law.inverse(self.pressure * scale, P, ratio, ratio_q)
            # with a line inside the cells, clipped pressures differ from those at which rho was computed
            dense, rho = self.law, self.rho
            if dense is not None and self.closure.clips:
                rho = dense.density.ratio(np.minimum(P, dense.largest_pressure))
            P_q = ratio if dense is None else ratio / rho
            P /= scale
            ratio_q *= scale
            if self.law is not None and self.law.viscosity is None and shear is None:
                return None if beyond else OilFields(P, P_q)
        if beyond and law is not None:
            reduction = min(1.0, LARGEST_OVERSHOOT * law.largest_pressure / (P.max() * scale))
            for field in (P, ratio) if P_q is ratio else (P, ratio, P_q):
                field *= reduction
        if shear is None:
            return OilFields(P, P_q, ratio, ratio_q, self.nothing, self.nothing, beyond)
        factor, ratio_h, ratio_v = np.empty((3, *shape))
        slopes = shear.factor(self.H, self.vx, factor, ratio_h, ratio_v)
        if law is None:
            return OilFields(P, ratio=factor, ratio_h=ratio_h, ratio_v=ratio_v, ratio_g=slopes)
        for by in (ratio_h, ratio_v, slopes):
            if by is not None:
                by *= ratio
        ratio_q *= factor
        return OilFields(P, P_q, factor * ratio, ratio_q, ratio_h, ratio_v, beyond, slopes)

    def factor_solution(self) -> None:
        """Refactor the matrix at the last solution, unless its factor is exact already."""
        if self.work.exact:
            return
        if self.elements is not None:
            self.elements.factor_solution()
        else:
            factor_solution(self.system, self.work)
        self.work.exact = True

    @property
    def unknowns(self) -> int:
        """Number of unknowns: pressures and fills of vertices, and pressures of areas with a balance."""
        return self.work.count + (0 if self.reservoirs is None else int(self.reservoirs.live.sum()))

    def border(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return B^T and C (k, count), and D (k, k), symbols of `exudyn_ehd.film.supply.restrictors`, for p as unknown
        of the film and scaled Q."""
        s, r, w = self.system, self.reservoirs, self.work
        assert r is not None
        self.factor_solution()
        slopes = np.array((s.kx, -s.kx, s.kz, -s.kz, self.nothing)) if self.symmetric else w.slopes
        live = np.where(r.live, np.cumsum(r.live) - 1, -1)
        (B, C), D = np.zeros((2, r.live.sum(), w.count)), np.zeros((r.live.sum(), r.live.sum()))
        add_border(np.append(live, -1)[r.areas], w.number, slopes.reshape(5, *self.grid.shape), B, C, D)
        thin = None if self.elements is None else self.elements.thin
        if thin is not None and r.live.any():
            E = np.zeros((len(D), *self.grid.shape))
            E.reshape(len(D), -1)[:, r.at] = r.within().T
            self._add_corners(thin, E, B, C, D)
        return B, C, D

    def _add_corners(self, thin: ShearThinning, E: np.ndarray, B: np.ndarray, C: np.ndarray, D: np.ndarray) -> None:
        """Add to the results of `border` the flows that follow gradients across the links, for areas E (k, n, m)."""
        s, (_, across, *_), at, flat = self.system, thin.response(), self.work.order[: self.work.count], (len(E), -1)
        unknown = s.fixed | self.work.active if self.closure.conserves_mass else self.ones
        for q, k in enumerate((s.kx, s.kz)):
            gradient, by = thin.operators[1 - q], -0.5 * k * across[q]
            mean = (gradient @ E.reshape(flat).T).T.reshape(E.shape)
            flow, taken = by * (mean + np.roll(mean, -1, q + 1)), by * (E - np.roll(E, -1, q + 1))
            balance = (flow - np.roll(flow, 1, q + 1)).reshape(flat)
            drawn = (taken + np.roll(taken, 1, q + 1)).reshape(flat) @ gradient * unknown.ravel()
            B += balance[:, at]
            C += drawn[:, at]
            D += E.reshape(flat) @ balance.T

    def reduced(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """B^T, ``C A^-1`` of the film alone, and S, with shapes as of `border`; p in Pa."""
        r = self.reservoirs
        assert r is not None
        if self._reduced is None or not np.array_equal(self._reduced[0], r.live):
            B, C, D = self.border()
            self._solve_film_transposed(C)
            self._reduced = r.live, B, C, D - C @ B.T
        _, B, C, S = self._reduced
        by_pressure = r.transformed()[1][r.live] / self.pressure_scale
        return B * by_pressure[:, None], C, S * by_pressure

    def solve_transposed(self, rhs: np.ndarray) -> None:
        """Solve ``A^T lam = rhs`` for every row of rhs (k, count), in place."""
        if self.reservoirs is None:
            self._solve_film_transposed(rhs)
            return
        count, r, (B, C, S) = self.work.count, self.reservoirs, self.reduced()
        film = rhs[:, :count].copy()
        self._solve_film_transposed(film)
        rhs[:, count:] = np.linalg.solve(r.derivatives(S).T, (rhs[:, count:] - film @ B.T).T).T
        rhs[:, :count] = film - (rhs[:, count:] * r.weights()) @ C

    def _solve_film_transposed(self, rhs: np.ndarray) -> None:
        """Solve as `solve_transposed`, at given pressures of all areas."""
        w = self.work
        self.factor_solution()
        self._couple(rhs.T, True)
        if self.symmetric:
            solve_ldl(self._bands()[1], w.inv_diag, w.count, w.width, rhs)
        else:
            solve_lu_transposed(*self._bands(), w.inv_diag, w.count, w.width, rhs)

    def direct(self, rhs: np.ndarray) -> None:
        """Solve ``A du = rhs`` for every column of rhs (count, k), in place."""
        w, r = self.work, self.reservoirs
        if r is not None:
            (B, C, S), rhs, areas = self.reduced(), rhs[: w.count], rhs[w.count :]
            areas[:] = np.linalg.solve(r.derivatives(S), areas - r.weights()[:, None] * (C @ rhs))
            rhs -= B.T @ areas
        self.factor_solution()
        lower, upper = self._bands()
        if rhs.shape[1] > 1:
            solve_columns(lower, upper, w.inv_diag, self.symmetric, w.count, w.width, rhs)
        elif self.symmetric:
            solve_ldl(upper, w.inv_diag, w.count, w.width, rhs.T)
        else:
            solve_lu(lower, upper, w.inv_diag, w.count, w.width, rhs.T)
        self._couple(rhs, False)

    def matrix(self) -> csc_matrix:
        """Return the matrix A of the unknowns of vertices, and with reservoirs of areas."""
        self.factor_solution()
        w, count = self.work, self.work.count
        lower, upper = self._bands()
        if self.symmetric:
            lower = upper * w.inv_diag[:count, None]
        bands = range(1, w.width + 1)
        L = diags_array([lower[: count - k, k] for k in bands], offsets=[-k for k in bands], shape=(count, count))
        U = diags_array([upper[: count - k, k] for k in (0, *bands)], offsets=[0, *bands], shape=(count, count))
        A = csc_matrix(U + L @ U)
        if self.system.column_line is not None:
            coupling = np.eye(count)
            self._couple(coupling, False)
            A = A @ csc_matrix(2.0 * np.eye(count) - coupling)  # the inverse of the coupling
        if self.reservoirs is None:
            return A
        r, (B, C, D) = self.reservoirs, self.border()
        by_pressure = r.transformed()[1][r.live] / self.pressure_scale
        return csc_matrix(
            block_array([[A, B.T * by_pressure], [r.weights()[:, None] * C, r.derivatives(D * by_pressure)]])
        )

    def _couple(self, x: np.ndarray, transposed: bool) -> None:
        """Couple the rows (count, k) of the film's pressures and of those continued beyond a line between columns, see
        `ColumnLine.couple`."""
        if self.system.column_line is not None:
            self.system.column_line.couple(self.work, x, transposed)

    def _bands(self) -> tuple[np.ndarray, np.ndarray]:
        w = self.work
        lower = w.upper if self.symmetric else w.lower
        return dense_band(lower, w.count, w.width), dense_band(w.upper, w.count, w.width)

    def gradients(self, places: np.ndarray | None = None) -> Gradients:
        """Derivatives of the balances to the motion at fixed unknowns, for the last solution.

        The balances are those of the flat vertices ``places``; None: of the unknowns. With an elastic liner, gaps are
        those of the undeformed surfaces.
        """
        at, storage = self.work.order[: self.work.count] if places is None else places, self.storage_weights()
        e, s, by = self.elements, self.system, np.empty((10, at.size))
        if e is None:
            rows, by_speed, follows = np.empty((4, self.area.size)), np.empty((3, self.area.size)), None
            links, laws = (s.linear_pressure, self.H, self.HF), None if self.flux is None else self.flux.laws
            link_derivatives(*links, None, self.taken_along(), laws, self.metric, self.vx, self.vz, rows, by_speed)
        else:
            rows, by_speed, follows = e.by, e.by_speed, e.follows()
        if not self.axial:
            by_speed[1] = 0.0
        link_rows(at, at.size, self.grid.z.size, rows, by_speed, follows, storage, by)
        out = Gradients(np.arange(at.size), at, by)
        line = self.line_gradients(places)
        return out if line is None else join(out, line)

    def storage_weights(self) -> tuple[np.ndarray, np.ndarray]:
        """Derivatives (n, m) of the storage of every vertex to the rate and to the gap of the undeformed surfaces."""
        s, e = self.system, self.elements
        content = self.area if self.law is None else self.area * self.rho
        if self.closure.conserves_mass:
            content = content * s.fill
        if s.inverse_step > 0.0 and not s.instant:
            by_rate = self.area * self.follows
            by_gap = content if e is None else content * e.gap_slopes.H_r
            return by_rate, (by_gap - by_rate) * s.inverse_step
        if not self.squeeze:
            return self.nothing, self.nothing
        if e is None:
            return content, self.nothing
        return content * e.gap_slopes.rate_t, content * e.gap_slopes.rate_r

    def surroundings(self) -> np.ndarray:
        """Derivatives (count + k,) of the balances to the rates of the unknowns, through storage outside of the film:
        by a liner's deflection, and of oil in supply areas with a restrictor."""
        stored, r = self.nothing, self.reservoirs
        if self.elements is not None:
            stored = self.storage_weights()[0] * self.elements.deflection_by_pressure
        film_storage = stored.reshape(-1)[self.work.order[: self.work.count]]
        if r is None:
            return film_storage
        deflects = (r.sums(stored) * r.transformed()[1])[r.live] / self.pressure_scale
        return np.append(film_storage, r.storage() + r.weights() * deflects)

    @property
    def pockets(self) -> np.ndarray | None:
        """Pressures (k,) of supply areas with a restrictor, Pa, for the next step; None without a compressible
        volume."""
        r = self.reservoirs
        return r.pressures.copy() if r is not None and r.compliance.any() else None

    def _at_line(self) -> AtLine:
        """Return the film at the cavity pressure, for derivatives of the rupture line."""
        return AtLine((self.H, self.HF), self.flux, None) if self.elements is None else self.elements.at_line

    def _to_motion(self, line: Gradients) -> Gradients:
        """Convert a line's derivatives to the film's gaps into those to gaps of the undeformed surfaces, in place."""
        if not self.axial:
            line.by[7] = 0.0
        return undeformed(line, self._at_line().chain)

    def line_gradients(self, places: np.ndarray | None = None) -> Gradients | None:
        """Contribution of the rupture line inside the cells to the derivatives of the balances; None without one.

        It holds for the last solution at fixed pressure. ``places``: flat vertices of balances, None: those of the
        unknowns. With ``places``, only mass-conserving films have a contribution.
        """
        fills = self.fill_gradients()
        if fills is not None and self.oil_line is not None:
            at = self.work.order[: self.work.count] if places is None else places
            return self.oil_line.balance_gradients(fills, *self.fill_weights(), at)
        s = self.system
        if places is not None:
            return None
        if s.column_line is not None:
            return s.column_line.gradients(self.work, s.cavity_pressure, self.H, self.flux)
        if self.line is None:
            return None
        (gaps, flux, _), v = self._at_line(), (self.vx, self.vz)
        return self._to_motion(self.line.gradients(self.work, gaps, flux, v, self.flow_x, self.squeeze, self.grid.mesh))

    def fill_gradients(self) -> tuple[Gradients, Gradients] | None:
        """Derivatives of two fills of the vertices at a line inside the cells of a mass-conserving film: fill of the
        outflow, fill of the vertex; None without such a line.

        They hold for the last solution at fixed pressure; ``rows`` are flat vertices.
        """
        if self.oil_line is None:
            return None
        if self._fills is None:
            (gaps, flux, _), v = self._at_line(), (self.vx, self.vz)
            squeeze = self.squeeze and not (self.elements is not None and self.elements.takes_up_squeeze)
            carried, held = self.oil_line.gradients(gaps, flux, v, self.flow_x, squeeze, self.grid.mesh)
            self._fills = self._to_motion(carried), self._to_motion(held)
        return self._fills

    def fill_weights(self) -> tuple[FilmTerms, np.ndarray]:
        """Terms with the Couette flows of a full film, and its storage (n, m); mass flows with a density law."""
        terms, rho = self.system.terms, self.rho
        if self.law is None:
            return terms, terms.area * terms.grow
        fx, fz = (0.5 * f * (rho + np.roll(rho, -1, axis)) for axis, f in enumerate((terms.fx, terms.fz)))
        return terms._replace(fx=fx, fz=fz), terms.area * terms.grow * rho

    def inflow(self, ended: bool = False, linear: bool = False) -> np.ndarray:
        """Scaled volume (or mass) flow that every prescribed vertex feeds into the film (n, m); zero elsewhere.

        ``ended``: whether films between supply areas and a cavity may end within a link, see `end_films_of_areas`.
        ``linear``: whether the flows are those of the linear film, before pressures are clipped.
        """
        s, conserves_mass = self.system, self.closure.conserves_mass
        P = s.linear_pressure if linear else self.flow_pressures()[0]
        balance = np.empty(self.grid.shape)
        if conserves_mass or self.law is not None:
            fill, rho = s.fill if conserves_mass else None, None if self.law is None else self.rho
            film_balance(P, fill, rho, s.terms, balance)
        else:
            linear_residual((s.kx, s.kz, s.b), P, balance)
            np.negative(balance, out=balance)
            if ended and self.complementary:
                end_films_of_areas(s, self.work.active, self.grid, balance)
        return np.where(self.grid.fixed, balance, 0.0)
