"""Mass-conserving cavitation (Jakobsson-Floberg-Olsson condition in the form of Elrod and Adams).

Every vertex is either full (``P >= Pc``, fill = 1, unknown P) or cavitated (``P = Pc``, 0 <= fill <= 1, unknown fill).
Its balance is

    sum over links of [k (P - P_neighbour) + f carried_upstream] + area (fill H - kept) / dt = 0,

with the Poiseuille conductance k, the Couette flux f of a full film (gap on the link), the fill carried from upstream,
which in a step is averaged over it (`exudyn_ehd.film.reynolds.lagging_void`), and ``kept`` by the film's history,
`exudyn_ehd.film.solvers.solver.FilmSolver.keep`. Without a history the film is steady and the last term is
``area fill dH/dt``. For given sets the system is linear; `exudyn_ehd.film.cavitation.solve` finds them with it. Should
it not, the film is approached through growing pseudo time steps, whose storage makes the matrices dominant enough.

Sources: H. G. Elrod, J. Lubrication Technology 103 (1981) 350; the one-unknown form after F. M. Alakhramsing, R. van
Ostayen, R. Eling, Lubricants 3 (2015) 256, and T. Woloszynski, P. Podsiadlo, G. W. Stachowiak, Tribology Letters 58
(2015) 18.
"""

from __future__ import annotations

from dataclasses import dataclass

from exudyn_ehd.film.cavitation.closures import Closure, check_cavity_pressure
from exudyn_ehd.status import require_bool


@dataclass(frozen=True, kw_only=True)
class ElrodAdams(Closure):
    """Cavitation that conserves the oil: rupture and reformation, with the oil in the cavity remembered in time.

    For starved or grooved bearings, oscillating loads, and wherever leakage and friction of the cavity matter. In a
    joint it needs an implicit solver. A steady film needs oil from somewhere: end or supply pressures above the cavity
    pressure; a moving one without it runs dry within some turns, and the joint warns.

    In time its history is the void of the gap; full films are squeezed as under `SwiftStieber`. Flows balance what they
    bring to rounding; the content keeps to that within half a step of the gap's rate, over any number of steps.

    With ``line_in_cells`` steady stiffness is within 1.5 % in any direction (default grid, eccentricity ratio 0.6 to
    0.9, L/D 0.5 and 1) instead of 9 %, and damping varies by 1.3 % with the direction instead of 10 %, in two to
    three times the time. Where the film reforms it does so on the grid's vertices: damping may be off by 6 % for it.

    Parameters
    ----------
    cavity_pressure : float, default 0.0
        Gauge pressure of the cavity, Pa; about -1e5 for oil vapour or released air, 0 for a vented cavity.
    line_in_cells : bool, default False
        True: the film ruptures where it does, inside the cells of the grid; not in a `ShortBearing`; see
        `exudyn_ehd.film.cavitation.oil_line`. False: on their vertices.

    Source
    ------
    H. G. Elrod, J. Lubrication Technology 103 (1981) 350; one unknown per vertex after Alakhramsing et al., Lubricants
    3 (2015) 256, and Woloszynski et al., Tribology Letters 58 (2015) 18.

    Examples
    --------
    >>> b = dict(journal_radius=0.025, length=0.025, radial_clearance=25e-6, lubricant=ehd.Lubricant(viscosity=0.02))
    >>> bearing = ehd.JournalBearing(**b, cavitation=ehd.ElrodAdams(cavity_pressure=-1e5))
    >>> film = ehd.steady(bearing, speed=314.0, eccentricity_ratio=0.8)
    >>> round(np.hypot(*film.force[:2])), round(float(film.fill.min()), 2)  # N, least share of oil
    (12179, 0.12)
    """

    cavity_pressure: float = 0.0
    line_in_cells: bool = False

    conserves_mass = True

    def __post_init__(self) -> None:
        check_cavity_pressure("ElrodAdams", self.cavity_pressure)
        object.__setattr__(self, "line_in_cells", require_bool("ElrodAdams.line_in_cells", self.line_in_cells))
