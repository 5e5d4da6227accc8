"""Thermal effects that a scene names: one film temperature, or a temperature field. Isothermal is None.

With a lubricant's ``density_law`` (compressible film), flows and contents are masses over the density at ambient
pressure rho, so that c_p belongs to the mass. What heats the film is the dissipated power ``Phi``: shear, and the mass
flow under pressure times the drop of ``integral of dp / (rho(p) / rho)``. Heat of compression ``alpha_T T dp/dt``
(alpha_T thermal expansion) is left out, in compressible films as in others: it is reversible, oil that passes through a
pressure p is warmer there by ``alpha_T T p / (rho c_p)``, with 7e-4 1/K and 320 K by 1.3 K per 10 MPa, and cools down
as it leaves. Nor does the density follow the temperature.

Heat in the wall of a bush or of a journal: rings of finite volumes around the axis, a column for each of the film's.

    rho c dT/dt = k (1/r d/dr (r dT/dr) + 1/r^2 d2T/dtheta2) - loss

Vertices lie evenly from the film's surface to the far one, with half a ring at either. The conductance between two of
them is that of the logarithmic profile, k times angle and length over ln(r2 / r1), so that what flows steadily and the
same all around is exact; the rest is of second order in radius and angle. Backward Euler in time, first order.

Around the axis the system is the same at every angle, so that its Fourier coefficients are independent: each is a
small system along the radius, condensed onto the film's surface.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import partial
from typing import ClassVar

import numpy as np

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
class LumpedThermal(Checked):
    """One temperature T for the whole film; for warm-up and a first idea of the viscosity.

    Costs 5 % of a step at most, a sixth with a density law.

    ``C dT/dt = P - rho c_p Q (T - T_supply) - G (T - T_housing)``: P mechanical and pumping power that the film
    dissipates, Q flow that leaves the film and is replaced by supply oil, G conductance to the housing,
    ``C = rho c_p 2 pi R L c + capacity`` (with a density law, too: the mass in it at ambient pressure). Of a supply
    area Q counts the net flow: an area is a well-mixed volume, see `FilmEnergy`. Backward Euler
    at every accepted step, first order; the force of a step sees the temperature at its start, and so does the heat P
    of steps that are short beside the exchange of the oil; in longer ones P follows the temperature. `steady` and
    `equilibrium` take the steady temperature; a static solution of a multibody model takes the initial one.

    Heat of compression, some 1.3 K per 10 MPa and reversible, is left out.

    Parameters
    ----------
    supply_temperature : float
        Of the oil that enters, K.
    housing_conductance : float, default 0.0
        G, W/K.
    housing_temperature : float or None, default None
        K; None: the supply temperature.
    capacity : float, default 0.0
        Heat capacity that warms up with the film (surfaces near it), J/K.
    initial_temperature : float or None, default None
        Of the film at the start of a motion, K; None: the supply temperature.
    carry_over : float, default 1.0
        As of `FilmEnergy`.

    Examples
    --------
    >>> thermal = ehd.LumpedThermal(supply_temperature=313.15, housing_conductance=5.0)
    >>> b = dict(journal_radius=0.025, length=0.025, radial_clearance=25e-6, lubricant=ehd.oil("ISO VG 46"))
    >>> film = ehd.steady(ehd.JournalBearing(**b, thermal=thermal), speed=314.0, eccentricity_ratio=0.8)
    >>> round(film.temperature - 273.15, 1)  # degrees Celsius
    63.1
    """

    supply_temperature: float
    housing_conductance: float = 0.0
    housing_temperature: float | None = None
    capacity: float = 0.0
    initial_temperature: float | None = None
    carry_over: float = 1.0

    checks: ClassVar = {
        **dict.fromkeys(("supply_temperature", "housing_temperature", "initial_temperature"), KELVIN),
        **dict.fromkeys(("housing_conductance", "capacity"), NOT_NEGATIVE),
        "carry_over": SHARE,
    }


@dataclass(frozen=True, kw_only=True)
class Conduction(Checked):
    """Wall of a bush or a journal that takes heat from the film, conducts it, stores it, and grows with it.

    ``rho c dT/dt = k (1/r d/dr (r dT/dr) + 1/r^2 d2T/dtheta2) - loss``, the mean along the bearing, in rings of finite
    volumes from the film's surface on. A bush has a temperature at every angle and gives heat off at its outer surface,
    ``conductance (T - ambient_temperature)``, evenly all around. A journal turns fast against the heat: it has one
    temperature at every angle, and gives heat off along its axis, by all of its section alike. Steady heat that is the
    same all around is exact, the rest of second order; backward Euler over the accepted steps, first order.

    A wall whose surfaces are free grows at the film by ``expansion R (mean of T - clearance_temperature)``, the mean
    over its section, whatever the profile along the radius (Timoshenko and Goodier, Theory of Elasticity, the thermal
    stress of discs and cylinders). What varies with the angle is left out of the growth.

    Parameters
    ----------
    thickness : float
        Of the wall, m: of a bush outward from the bore, of a journal inward from its surface; a solid journal's is its
        radius.
    conductance : float
        To the ambient, W/K; of a bush its outer surface times the heat transfer coefficient there. 0: none.
    ambient_temperature, initial_temperature : float or None, default None
        K; None: the supply temperature of the oil.
    conductivity, density, specific_heat : float, default 45.0, 7800.0, 460.0
        W/(m K), kg/m3, J/(kg K), the defaults those of steel.
    expansion : float, default 0.0
        Coefficient of linear thermal expansion, 1/K; of steel 1.15e-5. 0: the wall does not grow.
    clearance_temperature : float or None, default None
        At which the bearing has its radial clearance, K; None: the supply temperature.
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
    """Temperature field T(theta, z), averaged across the film or with its profile; where heating decides load or peak
    temperature.

    One factorisation per accepted step: a third of a step's time with `ElrodAdams`, as much as the step with
    `SwiftStieber` (half more with a density law). With ``across=2`` a step takes four to six times as long.

    ``rho c_p [d(m T)/dt + div(q T)] = Phi - U_b (T - T_b) - U_j (T - T_j)``: m film content, q flow per width (pressure
    and Couette flow), Phi heat of shear and pressure flow per area. Finite volumes, backward Euler, upwind in theta
    (first order), of second order in z without new extrema. Oil enters through the ends with the supply temperature.

    A supply area is a well-mixed volume: all that flows out of it has ``T_mix = (Q T + N T_supply) / (Q + N)``, with
    the flow Q that the film presses into it, Q's mean temperature T, and the net feed N, which alone is fresh (H.
    Heshmat and O. Pinkus, J. Tribology 108 (1986) 231). `LumpedThermal` has the same law. Flush or cool a groove by
    ``carry_over``. In films without axial flow, oil that pressure drives into an area leaves, and that from an area is
    fresh.

    Cavitation models that do not conserve mass lose oil at the end of the film and find it again at its beginning: it
    returns fully mixed, the leakage replaced by supply oil. The viscosity of a step follows from the temperatures at
    its start: the coupling is explicit, of first order; in steps that are long beside the exchange of the oil the heat
    follows the temperature, or the film would swing from step to step. `steady` and `equilibrium` take the steady
    field; a static solution of a multibody model takes the initial temperature.

    Accuracy, against solutions with the profile across the film of a long bearing that heats by 13 to 58 K
    (``tests/validation/test_thd_cross_film.py``): between adiabatic walls load and peak pressure to 5 %, mean rise to 4
    %, rise at the bush to 7 %; with walls at given temperatures and a ``conductivity`` load to 4 % (both walls) and 9 %
    (one), mean temperature to 1.5 and 6 K, while an adiabatic bush next to a cooled journal is up to 8 K hotter than
    the mean. A constant 3 k/c instead of the conductivity: load to 14 %.

    With ``across=2`` and the same solutions: load and peak pressure to 1.5 % on 192 columns and to 2.4 % on 96, with
    the grid's own error, mean temperature to 1 K, hottest place of the bush to 0.9 K; 3 % of load next to a journal
    that is colder than the oil that enters, whose cold layer is thinner than a cubic follows. The temperature across
    the film is a cubic that meets what the surfaces let through, the fluidity 1/mu another one, with which the
    velocities, the share that sliding carries, and the stresses on the surfaces depart from those of an even film.
    Oil is mixed over the height of supply areas. `SteadyResult.walls` has the ``across`` temperatures, histories the
    surfaces' means.

    Along z, 10, 20 and 40 intervals bring a film with a supply within 0.5, 0.1 and 0.01 % of the converged load.
    Without supply and with hardly cooled walls, hot oil turns with the journal beside cold oil from the ends, a jump
    that a grid smears: 6, 3 and 1 %. The rise of the hottest place is mostly within 3 % on 10 intervals; in films fed
    through their ends alone it may be a fifth too low (``tests/joint/heat/test_energy_along_z.py``).

    Oil and walls carry the loss away to 2 % on 10 intervals and 0.5 % on 40, at rest and over a settled cycle of 64
    steps (``tests/joint/heat/test_heat_balance.py``).

    Heat of compression, some 1.3 K per 10 MPa and reversible, is left out. With a ``density_law`` it counts masses.

    Parameters
    ----------
    supply_temperature : float
        Of the oil that enters, K.
    bush_coefficient, journal_coefficient : float, default 0.0
        U_b, U_j, heat transfer from the film's mean temperature to the surfaces, W/(m2 K).
    bush_temperature, journal_temperature : float or None, default None
        T_b, T_j, K; None: the supply temperature.
    initial_temperature : float or None, default None
        Of the film at the start of a motion, K; None: the supply temperature.
    conductivity : float or None, default None
        Of the oil, W/(m K), 0.13 for mineral oils: U_b and U_j then act on the film's surfaces, with the oil between
        them and the mean temperature, 3 to 6 k/h; None: U_b and U_j from the mean temperature.
    bush, journal : Conduction or None, default None
        Walls that take the film's heat at its surfaces, in place of coefficient and temperature on that side; they need
        the oil's ``conductivity``. The walls' temperatures are unknowns of a step as the film's are, and the gap of a
        step sees their growth at its start.
    carry_over : float, default 1.0
        Share of hot oil's rise over the supply temperature that passes a supply area which feeds nothing, above 0 up to
        1. Smaller values flush the area with ``(1 / carry_over - 1) Q`` of supply oil, Q the flow that arrives from the
        film: ``1 - carry_over`` of the mixture is fresh then. Of closures that do not conserve mass also the share of
        the cavity's rise that the film begins with, the rest being fresh oil. 1: hot oil mixes with the net feed alone.
    across : int, default 1
        Temperatures across the film: 1, its mean; 2, its mean and its tilt from bush to journal, which needs the oil's
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

    supply_temperature: float
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
        **dict.fromkeys(
            ("supply_temperature", "bush_temperature", "journal_temperature", "initial_temperature"), KELVIN
        ),
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
    """Temperatures of a bearing's walls, K, and what they make of the clearance.

    Attributes
    ----------
    bush : (n, k) array or None
        At every angle of the film, from the bore outward; None for a bush that does not conduct.
    journal : (k,) array or None
        From the surface inward; None for a journal that does not conduct.
    bush_radii, journal_radii : (k,) arrays or None
        Where, m.
    clearance : float
        Radial, with what the walls have grown by, m.
    across : (3, n, m) array or None
        Of a film with two temperatures across it: the tilt, half of what its straight part rises by from bush to
        journal, and the surfaces' temperatures, bush and journal, K.
    """

    bush: np.ndarray | None
    journal: np.ndarray | None
    bush_radii: np.ndarray | None
    journal_radii: np.ndarray | None
    clearance: float
    across: np.ndarray | None = None

    def across_film(self, temperature: float | np.ndarray) -> np.ndarray:
        """Temperatures of a film of these walls, K: its own (n, m), or (n, m, 4) at Lobatto's points across it."""
        if self.across is None:
            return np.asarray(temperature)
        # imported here: other films have no profile across them
        from exudyn_ehd.film.heat.across import at_points

        return at_points(np.array([temperature, *self.across]))

    def numbers(self, area: np.ndarray) -> dict[str, float]:
        """Mean temperatures at the film, whose vertices have areas (n, m), K, of walls that conduct; clearance, m."""
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
        """Walls of these temperatures throughout, K."""
        own, turning = (
            None if T is None else np.full_like(T, value) for T, value in ((self.bush, bush), (self.journal, journal))
        )
        across = self.across
        if across is not None:
            across = np.stack([np.full_like(across[0], T) for T in (0.5 * (journal - bush), bush, journal)])
        return replace(self, bush=own, journal=turning, across=across)

    def behind(self, temperature: float | np.ndarray) -> np.ndarray:
        """The film's temperatures (n, m) with those of the walls behind them, as a film remembers them."""
        T = [np.asarray(temperature)]
        T += [] if self.across is None else [T[0] + self.across[0], *self.across[1:]]
        T += [] if self.bush is None else [self.bush]
        if self.journal is not None:
            T.append(np.tile(self.journal, (len(T[0]), 1)))
        return np.hstack(T)


