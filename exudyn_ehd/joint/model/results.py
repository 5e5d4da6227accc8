"""Results of a solved film: scalars in SI units (gap, peak, friction, losses, flows), and copies of its fields."""

from __future__ import annotations

import math

import numpy as np

from exudyn_ehd.film import loads
from exudyn_ehd.joint.heat.power import OilFlows, powers
from exudyn_ehd.joint.model.effects import Wear
from exudyn_ehd.joint.solved_film import FilmParts, History, SolvedFilm
from exudyn_ehd.pictures.mixins import FilmPictures
from exudyn_ehd.pictures.records import FilmRecord, JointFilm, shown


def eccentricities(parts: FilmParts, pose: np.ndarray) -> dict[str, float]:
    """``eccentricity_ratio`` and ``largest_eccentricity_ratio`` of a scaled pose (4,); see `quantities`."""
    x, y, bx, by = pose.tolist()
    a, b = parts.half_length * bx, parts.half_length * by
    return {
        "eccentricity_ratio": math.hypot(x, y),
        "largest_eccentricity_ratio": max(math.hypot(x + a, y + b), math.hypot(x - a, y - b)),
    }


def quantities(film: SolvedFilm, wear: Wear | None = None) -> dict[str, float]:
    """Scalars of a solved film.

    The mechanical power that enters the film becomes heat of shear and pressure flow, and work on the oil that flows
    out,

        power_loss = int (mu U^2 share / h + h^3 / (12 mu) |grad p|^2) dA
                     + sum (p - pc) outflow - pc dV/dt - w sum p h ds,

    with pc the cavity pressure, V the volume between the surfaces, ds along the ends (+ at z > 0, - at z < 0). It
    follows from Reynolds' equation times p - pc, summed by parts. If ends and cavity are at gauge pressure 0, it is the
    heat alone. The shear term is that of the lands; for supply areas with a depth see `exudyn_ehd.film.supply.areas`.
    The last term is the power of the pressure on the ends' cross section, which is part of the journal's wrench. For
    compressible oil, p - pc becomes the integral of dp / (rho / rho_0), the outflow the mass flow over rho_0, and the
    rate of the elastic energy in the film is added. The power that deflects a flexible bore is not included, because it
    enters the bush. Neither is the power that solids store and give back,

        stored_power = int (p + p_c) d(delta)/dt - (p_c + (1 - dh/dg) p) dg/dt dA

    with a liner's deflection delta, the contact pressure p_c, the gap g of the surfaces and the film's gap h, which
    differs from g where a wall or asperities limit it. Liner and contact pressure give back all stored energy. The oil
    pressure on touching surfaces gives energy back at the pressure of that instant, so that over a cycle a difference
    of either sign may remain.

    In a steady state ``stored_power`` is zero, and ``power_loss`` is the heat of `LumpedThermal` plus the work on the
    oil, to round-off. In motion they differ by the grid's error, of second order, since power is computed from forces
    and heat from flows, and by the error of backward Euler in a step. `FilmEnergy` sums the heat over control volumes,
    with the grid's error in all states.

    Returns
    -------
    dict
        ``minimum_gap`` (m, over the whole bearing with its edges), ``minimum_gap_angle`` and ``minimum_gap_z`` (its
        place, rad and m), ``eccentricity_ratio`` (at the mid-plane), ``largest_eccentricity_ratio`` (over the
        length), ``peak_pressure`` (Pa, from parabolas through the largest vertex) at ``peak_angle`` (rad),
        ``friction_torque`` (Nm, on the journal about its own axis, film and contact), ``friction_torque_unbroken``
        (Nm, of the film, with shear of its unbroken part only), ``friction_torque_bush`` (Nm, on the housing about the
        bearing axis), ``power_loss`` (W, mechanical power dissipated in film and contact), ``stored_power`` (W, stored
        by liner and contact; negative: given back), ``leakage`` (m3/s out of both ends), ``leakage_lower`` and
        ``leakage_upper``, ``contact_load`` (N, vector sum of the contact pressure), ``contact_torque`` (Nm, friction of
        the contact on the journal about its own axis), ``contact_power_loss`` (W, part of ``power_loss`` by this
        friction), ``peak_contact_pressure`` (Pa, largest vertex); with supply areas also ``supply_flow`` (m3/s, out of
        all of them), which with arcs includes the oil that enters at their edges; with restrictors
        ``lowest_pocket_pressure`` and ``highest_pocket_pressure`` (Pa) of the areas that they feed; with a thermal
        effect ``film_temperature`` (K, mean over the area) and ``peak_temperature`` (K), with a sump
        ``sump_temperature`` (K), with walls that conduct or two temperatures across the film ``bush_temperature`` and
        ``journal_temperature`` (K, mean at the film) and ``clearance`` (m, radial, including the walls' growth), with a
        liner or a flexible bore ``bore_displacement`` (m, the largest), with ``wear``
        ``wear_depth`` (m, the largest) and ``worn_volume`` (m3) of the bore at the end of the step.
    """
    p, w, area = film.parts, film.journal, film.grid.area
    R = p.grid.reference_length
    angle, z = minimum_place(film)
    lower, upper = leakages(film)
    power = powers(film)
    torque_scale, poiseuille = film.scales.shear * R**2, 6.0 * film.loads.s_theta
    contact_load = peak_contact = 0.0
    if film.pressing is not None:
        contact_load = R**2 * math.hypot(*film.pressing.integrals[:, :2].sum(axis=0).tolist())
        peak_contact = max(float(f.max()) for f in film.pressing.P)
    largest, peak_angle, _ = refined_peak(film)
    out = {
        "minimum_gap": film.minimum_gap,
        **eccentricities(p, w.pose),
        "minimum_gap_angle": angle,
        "minimum_gap_z": z,
        "peak_pressure": largest,
        "peak_angle": peak_angle % (2.0 * math.pi),
        "friction_torque": power.friction_torque,
        "friction_torque_unbroken": -torque_scale * (w.omega * _unbroken_couette(film) - poiseuille),
        "friction_torque_bush": -float(film.loads.wrench[5]),
        "power_loss": power.loss,
        "stored_power": power.stored,
        "leakage": p.flow_scale * (lower + upper),
        "leakage_lower": p.flow_scale * lower,
        "leakage_upper": p.flow_scale * upper,
        "contact_load": contact_load,
        "contact_torque": power.contact_torque,
        "contact_power_loss": power.contact_loss,
        "peak_contact_pressure": peak_contact,
    }
    if p.supply is not None or p.grid.edges.size:
        out["supply_flow"] = float(supply_flows(film).sum())
    if (reservoirs := p.solver.reservoirs) is not None:
        out["lowest_pocket_pressure"] = float(reservoirs.pressures.min())
        out["highest_pocket_pressure"] = float(reservoirs.pressures.max())
    if film.temperature is not None:
        out["film_temperature"] = float(np.average(np.broadcast_to(film.temperature, area.shape), weights=area))
        T = film.temperature if film.walls is None else film.walls.across_film(film.temperature)
        out["peak_temperature"] = float(np.max(T))
    if film.history is not None and film.history.sump is not None:
        out["sump_temperature"] = film.history.sump
    if film.walls is not None:
        out |= film.walls.numbers(area)
    if p.liner is not None:
        out["bore_displacement"] = float(np.abs(p.liner.deflection).max()) * p.bearing.radial_clearance
    if wear is not None:
        depth = p.bearing.radial_clearance * wear.grown(film)
        out |= {"wear_depth": float(depth.max()), "worn_volume": R**2 * float(np.vdot(depth, p.grid.weight))}
    return out


