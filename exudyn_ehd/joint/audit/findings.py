"""Audit of a bearing: its findings about effects, and the limit beyond which each effect matters."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import NamedTuple

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.film.solvers.impedance_map import ImpedanceMap
from exudyn_ehd.joint.audit.case import MATTERS, NOTHING, Case, Change
from exudyn_ehd.joint.audit.resolution import FEWEST, LIMIT, STEEPEST
from exudyn_ehd.joint.audit.switches import Switch, turbulent, two_dimensional
from exudyn_ehd.joint.balance.limits import HOT
from exudyn_ehd.status import InputError
from exudyn_ehd.tables import html_table

_ON = {True: "on", False: "off", None: "-"}


class Limit(NamedTuple):
    """Limit beyond which an effect matters, and range of values in which films with and without it are compared.

    Attributes
    ----------
    value : float
        The effect matters above it, or ``below`` it.
    source : str
        Meaning of the value.
    nothing : float or None
        Value on the harmless side of which the effect is negligible, so that no films are compared. None: the value
        alone decides, films are never compared.
    much, much_on : float
        Value above which the effect surely matters: of an effect that is off, and of one that is on. Films are not
        compared there, since the search for the other film would be long.
    """

    value: float
    source: str
    below: bool = False
    nothing: float | None = None
    much: float = math.inf
    much_on: float = math.inf

    def is_unclear(self, value: float, on: bool | None) -> bool:
        """Return whether the value leaves open if the effect matters, so that films have to be compared."""
        if self.nothing is None or value > (self.much_on if on else self.much):
            return False
        return not (value > self.nothing if self.below else value < self.nothing)


# Limits for which load, peak pressure, friction or minimum film thickness change by some 5 to 10 %. Percentages without
# another source: bearing with L/D = 0.75 at eccentricity ratio 0.8, with Swift-Stieber.
# Heating: a rise of 0.7 over the temperature coefficient halves the viscosity.
LIMITS = {
    "misalignment": Limit(0.1, "of the mid-plane gap: that much of the minimum film thickness, 1 % of the peak"),
    "elasticity": Limit(
        0.1, "of the minimum film thickness: 6 % of the peak pressure at the same position", False, 0.01, 5.0, 5.0
    ),
    "journal elasticity": Limit(0.1, "of the minimum film thickness, as for elasticity", False, 0.01, 5.0, 5.0),
    "profile": Limit(0.1, "of the minimum film thickness, as for elasticity", nothing=0.01),
    "piezoviscosity": Limit(0.1, "alpha p_max: 3 % of the load, 5 % of the peak pressure", nothing=0.01),
    "heating": Limit(0.1, "change of the viscosity", nothing=0.01, much_on=0.7),
    "walls": Limit(0.05, "of the heat, that much of the film's rise", nothing=0.01),
    "oil temperature": Limit(HOT, "K: `exudyn_ehd.joint.balance.limits`, which warns from there on"),
    "shear thinning": Limit(1.0, "shear rate over the one at which a multigrade oil begins to thin", nothing=0.2),
    "roughness": Limit(3.0, "film over roughness: 6 % of the load by flow factors", below=True, nothing=10.0),
    "asperities": Limit(3.0, "film over roughness, below which asperities carry", below=True, nothing=6.0),
    # contacts that carry a small share of the load may cause a large share of the friction
    "contact": Limit(
        2e-3, "of the load: 5 % of the friction, where a film has 0.004 and asperities 0.1", False, 1e-6, 2e-3, 2e-3
    ),
    "wear": Limit(1e-4, "of the load: wear asks for less contact than friction"),
    "squeeze": Limit(0.05, "of the sources of the Reynolds equation"),
    "cavitation": Limit(0.01, "of the bore"),
    "rupture": Limit(0.01, "of the bore", nothing=0.0),
    "mass conservation": Limit(0.05, "of the bore, moving or refilled", nothing=1e-3),
    "thrust faces": Limit(0.03, "of the joint's loss"),
    "heat of thrust faces": Limit(0.1, "change of the viscosity, as for heating"),
    "Taylor vortices": Limit(41.2, "concentric journal: G. I. Taylor, Phil. Trans. R. Soc. A 223 (1923) 289"),
    "turbulence": Limit(2000.0, "rho U c / mu of a Couette flow", nothing=200.0),
    # up to twice the forces of lubrication theory were measured at 10: ASME GT1984, V005T13A003
    "fluid inertia": Limit(1.0, "rho w c^2 / mu: inertia takes a tenth of the viscous pressure of a swinging flow"),
    "grid around": Limit(FEWEST, "intervals: 5 % of the peak pressure, `joint.audit.resolution`", below=True),
    "grid along": Limit(STEEPEST, "times as thick a film: as around"),
    "supply resolution": Limit(
        1.0, "interval across the narrowest area, whose edges act where they are", below=True, nothing=math.inf
    ),
    "time step": Limit(0.05, "of the minimum film thickness"),
    "ringing": Limit(LIMIT - 1.0, "bursts of `exudyn_ehd.joint.audit.resolution`, which warns from four on"),
}


@dataclass(frozen=True, kw_only=True)
class Finding:
    """A row of an `Audit`: one effect, its number against a limit, and advice.

    Attributes
    ----------
    effect, indicator : str
        Name of the effect, and meaning of ``value``.
    value, threshold : float
        The indicator at the worst state, and the limit beyond which the effect matters.
    below : bool
        True: the effect matters below the threshold; False: above it.
    on : bool or None
        True: the bearing has the effect; False: it has not; None: an assumption or a number that can't be switched.
    matters : bool
        Switching the effect changes minimum film thickness, peak pressure or power loss at the same load by more than
        3 %. Where no change was computed or no film was found: ``value`` is beyond ``threshold``.
    unneeded : bool
        The bearing has the effect, it takes computing time, and it does not matter; False if no film was found without
        it.
    advice : str
        Remedy; empty if none is needed.
    change : Change or None
        Relative changes by switching the effect, computed at the audited states; ``change.found`` is False if no film
        then carries the same load. None if ``value`` alone shows that the effect is negligible, or if the films can't
        be compared.
    remedy : function or None
        Function that applies ``advice`` to a bearing.
    time_share : float or None
        Time of the effect over that of a film evaluation with its tangent, 0 to 1; None if not measured.

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


