"""Mechanical power that film and contacts dissipate or store, friction, oil flows and heat of a solved film.

The heat balances of `exudyn_ehd.joint.heat` are made of them.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from exudyn_ehd.bearing import MaximumGap
from exudyn_ehd.film.heat.energy import (
    content_rate,
    end_flows_around,
    film_flows,
    film_heat,
    outside_flows,
    pass_on,
)
from exudyn_ehd.film.solvers.film import ends_of_cavities
from exudyn_ehd.joint.solved_film import SolvedFilm


class Powers(NamedTuple):
    """Friction on the journal about its own axis, Nm, and powers, W, of film and contacts.

    friction_torque, contact_torque : of film and contacts, and of the contacts alone
    sliding, contact_loss : power put in by spin and axial speed, and its part dissipated by contact friction
    stored : power stored by a liner and by touching surfaces
    loss : dissipated power, without the power that the film transmits to a flexible bore

    See `exudyn_ehd.joint.model.results.quantities`.
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
    """Power that a liner and touching surfaces store, W; see `exudyn_ehd.joint.model.results.quantities`."""
    p, limited, scaled = film.parts, film.limited, 0.0
    if p.liner is not None:
        scaled = p.liner.stored_power()
        if p.liner.limiter is not None:
            contact = p.liner.contact_pressure / film.scales.pressure
            scaled += _by_touching(film, p.liner.gap_slopes.rate_t, p.liner.true_rate, contact)
    elif limited is not None:
        pressed = film.solver.nothing if film.pressing is None else np.sum(film.pressing.P, axis=0)
        scaled = _by_touching(film, limited.slope, limited.rate, pressed / film.scales.pressure)
    return scaled * film.scales.pressure * p.flow_scale


def _by_touching(film: SolvedFilm, slope: np.ndarray, rate: np.ndarray, contact: np.ndarray) -> float:
    """Scaled ``-sum (p_c + (1 - slope) p) dh/dt``; h is the true gap, slope the film gap's derivative to h."""
    return -float(np.sum(film.grid.weight * (contact + (1.0 - slope) * film.oil.P) * rate))


