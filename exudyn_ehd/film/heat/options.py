"""Options for thermal effects: one film temperature, or a temperature field. None stands for an isothermal film.

With a lubricant's ``density_law`` (compressible film), flows and contents are masses over the density at ambient
pressure rho, so that c_p belongs to the mass. The dissipated power ``Phi`` heats the film: shear, and the mass
flow under pressure times the drop of ``integral of dp / (rho(p) / rho)``. Heat of compression ``alpha_T T dp/dt`` with
the thermal expansion alpha_T is omitted, in compressible films too. It is reversible: at a pressure p the oil is warmer
by ``alpha_T T p / (rho c_p)``, 1.3 K per 10 MPa with 7e-4 1/K and 320 K, and it cools down as it leaves. The density
does not depend on the temperature.

Heat in the wall of a bush or of a journal: rings of finite volumes, a column for each of the film's
----------------------------------------------------------------------------------------------------
    rho c dT/dt = k (1/r d/dr (r dT/dr) + 1/r^2 d2T/dtheta2) - loss

The vertices are equidistant from the film's surface to the far surface, with half a ring at each surface. The
conductance between two vertices is that of the logarithmic profile, k times angle and length over ln(r2 / r1). So a
steady heat flow that does not depend on the angle is exact; other heat flows are of second order in radius and angle.
Backward Euler in time, first order.

The system is the same at every angle, so that its Fourier coefficients around the axis are independent. Each of them is
a small system along the radius, which is condensed onto the film's surface.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import partial
from typing import ClassVar

import numpy as np

from exudyn_ehd.film.heat.energy import at_points
from exudyn_ehd.status import (
    KELVIN,
    NOT_NEGATIVE,
    POSITIVE,
    SHARE,
    Checked,
    InputError,
    require_integer,
    require_type,
)


@dataclass(frozen=True, kw_only=True)
class Sump(Checked):
    """Oil tank whose temperature follows from the heat that the oil brings: ``supply_temperature`` of a film.

    ``heat_capacity dT_sump/dt + conductance (T_sump - ambient) = H``, with the heat H that the oil carries out of the
    bearing, in a steady film `SteadyResult.heat_by_oil`. Several bearings on one tank: give each the part of the
    conductance and of the capacity that is its part of the heat.

    In joints: backward Euler over the accepted steps, together with the film's temperature; histories have
    ``sump_temperature``. Steady films (`steady`, `equilibrium`, `stribeck`) have a steady sump. A tank takes minutes to
    hours to warm up: for shorter runs give ``initial_temperature``. Temperatures of the thermal option that default to
    the supply temperature default to ``ambient`` with a sump. `FilmEnergy` takes up to four times as long with a sump.

    Parameters
    ----------
    conductance : float
        Heat that the tank gives off per kelvin, W/K: its surface times the heat transfer coefficient there, some 10 to
        20 W/(m2 K) in air, or that of a cooler.
    ambient : float
        Temperature of the ambient or of the cooling water, K.
    heat_capacity : float, default 0.0
        Heat capacity of the tank with its oil, J/K: some 1.7e6 per m3 of oil. 0: in a joint the sump is in balance with
        the oil that comes back, at every instant.
    initial_temperature : float or None, default None
        Temperature of the sump at the start of a motion, K; None: the ambient.

    Examples
    --------
    >>> thermal = ehd.LumpedThermal(supply_temperature=ehd.Sump(conductance=6.0, ambient=293.15))
    >>> b = dict(journal_radius=0.025, length=0.025, radial_clearance=25e-6, lubricant=ehd.oil("ISO VG 46"))
    >>> film = ehd.steady(ehd.JournalBearing(**b, thermal=thermal), speed=314.0, eccentricity_ratio=0.8)
    >>> round(film.supply_temperature - 273.15, 1), round(film.temperature - 273.15, 1)  # degrees Celsius
    (49.6, 76.2)
    """

    conductance: float
    ambient: float
    heat_capacity: float = 0.0
    initial_temperature: float | None = None

    checks: ClassVar = {
        "conductance": POSITIVE,
        "heat_capacity": NOT_NEGATIVE,
        **dict.fromkeys(("ambient", "initial_temperature"), KELVIN),
    }


def _supply(where: str, value: float | Sump) -> None:
    if not isinstance(value, Sump):
        KELVIN(where, value)


def known_supply(thermal: LumpedThermal | FilmEnergy) -> float:
    """Return the known temperature outside a film, K: that of its supply, or the ambient of its sump."""
    supply = thermal.supply_temperature
    return supply.ambient if isinstance(supply, Sump) else supply


@dataclass(frozen=True, kw_only=True)
class LumpedThermal(Checked):
    """One temperature T for the whole film; for warm-up and a first idea of the viscosity.

    The viscosity follows it by the lubricant's ``temperature_law``, such as those of `oil`; without one it stays
    constant, and T is a result only. Adds at most 5 % to the time of a step, 17 % with a density law.

    ``C dT/dt = P - rho c_p Q (T_out - T_supply) - G (T - T_housing)``, with the mechanical and pumping power P that the
    film dissipates, the flow Q that leaves the film and is replaced by supply oil, its temperature T_out, and
    ``C = rho c_p V + capacity``, rho at ambient pressure and V = 2 pi R L c, with the angle of all arcs for 2 pi where
    there are any. The film is mixed, T_out = T, or warms up along its way: ``T - T_supply = effective_rise (T_out -
    T_supply)``. Of a supply area Q counts the net flow: an area is a well-mixed volume, see `FilmEnergy`. Heat of
    compression is omitted: some 1.3 K per 10 MPa, reversible.

    Films on end faces (``thrust``) have the same T. Bore and faces lie in series: the flow L that leaves the bore at an
    end enters the gap of the face there. The face takes in the flow I at its inner radius (with the oil that cavities
    gain by a model that does not conserve it) and B at its outer radius. So supply oil replaces the flow ``Q = Q_bore +
    sum of max(I - L, 0) + B``; P is the power of all films, and V contains the gaps between bush and collars. A face
    without pads and pressures takes in no oil: its heat leaves with the oil of the bore and by G.

    In time: backward differences of second order over the accepted steps; the first step, and steps more than 2.4 times
    as long as the one before, backward Euler. Force and P of a step use the temperature that is extrapolated to its
    end. In steps longer than the time in which the film's oil is replaced, P is linearised about it. `steady` and
    `equilibrium` use the steady temperature, a static solution of a multibody model the initial one.

    Parameters
    ----------
    supply_temperature : float or Sump
        T_supply of the oil that enters, K.
    housing_conductance : float, default 0.0
        G from film to housing, W/K.
    housing_temperature : float or None, default None
        T_housing, K; None: the supply temperature.
    capacity : float, default 0.0
        Heat capacity of the metal that warms up with the film, J/K.
    initial_temperature : float or None, default None
        Temperature of the film at the start of a motion, K; None: the supply temperature.
    carry_over : float, default 1.0
        As for `FilmEnergy`.
    effective_rise : float, default 1.0
        Above 0 up to 1: rise of the film's temperature T above T_supply, over that of the oil that leaves. 1: the film
        is mixed, and has the temperature of its outlet. 0.5: the effective temperature of ISO 7902 and of Raimondi and
        Boyd, the mean of inlet and outlet.

    Examples
    --------
    >>> thermal = ehd.LumpedThermal(supply_temperature=313.15, housing_conductance=5.0)
    >>> b = dict(journal_radius=0.025, length=0.025, radial_clearance=25e-6, lubricant=ehd.oil("ISO VG 46"))
    >>> film = ehd.steady(ehd.JournalBearing(**b, thermal=thermal), speed=314.0, eccentricity_ratio=0.8)
    >>> round(film.temperature - 273.15, 1)  # degrees Celsius
    63.1
    """

    supply_temperature: float | Sump
    housing_conductance: float = 0.0
    housing_temperature: float | None = None
    capacity: float = 0.0
    initial_temperature: float | None = None
    carry_over: float = 1.0
    effective_rise: float = 1.0

    checks: ClassVar = {
        "supply_temperature": _supply,
        **dict.fromkeys(("housing_temperature", "initial_temperature"), KELVIN),
        **dict.fromkeys(("housing_conductance", "capacity"), NOT_NEGATIVE),
        **dict.fromkeys(("carry_over", "effective_rise"), SHARE),
    }


@dataclass(frozen=True, kw_only=True)
class Conduction(Checked):
    """Wall of a bush or a journal that takes heat from the film, conducts it, stores it, and grows with it.

    Arguments ``bush`` and ``journal`` of `FilmEnergy`.

    ``rho c dT/dt = k (1/r d/dr (r dT/dr) + 1/r^2 d2T/dtheta2) - loss``, with T the mean along the bearing. A bush has
    its own temperature at every angle. It loses ``conductance (T - ambient_temperature)`` at its outer surface, evenly
    all around. A journal turns too fast to have hot and cold sides: T depends on the radius alone, and the heat leaves
    along its axis, evenly over its section.

    Finite volumes: steady heat that is the same all around is exact, all else of second order; backward Euler over the
    accepted steps, first order.

    The surface at the film moves outward by ``expansion R (mean of T - clearance_temperature)``, with the mean over the
    wall's section, whatever the profile along the radius (Timoshenko and Goodier, Theory of Elasticity, thermal stress
    of discs and cylinders). So a hot bush opens the clearance and a hot journal closes it. Growth that varies with the
    angle is omitted.

    Parameters
    ----------
    thickness : float
        Thickness of the wall, m: of a bush outward from the bore, of a journal inward from its surface; the radius for
        a solid journal.
    conductance : float
        Conductance from the wall to the ambient, W/K; for a bush its outer surface times the heat transfer coefficient
        there. 0: none.
    ambient_temperature, initial_temperature : float or None, default None
        Temperature of the ambient, and of the wall at the start of a motion, K; None: the oil's supply temperature.
    conductivity, density, specific_heat : float, default 45.0, 7800.0, 460.0
        k, W/(m K), rho, kg/m3, and c, J/(kg K), of the wall; the defaults are those of steel.
    expansion : float, default 0.0
        Coefficient of linear thermal expansion, 1/K; 1.15e-5 for steel. 0: the wall does not grow.
    clearance_temperature : float or None, default None
        Temperature of the walls at which the bearing has its radial clearance, K; None: the oil's supply temperature.
    rings : int, default 8
        Intervals along the radius.

    Examples
    --------
    A steel bush in still air, and a shaft that gives its heat off to its surroundings:

    >>> bush = ehd.Conduction(thickness=0.02, conductance=0.2, expansion=1.15e-5)
    >>> walls = dict(bush=bush, journal=ehd.Conduction(thickness=0.025, conductance=0.5, expansion=1.15e-5))
    >>> thermal = ehd.FilmEnergy(supply_temperature=313.15, conductivity=0.13, **walls)
    >>> b = dict(journal_radius=0.025, length=0.025, radial_clearance=25e-6, lubricant=ehd.oil("ISO VG 46"))
    >>> film = ehd.steady(ehd.JournalBearing(**b, thermal=thermal), speed=314.0, eccentricity_ratio=0.8)
    >>> film.walls.bush.shape, film.walls.journal.shape  # theta and rings from the bore outward, rings inward, K
    ((112, 9), (9,))
    """

    thickness: float
    conductance: float
    ambient_temperature: float | None = None
    initial_temperature: float | None = None
    conductivity: float = 45.0
    density: float = 7800.0
    specific_heat: float = 460.0
    expansion: float = 0.0
    clearance_temperature: float | None = None
    rings: int = 8

    checks: ClassVar = {
        **dict.fromkeys(("thickness", "conductivity", "density", "specific_heat"), POSITIVE),
        **dict.fromkeys(("conductance", "expansion"), NOT_NEGATIVE),
        **dict.fromkeys(("ambient_temperature", "initial_temperature", "clearance_temperature"), KELVIN),
        "rings": partial(require_integer, at_least=2),
    }


@dataclass(frozen=True, kw_only=True)
class FilmEnergy(Checked):
    """Temperature field T(theta, z) of the film; where heating decides load or peak temperature.

    The viscosity follows it by the lubricant's ``temperature_law``, such as those of `oil`; without one it stays
    constant, and the field is a result only. Adds a third to the time of a step with `ElrodAdams`, doubles it with
    `SwiftStieber` (half more with a density law). With ``across=2`` a step takes four to six times as long.

    ``rho c_p [d(m T)/dt + div(q T)] = Phi - U_b (T - T_b) - U_j (T - T_j)``, with the film content m (oil per area),
    the flow q per width (pressure and Couette flow), and the heat Phi of shear and pressure flow per area. With a
    ``density_law`` m and q are masses over rho. Heat of compression is omitted: some 1.3 K per 10 MPa, reversible.
    Finite volumes of second order, with limiters that reduce it to first order (upwind) at extrema.

    Where oil enters. Through the ends it has the supply temperature. A supply area is a well-mixed volume, and so is
    the groove between two arcs: all that flows out of it has ``T_mix = (Q T + N T_supply) / (Q + N)``, with the flow Q
    that enters it from the film, Q's mean temperature T, and the net feed N, which alone is fresh (H. Heshmat and O.
    Pinkus, J. Tribology 108 (1986) 231). To flush or cool a groove, lower ``carry_over``. In films without axial flow,
    oil that pressure drives into an area leaves the bearing, and oil from an area is fresh. Cavitation models that do
    not conserve mass lose oil at the rupture line and find it again where the film begins: there it returns fully
    mixed, with the leakage replaced by supply oil. On an arc the cavity passes its oil on to the groove behind the arc.

    In time: backward differences of second order over the accepted steps; the first step, and steps more than 2.4 times
    as long as the one before, backward Euler. Viscosity and heat of a step use the temperatures that are extrapolated
    to its end, which stay above the coldest one of film, walls and oil that enters. In steps longer than the time in
    which the film's oil is replaced, the heat is linearised about them. If the oil passes more than one column of the
    grid in a step, its transport is partly of first order: in steps of three turns the temperatures of fed films
    approach values that differ from the steady ones by up to 27 % of their range at single vertices and 5 % in the
    mean, and forces by up to 6 %. Walls and sumps: backward Euler. `steady` and `equilibrium` use the steady field, a
    static solution of a multibody model the initial temperature.

    Errors by the steps: with 120 steps per period of the load 0.01 to 0.7 % of the film thickness in eleven of thirteen
    random scenes that heat by 3 to 53 K, 1.8 and 6.5 % in the others; they fall with the square of the step
    (``tests/mechanisms/test_heat_in_time.py``).

    Errors against solutions with the full profile across the film of a long bearing that heats by 13 to 58 K
    (``tests/validation/test_thd_cross_film.py``):

    - ``across=1``, adiabatic walls: load and peak pressure 5 %, mean temperature rise 4 %, rise at the bush 7 %.
    - ``across=1``, walls at given temperatures, with ``conductivity``: load 4 % (both walls) or 9 % (one), mean
      temperature 1.5 or 6 K; an adiabatic bush opposite a cooled journal is up to 8 K hotter than the mean. Load 14 %
      with coefficients 3 k/c in place of the conductivity.
    - ``across=2``: load and peak pressure 1.9 % on 192 columns and 2.5 % on 96, mean temperature and hottest place of
      the bush 1 K; load 3 % next to a journal that is colder than the oil that enters.

    With ``across=2`` temperature and fluidity 1/mu are cubics across the film and change velocities and wall stresses.
    Oil is mixed over the height of supply areas. `SteadyResult.walls` has the temperatures ``across`` the film,
    histories the means of the surfaces.

    Errors of the grid. Power loss with 48 and 96 columns: 0.02 and 0.01 %. Load with 10, 20 and 40 intervals along z:
    0.7, 0.1 and 0.04 % in films with a supply; 12, 6 and 2 % with `ElrodAdams`, no supply and hardly cooled walls,
    where hot oil that turns with the journal lies beside cold oil from the ends. Rise of the hottest place on 10
    intervals: mostly 3 %; up to 20 % too low in films fed through their ends alone
    (``tests/joint/heat/test_energy_along_z.py``). Heat that oil and walls carry away, against the power loss: 2 % on 10
    intervals, 0.5 % on 40, in steady films and over a periodic cycle of 64 steps
    (``tests/joint/heat/test_heat_balance.py``).

    Parameters
    ----------
    supply_temperature : float or Sump
        T_supply of the oil that enters, K.
    bush_coefficient, journal_coefficient : float, default 0.0
        U_b, U_j, heat transfer from the film's mean temperature to bush and journal, W/(m2 K). 0: adiabatic.
    bush_temperature, journal_temperature : float or None, default None
        T_b, T_j, K; None: the supply temperature.
    initial_temperature : float or None, default None
        Temperature of the film at the start of a motion, K; None: the supply temperature.
    conductivity : float or None, default None
        k of the oil, W/(m K), 0.13 for mineral oils: heat then also crosses the oil from its mean temperature to the
        surfaces (3 to 6 k/h, in series with U_b and U_j). None: U_b and U_j alone.
    bush, journal : Conduction or None, default None
        Wall that takes the film's heat, in place of coefficient and temperature on that side; needs the oil's
        ``conductivity``. A bush of arcs has none. Its temperatures are solved together with the film's; the gap
        of a step has the wall's growth at the start of the step.
    carry_over : float, default 1.0
        Above 0 up to 1: share of its rise over the supply temperature that hot oil keeps when it passes a supply area
        without net feed. 1: hot oil mixes with the net feed alone. Below 1 the area is flushed with
        ``(1 / carry_over - 1) Q`` of supply oil in addition. In cavitation models that do not conserve mass it is also
        the share of the cavity's rise with which the film begins.
    across : int, default 1
        Unknown temperatures across the film: 1, the mean; 2, the mean and the tilt from bush to journal, which needs
        ``conductivity`` and does not go with a ``shear_law``.

    Examples
    --------
    >>> thermal = ehd.FilmEnergy(supply_temperature=313.15, bush_coefficient=1000.0, conductivity=0.13, across=2)
    >>> b = dict(journal_radius=0.025, length=0.025, radial_clearance=25e-6, lubricant=ehd.oil("ISO VG 46"))
    >>> film = ehd.steady(ehd.JournalBearing(**b, thermal=thermal), speed=314.0, eccentricity_ratio=0.8)
    >>> tilt, bush, journal = film.walls.across
    >>> bool(bush.max() < film.temperature.max() < journal.max())
    True
    """

    supply_temperature: float | Sump
    bush_coefficient: float = 0.0
    bush_temperature: float | None = None
    journal_coefficient: float = 0.0
    journal_temperature: float | None = None
    initial_temperature: float | None = None
    conductivity: float | None = None
    bush: Conduction | None = None
    journal: Conduction | None = None
    carry_over: float = 1.0
    across: int = 1

    checks: ClassVar = {
        "supply_temperature": _supply,
        **dict.fromkeys(("bush_temperature", "journal_temperature", "initial_temperature"), KELVIN),
        **dict.fromkeys(("bush_coefficient", "journal_coefficient"), NOT_NEGATIVE),
        "conductivity": POSITIVE,
        "carry_over": SHARE,
        "across": partial(require_integer, at_least=1),
    }

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.across > 2:
            raise InputError(
                f"FilmEnergy.across must be 1, the mean temperature, or 2, mean and tilt, got {self.across}; "
                "there are no more than two."
            )
        if self.across == 2 and self.conductivity is None:
            raise InputError(
                "FilmEnergy.across=2 needs the oil's conductivity, got None: it makes the profile across the film; "
                "give conductivity=0.13 (W/(m K)) for mineral oils, or take across=1."
            )
        for side in ("bush", "journal"):
            self._check_wall(side, getattr(self, side))

    def _check_wall(self, side: str, wall: Conduction | None) -> None:
        require_type(f"FilmEnergy.{side}", wall, Conduction, type(None))
        if wall is None:
            return
        if getattr(self, f"{side}_coefficient") != 0.0 or getattr(self, f"{side}_temperature") is not None:
            raise InputError(
                f"FilmEnergy.{side}=Conduction(...) and {side}_coefficient or {side}_temperature exclude each other: "
                "both say where the heat on that side goes; leave out the coefficient and its temperature."
            )
        if self.conductivity is None:
            raise InputError(
                f"FilmEnergy.{side}=Conduction(...) needs the oil's conductivity, got None: the heat reaches the wall "
                "across the film; give conductivity=0.13 (W/(m K)) for mineral oils."
            )


@dataclass(frozen=True, eq=False)
class Walls:
    """Temperatures of a bearing's walls, K, and the clearance with the walls' thermal growth.

    Attributes
    ----------
    bush : (n, k) array or None
        Temperatures at every angle of the film, from the bore outward; None for a bush without `Conduction`.
    journal : (k,) array or None
        Temperatures from the surface inward; None for a journal without `Conduction`.
    bush_radii, journal_radii : (k,) arrays or None
        Radii of these temperatures, m.
    clearance : float
        Radial clearance with the growth of the walls, m.
    across : (3, n, m) array or None
        For a film with ``across=2``: the tilt, which is half of the rise of the profile's linear part from bush to
        journal, and the temperatures of the surfaces of bush and journal, K.
    """

    bush: np.ndarray | None
    journal: np.ndarray | None
    bush_radii: np.ndarray | None
    journal_radii: np.ndarray | None
    clearance: float
    across: np.ndarray | None = None

    def across_film(self, temperature: float | np.ndarray) -> np.ndarray:
        """Temperatures of a film with these walls, K: its mean (n, m), or (n, m, 4) at Lobatto's points across it."""
        if self.across is None:
            return np.asarray(temperature)
        return at_points(np.array([temperature, *self.across]))

    def numbers(self, area: np.ndarray) -> dict[str, float]:
        """Mean surface temperatures, K, of walls with `Conduction`, and clearance, m; areas (n, m) of the vertices."""
        out = {"clearance": self.clearance}
        if self.across is not None:
            means = np.tensordot(self.across[1:], area / area.sum(), 2)
            out["bush_temperature"], out["journal_temperature"] = means.tolist()
        if self.bush is not None:
            out["bush_temperature"] = float(np.mean(self.bush[:, 0]))
        if self.journal is not None:
            out["journal_temperature"] = float(self.journal[0])
        return out

    def at(self, bush: float, journal: float) -> Walls:
        """Walls with one temperature each, that of bush and journal, K."""
        own, turning = (
            None if T is None else np.full_like(T, value) for T, value in ((self.bush, bush), (self.journal, journal))
        )
        across = self.across
        if across is not None:
            across = np.stack([np.full_like(across[0], T) for T in (0.5 * (journal - bush), bush, journal)])
        return replace(self, bush=own, journal=turning, across=across)

    def behind(self, temperature: float | np.ndarray) -> np.ndarray:
        """The film's temperatures (n, m) followed by those of the walls, as a film's history stores them."""
        T = [np.asarray(temperature)]
        T += [] if self.across is None else [T[0] + self.across[0], *self.across[1:]]
        T += [] if self.bush is None else [self.bush]
        if self.journal is not None:
            T.append(np.tile(self.journal, (len(T[0]), 1)))
        return np.hstack(T)