@dataclass(frozen=True, kw_only=True)
class Audit:
    """Table of effects: which mattered, which omitted ones would have, which are not needed; print it.

    From `SteadyResult.audit` or `LubricatedJoint.audit`. Columns of the printed table: the effect; on or off (- for an
    assumption or a number); the largest change of minimum film thickness, peak pressure and power loss at the same load
    if the effect is switched; an indicator's value and the limit beyond which the effect may matter; share of computing
    time; verdict; meaning of the indicator. An effect matters if it changes one of the three by more than 3 %. Advice
    stands below the table.

    Attributes
    ----------
    findings : tuple of Finding
        The rows.

    Examples
    --------
    After the example of `JournalBearing`:

    >>> audit = ehd.steady(bearing, speed=314.0, eccentricity_ratio=0.8).audit()
    >>> [finding.effect for finding in audit.neglected]
    ['elasticity', 'journal elasticity', 'piezoviscosity', 'heating', 'shear thinning', 'mass conservation']
    >>> better = audit.improved(bearing)
    """

    findings: tuple[Finding, ...]

    @property
    def matters(self) -> tuple[Finding, ...]:
        """Effects that matter, whether the bearing has them or not."""
        return tuple(f for f in self.findings if f.matters)

    @property
    def neglected(self) -> tuple[Finding, ...]:
        """Effects that matter and are off, and assumptions or numbers that do not hold."""
        return tuple(f for f in self.findings if f.matters and not f.on)

    @property
    def unneeded(self) -> tuple[Finding, ...]:
        """Effects that take time and do not matter."""
        return tuple(f for f in self.findings if f.unneeded)

    def __getitem__(self, effect: str) -> Finding:
        """Return the finding about an effect, by its name."""
        for finding in self.findings:
            if finding.effect == effect:
                return finding
        raise KeyError(f"Audit: no finding about {effect!r}; there are {', '.join(f.effect for f in self.findings)}.")

    def __repr__(self) -> str:
        said = [
            f"{what} {', '.join(f.effect for f in found)}"
            for what, found in (("neglected", self.neglected), ("unneeded", self.unneeded))
            if found
        ]
        return f"<Audit of {len(self.findings)} effects and assumptions: {'; '.join(said) or 'nothing to change'}>"

    def _rows(self) -> list[tuple[str, ...]]:
        head = ("effect", "", "change", "value", "limit", "time", "verdict", "indicator")
        return [head, *(_row(finding) for finding in self.findings)]

    def _repr_html_(self) -> str:
        return html_table(self._rows())

    def __str__(self) -> str:
        rows = self._rows()
        widths = [max(len(row[k]) for row in rows) for k in range(7)]
        lines = ["  ".join(text.ljust(w) for text, w in zip(row, (*widths, 0))).rstrip() for row in rows]
        lines.insert(1, "-" * max(map(len, lines)))
        advice = [f"{f.effect}: {f.advice}" for f in self.findings if f.advice]
        changes = [f"{f.effect}: {f.change}" for f in self.findings if f.change is not None and f.matters]
        return "\n".join([*lines, *([""] if advice else []), *advice, *([""] if changes else []), *changes])

    def improved(self, bearing: JournalBearing) -> JournalBearing:
        """Return the bearing with missing effects switched on, with typical numbers, and unneeded ones switched off.

        Every advice is applied that the bearing's options allow; a bearing of arcs allows neither heat nor surfaces
        that deflect. The new numbers are typical ones: replace them by yours. Effects act on each other: compute the
        film or the run again with the result and audit it, until the audit advises no change.

        Parameters
        ----------
        bearing : JournalBearing
            The one that was audited.

        Returns
        -------
        JournalBearing

        Raises
        ------
        InputError
            If a missing effect is not supported by the bearing's film model, closure or thrust faces.
        """
        remedies = [finding.remedy for finding in self.findings if finding.remedy is not None]
        if remedies and isinstance(bearing.film, ImpedanceMap):
            bearing = two_dimensional(bearing)
        # turbulence excludes laws of laminar films: it is applied first, and advice that it excludes is dropped
        for remedy in sorted(remedies, key=lambda remedy: remedy is not turbulent):
            try:
                bearing = remedy(bearing)
            except InputError:
                if bearing.turbulence is None and not bearing.bore_arcs:
                    raise
        return bearing


