"""Descriptions of bearings by the user: one frozen, validated object per bearing. Effects are named or absent."""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import partial
from typing import TYPE_CHECKING, ClassVar, get_args

import numpy as np

from exudyn_ehd.film.arcs import Arc, check_arcs
from exudyn_ehd.film.cavitation.closures import Closure, ElrodAdams, FullSommerfeld, Gumbel, SwiftStieber, place_line
from exudyn_ehd.film.combinations import check_combinations
from exudyn_ehd.film.heat.options import FilmEnergy, LumpedThermal
from exudyn_ehd.film.lubricant.lubricant import Lubricant
from exudyn_ehd.film.models import (
    FilmOption,
    FiniteLength,
    LongBearing,
    ShortBearing,
    check_film,
    check_line,
    columns_of,
    no_line_with,
    sized,
)
from exudyn_ehd.film.reynolds.turbulence import Hirs, NgPan
from exudyn_ehd.film.solvers.impedance_map import ImpedanceMap
from exudyn_ehd.film.supply.areas import SupplyArea, require_areas, source_pressure
from exudyn_ehd.film.supply.restrictors import EndSeal, require_seals
from exudyn_ehd.film.supply.rows import check_depths, check_on_arcs, check_supply
from exudyn_ehd.film.surfaces.contact import ArchardWear, ElasticLiner, RegularisedWall
from exudyn_ehd.film.surfaces.profile import SurfaceProfile
from exudyn_ehd.film.surfaces.roughness import GreenwoodTripp, PatirCheng
from exudyn_ehd.film.thrust.annulus import ThrustFaces, check_faces
from exudyn_ehd.status import (
    POSITIVE,
    Checked,
    InputError,
    PlausibilityWarning,
    require_bool,
    require_type,
    require_vector,
    warn_user,
)

if TYPE_CHECKING:
    from exudyn_ehd.solid.bush import ANCFBush, ModalBush
    from exudyn_ehd.solid.fe_bore import FEBore, ReducedBore
    from exudyn_ehd.solid.journal import ElasticJournal
    from exudyn_ehd.solid.turning_journal import FEJournal, TurningJournal


@dataclass(frozen=True, kw_only=True)
class Periodic:
    """Default ``inlet``: the film closes around the bearing.

    Examples
    --------
    >>> b = dict(journal_radius=0.025, length=0.025, radial_clearance=25e-6, lubricant=ehd.Lubricant(viscosity=0.02))
    >>> bearing = ehd.JournalBearing(**b, inlet=ehd.Periodic())
    >>> film = ehd.steady(bearing, speed=314.0, eccentricity_ratio=0.8)
    >>> round(np.hypot(*film.force[:2]))  # N
    13615
    """


@dataclass(frozen=True, kw_only=True)
class MaximumGap:
    """``inlet`` of design charts: ambient pressure on the line of maximum gap; for `steady` and `equilibrium`.

    The line lies opposite to the journal's position. `InputError` in joints, as it is undefined for a concentric
    journal and jumps with a moving one. At L/D = 1 and eccentricity ratio 0.1 the load is 2 % lower than with
    `Periodic`.

    Examples
    --------
    >>> b = dict(journal_radius=0.025, length=0.025, radial_clearance=25e-6, lubricant=ehd.Lubricant(viscosity=0.02))
    >>> bearing = ehd.JournalBearing(**b, inlet=ehd.MaximumGap())
    >>> film = ehd.steady(bearing, speed=314.0, eccentricity_ratio=0.8)
    >>> round(np.hypot(*film.force[:2]))  # N
    13626
    """


Cavitation = FullSommerfeld | Gumbel | SwiftStieber | ElrodAdams | Closure
Inlet = Periodic | MaximumGap