def _unbroken_couette(film: SolvedFilm) -> float:
    """Scaled integral of the Couette shear over the unbroken film, recesses included."""
    s, g, ratio, recess = film.solver, film.grid, film.oil.ratio, film.loads.recess
    density = g.shear_weight if ratio is None else ratio * g.shear_weight
    if s.closure.conserves_mass:
        unbroken = float(np.sum(density / s.H, where=film.share() >= 1.0))
    else:
        unbroken = loads.couette_integral(s.H, density, s.work.active, g.fixed, 0.0)
    return unbroken if recess is None else unbroken + float(recess.density.sum())


def supply_flows(film: SolvedFilm) -> np.ndarray:
    """Return the inflow of every area of ``bearing.supply``, m3/s; empty without areas and arcs.

    With arcs, two values for each arc come first: the inflow at its leading and at its trailing edge, 0 for outflow.
    Without the oil that a cavity of `SwiftStieber` makes in front of grooves and pockets.
    """
    p, flow_scale, edges = film.parts, film.parts.flow_scale, np.zeros(0)
    if p.grid.edges.size:
        k, P, (first, last) = p.solver.system.kx, p.solver.system.pressure, p.grid.edges.T
        # without the flows from the arc's corners along the ends, where pressures jump
        jumps = np.array((k[first] * (P[first] - P[first + 1]), k[last - 1] * (P[last] - P[last - 1])))
        fed = p.solver.inflow()[p.grid.edges.T].sum(axis=-1) - jumps[..., [0, -1]].sum(axis=-1)
        edges = fed.T.ravel().clip(0.0)
    if p.supply is None:
        return edges * flow_scale
    # not for turning areas, whose flow would jump when an edge passes a column
    flows = p.supply.flows(p.solver.inflow(ended=not p.supply.rotating))
    if p.solver.reservoirs is not None:  # areas with a restrictor: the inflow of their balances
        flows = np.where(p.supply.fed, p.supply.flows(p.solver.inflow()), flows)
    if p.grooves.any():
        flows = flows + p.supply.flows(OilFlows(film, 1.0).made)
    return np.append(edges, flows) * flow_scale