class Rings:
    """One wall on the columns of a film; temperatures are rises over the ambient, K.

    Parameters
    ----------
    wall : Conduction
    radius, length : float
        Of the film's surface, m.
    columns : int
        Around the axis; 1: a wall that turns fast against the heat, with the same temperature at every angle.
    inward : bool
        Whether it is a journal, which gives its heat off all over its section; a bush does so at its far surface.

    Attributes
    ----------
    radii : (k,) array
        Of the vertices, from the film's surface on, m.
    share : (k,) array
        Of each ring in the section.
    loss : (k,) array
        To the ambient, W/K for a column.
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
        # of one column there is nothing to conduct around
        self.around = np.outer(waves, around) if columns > 1 else np.zeros((1, r.size))
        self.step = math.nan

    def bring_to(self, step: float) -> None:
        """Condense the system of a step, s; 0: of the steady wall."""
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
        """Heat into every column's surface, W, per kelvin of the surface's temperatures (columns, columns)."""
        row = np.fft.irfft(self.stiffness, self.columns) if self.columns > 1 else self.stiffness
        k = np.arange(self.columns)
        return row[(k[:, None] - k) % self.columns]

    def remembered(self, old: np.ndarray) -> np.ndarray:
        """Heat out of the surface (columns,), W, that old temperatures (columns, k) give at a surface of no rise."""
        known = np.fft.rfft(self.store * old, axis=0)
        first = known[:, 0] + self.radial[0] * np.einsum("pk,pk->p", self.inner[:, 0], known[:, 1:])
        return np.fft.irfft(first, self.columns) if self.columns > 1 else first.real

    def behind(self, surface: np.ndarray, old: np.ndarray) -> np.ndarray:
        """Temperatures (columns, k) at the end of the step with those of the surface (columns,)."""
        known = np.fft.rfft(self.store * old, axis=0)
        known[:, 1] += self.radial[0] * np.fft.rfft(surface)
        inner = np.einsum("pij,pj->pi", self.inner, known[:, 1:])
        inside = np.fft.irfft(inner, self.columns, axis=0) if self.columns > 1 else inner.real
        return np.column_stack((surface, inside))