class OilFlows:
    """Flows of a solved film, oil that enters it from outside, and the rate of its content, in units of c R^2.

    The ends, supply areas and edges of arcs belong to the outside. Oil that flows around within them neither enters nor
    leaves the film.

    The half control volume of an end has the void of the neighbouring vertex. If it were full next to a cavity, as its
    prescribed pressure suggests, it would take in cold oil where the gap opens and give off hot oil where it closes.

    A supply area is a well-mixed volume, and so is the groove between two arcs. With the flow Q that the film presses
    into it, of the mean temperature T, the net feed N of fresh oil at the supply temperature T_s, and X that flushes
    it, all that flows out of it has

        T_mix = (Q T + (N + X) T_s) / (Q + N + X),        X = (1 / carry_over - 1) Q,

    the heat balance of a groove with hot oil carried over (H. Heshmat and O. Pinkus, J. Tribology 108 (1986) 231). In
    an area with a net outflow, N < 0, only Q and X mix, and the outflow leaves with T_mix. In a film without axial
    flow, oil leaves through areas only, and areas do not mix: oil that the film presses into an area leaves, and oil
    from an area is fresh.

    Flows and contents of a compressible film are masses over the density at ambient pressure.

    Parameters
    ----------
    film : SolvedFilm
    carry_over : float
        See `exudyn_ehd.film.heat.options`.

    Attributes
    ----------
    rate, content : (n, m) arrays
        d(fill H)/dt, 1/s; content of the storage term (scaled gap, times the density ratio), in the middle of the step.
    x, z : (n, m) arrays
        Flows over the links i -> i+1 and j -> j+1.
    outside : (n, m) array
        Net flow into the film at the ends and at supplies.
    entering, leaving : (n, m) arrays
        Flow that enters with the supply temperature, and flow that leaves with the film's temperature; their difference
        is ``outside``. In areas that mix, only the sums over the area are meaningful: single values of ``leaving`` may
        be negative.
    found, lost : (n, m) arrays
        Where a cavitation model does not conserve mass: oil that it makes, and oil that it drops. Not the oil that it
        makes as the gap of a cavity widens in front of a groove or of the edge of an arc: see `pass_on`.
    passed, made : (n, m) arrays
        Oil that this groove or edge receives less, contained in ``outside``; and all oil that a cavitation model makes
        in front of it. The latter is larger where a loaded film forms again between cavity and groove.
    back : float
        Share of ``found`` that has the mixed temperature of ``lost``; the rest is fresh oil.
    areas : list of (n, m) bool arrays
        Vertices of the areas that mix.
    lines : list of (n, m) bool arrays
        Vertices of the line of `MaximumGap`, for closures that do not conserve mass. Oil is lost or found there, as
        where the film of a closed ring begins, so that oil leaves the bearing only at its ends.
    """

    def __init__(self, film: SolvedFilm, carry_over: float) -> None:
        s, y, supply = film.solver, film.solver.system, film.parts.supply
        conserves, fixed = s.closure.conserves_mass, film.grid.fixed
        fill, fx, fz, carried = s.fill if conserves else s.ones, y.fx, y.fz, s.carried
        if s.law is not None:
            # these flows already contain the upstream film fraction and the density of the links
            fx, fz, _ = s.couette_flows()
            fill, carried = s.rho * fill, s.ones
        stepped = conserves and y.inverse_step > 0.0 and not y.instant
        self.rate = content_rate(s.H, s.H_t, fill, y.mass_old, y.inverse_step if stepped else 0.0, s.squeeze)
        # in the middle of the step: the content at its start plus half a step of the gap's rate
        before = y.mass_old if stepped else fill * s.H - film.step * self.rate
        self.content = np.maximum(before + 0.5 * film.step * s.H_t, 0.0)
        links, balance = film_flows(y.flow_pressure, carried, conductances_of(film), np.array((fx, fz)))
        self.x, self.z = links
        if conserves:
            self._void_the_ends(film, stepped)
        balance += s.area * self.rate
        unbroken = np.ones_like(fixed) if conserves else s.work.active | fixed
        self.outside = outside_flows(self.z, balance, fixed, unbroken)
        if conserves and film.grid.flows_along_z:
            self._flow_around(film, fx)
        self.areas = film.parts.mixing if film.grid.flows_along_z else []
        if self.areas and not conserves:
            # inflow of films that end within a link of an area; the rest of the balance is found or lost by the cavity
            inside = np.logical_or.reduce(self.areas)
            ended = supply is not None and not supply.rotating
            np.copyto(self.outside, s.inflow(ended), where=inside)
        self.lines: list[np.ndarray] = []
        if not conserves and film.grid.flows_along_z and isinstance(film.parts.bearing.inlet, MaximumGap):
            self.lines = [(np.arange(len(fixed)) == 0)[:, None] & (np.abs(film.grid.z) < film.grid.z[-1])]
            self.outside[self.lines[0]] = 0.0
        found = s.nothing if conserves else balance - self.outside
        self.passed, self.made = self._pass_on(film, fx, found)
        self.outside += self.passed
        self.found, self.lost = np.maximum(found, 0.0), np.maximum(-found, 0.0)
        self.total_found, self.total_lost = float(self.found.sum()), float(self.lost.sum())
        self.back = carry_over * min(1.0, self.total_lost / self.total_found) if self.total_found > 0.0 else 0.0
        self.entering = np.maximum(self.outside, 0.0)
        for area in self.areas:
            self.entering[area] = max(0.0, float(self.outside[area].mean()))
        if carry_over < 1.0 and film.parts.mixing:
            self.entering += (1.0 / carry_over - 1.0) * self._arriving(np.logical_or.reduce(film.parts.mixing))
        self.leaving = self.entering - self.outside

    @property
    def exchanged(self) -> float:
        """Flow that leaves a film of one temperature and is replaced by oil of the supply temperature."""
        return float(self.leaving.sum()) + self.total_lost - self.back * self.total_found

    @property
    def largest(self) -> float:
        """Largest flow over a link."""
        return float(max(np.abs(self.x).max(), np.abs(self.z).max()))

    def _pass_on(self, film: SolvedFilm, fx: np.ndarray, found: np.ndarray) -> np.ndarray:
        """Return `pass_on` for the walls of grooves and the edges of arcs.

        The film in front of a groove is full, up to the groove's pressure, and feeds on what the cavity passes on. A
        film at higher pressures carries load and finds the oil that it needs: a vertex passes on the ratio of the
        largest pressure at the walls to its own. Below 1 % of the largest pressure of the film it passes on all, also
        in front of grooves without pressure, so that the flows do not jump where a cavity ends at another vertex.
        """
        walls, P = film.parts.grooves, film.solver.pressure
        if film.solver.closure.conserves_mass or not walls.any():
            return np.zeros((2, *P.shape))
        level = max(float(P[walls > 0.0].max()), 0.01 * float(P.max()), 1e-300)
        shares = level / np.maximum(P, level)
        return np.asarray(pass_on(self.x, fx, found, shares, walls, film.journal.omega))

    def _void_the_ends(self, film: SolvedFilm, stepped: bool) -> None:
        """Give the ends' control volumes the void of the neighbouring vertices."""
        s = film.solver
        old = film.history.void if stepped and film.history is not None else None
        for end, beside, at in ends_of_cavities(s.system, True):
            if old is None:
                share = np.where(at, s.fill[:, beside], 1.0)
                self.rate[:, end] *= share
                self.content[:, end] *= share
            else:
                void, lacked = (np.where(at, v[:, beside], 0.0) for v in (s.H - s.content, old))
                self.rate[:, end] -= (void - lacked) * s.system.inverse_step
                self.content[:, end] = np.maximum(self.content[:, end] - lacked, 0.0)

    def _flow_around(self, film: SolvedFilm, fx: np.ndarray) -> None:
        """Exclude oil that flows around within the ends' control volumes from the oil that enters."""
        s = film.solver
        for end, beside, _ in ends_of_cavities(s.system, True):
            if not film.grid.fixed[:, end].all():
                continue
            pressed = self.z[:, 0].copy() if end == 0 else -self.z[:, beside]
            stored, squeezed = (s.area[:, end] * rate[:, end] for rate in (self.rate, s.H_t))
            full = (s.fill[:, beside] >= 1.0) & (s.pressure[:, end] > s.system.cavity_pressure)
            full[film.grid.edges.ravel()] = True  # grooves between arcs
            flow = np.empty_like(pressed)
            end_flows_around(fx[:, end].copy(), pressed, stored, squeezed, full, flow, self.outside[:, end])
            self.x[:, end] = flow

    def _arriving(self, inside: np.ndarray) -> np.ndarray:
        """Flow from the film into the vertices ``inside`` supply areas (n, m)."""
        out = np.zeros(inside.shape)
        for axis, flow in enumerate((self.x, self.z)):
            # no flow along z links the last column with the first
            after = np.roll(inside, -1, axis)
            out += np.roll(np.where(after & ~inside, np.maximum(flow, 0.0), 0.0), 1, axis)
            out += np.where(inside & ~after, np.maximum(-flow, 0.0), 0.0)
        return out