def pocket_pressures(film: SolvedFilm) -> tuple[np.ndarray, np.ndarray]:
    """Pressure of every area of ``bearing.supply``, Pa, and flow through its restrictor, m3/s, nan without one."""
    supply, reservoirs = film.parts.supply, film.solver.reservoirs
    pressures = np.zeros(0) if supply is None else supply.pressures()
    flows = np.full(pressures.size, np.nan)
    if supply is not None and reservoirs is not None:
        pressures[supply.fed], flows[supply.fed] = reservoirs.pressures, reservoirs.flows()
    return pressures, flows


def passing_flows(film: SolvedFilm) -> tuple[float, float]:
    """Return the circumferential flow into the loaded zone, and the flow of fresh oil through the film, m3/s.

    The first is the flow, in the direction of the spin, through the section at the angle theta_1 where the film begins,

        Q_1 = int q_theta dz,    q_theta = fill U h / 2 - h^3 / (12 mu R) dp/dtheta,    U = R omega,

    the flow at the entrance of the gap in ISO 7902, Raimondi and Boyd's Q. theta_1 is searched from the largest
    pressure, against the spin, along its row of the grid: the first vertex at an edge of an arc or of a supply area, in
    a cavity, on the line of `MaximumGap`, or with the largest gap of the row. The flow is that of the link that begins
    there; nan without a spin. The second one is `exudyn_ehd.joint.heat.power.OilFlows.exchanged`. With a single arc it
    is the supply flow: oil that enters at its edges is fresh.
    """
    g, p, omega = film.grid, film.parts, film.journal.omega
    flows = OilFlows(film, getattr(p.bearing.thermal, "carry_over", 1.0))
    through = p.flow_scale * flows.exchanged if len(g.edges) != 1 else float(supply_flows(film).sum())
    if omega == 0.0:
        return math.nan, through
    k, row = divmod(int(np.argmax(np.where(g.fixed, -math.inf, film.oil.P))), g.z.size)
    begins = g.fixed[:, row] | ~film.solver.work.active[:, row]
    begins[film.solver.H[:, row].argmax()] = True
    way = 1 if omega > 0.0 else -1
    while not begins[k := (k - way) % g.x.size]:
        pass
    return p.flow_scale * abs(float(flows.x[k if way > 0 else k - 1].sum())), through


def leakages(film: SolvedFilm) -> tuple[float, float]:
    """Scaled flows out of the lower and the upper end; times ``flow_scale`` in m3/s."""
    s, g = film.solver, film.grid
    if not g.flows_along_z:
        return 0.0, 0.0
    # not for arcs: balances of the vertices on their ends include oil that flows along the end from edge to edge
    if s.closure.conserves_mass and not g.edges.size:
        inflow = s.inflow()
        return -float(inflow[:, 0].sum()), -float(inflow[:, -1].sum())
    fx, fz, rate = s.couette_flows()
    P, full = s.flow_pressures()
    if film.parts.supply is not None:
        full = np.logical_or.reduce([full, *film.parts.supply.masks])
    return loads.end_flows(P, s.system.kz, fz, fx, rate, g.width_x, g.width_z, s.squeeze, full)


def minimum_place(film: SolvedFilm) -> tuple[float, float]:
    """theta (rad, 0 to 2 pi) and z (m) of the minimum film thickness.

    For rigid cylinders it is exact: at one of the ends, or at z = 0 if the gap is the same along the bearing. With a
    profile, wear, arcs or a flexible bore it is the vertex with the smallest gap.
    """
    R, half = film.grid.reference_length, film.parts.half_length
    if film.extra is not None or film.parts.liner is not None or film.grid.edges.size:
        i, j = divmod(int(np.argmin(film.solver.H)), film.grid.z.size)
        return float(film.grid.x[i] % (2.0 * math.pi)), float(film.grid.z[j] * R)
    x, y, bx, by = film.journal.pose.tolist()
    # |e|^2 at either end differs by 4 half (x bx + y by)
    lean = x * bx + y * by
    end = math.copysign(half, lean) if lean != 0.0 or bx != 0.0 or by != 0.0 else 0.0
    return math.atan2(y + end * by, x + end * bx) % (2.0 * math.pi), end * R


