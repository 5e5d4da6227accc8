"""Mechanical power that film and contacts keep or store, and the friction behind it.

Oil that a film takes in, holds and gives off, and the heat of its motion: what the temperature's balances are made of.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from exudyn_ehd.film.heat.energy import content_rate, film_flows, outside_flows
from exudyn_ehd.joint.solved_film import SolvedFilm


class Powers(NamedTuple):
    """Friction on the journal about its own axis, Nm, and powers, W, of film and contacts.

    friction_torque, contact_torque : of all, and of the contacts
    sliding, contact_loss : what spin and axial speed put in, and the part that contact friction takes
    stored : what a liner and touching surfaces take up
    loss : what stays, without what the film does to a flexible bore

    See `exudyn_ehd.joint.model.quantities.quantities`.
    """

    friction_torque: float
    contact_torque: float
    sliding: float
    contact_loss: float
    stored: float
    loss: float


def powers(film: SolvedFilm) -> Powers:
    """Friction and powers of a solved film."""
    x, y, bx, by, x_t, y_t, bx_t, by_t, omega, w = film.journal.motion[:10].tolist()
    loads = film.loads
    fx, fy, fz, mx, my, _ = loads.wrench.tolist()
    contact, contact_loss = 0.0, 0.0
    if film.pressing is not None:
        cx, cy, cz, c_mx, c_my, c_mz = loads.contact.tolist()
        contact = c_mz - (x * cy - y * cx - bx * c_mx - by * c_my)
        contact_loss = 0.0 - contact * omega - cz * w
    torque_scale = film.scales.shear * film.grid.reference_length**2
    friction = -torque_scale * (omega * loads.couette - 6.0 * loads.s_theta) + contact
    along = fz + bx * fx + by * fy  # a tilted journal slides along its own axis, not along z
    sliding, stored = -(friction * omega + along * w), stored_power(film)
    loss = sliding - (fx * x_t + fy * y_t - mx * by_t + my * bx_t) - stored
    if film.bore is not None:
        loss -= float(film.bore.load @ film.bore.rates)
    return Powers(friction, contact, sliding, contact_loss, stored, loss)


def stored_power(film: SolvedFilm) -> float:
    """Power that a liner and touching surfaces take up, W; see `exudyn_ehd.joint.model.quantities.quantities`."""
    p, limited, scaled = film.parts, film.limited, 0.0
    if p.liner is not None:
        scaled = p.liner.stored_power()
        if p.liner.limited:
            contact = p.liner.contact_pressure / film.scales.pressure
            scaled += _by_touching(film, p.liner.gap_slopes.rate_t, p.liner.true_rate, contact)
    elif limited is not None:
        pressed = film.solver.nothing if film.pressing is None else np.sum(film.pressing.P, axis=0)
        scaled = _by_touching(film, limited.slope, limited.rate, pressed / film.scales.pressure)
    return scaled * film.scales.pressure * p.flow_scale


def _by_touching(film: SolvedFilm, slope: np.ndarray, rate: np.ndarray, contact: np.ndarray) -> float:
    """``-sum (p_c + (1 - slope) p) dh/dt`` with the slope of the film's gap to the true gap h and h's rate, scaled."""
    return -float(np.sum(film.grid.weight * (contact + (1.0 - slope) * film.oil.P) * rate))


class Exchange:
    """Flows of a solved film, oil that enters it from outside, and the rate of its content, in units of c R^2.

    Of a compressible film, flows and contents are masses over the density at ambient pressure.

    Attributes
    ----------
    fill, rate, outside : (n, m) arrays
        Film fraction, times the density ratio; d(fill H)/dt, 1/s; flow that enters at the ends and at supplies.
    x, z : (n, m) arrays
        Over the links i -> i+1 and j -> j+1.
    balance : (n, m) array
        What leaves a vertex over its links, or is stored there.
    fx, fz, convected : (n, m) arrays
        Couette flows of the links before they take the upstream value of ``convected`` along.
    """

    def __init__(self, film: SolvedFilm) -> None:
        s, y = film.solver, film.solver.system
        conserves, fixed = s.closure.conserves_mass, film.grid.fixed
        self.fill, self.convected = s.fill if conserves else s.ones, s.carried
        self.fx, self.fz = y.fx, y.fz
        oil = film.parts.compressible
        if oil is not None:
            # these flows hold the upstream film fraction and the links' density already
            self.fx, self.fz, _ = oil.couette_flows()
            self.fill, self.convected = oil.rho * self.fill, s.ones
        self.stepped = conserves and y.inverse_step > 0.0 and not s.instant
        inverse_step = y.inverse_step if self.stepped else 0.0
        self.rate = content_rate(s.H, s.H_t, self.fill, y.mass_old, inverse_step, s.squeeze)
        unbroken = np.ones_like(fixed) if conserves else s.work.active | fixed
        self.x, self.z, self.balance = np.empty((3, *film.grid.shape))
        film_flows(s.pressure, self.convected, y.kx, y.kz, self.fx, self.fz, self.x, self.z, self.balance)
        self.balance += s.area * self.rate
        self.outside = outside_flows(self.z, self.balance, fixed, unbroken)

    @property
    def leaving(self) -> float:
        """Sum of what leaves."""
        return -float(np.minimum(self.outside, 0.0).sum())


class OilFlows(Exchange):
    """`Exchange` of a film with what its energy equation asks for in addition.

    Attributes
    ----------
    found : (n, m) array
        Entering in addition, where a cavitation model does not conserve mass; negative where it loses oil.
    content : (n, m) array
        Content of the storage term (scaled gap, times the density ratio).
    """

    def __init__(self, film: SolvedFilm) -> None:
        super().__init__(film)
        s, y = film.solver, film.solver.system
        self.content = y.mass_old if self.stepped else self.fill * s.H
        self.found = s.nothing if s.closure.conserves_mass else self.balance - self.outside


def heat_and_leakage(film: SolvedFilm) -> tuple[float, float]:
    """Power that film and contacts turn into heat, W, and the flow that leaves, in units of c R^2.

    What a link carries dissipates its own power: what sliding puts in, and what the flow loses of its pressure. Summed
    over the links by parts, with the cavity's pressure pc, the inflow S from outside and the content's rate,

        heat = sliding power + sum (p - pc) (S - A dm/dt),

    which holds none of the powers that store and give back: where nothing changes in time it is `Powers.loss` plus the
    work on the oil, to rounding. Oil that cavities find or lose has their pressure and does no work, also where a
    rupture line crosses a cell. Of a compressible film p is the flow work ``integral of dp / (rho / rho_0)``, flows and
    content are masses. The flow that leaves is that of `Exchange`, less what a supply area takes back from the film and
    gives to it again; in a long bearing, whose oil has no other way out, all of it.
    """
    flows, oil = Exchange(film), film.parts.compressible
    P, cavity = film.oil.P, np.asarray(film.scales.cavity if math.isfinite(film.scales.cavity) else 0.0)
    pressure = P - cavity if oil is None else oil.flow_work(P) - oil.flow_work(cavity)
    work = float(np.sum(pressure * (flows.outside - film.solver.area * flows.rate)))
    power = film.scales.pressure * film.parts.flow_scale
    areas = film.parts.supply.masks if film.parts.supply is not None and film.grid.flows_along_z else ()
    back = sum(min(np.maximum(side * flows.outside[at], 0.0).sum() for side in (1.0, -1.0)) for at in areas)
    return powers(film).sliding + power * (work + _end_work(film)), flows.leaving - float(back)


def _end_work(film: SolvedFilm) -> float:
    """Work of the pressure on the ends' cross section, scaled."""
    if film.journal.axial_speed == 0.0:
        return 0.0
    g, section = film.grid, film.oil.P * film.solver.H
    return film.journal.axial_speed / g.reference_length * float(g.width_x @ (section[:, -1] - section[:, 0]))
