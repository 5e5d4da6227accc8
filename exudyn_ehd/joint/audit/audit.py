"""Audit of a bearing.

Which effects mattered in the films it has had, which were left out, and which take time without need.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.film.solvers.impedance_map import ImpedanceMap
from exudyn_ehd.film.surfaces.elastic_liner import ElasticLiner
from exudyn_ehd.joint.audit import assumptions, effects
from exudyn_ehd.joint.audit.case import Case
from exudyn_ehd.joint.audit.findings import Finding
from exudyn_ehd.joint.audit.samples import RecordedSteps, recorded_states
from exudyn_ehd.joint.audit.switches import turbulent, two_dimensional
from exudyn_ehd.joint.model.build import build_study_model
from exudyn_ehd.status import InputError
from exudyn_ehd.tables import html_table

__all__ = ["Audit", "Finding", "audit_of", "audit_record"]

_ON = {True: "on", False: "off", None: "-"}
# Function that finds what an audit says about an effect, None where there is nothing to say.
AuditRow = Callable[[Case], Finding | None]
ROWS: Mapping[str, AuditRow] = {
    "misalignment": assumptions.misalignment,
    "elasticity": effects.elasticity,
    "journal elasticity": effects.journal_elasticity,
    "profile": effects.shape,
    "piezoviscosity": effects.piezoviscosity,
    "heating": effects.heating,
    "walls": effects.walls,
    "oil temperature": effects.temperature,
    "shear thinning": effects.shear_thinning,
    "roughness": effects.roughness,
    "contact": effects.contact,
    "wear": effects.wear,
    "squeeze": assumptions.squeeze,
    "cavitation": assumptions.cavitation,
    "rupture": assumptions.rupture,
    "mass conservation": assumptions.mass_conservation,
    "thrust faces": effects.faces_share,
    "heat of thrust faces": effects.faces_heat,
    "Taylor vortices": assumptions.vortices,
    "turbulence": assumptions.turbulence,
    "fluid inertia": assumptions.inertia,
    "grid around": assumptions.grid_columns,
    "grid along": assumptions.grid_rows,
    "supply resolution": assumptions.supply_resolution,
    "time step": assumptions.time_step,
    "ringing": assumptions.ringing,
}


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
        """The finding about an effect, by its name."""
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
        """The bearing with missing effects switched on, with typical numbers, and unneeded ones switched off.

        It follows every advice that the bearing's options allow; an arc takes neither heat nor surfaces that deflect.
        The new numbers are typical ones: replace them by yours. Effects act on each other: compute the film or the run
        anew with the result and audit it, until nothing is left to change.

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
        # turbulence leaves out laws of laminar films: where both are missing, the next audit says so
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


def audit_of(case: Case, rows: Mapping[str, AuditRow] = ROWS) -> Audit:
    """Audit the films of a case."""
    findings = [row(case) for row in rows.values()]
    return Audit(findings=tuple(finding for finding in findings if finding is not None))


def audit_record(
    bearing: JournalBearing, record: RecordedSteps, *, liner: ElasticLiner | None = None, measure_time: bool = False
) -> Audit:
    """Audit a bearing by the worst states of a record; arguments as for `Case`.

    Films that remember are run again over up to 60 recorded steps before such a state.
    """
    # what faces do not go with may well act in the journal's film
    model = build_study_model(replace(bearing, thrust=None), 0.0)
    states = recorded_states(model, record)
    return audit_of(Case(model, states, record, liner=liner, faces=bearing.thrust, measure_time=measure_time))