class Rings:
    """Finite volumes of one wall on the columns of a film; temperatures are rises over the ambient, K.

    Parameters
    ----------
    wall : Conduction
    radius, length : float
        Radius and length of the film's surface, m.
    columns : int
        Number around the axis; 1: a wall that turns so fast that its temperature is the same at every angle.
    inward : bool
        True: a journal, whose heat loss is spread over its section. False: a bush, whose loss is at its far surface.

    Attributes
    ----------
    radii : (k,) array
        Radii of the vertices, beginning at the film's surface, m.
    share : (k,) array
        Share of each ring in the area of the section.
    loss : (k,) array
        Heat loss of each ring to the ambient, W/K for a column.
    stiffness : (columns // 2 + 1,) array
        Heat into the surface per kelvin of its temperature, W/K for a column, by Fourier coefficient.
    """

    def __init__(self, wall: Conduction, radius: float, length: float, columns: int, inward: bool) -> None:
        self.columns, far = columns, radius - wall.thickness if inward else radius + wall.thickness
        self.radii = r = np.linspace(radius, max(far, 0.0), wall.rings + 1)
        bounds = np.concatenate((r[:1], 0.5 * (r[1:] + r[:-1]), r[-1:]))
        angle = 2.0 * math.pi / columns
        section = np.abs(np.diff(bounds**2))
        self.share = section / section.sum()
        self.capacity = wall.density * wall.specific_heat * length * 0.5 * angle * section
        with np.errstate(divide="ignore"):
            self.radial = wall.conductivity * length * angle / np.abs(np.diff(np.log(r)))
            around = wall.conductivity * length / angle * np.abs(np.diff(np.log(bounds)))
        if r[-1] == 0.0:  # the innermost pair by the radius between them
            self.radial[-1] = 0.5 * wall.conductivity * length * angle
        self.loss = wall.conductance / columns * (self.share if inward else np.eye(r.size)[-1])
        waves = 2.0 - 2.0 * np.cos(angle * np.arange(columns // 2 + 1))
        # with one column there is no conduction around the axis
        self.around = np.outer(waves, around) if columns > 1 else np.zeros((1, r.size))
        self.step = math.nan

    def bring_to(self, step: float) -> None:
        """Condense the system of a step, s, onto the film's surface; 0: the system of a steady wall."""
        if step == self.step:
            return
        self.step, self.store = step, self.capacity / step if step > 0.0 else np.zeros_like(self.capacity)
        size, k = self.radii.size, np.arange(self.radii.size - 1)
        radial = np.zeros((size, size))
        radial[k, k + 1] = radial[k + 1, k] = -self.radial
        np.fill_diagonal(radial, -radial.sum(axis=1))
        matrix = radial + np.eye(size) * (self.around + self.store + self.loss)[:, None, :]
        self.inner = np.linalg.inv(matrix[:, 1:, 1:])
        self.stiffness = matrix[:, 0, 0] - self.radial[0] ** 2 * self.inner[:, 0, 0]

    def matrix(self) -> np.ndarray:
        """Heat into every column's surface, W, per kelvin of every column's surface temperature (columns, columns)."""
        row = np.fft.irfft(self.stiffness, self.columns) if self.columns > 1 else self.stiffness
        k = np.arange(self.columns)
        return row[(k[:, None] - k) % self.columns]

    def remembered(self, old: np.ndarray) -> np.ndarray:
        """Heat out of the surface (columns,), W, from the old temperatures (columns, k), if the surface has no rise."""
        known = np.fft.rfft(self.store * old, axis=0)
        first = known[:, 0] + self.radial[0] * np.einsum("pk,pk->p", self.inner[:, 0], known[:, 1:])
        return np.fft.irfft(first, self.columns) if self.columns > 1 else first.real

    def behind(self, surface: np.ndarray, old: np.ndarray) -> np.ndarray:
        """Temperatures (columns, k) at the end of the step, from those of the surface (columns,) and the old ones."""
        known = np.fft.rfft(self.store * old, axis=0)
        known[:, 1] += self.radial[0] * np.fft.rfft(surface)
        inner = np.einsum("pij,pj->pi", self.inner, known[:, 1:])
        inside = np.fft.irfft(inner, self.columns, axis=0) if self.columns > 1 else inner.real
        return np.column_stack((surface, inside))