def conductances_of(film: SolvedFilm) -> np.ndarray:
    """Conductances (2, n, m) of the links in theta and z; 0 on links along the ends to corners of arcs.

    Pressures jump at these corners.
    """
    k, (first, last) = np.array((film.solver.system.kx, film.solver.system.kz)), film.grid.edges.T
    k[0, np.append(first, last - 1)[:, None], [0, -1]] = 0.0
    return k


def heat_and_exchange(film: SolvedFilm, carry_over: float) -> tuple[float, float]:
    """Power that film and contacts turn into heat, W, and `OilFlows.exchanged`; both with films on end faces.

    Each link dissipates the power of sliding and the pressure drop times the flow. Summed by parts over the links, with
    the cavity pressure pc, the inflow S from outside and the rate dm/dt of the content,

        heat = sliding power + sum (p - pc) (S - A dm/dt),

    It contains no stored power. In a steady state it is `Powers.loss` plus the work on the oil, to round-off. Oil that
    cavities find or lose has their pressure and does no work, also where a rupture line crosses a cell. In a
    compressible film p is the flow work ``integral of dp / (rho / rho_0)``, and flows and contents are masses.

    Oil that leaves the bore at an end flows into the gap between bush and collar. A thrust face takes in this oil
    first. If it needs more, and at its outer radius, it takes in fresh oil.
    """
    flows, s = OilFlows(film, carry_over), film.solver
    cavity = np.asarray(film.scales.cavity if math.isfinite(film.scales.cavity) else 0.0)
    pressure = dropped(film) - (cavity if s.law is None else s.flow_work(cavity))
    entering = flows.outside - flows.passed - s.area * flows.rate
    for area in [*flows.areas, *flows.lines]:
        entering[area] += flows.found[area] - flows.lost[area]
    work = float(np.sum(pressure * entering))
    power = film.scales.pressure * film.parts.flow_scale
    heat, exchanged = powers(film).sliding + power * (work + _end_work(film)), flows.exchanged
    if film.beside is not None:
        own, unit = film.beside, film.parts.flow_scale
        lacking = own.inner / unit - np.maximum(flows.leaving[:, [0, -1]], 0.0).sum(axis=0)
        heat, exchanged = heat + own.heat, exchanged + float(np.maximum(lacking, 0.0).sum()) + own.outer / unit
    return heat, exchanged