@dataclass(frozen=True, kw_only=True)
class JournalBearing(Checked):
    """Description of a journal bearing for joints and static studies: dimensions, oil, and the effects in its film.

    Frame of all places and angles: the joint's, fixed in the housing, with its origin in the bearing's mid-plane and z
    along the bearing's axis. theta counts from x, positive about z, as the spin of the journal. Pressures are gauge
    pressures: Pa above ambient. Effects that exclude each other raise `InputError`.

    Parameters
    ----------
    journal_radius : float
        R, m.
    length : float
        L, m.
    radial_clearance : float
        c = bore radius - journal radius, half the diametral clearance, m. Of arcs with a preload it is the
        assembled clearance, see `Arc`. A ratio c/R outside 1e-4 to 1e-2 warns.
    lubricant : Lubricant
        Oil, e.g. ``ehd.oil("ISO VG 46")``.
    film : FiniteLength, ShortBearing, LongBearing, ImpedanceMap or ClassicSOR, default FiniteLength()
        Film model and grid.
    cavitation : FullSommerfeld, Gumbel, SwiftStieber, ElrodAdams or Closure, default SwiftStieber()
        Cavitation model; `Closure` is one of your own, see "Extension points" in the package's README.
    inlet : Periodic or MaximumGap, default Periodic()
        Periodic: the film closes around the bearing. MaximumGap: it begins at ambient pressure where the gap is
        largest; for `steady` and `equilibrium`.
    arc : Arc or None, default None
        Bore on a part of the circle; None: all around.
    arcs : tuple of Arc, default ()
        Bore on several parts of the circle, in the order of their angles, such as lobes; see `two_lobe`, `three_lobe`,
        `offset_halves` and `pressure_dam`. Empty: ``arc``, or all around. Not together with ``arc``.
    end_pressures : (float, float), default (0.0, 0.0)
        Gauge pressures at z = -L/2 and z = +L/2, Pa.
    end_seals : EndSeal, pair of EndSeal or None, or None, default None
        Seals between the film and ``end_pressures``: one for both ends, or those at z = -L/2 and z = +L/2, None for an
        open end. None: open ends.
    squeeze : bool, default True
        False omits the squeeze term (quasi-static film without damping).
    contact : RegularisedWall or None, default None
        Smooth wall that carries load before the gap vanishes; not with ``asperity`` or ``roughness``. None: a
        vanishing gap ends the run with an error, unless there is an ``asperity``.
    supply : tuple of AxialGroove, CircumferentialGroove, Hole or Pocket, default ()
        Areas with a prescribed supply pressure, or fed through a restrictor; empty: none.
    thermal : LumpedThermal, FilmEnergy or None, default None
        Temperature of the film, which the viscosity follows by the lubricant's ``temperature_law``. None: isothermal,
        at ``lubricant.temperature``.
    bush : ElasticLiner, ModalBush, ANCFBush, FEBore or None, default None
        Flexible bore that deflects under the film's pressure; the outer surface of a bush moves with the housing.
        None: a rigid bore.
    journal : ElasticJournal, FEJournal or None, default None
        Flexible journal. `ElasticJournal`: a pin in a rigid bore or a `ModalBush`. `FEJournal`: the reduced
        finite-element body that the joint holds as its journal, in a rigid bore. None: a rigid journal.
    asperity : GreenwoodTripp or None, default None
        Contact of rough surfaces with boundary friction; carries load before the gap vanishes, in place of ``contact``.
    roughness : PatirCheng or None, default None
        Flow factors of rough surfaces; with ``asperity`` both must have the same ``composite_roughness``.
    profile : SurfaceProfile, tuple of SurfaceProfile or None, default None
        Addition to the gap by the surfaces' shape: `OutOfRound`, `Crown`, `EdgeRelief`, `AxialProfile`, `ProfileTable`,
        `WornArc`.
    wear : ArchardWear or None, default None
        Wear of the bore by the asperity contact; needs ``asperity``.
    turbulence : NgPan, Hirs or None, default None
        Turbulent film by the local Reynolds number; None: laminar.
    thrust : ThrustFaces or None, default None
        Films on the two end faces, which carry axial load; None: the film's drag is the only axial force.

    Raises
    ------
    InputError
        For values of a wrong type or outside their ranges, and for options that exclude each other.

    Examples
    --------
    >>> bearing = ehd.JournalBearing(
    ...     journal_radius=0.025, length=0.025, radial_clearance=25e-6, lubricant=ehd.Lubricant(viscosity=0.02)
    ... )
    >>> bearing.clearance_ratio
    0.001
    >>> round(bearing.reference_force(speed=314.0))  # N
    7850
    """

    journal_radius: float
    length: float
    radial_clearance: float
    lubricant: Lubricant
    film: FilmOption = FiniteLength()
    cavitation: Cavitation = SwiftStieber()
    inlet: Inlet = Periodic()
    arc: Arc | None = None
    arcs: tuple[Arc, ...] = ()
    end_pressures: tuple[float, float] = (0.0, 0.0)
    end_seals: EndSeal | tuple[EndSeal | None, EndSeal | None] | None = None
    squeeze: bool = True
    contact: RegularisedWall | None = None
    supply: tuple[SupplyArea, ...] = ()
    thermal: LumpedThermal | FilmEnergy | None = None
    bush: ElasticLiner | ModalBush | ANCFBush | FEBore | ReducedBore | None = None
    journal: ElasticJournal | FEJournal | TurningJournal | None = None
    asperity: GreenwoodTripp | None = None
    roughness: PatirCheng | None = None
    profile: SurfaceProfile | tuple[SurfaceProfile, ...] | None = None
    wear: ArchardWear | None = None
    turbulence: NgPan | Hirs | None = None
    thrust: ThrustFaces | None = None

    checks: ClassVar = {
        "journal_radius": partial(POSITIVE, hint="it is half the diameter."),
        "length": POSITIVE,
        "radial_clearance": partial(
            POSITIVE, hint="it is bore radius minus journal radius; if yours is diametral, halve it."
        ),
        "squeeze": require_bool,
        "lubricant": (Lubricant,),
        "film": get_args(FilmOption),
        "cavitation": get_args(Cavitation),
        "inlet": get_args(Inlet),
        "arc": (Arc, type(None)),
        "contact": (RegularisedWall, type(None)),
        "thermal": (LumpedThermal, FilmEnergy, type(None)),
        "asperity": (GreenwoodTripp, type(None)),
        "roughness": (PatirCheng, type(None)),
        "wear": (ArchardWear, type(None)),
        "turbulence": (NgPan, Hirs, type(None)),
        "thrust": (ThrustFaces, type(None)),
    }

    def __post_init__(self) -> None:
        super().__post_init__()
        # beyond it nothing is a thin film, or lengths are in other units
        if self.radial_clearance > 0.1 * self.journal_radius:
            raise InputError(
                "JournalBearing.radial_clearance must be at most 0.1 of the journal radius for a thin film, got "
                f"{self.radial_clearance!r} m at {self.journal_radius!r} m; lengths are in metres, "
                "usual clearances a thousandth of the radius."
            )
        for profile in self.profiles:
            require_type("JournalBearing.profile", profile, *get_args(SurfaceProfile))
        ends = require_vector("JournalBearing.end_pressures", self.end_pressures, 2, "Pa (at z = -L/2 and +L/2)")
        # a list or an array compares and hashes like the pair that it is
        object.__setattr__(self, "end_pressures", tuple(ends.tolist()))
        require_seals(self.end_seals)
        require_areas(self.supply)
        check_arcs(self.arc, self.arcs, self.length)
        open_ring = isinstance(self.inlet, MaximumGap)
        check_film(self.film, self.cavitation, self.supply, open_ring, self.end_pressures)
        if isinstance(self.film, ImpedanceMap):
            self._check_plain()
        check_line(self.film, self.cavitation, self.yielding, self.lubricant)
        check_combinations(vars(self) | {"arcs": self.bore_arcs})
        check_faces(vars(self))
        self._check_supply()
        self._check_pressures()
        self._check_clearance()
        if self.journal is not None or not isinstance(self.bush, ElasticLiner | None):
            _check_elastic(self)

    def _check_plain(self) -> None:
        """Check for `ImpedanceMap`: nothing besides geometry, viscosity and a closure at ambient cavity pressure."""
        expected = "the map holds plain bearings only; use film=FiniteLength(...)."
        own = {"journal_radius", "length", "radial_clearance", "lubricant", "film", "cavitation"}
        # without a thermal effect the oil has its viscosity, and all else of it that heat would need is not asked for
        isothermal = {"viscosity", "density", "temperature", "temperature_law", "specific_heat"}
        for item, known in ((self, own), (self.lubricant, isothermal)):
            for f in fields(item):
                if f.name not in known and getattr(item, f.name) != f.default:
                    raise InputError(
                        f"{type(item).__name__}.{f.name} must be {f.default!r} with film=ImpedanceMap(...), got "
                        f"{getattr(item, f.name)!r}; {expected}"
                    )
        closure = self.cavitation
        if closure.conserves_mass or closure.cavity_pressure != 0.0 or closure.cavity_shear != 1.0:
            raise InputError(
                "JournalBearing.cavitation must be Gumbel() or SwiftStieber() at cavity_pressure=0 and cavity_shear=1 "
                f"with film=ImpedanceMap(...), got {closure!r}; {expected}"
            )

    def _check_supply(self) -> None:
        if not self.supply:
            return
        film, ends = self.film, None if isinstance(self.film, LongBearing) else self.end_pressures
        around = film.circumferential_pressure_flow
        if self.bore_arcs:
            spans = np.array([(arc.start, arc.extent) for arc in self.bore_arcs])
            check_on_arcs(self.supply, spans, self.journal_radius, self.columns)
        check_supply(self.supply, self.journal_radius, self.length, self.columns, around, ends)
        if isinstance(self.inlet, MaximumGap):
            raise InputError(
                "JournalBearing.supply and inlet=MaximumGap() exclude each other: a supplied film starts at its "
                "grooves; use inlet=Periodic()."
            )
        check_depths(self.supply, self.radial_clearance)
        lowest, pc = min(map(source_pressure, self.supply)), self.cavitation.cavity_pressure
        if pc > lowest:
            raise InputError(
                f"JournalBearing.supply: pressures must not be below {type(self.cavitation).__name__}.cavity_pressure "
                f"({pc:g} Pa), got {lowest:g} Pa; both are gauge pressures."
            )

    def _check_pressures(self) -> None:
        pc = self.cavitation.cavity_pressure
        lowest = min(self.end_pressures)
        edges = f"JournalBearing.end_pressures {self.end_pressures!r} Pa"
        if isinstance(self.inlet, MaximumGap) and lowest > 0.0:
            lowest, edges = 0.0, "the ambient pressure (0 Pa) of inlet=MaximumGap()"
        for arc in self.bore_arcs:
            if lowest > min(arc.pressures):
                lowest, edges = min(arc.pressures), f"the pressures at the edges of {arc!r}"
        if pc > lowest:
            raise InputError(
                f"{type(self.cavitation).__name__}.cavity_pressure must not exceed {edges}, got {pc:g} Pa; all are "
                "gauge pressures, lower the cavity pressure."
            )

    def _check_clearance(self) -> None:
        if self.contact is not None and not self.contact.onset < self.radial_clearance:
            raise InputError(
                f"RegularisedWall.onset must be below the radial clearance {self.radial_clearance:g} m, got "
                f"{self.contact.onset:g} m; the wall would touch a concentric journal."
            )
        ratio = self.clearance_ratio
        if not 1e-4 <= ratio <= 1e-2:
            warn_user(
                f"JournalBearing: the clearance ratio c/R is {ratio:.3g}, outside 0.0001 to 0.01; radial_clearance is "
                "radial (bore radius - journal radius), not diametral, and in metres.",
                PlausibilityWarning,
            )

    @property
    def seals(self) -> tuple[float | None, float | None] | None:
        """Conductances of both seals over clearance and R, 1/(Pa s), with None for an open end; None without seals."""
        if self.end_seals is None:
            return None
        pair = self.end_seals if isinstance(self.end_seals, tuple) else (self.end_seals, self.end_seals)
        scale = self.radial_clearance * self.journal_radius
        lower, upper = (None if seal is None else seal.conductance / scale for seal in pair)
        return lower, upper

    @property
    def profiles(self) -> tuple[SurfaceProfile, ...]:
        """The profiles as a tuple; empty for circular cylinders."""
        if self.profile is None:
            return ()
        return self.profile if isinstance(self.profile, tuple) else (self.profile,)

    @property
    def bore_arcs(self) -> tuple[Arc, ...]:
        """Parts of the circle that have a bore, in order; empty for a bore all around."""
        return self.arcs if self.arc is None else (self.arc,)

    @property
    def is_lobed(self) -> bool:
        """Return whether the bore is more than one part of one circle: the journal may leave the clearance circle."""
        arcs = self.bore_arcs
        return len(arcs) > 1 or any(arc.preload > 0.0 for arc in arcs)

    @property
    def edge_pressures(self) -> tuple[float, ...]:
        """Gauge pressures at the leading and the trailing edge of every arc in turn, Pa."""
        return tuple(p for arc in self.bore_arcs for p in arc.pressures)

    @property
    def yielding(self) -> object | None:
        """Flexible side: the bush, else the elastic journal; None between rigid surfaces."""
        return self.journal if self.bush is None else self.bush

    @property
    def clearance_ratio(self) -> float:
        """psi = c/R."""
        return self.radial_clearance / self.journal_radius

    @property
    def sized_film(self) -> FilmOption:
        """``film`` with the number of columns that the bearing's L/D gives where ``n_theta`` is None."""
        return sized(self.film, 0.5 * self.length / self.journal_radius)

    @property
    def columns(self) -> int:
        """Vertices of the film around the circumference."""
        return columns_of(self.film, 0.5 * self.length / self.journal_radius)

    @property
    def closure(self) -> Cavitation:
        """``cavitation`` with the value of ``line_in_cells`` that a None stands for in this bearing."""
        return place_line(self.cavitation, not no_line_with(self.film, self.cavitation, self.yielding, self.lubricant))

    def reference_force(self, speed: float) -> float:
        """L D mu |omega| / psi^2, the unit of the Sommerfeld number.

        Parameters
        ----------
        speed : float
            Relative spin omega, rad/s.

        Returns
        -------
        float
            N.
        """
        area = 2.0 * self.journal_radius * self.length
        return area * self.lubricant.viscosity * abs(speed) / self.clearance_ratio**2


