"""The film on one end face between a bush and the collar of its journal: wrench and exact tangent.

In the joint frame, with s = 1 for the upper face at z = L/2 and -1 for the lower one, the collar is a plane whose place
on the bearing's axis is zeta from the middle of its play. At the point r = (X, Y) of the face

    h = c + s (zeta - bx X - by Y) + d(theta),        dh/dt = s (zeta_t - bx_t X - by_t Y),

and the collar slides past with U = omega e_z x r + u, u the velocity of its point on the axis. Reynolds' equation

    div(h^3 / (12 mu) grad p) = U . grad h / 2 + dh/dt,          p given at r_i and r_o,

contains the rotation omega as Couette flow of the links (`exudyn_ehd.film.thrust.annulus`). The shift u, which is
smaller by clearance over radius, enters as a rate of the gap, ``u . grad h / 2``. Normals are fixed in the housing. On
the collar act p along s e_z and, in the plane, the shear and the pressure on the slope of the collar,

    f = -mu U / h - h/2 grad p - p grad(h - d),

and the opposite on the bush, so that force and moment of both cancel exactly. Work is heat:
``-int f . U - int s p v_z = int mu U^2 / h + h^3 / (12 mu) |grad p|^2`` for p = 0 at the edges.

Motion of a face: m = (zeta, bx, by, zeta_t, bx_t, by_t, omega, u_x, u_y). Integrals: N, X, Y of the pressure times 1, x
and y; E = -int h u . grad p for the turn and the shifts along x and y; S = int mu / mu_0 U . u / h for these three.

Laws of the oil. With a pressure or density law the solver's unknown is q, dq = dp (rho / rho_0) / (mu / mu_0)
(`exudyn_ehd.film.lubricant.density`), whose balance is that of a film of constant viscosity; N to E take p(q), S the
viscosity of every vertex. Turbulence and shear thinning follow the sliding at their radius, omega r: a turbulent link
has the Reynolds number rho omega r h / mu, and with x = r / R a shear rate is that of a film of the gap h / x at the
radius R, in gradients along theta and s too. The shear of the shift u has the same factor; the factor does not depend
on u. The mean of the shear on both walls is the factor times mu U / h, its difference h grad p.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from exudyn_ehd.film.cavitation.closures import Closure
from exudyn_ehd.film.heat.energy import ViscosityField
from exudyn_ehd.film.loads import end_flows, film_scales
from exudyn_ehd.film.lubricant.density import CompressibleLaw
from exudyn_ehd.film.lubricant.lubricant import Lubricant, transform_of
from exudyn_ehd.film.lubricant.shear_thinning import ShearThinning
from exudyn_ehd.film.reynolds.gap import to_ends
from exudyn_ehd.film.reynolds.links import LinkLaw
from exudyn_ehd.film.reynolds.turbulence import Hirs, NgPan
from exudyn_ehd.film.solvers.film import shear_share
from exudyn_ehd.film.solvers.solver import FilmSolver
from exudyn_ehd.film.surfaces.contact import WallContact
from exudyn_ehd.film.thrust.annulus import AnnularFlow, Annulus, ThrustFaces, products
from exudyn_ehd.film.thrust.tilting import TiltingThrustPads
from exudyn_ehd.status import Status

FACE_SIZE = 9


@dataclass(frozen=True, eq=False)
class FaceState:
    """One evaluation of a face.

    Attributes
    ----------
    status : Status
    wrench : (6,) array
        Wrench on the journal, moment about the face's centre, N and Nm; nan without a film.
    minimum_gap, peak_pressure, power_loss, contact_load : float
        m, Pa, W, N. The power loss is heat of film and contact, and work on the oil that they press out.
    """

    status: Status
    wrench: np.ndarray
    minimum_gap: float
    peak_pressure: float = np.nan
    power_loss: float = np.nan
    contact_load: float = np.nan


class FaceFilm:
    """Film on one face; the tangent is that of the last evaluation.

    Parameters
    ----------
    faces : ThrustFaces or TiltingThrustPads
    side : int
        1 for the upper face and for a pad, -1 for the lower face.
    closure : Closure
        Closure that does not conserve mass; on pads the rupture line of Swift-Stieber lies on vertices.
    oil : Lubricant
    pressures : (float, float)
        At the inner and the outer radius, Pa.
    squeeze : bool
        False leaves out the rate of the gap.
    turbulence : NgPan, Hirs or None

    Attributes
    ----------
    pressures : (3,) array
        At the inner and the outer radius, and of a cavity, Pa.
    known : (3,) array
        The same as the solver's scaled unknowns.
    fields : OilFields
        Of the last solution.
    c, R : float
        Clearance and the radius of `Annulus`, m.
    by_place : (3,) array
        Factors from the place (zeta, bx, by) to the scaled one.
    """

    def __init__(
        self,
        faces: ThrustFaces | TiltingThrustPads,
        side: int,
        closure: Closure,
        oil: Lubricant,
        pressures: tuple[float, float],
        squeeze: bool = True,
        turbulence: NgPan | Hirs | None = None,
    ) -> None:
        self.side, self.closure, self.squeeze, self.oil = side, closure, float(squeeze), oil
        # columns of pads are not equal
        has_pads = faces.profile is not None or faces.grid[3] is not None
        if has_pads and closure.line_in_cells and not (closure.clips or closure.conserves_mass):
            # at a step oil is lost on the edge itself, so that no parabola of pressure ends in the cells downstream
            self.closure = closure = replace(closure, line_in_cells=False)  # type: ignore[type-var]
        self.annulus = a = Annulus(faces.inner_radius, faces.outer_radius, *faces.grid)
        self.wall = None if faces.contact is None else WallContact(faces.contact, faces.clearance)
        self.pressures = np.array([*pressures, closure.cavity_pressure])
        shape, grid, c = a.grid.shape, a.grid, faces.clearance
        # on the links, and of the half control volumes behind and ahead of the vertices
        link, sides = np.zeros((shape[0], 1)), np.zeros((2, shape[0], 1))
        if faces.profile is not None:
            # crowns of sectors have no steps
            apart = np.array([-0.5, 0.5]) if faces.grid[3] is None else np.zeros(2)
            quarters = a.sides * grid.width_x[:, None] * apart[:, None, None]
            link = faces.profile.depth_at(grid.x_face)[:, None] / c
            sides = faces.profile.depth_at(grid.x[:, None] + quarters) / c
        self.link_depth, self.depth = link, (a.sides * sides).sum(axis=0)
        self.steps = sides - self.depth
        self.law, self.sliding = transform_of(oil), sliding_law(oil, turbulence, a, c)
        effects = AnnularFlow(a.square, a.sides, self.steps), *(() if self.sliding is None else (self.sliding,))
        density = self.law if isinstance(self.law, CompressibleLaw) else None
        self.solver = FilmSolver(grid, closure, flux_effects=effects, density=density)
        self.c, self.R, self.flow_scale = c, a.scale, c * a.scale**2
        self.by_place = np.array([1.0, a.scale, a.scale]) / c
        self._scale(1.0)
        around = (link - np.roll(link, 1, axis=0)) / grid.width_x[:, None] / a.r
        # u . grad d / 2 for the shifts along x and y
        self.shifted = 0.5 * np.array([-around * np.sin(grid.x)[:, None], around * np.cos(grid.x)[:, None]])
        # derivatives of the scaled gap to (zeta / c, bx R / c, by R / c)
        sign = side * np.array([1.0, -1.0, -1.0])[:, None, None]
        self.shape, self.link_shape = sign * a.moments, sign * a.link_moments[:3]

    def _scale(self, ratio: float) -> None:
        """Scale the film to ``ratio`` times the oil's viscosity."""
        a, self.ratio = self.annulus, ratio
        self.scales = film_scales(ratio * self.oil.viscosity, self.R, self.c, self.pressures)
        self.solver.pressure_scale = self.scales.pressure
        known = self.pressures if self.law is None else self.law.transform(self.pressures)
        self.known = known / self.scales.pressure
        if self.sliding is not None and isinstance(self.sliding.field, ViscosityField):
            self.sliding.field.set(np.full(a.grid.shape, ratio / a.r))

    def evaluate(self, motion: np.ndarray, ratio: float = 1.0) -> FaceState:
        """The film at a motion (9,), SI units, with ``ratio`` times the oil's viscosity."""
        if ratio != self.ratio:
            self._scale(ratio)
        s, k = self.solver, self.scales
        smallest = self.c * self._set_gap(motion)
        if smallest <= 0.0 and self.wall is None:
            return FaceState(Status.NO_FILM, np.full(6, np.nan), smallest)
        s.pressure[:, 0], s.pressure[:, -1] = self.known[:2]
        status, _ = s.solve(0.5 * motion[6], 0.0, float(self.known[2]))
        oil = s.oil_fields(self.law, self.sliding) if status is Status.CONVERGED else None
        status = Status.NO_PRESSURE if status is Status.CONVERGED and (oil is None or oil.beyond) else status
        if oil is None:
            return FaceState(status, np.full(6, np.nan), smallest)
        self.fields = oil
        self._integrate()
        peak, contact = float(oil.P.max()) * k.pressure, float((self.annulus.weight * self.contact).sum())
        return FaceState(status, self._wrench(), smallest, peak, self._power(), contact * self.R**2)

    def flows(self) -> tuple[float, float]:
        """Flows of the last solution in at the inner radius and out at the outer one, m3/s."""
        s, grid, unit = self.solver, self.annulus.grid, self.flow_scale
        (fx, fz, rate), (P, full) = s.couette_flows(), s.flow_pressures()
        inner, outer = end_flows(P, s.system.kz, fz, fx, rate, grid.width_x, grid.width_z, s.squeeze, full)
        return -unit * inner, unit * outer

    def heat(self) -> tuple[float, float, float]:
        """Heat of the last solution, W, and oil that it takes in at the inner and at the outer radius, m3/s.

        The heat is ``power_loss`` and the work of the pressures above the cavity's on the oil that comes and goes. Oil
        that a cavity finds beyond what it has lost is taken in at the inner radius.
        """
        s, (inner, outer), P = self.solver, self.flows(), self.solver.flow_pressures()[0]
        unit, out = self.flow_scale, s.system.kz[:, [0, -2]] * (P[:, [0, -2]] - P[:, [1, -1]])
        widened = unit * float((self.annulus.weight * self.true_rate).sum())
        into, back = unit * float(out[:, 0].clip(0.0).sum()), unit * float((-out[:, 1]).clip(0.0).sum())
        p_in, p_out, cavity = np.where(np.isfinite(self.pressures), self.pressures, 0.0).tolist()
        work = (p_in - cavity) * inner - (p_out - cavity) * outer + cavity * widened
        return self._power() + work, into + max(outer - inner + widened, 0.0), back

    def flows_along(self) -> tuple[float, float]:
        """Flows of the last solution in at the first edge of a sector and out at the last one, m3/s."""
        s, unit = self.solver, self.flow_scale
        fx, P, ends = s.couette_flows()[0], s.flow_pressures()[0], np.array([0, -2])
        first, last = (fx[ends] + s.system.kx[ends] * (P[ends] - P[ends + 1])).sum(axis=1).tolist()
        return unit * first, unit * last

    @property
    def pressure(self) -> np.ndarray:
        """Pressure of the last solution (n, m), Pa."""
        return self.fields.P * self.scales.pressure

    @property
    def gap(self) -> np.ndarray:
        """Film gap of the last solution (n, m), m."""
        return self.solver.H * self.c

    def _set_gap(self, motion: np.ndarray) -> float:
        """Write gaps and weighted rate into the solver's buffers; return the smallest scaled gap of the surfaces."""
        s, a, scale = self.solver, self.annulus, self.by_place
        self.motion = motion
        self.pose, self.rate, self.shift = motion[:3] * scale, self.squeeze * motion[3:6] * scale, motion[7:] / self.R
        s.H[:] = 1.0 + self.depth + np.tensordot(self.pose, self.shape, 1)
        s.HF[:] = 1.0 + self.link_depth + np.tensordot(self.pose, self.link_shape, 1)
        s.H_t[:] = np.tensordot(self.rate, self.shape, 1)
        self.true_rate = s.H_t.copy()
        s.H_t += np.tensordot(self.shift, self.shifted, 1) - 0.5 * self.side * float(self.shift @ self.pose[1:])
        smallest = min(float((s.H + self.steps.min(axis=0)).min()), float(s.HF.min()))
        self.slope, self.bend, self.face_slope = s.ones, s.nothing, s.ones
        self.contact = self.contact_slope = s.nothing
        if self.wall is not None and smallest < self.wall.onset:
            self._press(self.wall)
        s.H_t *= a.square
        return smallest

    def _press(self, wall: WallContact) -> None:
        """Set the pressure of a touching wall, and replace gap and rate of the surfaces there by the film's."""
        s, shape = self.solver, self.solver.H.shape
        self.contact, self.contact_slope, self.bend = np.zeros((3, *shape))
        self.slope, self.face_slope, pressure, slope = np.ones((4, *shape))
        for share, step in zip(self.annulus.sides, self.steps, strict=True):
            wall.pressure(s.H + step, pressure, slope)
            self.contact += share * pressure
            self.contact_slope += share * slope
        wall.limit(s.H, s.HF, s.H_t, self.slope, self.bend, self.face_slope)
        self.true_rate *= self.slope

    def _integrate(self) -> None:
        """Integrals of the last solution: N, X, Y (3,) and E (3,), scaled; shear matrix (3, 3) in SI units."""
        s, k, a, oil = self.solver, self.scales, self.annulus, self.fields
        pressed = a.weight * (oil.P + self.contact / k.pressure)
        self.loads = products(a.moments, pressed[None])[:, 0]
        self.rows = a.link_rows(s.H, s.HF)
        self.carried = products(self.rows, oil.P[None])[:, 0]
        self.share = share = shear_share(s.system, s.work.active, self.closure)
        if oil.ratio is not None:
            share = share * oil.ratio
        # on the links, whose gaps lie on one side of a step
        self.sheared = a.link_weight * 0.5 * (share + np.roll(share, -1, axis=0)) / s.HF
        self.shear = self._shear_matrices(self.sheared[None])[0]

    def _shear_matrices(self, densities: np.ndarray) -> np.ndarray:
        """``int u_k . u_l density dA`` (k, 3, 3) of densities (k, n, m), SI units, for the velocities of `Annulus`."""
        R, out = self.R, np.zeros((len(densities), 3, 3))
        whole, x, y, turn = products(self.annulus.link_moments, densities)
        out[:, 0, 0], out[:, 1, 1], out[:, 2, 2] = R**2 * turn, whole, whole
        out[:, 0, 1], out[:, 0, 2] = -R * y, R * x
        out[:, 1:, 0] = out[:, 0, 1:]
        return np.asarray(self.scales.shear * out)

    def _weights(self) -> np.ndarray:
        """Weights (6, 6) of N, X, Y and E in the wrench without its shear, SI units."""
        k, s, (bx, by) = self.scales, self.side, self.motion[1:3]
        out, half = np.zeros((6, 6)), 0.5 * k.pressure * self.c * self.R
        out[0, 0], out[1, 0], out[2, 0] = s * bx * k.force, s * by * k.force, s * k.force
        out[3, 2], out[4, 1] = s * k.force * self.R, -s * k.force * self.R
        out[5, 1], out[5, 2] = s * by * k.force * self.R, -s * bx * k.force * self.R
        out[0, 4] = out[1, 5] = half
        out[5, 3] = half * self.R
        return out

    def _wrench(self) -> np.ndarray:
        out = self._weights() @ np.concatenate((self.loads, self.carried))
        out[[5, 0, 1]] -= self.shear @ self.motion[6:]
        return np.asarray(out)

    def _power(self) -> float:
        k, sliding = self.scales, self.motion[6:]
        half = 0.5 * k.pressure * self.c * self.R * np.array([self.R, 1.0, 1.0])
        squeezed = k.force * self.c * float((self.annulus.weight * self.fields.P * self.true_rate).sum())
        return float(sliding @ self.shear @ sliding - sliding @ (half * self.carried)) - squeezed

    def tangent(self) -> np.ndarray:
        """d wrench / d motion (6, 9) of the last evaluation, exact for its active set."""
        k, n, R = self.scales, self.side, self.R
        gradient = self._gradients()
        out = self._weights() @ gradient[:6]
        N, X, Y = (k.force * self.loads * np.array([1.0, R, R])).tolist()
        # dependence of the weights on the tilt
        out[0, 1] += n * N
        out[1, 2] += n * N
        out[5, 1] -= n * Y
        out[5, 2] += n * X
        rows, sliding = [5, 0, 1], self.motion[6:]
        out[rows, 6:] -= self.shear
        thinner = -self.sheared * self.face_slope / self.solver.HF
        out[rows, :3] -= (self._shear_matrices(thinner * self.link_shape) @ sliding).T * self.by_place
        if len(gradient) > 6:
            out[rows] -= k.shear * gradient[6:]
        return np.asarray(out)

    def _gradients(self) -> np.ndarray:
        """Gradients (6, 9) of N, X, Y and E to the motion, SI units; contact included.

        If the viscosity depends on the film, those of S (3, 9) through the viscosity follow.
        """
        a, oil = self.annulus, self.fields
        fields = np.concatenate((a.moments * a.weight, self.rows)) * (1.0 if oil.P_q is None else oil.P_q)
        drag = None if oil.ratio_q is None and oil.ratio_h is None else self._drag_of_viscosity()
        if drag is not None:
            fields = np.append(fields, drag * (0.0 if oil.ratio_q is None else oil.ratio_q), axis=0)
        rows = self._adjoint(fields, drag)
        cell, face, rate, speed = self.solver.gradients().fields(rows, a.weight.shape)
        by_gap, by_link = a.link_gradients(oil.P)
        cell[3:6] += by_gap
        face[3:6] += by_link
        if drag is not None and oil.ratio_h is not None and oil.ratio_v is not None:
            cell[6:] += drag * oil.ratio_h
            speed[6:, 0] += (drag * oil.ratio_v).sum(axis=(1, 2))
        # from the film's gap and weighed rate to the surfaces' gap and rate
        rate *= a.square
        cell = cell * self.slope + rate * self.bend
        cell[:3] += a.moments * a.weight * self.contact_slope / self.scales.pressure
        return self._by_motion(cell, face * self.face_slope, rate * self.slope, speed)

    def _drag_of_viscosity(self) -> np.ndarray:
        """Derivatives (3, n, m) of S to the viscosity ratio at the vertices, scaled as `_shear_matrices`."""
        a, R, (turn, u_x, u_y) = self.annulus, self.R, self.motion[6:]
        _, x, y, _ = a.link_moments
        U_x, U_y = u_x - turn * R * y, u_y + turn * R * x
        on_links = np.array([R * (x * U_y - y * U_x), U_x, U_y]) * a.link_weight / self.solver.HF
        return to_ends(on_links, 1) * self.share

    def _adjoint(self, fields: np.ndarray, drag: np.ndarray | None) -> np.ndarray:
        """Adjoint rows (k, count) of sums over the pressure with the weights ``fields`` (k, n, m).

        The last three also follow the gradients of the pressure, by ``drag`` times the viscosity's slopes.
        """
        by_gradient = None
        if drag is not None and self.fields.ratio_g is not None and isinstance(self.sliding, ShearThinning):
            by_gradient = np.zeros_like(fields)
            by_gradient[6:] = [self.sliding.gather(self.fields.ratio_g * own) for own in drag]
        return self.solver.adjoint(fields * self.solver.work.active, by_gradient)

    def _by_motion(self, cell: np.ndarray, face: np.ndarray, rate: np.ndarray, speed: np.ndarray) -> np.ndarray:
        """Gradients (k, 9) to the motion, SI units, from those of `Gradients.fields`."""
        pose = products(cell, self.shape) + products(face, self.link_shape)
        through, whole = products(rate, self.shape), rate.sum(axis=(1, 2))
        # the shift's rate -side u . b / 2 in scaled tilt and shift
        pose[:, 1:] -= 0.5 * self.side * np.outer(whole, self.shift)
        shift = products(rate, self.shifted) - 0.5 * self.side * np.outer(whole, self.pose[1:])
        by_place, by_rate = pose * self.by_place, self.squeeze * through * self.by_place
        return np.concatenate((by_place, by_rate, 0.5 * speed[:, :1], shift / self.R), axis=1)


def sliding_law(oil: Lubricant, turbulence: NgPan | Hirs | None, annulus: Annulus, clearance: float) -> LinkLaw | None:
    """Return turbulence or shear thinning of a face, by the sliding at every radius; None of a plain oil."""
    R, r = annulus.scale, annulus.r
    if turbulence is not None:
        turbulent = turbulence.bound(R, clearance, oil.density, oil.viscosity, plane=True)
        # the Reynolds number at r R is that at the radius R in an oil whose viscosity is divided by r
        turbulent.field = ViscosityField()
        return turbulent
    if (thinning := oil.shear_law and oil.shear_law.bound(R, clearance)) is not None:
        assert isinstance(thinning, ShearThinning)
        thinning.radii = r, np.append(np.sqrt(r[1:] * r[:-1]), 1.0)
    return thinning
