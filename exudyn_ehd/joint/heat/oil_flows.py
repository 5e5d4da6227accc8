"""Oil that a film takes in, holds and gives off, and the heat of its motion.

What the temperature's balances are made of.
"""

from __future__ import annotations

import math

import numpy as np

from exudyn_ehd.film.heat.energy import (
    content_rate,
    exchange_sums,
    film_flows,
    outside_flows,
)
from exudyn_ehd.joint.heat.power import sliding_power
from exudyn_ehd.joint.solved_film import SolvedFilm


class Exchange:
    """Oil that enters a solved film from outside, and the rate of its content.

    Of a compressible film, flows and contents are masses over the density at ambient pressure.

    Attributes
    ----------
    fill, rate, outside : (n, m) arrays
        Film fraction, times the density ratio; d(fill H)/dt, 1/s; flow that enters at the ends and at supplies, in
        units of c R^2.
    fx, fz, convected : (n, m) arrays
        Couette flows of the links before they take the upstream value of ``convected`` along.
    """

    def __init__(self, film: SolvedFilm) -> None:
        s, y, shape = film.solver, film.solver.system, film.grid.shape
        conserves, fixed = s.closure.conserves_mass, film.grid.fixed
        self.fill, self.convected = s.fill if conserves else s.ones, s.carried
        self.fx, self.fz = y.fx, y.fz
        oil = film.parts.compressible
        if oil is not None:
            # these flows hold the upstream film fraction and the links' density already
            self.fx, self.fz, _ = oil.couette_flows()
            self.fill, self.convected = oil.rho * self.fill, s.ones
        self.rate, self.outside = np.empty(shape), np.empty(shape)
        self.stepped = conserves and y.inverse_step > 0.0 and not s.instant
        old = y.mass_old if self.stepped else s.H
        content_rate(s.H, s.H_t, self.fill, old, y.inverse_step if self.stepped else 0.0, s.squeeze, self.rate)
        unbroken = np.ones(shape, dtype=np.bool_) if conserves else s.work.active | fixed
        outside_flows(
            s.pressure, self.convected, y.kx, y.kz, self.fx, self.fz, s.area, self.rate, fixed, unbroken, self.outside
        )

    @property
    def leaving(self) -> float:
        """Sum of what leaves."""
        return -float(np.minimum(self.outside, 0.0).sum())


class OilFlows(Exchange):
    """All flows of a solved film, in units of c R^2.

    Attributes
    ----------
    x, z : (n, m) arrays
        Over the links i -> i+1 and j -> j+1.
    found : (n, m) array
        Entering in addition, where a cavitation model does not conserve mass; negative where it loses oil.
    content : (n, m) array
        Content of the storage term (scaled gap, times the density ratio).
    """

    def __init__(self, film: SolvedFilm) -> None:
        super().__init__(film)
        s, y, shape = film.solver, film.solver.system, film.grid.shape
        self.content = y.mass_old if self.stepped else self.fill * s.H
        self.x, self.z, self.found = np.empty(shape), np.empty(shape), s.area * self.rate
        film_flows(s.pressure, self.convected, y.kx, y.kz, self.fx, self.fz, self.x, self.z, self.found)
        self.found -= self.outside
        if s.closure.conserves_mass:
            self.found[:] = 0.0


def heat_and_leakage(film: SolvedFilm) -> tuple[float, float]:
    """Power that film and contacts turn into heat, W, and the flow that leaves, in units of c R^2.

    What a link carries dissipates its own power: what sliding puts in, and what the flow loses of its pressure. Summed
    over the links by parts, with the cavity's pressure pc, the inflow S from outside and the content's rate,

        heat = sliding power + sum (p - pc) (S - A dm/dt),

    which holds none of the powers that store and give back: where nothing changes in time it is `power_loss` plus the
    work on the oil, to rounding. Oil that cavities find or lose has their pressure and does no work, also where a
    rupture line crosses a cell. Of a compressible film p is the flow work ``integral of dp / (rho / rho_0)``, flows and
    content are masses. The flow that leaves is that of `Exchange`.
    """
    s, oil = film.solver, film.parts.compressible
    cavity = film.scales.cavity if math.isfinite(film.scales.cavity) else 0.0
    if oil is not None:
        flows = Exchange(film)
        pressure = oil.flow_work(film.oil.P) - oil.flow_work(np.asarray(cavity))
        work, leaving = float(np.sum(pressure * (flows.outside - s.area * flows.rate))), flows.leaving
    else:
        y, conserves = s.system, s.closure.conserves_mass
        stepped = conserves and y.inverse_step > 0.0 and not s.instant
        leaving, work = exchange_sums(
            film.oil.P,
            s.pressure,
            s.fill if conserves else s.ones,
            s.carried,
            s.work.active,
            conserves,
            y.mass_old if stepped else s.H,
            y.inverse_step if stepped else 0.0,
            s.squeeze,
            y.coefficients,
            cavity,
        )
    power = film.scales.pressure * film.parts.flow_scale
    return sliding_power(film) + power * (work + _end_work(film)), leaving


def _end_work(film: SolvedFilm) -> float:
    """Work of the pressure on the ends' cross section, scaled."""
    if film.journal.axial_speed == 0.0:
        return 0.0
    g, section = film.grid, film.oil.P * film.solver.H
    return film.journal.axial_speed / g.reference_length * float(g.width_x @ (section[:, -1] - section[:, 0]))