def _check_elastic(bearing: JournalBearing) -> None:
    """Raise `InputError` for objects that are no bush or journal, or whose surface does not fit the film."""
    # imported here: a rigid bearing needs no solid
    from exudyn_ehd.solid.bush import ANCFBush, ModalBush, require_bore
    from exudyn_ehd.solid.fe_bore import FEBore, ReducedBore
    from exudyn_ehd.solid.journal import ElasticJournal
    from exudyn_ehd.solid.turning_journal import FEJournal, TurningJournal

    kinds = (ElasticLiner, ModalBush, ANCFBush, FEBore, ReducedBore, type(None))
    require_type("JournalBearing.bush", bearing.bush, *kinds)
    require_type("JournalBearing.journal", bearing.journal, ElasticJournal, FEJournal, TurningJournal, type(None))
    if not isinstance(bearing.film, FiniteLength | ShortBearing):
        raise InputError(
            f"JournalBearing.{'bush' if bearing.journal is None else 'journal'} needs film=FiniteLength(...) or "
            f"ShortBearing(...), got {type(bearing.film).__name__}(...)."
        )
    if bearing.journal is not None:
        bearing.journal.require_fit(bearing.journal_radius, bearing.length, bearing.bush)
    if isinstance(bearing.bush, ModalBush | ANCFBush):
        require_bore(bearing.bush.mesh, bearing.journal_radius + bearing.radial_clearance, bearing.length)
