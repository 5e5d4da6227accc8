"""`recommend` on bearings drawn at random: is its bound one, and how far is it from the true error?

``python -m tests.studies.random_advice FIRST COUNT`` prints a line per bearing.
"""

from __future__ import annotations

import dataclasses
import sys
import time

import numpy as np

import exudyn_ehd as ehd
from exudyn_ehd.joint.model.build import build_model
from exudyn_ehd.studies.film_errors import SCALES, measure_motions, motion_at, scale_of

SPEED = 200.0
# Truth: this film in these many other directions.
FINE, DIRECTIONS = {"n_theta": 384, "n_z": 32}, 9


@dataclasses.dataclass(frozen=True, kw_only=True)
class Question:
    """Question made from one seed: a bearing, its working point and the quantity asked for."""

    bearing: ehd.JournalBearing
    eccentricity_ratio: float
    tilt_ratio: float
    quantity: str
    error: float


@dataclasses.dataclass(frozen=True, kw_only=True)
class Outcome:
    """Advice of `recommend`, and the true error of the film that it named (nan: none was named)."""

    advice: ehd.Recommendation
    true: float


def draw(seed: int) -> Question:
    """Bearings over the stated domain: a half plain, a half with one or two effects that change the film."""
    rng = np.random.default_rng([seed, 16])
    while True:
        radius = float(rng.choice([0.01, 0.025, 0.05]))
        length, clearance = 2.0 * radius * float(rng.uniform(0.25, 2.0)), radius * float(rng.choice([8e-4, 1.5e-3]))
        angle, feed = float(rng.uniform(0.0, 2.0 * np.pi)), float(rng.choice([0.0, 1e5, 4e5]))
        supplies = [
            ehd.AxialGroove(angle=angle, width_angle=float(rng.uniform(0.1, 0.6)), length=0.7 * length, pressure=feed),
            ehd.Hole(angle=angle, diameter=float(rng.uniform(0.1, 0.4)) * min(radius, length), pressure=feed),
            ehd.Pocket(angle=angle, width_angle=0.5, length=0.5 * length, pressure=feed),
            ehd.CircumferentialGroove(width=float(rng.uniform(0.05, 0.3)) * length, pressure=feed),
        ]
        effects = [
            ("supply", (supplies[rng.integers(4)],)),
            ("cavitation", [ehd.Gumbel(), ehd.ElrodAdams(), ehd.SwiftStieber(cavity_pressure=-5e4)][rng.integers(3)]),
            ("end_pressures", (1e5, 3e4)),
            ("bush", ehd.ElasticLiner(thickness=0.1 * radius, youngs_modulus=float(rng.choice([1e9, 1e10])))),
            ("roughness", ehd.PatirCheng(composite_roughness=0.02 * clearance)),
            ("profile", ehd.EdgeRelief(drop=0.2 * clearance, relief_length=0.2 * length)),
            ("pressure_law", ehd.RoelandsPressure(coefficient=1e-8)),
            ("shear_law", ehd.CarreauShear(relaxation_time=1e-6, exponent=0.75, residual=0.3)),
        ]
        count = int(rng.choice([0, 1, 2], p=[0.5, 0.3, 0.2]))
        options = dict(effects[k] for k in rng.permutation(len(effects))[:count])
        if isinstance(options.get("cavitation"), ehd.ElrodAdams):
            # a film that nothing feeds runs dry
            options.setdefault("supply", (supplies[rng.integers(4)],))
        laws = {name: options.pop(name) for name in ("pressure_law", "shear_law") if name in options}
        known = [n for n in SCALES if n != "critical mass" and (n != "supply flow" or "supply" in options)]
        question = {
            "eccentricity_ratio": float(rng.uniform(0.1, 0.95)),
            "tilt_ratio": float(rng.choice([0.0, rng.uniform(0.0, 0.7)])),
            "quantity": str(rng.choice([*known, "stiffness", "damping"] + ["supply flow"] * ("supply" in options))),
            "error": float(rng.choice([0.05, 0.02, 0.01])),
        }
        try:
            bearing = ehd.JournalBearing(
                journal_radius=radius,
                length=length,
                radial_clearance=clearance,
                lubricant=ehd.Lubricant(viscosity=0.02, **laws),
                **options,
            )
        except ehd.InputError:
            continue
        return Question(bearing=bearing, **question)


def ask(question: Question) -> Outcome:
    """The advice, and what it is worth."""
    q = dataclasses.asdict(question) | {"bearing": question.bearing}
    advice = ehd.recommend(q.pop("bearing"), q.pop("error"), q.pop("quantity"), **q, speed=SPEED)
    return Outcome(advice=advice, true=true_error(question, advice) if advice.found else np.nan)


def true_error(question: Question, advice: ehd.Recommendation) -> float:
    """Largest error of the film that was named over directions of its own, against a finer film."""
    rng = np.random.default_rng([round(1e6 * question.eccentricity_ratio), 5])
    bearing = dataclasses.replace(question.bearing, **advice.options)
    fine = dataclasses.replace(question.bearing, film=ehd.FiniteLength(**FINE), cavitation=_lined(question.bearing))
    place = SPEED, question.eccentricity_ratio, question.tilt_ratio
    angles = 2.0 * np.pi * (np.arange(DIRECTIONS) + rng.uniform(0.0, 1.0, DIRECTIONS)) / DIRECTIONS
    motions = [motion_at(bearing, *place, float(a)) for a in angles]
    value, truth = (measure_motions(build_model(b), motions)[question.quantity] for b in (bearing, fine))
    return float(np.max(np.abs(value - truth))) / scale_of(question.quantity, truth)


def _lined(bearing: ehd.JournalBearing) -> object:
    try:
        closure = dataclasses.replace(bearing.cavitation, line_in_cells=True)
        dataclasses.replace(bearing, film=ehd.FiniteLength(), cavitation=closure)
    except (TypeError, ehd.InputError):
        return bearing.cavitation
    return closure


def words(question: Question) -> str:
    """A question in one line."""
    b = question.bearing
    laws = [v for v in (b.lubricant.pressure_law, b.lubricant.shear_law) if v]
    named = [b.cavitation, b.bush, b.roughness, b.profile, *b.supply, *laws, any(b.end_pressures) or None]
    return (
        f"L/D {b.length / b.journal_radius / 2:.2f} eps {question.eccentricity_ratio:.3f} tilt "
        f"{question.tilt_ratio:.2f} {question.quantity} {question.error:g}: "
        + " ".join(type(v).__name__ for v in named if v is not None)
    )


def main(first: int, count: int) -> None:
    """Print a line per bearing and what they come to."""
    found, right, ratios = 0, 0, []
    for seed in range(first, first + count):
        question, start = draw(seed), time.process_time()
        out = ask(question)
        found += out.advice.found
        if out.advice.found:
            right += out.true <= out.advice.error
            ratios.append(out.advice.error / out.true if out.true > 0.0 else np.inf)
        verdict = "" if not out.advice.found or out.true <= out.advice.error else "WRONG"
        print(
            f"{seed}: {words(question)} | {out.advice.reason[:60] if out.advice.found else out.advice.reason} | bound "
            f"{out.advice.error:.2g}, true {out.true:.2g} {verdict} {time.process_time() - start:.1f} s",
            flush=True,
        )
    print(f"answers {found} of {count}, right {right}, median of bound over true error {np.median(ratios):.2f}")


if __name__ == "__main__":
    main(int(sys.argv[1]), int(sys.argv[2]))