def refined_peak(film: SolvedFilm) -> tuple[float, float, float]:
    """Peak pressure (Pa) with its angle (rad) and z (m), from parabolas through the largest vertex."""
    g = film.grid
    value, theta, z = loads.refined_peak(film.oil.P, g.fixed, g.x, g.link_x, g.z)
    return value * film.scales.pressure, theta, z * g.reference_length


class FilmFields(JointFilm, FilmPictures):
    """The film of a joint at one instant: joint frame, SI units, arrays ``[theta, z]``.

    Attributes
    ----------
    time : float
        Time of the film, s.
    theta, z : (n,), (m,) arrays
        Angles from x about z, rad, and places along the axis from the mid-plane, m, of the grid.
    pressure, gap : (n, m) arrays
        Film pressure above ambient, Pa, and film thickness, m.
    unbroken : (n, m) bool array
        True where the film is not cavitated.
    fill : (n, m) array or None
        Film fraction: oil over gap; None for closures that do not conserve mass.
    temperature : (n, m) array, float or None
        Temperature of the film, K; one number with `LumpedThermal`, None for an isothermal bearing.
    walls : Walls or None
        Temperatures of bush and journal, and the radial clearance that they leave; None unless a wall conducts or the
        film has two temperatures across it.
    bore_displacement : (n, m) array or None
        Deflection of a flexible bore or a liner, m, positive outward; None for a rigid one.
    contact_pressure : (n, m) array or None
        Pressure of asperities or wall, Pa; None without contact.
    wear_depth : (n, m) array or None
        Depth worn off the bore up to this instant, m; None without wear.
    force, moment : (3,) arrays
        Force [N] and moment [N m] on the journal, the moment about the frame's origin.
    motion : (10,) array
        Motion of the journal, as in `JointHistory`; with a flexible bore its coordinates and rates follow.
    bearing : JournalBearing
    bush_displacement : (k, 3) array or None
        Displacements of all nodes of a bush's mesh against the housing, joint frame, m; None without a bush.

    Examples
    --------
    After the example of `SolveDynamic`:

    >>> film = joint.film()
    >>> film.pressure.shape, film.time
    ((112, 11), 0.002)
    >>> round(float(1e-6 * film.pressure.max()), 2)  # MPa
    0.77
    """

    def __repr__(self) -> str:
        gap, peak = shown("length", float(self.gap.min())), shown("pressure", float(self.pressure.max()))
        return f"<FilmFields at {shown('time', self.time)}: minimum film thickness {gap}, peak pressure {peak}>"


def film_record(film: SolvedFilm) -> FilmRecord:
    """Return the common data of `FilmFields` and of a steady result for a solved film, copied."""
    film.require_current()
    solver, grid, temperature, bearing = film.solver, film.grid, film.temperature, film.parts.bearing
    liner, bore = film.parts.liner, film.bore
    yields = bore.displacement if bore is not None else None if liner is None else liner.deflection
    return FilmRecord(
        theta=grid.x.copy(),
        z=grid.z * grid.reference_length,
        pressure=film.pressure,
        gap=solver.H * bearing.radial_clearance,
        unbroken=solver.work.active.copy(),
        fill=solver.fill.copy() if solver.closure.conserves_mass else None,
        temperature=temperature.copy() if isinstance(temperature, np.ndarray) else temperature,
        walls=film.walls,
        bore_displacement=None if yields is None else yields * bearing.radial_clearance,
        force=film.loads.wrench[:3].copy(),
        moment=film.loads.wrench[3:].copy(),
        bearing=bearing,
        motion=film.journal.motion.copy(),
    )


def remembered(film: FilmRecord) -> History:
    """History with the temperatures of a film and its walls."""
    T = film.temperature
    return History(temperature=T if film.walls is None or T is None else film.walls.behind(T))


def film_fields(
    film: SolvedFilm, wear: Wear | None, time: float, bush_displacement: np.ndarray | None = None
) -> FilmFields:
    """Return the fields of a solved film, including contact pressure and wear depth."""
    contacts = film.parts.contacts
    return FilmFields(
        **vars(film_record(film)),
        time=time,
        contact_pressure=None if contacts is None else np.sum(contacts.P, axis=0),
        wear_depth=None if wear is None else wear.grown(film) * film.parts.bearing.radial_clearance,
        bush_displacement=bush_displacement,
    )
