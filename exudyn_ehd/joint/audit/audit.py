"""Audit of a bearing.

Which effects mattered in the films it has had, which were left out, and which take time without need.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.film.solvers.impedance_map import ImpedanceMap
from exudyn_ehd.film.surfaces.elastic_liner import ElasticLiner
from exudyn_ehd.film.thrust.options import ThrustFaces
from exudyn_ehd.joint.audit.changes import Comparison
from exudyn_ehd.joint.audit.findings import Case, Finding
from exudyn_ehd.joint.audit.indicators import INDICATORS, Indicator
from exudyn_ehd.joint.audit.samples import FilmState, RecordedSteps, Sample, recorded_states, take_sample
from exudyn_ehd.joint.audit.switches import turbulent, two_dimensional
from exudyn_ehd.joint.model.build import build_study_model
from exudyn_ehd.joint.model.flexible import ElasticBearingModel
from exudyn_ehd.joint.model.rigid import BearingModel
from exudyn_ehd.joint.solved_film import MOTION_SIZE
from exudyn_ehd.status import FilmError, InputError, Status, require_type
from exudyn_ehd.tables import html_table

__all__ = ["Audit", "Finding", "audit_record", "audit_states"]

# Rounds of a time measurement; the best of them counts.
ROUNDS = 5
_ON = {True: "on", False: "off", None: "-"}


@dataclass(frozen=True, kw_only=True)
class Audit:
    """Findings about one bearing; print it for a table.

    Attributes
    ----------
    findings : tuple of Finding

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

    @property
    def in_vain(self) -> tuple[Finding, ...]:
        """Another name of `unneeded`."""
        return self.unneeded

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
        """The bearing with what is missing switched on, with typical numbers, and what is unneeded switched off.

        Every advice that a description can follow. Effects act on each other: audit the bearing's own film or run
        again, until nothing is left to change.

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
            If its film model, closure or thrust faces do not go with what is missing.
        """
        remedies = [finding.remedy for finding in self.findings if finding.remedy is not None]
        if remedies and isinstance(bearing.film, ImpedanceMap):
            bearing = two_dimensional(bearing)
        # turbulence leaves out laws of laminar films: where both are missing, the next audit says so
        for remedy in sorted(remedies, key=lambda remedy: remedy is not turbulent):
            try:
                bearing = remedy(bearing)
            except InputError:
                if bearing.turbulence is None:
                    raise
        return bearing


@dataclass(frozen=True)
class Kind:
    """A kind of bearings: how one of its films is sampled and compared with others, and the rows of its audit."""

    sample: Callable[[BearingModel, FilmState, RecordedSteps | None], Sample | None]
    comparison: type[Comparison]
    indicators: tuple[Indicator, ...]


JOURNALS = Kind(take_sample, Comparison, INDICATORS)


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


def audit_states(
    model: BearingModel,
    states: Sequence[FilmState],
    *,
    record: RecordedSteps | None = None,
    liner: ElasticLiner | None = None,
    faces: ThrustFaces | None = None,
    measure_time: bool = False,
    kind: Kind = JOURNALS,
) -> Audit:
    """Audit a bearing by its films at some states.

    Parameters
    ----------
    model : BearingModel
    states : sequence of FilmState
    record : RecordedSteps, optional
        Record that the states come from; it adds how often contacts acted, mean heating and the time step.
    liner : ElasticLiner, optional
        Liner whose elasticity is assessed, for bearings without one.
    faces : ThrustFaces, optional
        Thrust faces in the record.
    measure_time : bool
        Measure the share of the time that every effect takes which is on and can be left out.
    kind : Kind
        Kind of the bearing.

    Raises
    ------
    FilmError
        If there is no film at any state.
    """
    require_type("audit: liner", liner, ElasticLiner, type(None))
    samples = [sample for state in states if (sample := kind.sample(model, state, record)) is not None]
    if not samples:
        raise FilmError(
            "audit: none of the states has a film that can be evaluated; audit a joint after its run, or a result "
            "of `steady`."
        )
    case = Case(model.bearing, samples, kind.comparison(model, states, record), record, liner, faces)
    findings = []
    for indicator in kind.indicators:
        finding = indicator.find(case)
        if finding is None:
            continue
        if measure_time and finding.on and indicator.without is not None:
            finding = replace(finding, time_share=_time_share(model, indicator, states))
        findings.append(finding)
    return Audit(findings=tuple(findings))


def audit_record(
    bearing: JournalBearing, record: RecordedSteps, *, liner: ElasticLiner | None = None, measure_time: bool = False
) -> Audit:
    """Audit a bearing by the worst states of a record; arguments as for `audit_states`.

    Films that remember are run again over up to 60 recorded steps before such a state.
    """
    # what faces do not go with may well act in the journal's film
    model = build_study_model(replace(bearing, thrust=None), 0.0)
    states = recorded_states(model, record)
    return audit_states(model, states, record=record, liner=liner, faces=bearing.thrust, measure_time=measure_time)


def _time_share(model: BearingModel, indicator: Indicator, states: Sequence[FilmState]) -> float | None:
    """Share of the time of evaluations with tangent that goes into an effect; None if no film does without it."""
    assert indicator.without is not None
    plain = build_study_model(indicator.without(model.bearing), float(model.grid.x[0]))
    # a history serves both: a model without an effect does not read what belongs to it
    pairs = [(s, replace(s, motion=_known_to(plain, s.motion))) for s in states]
    both = [(s, t) for s, t in pairs if s.evaluate(model).status is t.evaluate(plain).status is Status.CONVERGED]
    if not both:
        return None
    with_it, without_it = math.inf, math.inf
    for _ in range(ROUNDS):
        with_it = min(with_it, sum(_seconds(model, state) for state, _ in both))
        without_it = min(without_it, sum(_seconds(plain, state) for _, state in both))
    return max(0.0, 1.0 - without_it / with_it)


def _known_to(model: BearingModel, motion: np.ndarray) -> np.ndarray:
    """A motion without the coordinates and rates of bore or journal that ``model`` does not have."""
    q, q_t = np.split(motion[MOTION_SIZE:], 2)
    size = model.size if isinstance(model, ElasticBearingModel) else 0
    kept = slice(size) if model.bearing.bush is not None else slice(q.size - size, None)
    return np.concatenate((motion[:MOTION_SIZE], q[kept], q_t[kept]))


def _seconds(model: BearingModel, state: FilmState) -> float:
    """Time of a warm evaluation with tangent and history, s."""
    state.evaluate(model)
    begin = time.perf_counter()
    evaluation = state.evaluate(model)
    evaluation.tangent()
    evaluation.history()
    return time.perf_counter() - begin
