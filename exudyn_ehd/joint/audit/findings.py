"""Findings of an audit about effects, and the limit from which on each effect matters."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import NamedTuple

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.film.surfaces.elastic_liner import ElasticLiner
from exudyn_ehd.film.thrust.options import ThrustFaces
from exudyn_ehd.joint.audit.changes import MATTERS, NOTHING, Change, Comparison
from exudyn_ehd.joint.audit.ringing import LIMIT
from exudyn_ehd.joint.audit.samples import RecordedSteps, Sample
from exudyn_ehd.joint.audit.switches import Switch, turbulent
from exudyn_ehd.joint.balance.limits import HOT
from exudyn_ehd.joint.balance.resolution import FEWEST, STEEPEST
from exudyn_ehd.status import InputError


class Limit(NamedTuple):
    """Limit from which on an effect matters: above ``value``, or ``below`` it; ``source`` says what the value means."""

    value: float
    source: str
    below: bool = False


# An effect that is not computed matters if load, peak pressure, friction or minimum film thickness would change by some
# 5 to 10 % without it.
# Shares without another source: of a bearing with L/D = 0.75 at eccentricity ratio 0.8, with Swift-Stieber.
LIMITS = {
    "misalignment": Limit(0.1, "of the mid-plane gap: that much of the minimum film thickness, 1 % of the peak"),
    "elasticity": Limit(0.1, "of the minimum film thickness: 6 % of the peak pressure at the same position"),
    "journal elasticity": Limit(0.1, "of the minimum film thickness, as for elasticity"),
    "profile": Limit(0.1, "of the minimum film thickness, as for elasticity"),
    "piezoviscosity": Limit(0.1, "alpha p_max: 3 % of the load, 5 % of the peak pressure"),
    "heating": Limit(0.1, "change of the viscosity"),
    "walls": Limit(0.05, "of the heat, that much of the film's rise"),
    "oil temperature": Limit(HOT, "K: `exudyn_ehd.joint.balance.limits`, which warns from there on"),
    "shear thinning": Limit(1.0, "shear rate over the one at which a multigrade oil begins to thin"),
    "roughness": Limit(
        3.0, "film over roughness: 6 % of the load by flow factors; below, asperities carry", below=True
    ),
    "contact": Limit(2e-3, "of the load: 5 % of the friction, where a film has 0.004 and asperities 0.1"),
    "wear": Limit(1e-4, "of the load: wear asks for less contact than friction"),
    "squeeze": Limit(0.05, "of the sources of the Reynolds equation"),
    "cavitation": Limit(0.01, "of the bore"),
    "rupture": Limit(0.01, "of the bore"),
    "mass conservation": Limit(0.05, "of the bore, moving or refilled"),
    "thrust faces": Limit(0.03, "of the joint's loss"),
    "heat of thrust faces": Limit(0.1, "change of the viscosity, as for heating"),
    "Taylor vortices": Limit(41.2, "concentric journal: G. I. Taylor, Phil. Trans. R. Soc. A 223 (1923) 289"),
    "turbulence": Limit(2000.0, "rho U c / mu of a Couette flow"),
    # up to twice the forces of lubrication theory were measured at 10: ASME GT1984, V005T13A003
    "fluid inertia": Limit(1.0, "rho w c^2 / mu: inertia takes a tenth of the viscous pressure of a swinging flow"),
    "grid around": Limit(FEWEST, "intervals: 5 % of the peak pressure, `joint.balance.resolution`", below=True),
    "grid along": Limit(STEEPEST, "times as thick a film: as around"),
    "supply resolution": Limit(1.0, "interval across the narrowest area, whose edges act where they are", below=True),
    "time step": Limit(0.05, "of the minimum film thickness"),
    "ringing": Limit(LIMIT - 1.0, "bursts of `exudyn_ehd.joint.audit.ringing`, which warns from four on"),
}


# Values beyond which an effect is plainly nothing, so that no other film is solved for it.
PLAINLY_NOTHING = {
    "elasticity": 0.01,
    "journal elasticity": 0.01,
    "profile": 0.01,
    "piezoviscosity": 0.01,
    "heating": 0.01,
    "walls": 0.01,
    "shear thinning": 0.2,
    "roughness": 10.0,
    "contact": 6.0,
    "contact share": 1e-6,
    "mass conservation": 1e-3,
    "turbulence": 200.0,
}
# From here on effects plainly matter, heating if it is on; the search for the film without them is long. Oil that has
# warmed by so much is half as viscous.
PLAINLY_MUCH = {"elasticity": 5.0, "journal elasticity": 5.0}
PLAINLY_MUCH_ON = PLAINLY_MUCH | {"heating": 0.7}


@dataclass(frozen=True, kw_only=True)
class Finding:
    """Finding of an audit about one effect.

    Attributes
    ----------
    effect, indicator : str
        Name of the effect, and meaning of ``value``.
    value, threshold : float
        The indicator at the worst state, and its limit from which on the effect matters.
    below : bool
        The effect matters below the threshold, not above.
    on : bool or None
        True if the bearing has the effect; None for an assumption or a number that can't be switched.
    matters : bool
        The effect changes something by more than 3 %; where no change was computed or no film was found, ``value``
        beyond ``threshold``.
    unneeded : bool
        It takes time although it does not matter; never where no film was found without it.
    advice : str
        Remedy; empty if none is needed.
    change : Change or None
        Change by switching the effect, computed at the audited states; not ``found`` if no film then carries the same
        load. None if ``value`` alone shows that the effect is negligible, or if the films can't be compared.
    remedy : function or None
        Function that applies ``advice`` to a bearing.
    time_share : float or None
        Share of the time of a film evaluation with tangent that the effect takes, 0 to 1; None if not measured.

    Examples
    --------
    After the example of `Audit`:

    >>> heating = audit["heating"]
    >>> heating.on, heating.matters
    (False, True)
    >>> heating.advice.split(" and ")[0]
    'give the bearing thermal=LumpedThermal(...)'
    """

    effect: str
    indicator: str
    value: float
    threshold: float
    below: bool = False
    on: bool | None
    matters: bool
    unneeded: bool = False
    advice: str = ""
    change: Change | None = None
    remedy: Switch | None = field(default=None, repr=False, compare=False)
    time_share: float | None = None

    @property
    def in_vain(self) -> bool:
        """Another name of ``unneeded``."""
        return self.unneeded


@dataclass(frozen=True, eq=False)
class Case:
    """Subject of an audit.

    It holds the worst films and those of other bearings to compare with. If they come from a record, it holds the
    record too. Further data are a liner that the bearing does not have, and the thrust faces of the record. The bearing
    is that of the journal's film alone.
    """

    bearing: JournalBearing
    samples: list[Sample]
    films: Comparison
    record: RecordedSteps | None = None
    liner: ElasticLiner | None = None
    faces: ThrustFaces | None = None

    def largest(self, name: str) -> float:
        """Largest value of a number of the samples."""
        return max(getattr(sample, name) for sample in self.samples)

    def smallest(self, name: str) -> float:
        """Smallest value of a number of the samples."""
        return min(getattr(sample, name) for sample in self.samples)


def finding(
    effect: str,
    indicator: str,
    value: float,
    on: bool | None,
    *,
    limit: Limit | None = None,
    mattering: str = "",
    needless: str | None = None,
    change: Change | None = None,
    switch: Switch | None = None,
) -> Finding:
    """A finding with the advice for the case at hand.

    ``limit`` in place of the effect's own of `LIMITS`; ``mattering``: advice if it matters but is off; ``needless``: if
    it is on and does not matter, None for an effect that is never unneeded; ``change``: by ``switch``, which adds what
    is off and drops what is on.
    """
    limit = LIMITS[effect] if limit is None else limit
    if change is None or not change.found:
        matters = value < limit.value if limit.below else value > limit.value
        unneeded = not matters and change is None
    else:
        matters, unneeded = change.size > MATTERS, change.size < NOTHING
    unneeded = unneeded and on is True and needless is not None
    advice = mattering if matters and not on else ""
    if advice and change is not None and not change.found:
        advice += " No film was found that carries this load then."
    if unneeded and needless:
        advice = needless
    return Finding(
        effect=effect,
        indicator=indicator,
        value=value,
        threshold=limit.value,
        below=limit.below,
        on=on,
        matters=matters,
        unneeded=unneeded,
        advice=advice,
        change=change,
        remedy=switch if advice else None,
    )


def _refusal(switch: Switch, bearing: JournalBearing) -> str:
    """Return the message why a turbulent film does not support a switch; empty if it does."""
    if bearing.turbulence is None and switch is not turbulent:
        return ""
    try:
        switch(bearing)
    except InputError as error:
        return str(error)
    return ""


def judged(
    case: Case,
    effect: str,
    indicator: str,
    value: float,
    on: bool | None,
    switch: Switch,
    *,
    probe: Switch | None = None,
    limit: Limit | None = None,
    mattering: str = "",
    needless: str | None = None,
) -> Finding:
    """A finding by the change that ``switch`` makes (seen by ``probe``), unless its value says enough."""
    limit = LIMITS[effect] if limit is None else limit
    nothing = PLAINLY_NOTHING.get(effect, 0.0)
    plain = value > nothing if limit.below else value < nothing
    plain = plain or value > (PLAINLY_MUCH_ON if on else PLAINLY_MUCH).get(effect, math.inf)
    if not on and not plain and (refusal := _refusal(switch, case.bearing)):
        return finding(effect, indicator, value, on, limit=limit, mattering=f"{mattering} {refusal}")
    return finding(
        effect,
        indicator,
        value,
        on,
        limit=limit,
        mattering=mattering,
        needless=needless,
        change=None if plain else case.films.change(switch if probe is None else probe),
        switch=switch,
    )
