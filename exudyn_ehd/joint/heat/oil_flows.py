"""Oil that a film takes in, holds and gives off, and the heat of its motion: what the temperature's balances are made of."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from exudyn_ehd.film.heat.energy import (
    content_rate,
    end_section,
    exchange_sums,
    exchange_sums_fill,
    film_flows,
    outside_flows,
)
from exudyn_ehd.film.solvers.compressible import CompressibleFilmSolver

if TYPE_CHECKING:
    from exudyn_ehd.joint.model.rigid import BearingModel


class Exchange:
    """Oil that enters the film evaluated last from outside, and the rate of its content.

    Of a compressible film, flows and contents are masses over the density at ambient pressure.

    Attributes
    ----------
    fill, rate, outside : (n, m) arrays
        Film fraction, times the density ratio; d(fill H)/dt, 1/s; flow that enters at the ends and at supplies, in units of c R^2.
    fx, fz, carried : (n, m) arrays
        Couette flows of the links before they take the upstream value of ``carried`` along.
    """

    def __init__(self, model: BearingModel) -> None:
        s, y, shape = model.solver, model.solver.system, model.grid.shape
        conserves, fixed = s.closure.conserves_mass, model.grid.fixed
        self.fill = self.carried = s.fill if conserves else s.ones
        self.fx, self.fz = y.fx, y.fz
        if model.compressible is not None:
            # these flows hold the upstream film fraction and the links' density already
            self.fx, self.fz, _ = model.compressible.couette_flows()
            self.fill, self.carried = model.compressible.rho * self.fill, s.ones
        self.rate, self.outside = np.empty(shape), np.empty(shape)
        self.stepped = conserves and y.inverse_step > 0.0 and not s.instant
        old = y.mass_old if self.stepped else s.H
        content_rate(s.H, s.H_t, self.fill, old, y.inverse_step if self.stepped else 0.0, s.squeeze, self.rate)
        unbroken = np.ones(shape, dtype=np.bool_) if conserves else s.work.active | fixed
        outside_flows(
            s.pressure, self.carried, y.kx, y.kz, self.fx, self.fz, s.area, self.rate, fixed, unbroken, self.outside
        )  # fmt: skip

    @property
    def leaving(self) -> float:
        """Sum of what leaves."""
        return -float(np.minimum(self.outside, 0.0).sum())


class OilFlows(Exchange):
    """All flows of the film evaluated last, in units of c R^2.

    Attributes
    ----------
    x, z : (n, m) arrays
        Over the links i -> i+1 and j -> j+1.
    found : (n, m) array
        Entering in addition, where a cavitation model does not conserve mass; negative where it loses oil.
    content : (n, m) array
        Content of the storage term (scaled gap, times the density ratio).
    """

    def __init__(self, model: BearingModel) -> None:
        super().__init__(model)
        s, y, shape = model.solver, model.solver.system, model.grid.shape
        self.content = y.mass_old if self.stepped else self.fill * s.H
        self.x, self.z, self.found = np.empty(shape), np.empty(shape), np.empty(shape)
        film_flows(
            s.pressure, self.carried, y.kx, y.kz, self.fx, self.fz, s.area, self.rate, self.x, self.z, self.found
        )  # fmt: skip
        self.found -= self.outside
        if s.closure.conserves_mass:
            self.found[:] = 0.0


def heat_and_leakage(model: BearingModel) -> tuple[float, float]:
    """Power that film and contacts of the last evaluation turn into heat, W, and the flow that leaves, in units of c R^2.

    The heat is `BearingModel.power_loss` less the work on the oil; the flow is that of `Exchange`.
    """
    if model.compressible is not None:
        work, leaving = _compressible_work(model, model.compressible)
        return model.power_loss() + model.pressure_scale * model.flow_scale * work, leaving
    s, y, g = model.solver, model.solver.system, model.grid
    cavity = model.cavity_pressure if math.isfinite(model.cavity_pressure) else 0.0
    if s.closure.conserves_mass:
        stepped = y.inverse_step > 0.0 and not s.instant
        leaving, work = exchange_sums_fill(
            model.P, s.pressure, s.H, s.H_t, s.fill, y.mass_old if stepped else s.H, y.inverse_step if stepped else 0.0,
            s.squeeze, y.kx, y.kz, y.fx, y.fz, s.area, g.fixed, cavity,
        )  # fmt: skip
    else:
        leaving, work = exchange_sums(
            model.P, s.pressure, y.kx, y.kz, y.fz, y.b, s.H_t, s.area, g.fixed, s.work.active, s.squeeze, cavity
        )
    if model.axial_speed != 0.0:
        work += model.axial_speed / g.reference_length * end_section(model.P, s.H, g.width_x)
    return model.power_loss() + model.pressure_scale * model.flow_scale * work, leaving


def _compressible_work(model: BearingModel, film: CompressibleFilmSolver) -> tuple[float, float]:
    """Work on the oil of a compressible film, scaled, and the flow that leaves.

    With the density ratio rho, the flow work ``w = integral of dp / rho`` and a volume flow q per width, the mass balance times w less
    its value in the cavity, summed by parts, turns the power of the motion ``int mu U^2 / h + q_U . grad p - p dh/dt dA`` into

        heat + d/dt int e h dA - pc dV/dt - sum over what enters of (w - w_c) rho q,    e = rho (w - w_c) - (p - pc),

    e the elastic energy per volume of oil above that of the cavity's, ``d(e h) = e dh + h (w - w_c) d(rho)``. The second part, backward
    Euler, is left out where the mass balance leaves it out: without a history and its step.
    """
    s, g, flows = model.solver, model.grid, Exchange(model)
    cavity = model.bearing.cavitation.cavity_pressure / model.pressure_scale
    if not math.isfinite(cavity):
        cavity = 0.0
    w = film.flow_work(model.P) - film.flow_work(np.asarray(cavity))
    work = float(np.sum(w * flows.outside))
    if s.squeeze:
        elastic = film.rho * w - (model.P - cavity)
        work += float(np.sum(s.area * (cavity - elastic) * s.H_t))
    history, step = model.start
    if flows.stepped and history is not None and history.density is not None:
        work -= float(np.sum(s.area * s.H * w * (film.rho - history.density))) / step
    if model.axial_speed != 0.0:
        work += model.axial_speed / g.reference_length * end_section(model.P, s.H, g.width_x)
    return work, flows.leaving