def _end_work(film: SolvedFilm) -> float:
    """Work of the pressure on the ends' cross section, scaled."""
    if film.journal.axial_speed == 0.0:
        return 0.0
    g, section = film.grid, film.oil.P * film.solver.H
    return film.journal.axial_speed / g.reference_length * float(g.width_x @ (section[:, -1] - section[:, 0]))


def heat_of(film: SolvedFilm) -> np.ndarray:
    """Heat at the vertices, W (n, m): shear, pressure flow and contact friction.

    Their sum equals that of `heat_and_exchange` up to the grid's error. The shear is scaled to the shear of the loads.
    Counted on control volumes it would be too large on ten rows: up to 5 % next to supply areas, where the film
    fraction changes within a row, and up to 6 % where cold oil enters the ends, since the viscosity changes within a
    row. In films without supply areas the difference is applied at the ends.
    """
    p, s, R, w = film.parts, film.solver, film.grid.reference_length, film.journal
    flow_power = p.flow_scale * film.scales.pressure
    heat = sheared(film)
    heat += film_heat(dropped(film), s.system.flow_pressure, conductances_of(film))
    heat *= flow_power
    rubbed = powers(film).contact_loss
    if film.pressing is not None and rubbed > 0.0:
        friction = np.zeros(film.grid.shape)
        for (coefficient, transition), P in zip(film.pressing.friction, film.pressing.P, strict=True):
            (g_theta, g_z), _ = film.slip(transition)
            friction += coefficient * (g_theta * (R * w.omega) + g_z * w.axial_speed) * P * s.area
        # scaled to the friction of the loads, whose integrals resolve contacts on an edge
        heat += friction * (rubbed / friction.sum())
    return heat


def dropped(film: SolvedFilm) -> np.ndarray:
    """Return the energy per scaled flow at the vertices (n, m): pressure, or flow work of a compressible film."""
    return film.oil.P if film.solver.law is None else film.solver.flow_work(film.oil.P)


def sheared(film: SolvedFilm) -> np.ndarray:
    """Heat of sliding at the vertices (n, m), scaled by the power of a unit of flow and pressure."""
    R, w, s = film.grid.reference_length, film.journal, film.solver
    ratio = 1.0 if film.oil.ratio is None else film.oil.ratio
    speed2 = w.omega**2 + (w.axial_speed / R) ** 2
    flow_power = film.parts.flow_scale * film.scales.pressure
    shear = film.share() * ratio / s.H
    density = s.area * shear
    # scaled to the integrals of the loads, which resolve changes next to an area and to an end that cold oil enters
    if film.parts.supply is not None:
        density *= film.parts.supply.land
        density *= np.sum(film.grid.shear_weight * shear) / np.sum(density)
    else:
        missed, lower = (film.grid.shear_weight - s.area) * shear, 0.5 - 0.5 * np.sign(film.grid.z)
        for end, side in ((0, lower), (-1, 1.0 - lower)):
            density[:, end] *= 1.0 + float(np.sum(missed @ side)) / max(float(density[:, end].sum()), 1e-300)
    if film.loads.recess is not None:
        density += film.loads.recess.density
    return film.scales.shear / flow_power * speed2 * R**2 * density