def _row(f: Finding) -> tuple[str, ...]:
    verdict = (
        "neglected" if f.matters and f.on is False else "matters" if f.matters else "unneeded" if f.unneeded else ""
    )
    if f.matters and f.on is None:
        verdict = "beyond limit"
    share = "" if f.time_share is None else f"{f.time_share:.0%}"
    change = "" if f.change is None else f"{f.change.size:.1%}" if f.change.found else "no film"
    limit = f"{'<' if f.below else '>'} {f.threshold:.3g}"
    return f.effect, _ON[f.on], change, f"{f.value:.3g}", limit, share, verdict, f.indicator


def judged(
    case: Case,
    effect: str,
    indicator: str,
    value: float,
    on: bool | None,
    switch: Switch | None = None,
    *,
    probe: Switch | None = None,
    limit: Limit | None = None,
    mattering: str = "",
    needless: str | None = None,
) -> Finding:
    """Return a finding by its indicator's value, and by the change of the films if the value leaves the verdict open.

    Parameters
    ----------
    case : Case
    effect, indicator, value, on
        As in `Finding`.
    switch : function or None
        Adds the effect if it is off, removes it if it is on.
    probe : function or None
        Switch that is faster to compute; the change is computed with it in place of ``switch``.
    limit : Limit or None
        Limit in place of that in `LIMITS`.
    mattering : str
        Advice if the effect matters but is off.
    needless : str or None
        Advice if the effect is on and does not matter; None for an effect that is never unneeded.
    """
    limit, change = LIMITS[effect] if limit is None else limit, None
    if effect in case.omitted:
        on, switch, mattering = None, None, case.omitted[effect]
    if switch is not None and limit.is_unclear(value, on):
        if not on and (refusal := _refusal(switch, case.bearing)):
            switch, mattering = None, f"{mattering} {refusal}"
        else:
            change = case.change(switch if probe is None else probe)
    matters, is_idle, advice = value < limit.value if limit.below else value > limit.value, change is None, ""
    if change is not None and change.found:
        matters, is_idle = change.size > MATTERS, change.size < NOTHING
    unneeded = on is True and needless is not None and is_idle and not matters
    if unneeded and needless is not None:
        advice = needless
    elif matters and not on and mattering:
        is_lost = change is not None and not change.found
        advice = f"{mattering} No film was found that carries this load then." if is_lost else mattering
    return Finding(
        effect=effect,
        indicator=indicator,
        value=float(value),
        threshold=limit.value,
        below=limit.below,
        on=on,
        matters=bool(matters),
        unneeded=unneeded,
        advice=advice,
        change=change,
        remedy=switch if advice else None,
        time_share=case.time_share(switch) if on and switch is not None else None,
    )


def _refusal(switch: Switch, bearing: JournalBearing) -> str:
    """Return the message why a turbulent film does not support a switch; empty if it does or the film stays laminar."""
    if bearing.turbulence is None and switch is not turbulent:
        return ""
    try:
        switch(bearing)
    except InputError as error:
        return str(error)
    return ""
