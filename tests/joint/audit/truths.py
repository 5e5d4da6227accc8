"""Random bearings with the true change that every effect makes: `equilibrium` at equal load on converged grids.

``python -m tests.joint.audit.truths COUNT`` adds scenes to ``truths.jsonl`` up to a count, some seconds each;
``python -m tests.joint.audit.truths COUNT follow`` follows the advice of as many, in `ORDER`, prints where it ends, and
stores the films with everything on in ``complete.jsonl``.

Of the 200 scenes of `ORDER` some 180 end at a clean audit, after 1 to 4 rounds, nearly all of them within 5 % of the
film with everything on and two within 5.7 %, where several neglected effects of some per cent add up. In 15 no film
carries the load with what the advice switches on, and the search says so: mostly small fast bearings, whose films lose
more by their heat than they gain by a smaller gap. In 3 the film is above 423 K, which the audit's row "oil
temperature" tells, and up to 11 % off.
"""

from __future__ import annotations

import json
import math
import pathlib
import sys
import time
import warnings
from dataclasses import dataclass, replace

import numpy as np

import exudyn_ehd as ehd
from exudyn_ehd.joint.audit import switches as s
from exudyn_ehd.joint.balance.position import LoadSearch
from exudyn_ehd.joint.model.build import build_study_model
from exudyn_ehd.joint.solved_film import MOTION_SIZE
from exudyn_ehd.joint.static.steady import result_at

FILE = pathlib.Path(__file__).with_name("truths.jsonl")
COMPLETE = FILE.with_name("complete.jsonl")
SEED = 20240
ORDER = [int(k) for k in np.random.default_rng(7).permutation(200)]
CONVERGED = {"n_theta": 192, "n_z": 16}
NUMBERS = ("minimum_gap", "peak_pressure", "power_loss")
# effect: (whether a bearing has it, what adds it, what drops it)
EFFECTS = {
    "elasticity": (lambda b: b.bush is not None, s.steel_ring, s.rigid),
    "journal elasticity": (lambda b: b.journal is not None, s.steel_pin, s.rigid_journal),
    "piezoviscosity": (lambda b: b.lubricant.pressure_law is not None, s.piezoviscous, s.isoviscous),
    "heating": (lambda b: b.thermal is not None, s.heated, s.isothermal),
    "shear thinning": (lambda b: b.lubricant.shear_law is not None, s.thinning, s.newtonian),
    "roughness": (lambda b: b.roughness is not None, s.rough, s.smooth),
    "contact": (lambda b: b.asperity is not None, s.touching, s.untouching),
    "rupture": (lambda b: not b.cavitation.clips, s.swift_stieber, None),
    "mass conservation": (lambda b: b.cavitation.conserves_mass, s.mass_conserving, s.swift_stieber),
}


@dataclass(frozen=True)
class Scene:
    """A bearing under a load, N, with a speed, rad/s, and a tilt."""

    bearing: ehd.JournalBearing
    speed: float
    load: tuple[float, float]
    tilt: tuple[float, float]

    def film(self, bearing: ehd.JournalBearing, near: ehd.SteadyResult | None = None) -> ehd.SteadyResult:
        """Film of another bearing under the same load; that on the branch of another film, near it, if there is one."""
        if near is None:
            return ehd.equilibrium(bearing, speed=self.speed, load=self.load, tilt=self.tilt).film
        model = build_study_model(bearing, 0.0)
        place = LoadSearch(model, "truth", np.array(self.load)).find(near.motion[:MOTION_SIZE])
        return result_at(model, place.motion[:MOTION_SIZE], "truth")


def draw(number: int) -> Scene:
    """Scene of a number: radius 5 to 150 mm, mean pressure 0.1 to 40 MPa, films of 0.5 um and more, laminar."""
    rng = np.random.default_rng((SEED, number))

    def log(low: float, high: float) -> float:
        return float(np.exp(rng.uniform(math.log(low), math.log(high))))

    while True:
        R, oil = log(5e-3, 0.15), ehd.Lubricant(viscosity=log(5e-3, 0.1))
        L, c, speed = 2.0 * R * log(0.25, 1.5), R * log(5e-4, 2e-3), log(0.3, 40.0) / R
        eps, direction = rng.uniform(0.2, 0.97), rng.uniform(0.0, 2.0 * math.pi)
        n_theta, n_z = ((48, 6), (64, 8), (96, 10), (128, 12))[rng.integers(4)]
        b = ehd.JournalBearing(
            journal_radius=R,
            length=L,
            radial_clearance=c,
            lubricant=oil,
            film=ehd.FiniteLength(n_theta=n_theta, n_z=n_z),
            cavitation=(ehd.SwiftStieber(), ehd.SwiftStieber(cavity_pressure=-1e5), ehd.Gumbel())[
                rng.choice(3, p=(0.7, 0.15, 0.15))
            ],
        )
        if rng.random() < 0.35:
            groove = ehd.AxialGroove(
                angle=direction + rng.uniform(1.5, 4.5), width_angle=0.4, length=0.7 * L, pressure=log(5e4, 4e5)
            )
            b = replace(b, supply=(groove,))
        tilt = (0.0, 0.0)
        if rng.random() < 0.3:
            size, angle = rng.uniform(0.0, 0.4) * (1.0 - eps) * c / (0.5 * L), rng.uniform(0.0, 2.0 * math.pi)
            tilt = size * math.cos(angle), size * math.sin(angle)
        for effect, share in (("piezoviscosity", 0.25), ("heating", 0.25), ("roughness", 0.2), ("elasticity", 0.2)):
            if rng.random() < share:
                b = EFFECTS[effect][1](b)
        if oil.density * speed * R * c / oil.viscosity > 1000.0:
            continue
        try:
            film = ehd.steady(b, speed=speed, eccentricity_ratio=eps, direction=direction, tilt=tilt)
        except ehd.EHDError:
            continue
        mean = float(np.hypot(*film.force[:2])) / (2.0 * R * L)
        if 1e5 < mean < 4e7 and film.minimum_gap > 0.5e-6:
            return Scene(b, speed, (-float(film.force[0]), -float(film.force[1])), tilt)


def change(film: ehd.SteadyResult, other: ehd.SteadyResult) -> float:
    """Largest relative change of minimum film thickness, peak pressure and loss."""
    return max(abs(getattr(other, n) / getattr(film, n) - 1.0) for n in NUMBERS)


def truth(scene: Scene) -> dict[str, float | None]:
    """True change by every effect, and by the grid; None where there is no such film."""
    fine = replace(scene.bearing, film=ehd.FiniteLength(**CONVERGED))
    base = scene.film(fine)
    found: dict[str, float | None] = {"grid": round(change(base, scene.film(scene.bearing)), 4)}
    for effect, (has, add, drop) in EFFECTS.items():
        switch = drop if has(fine) else add
        if switch is None:
            continue
        try:
            # touching surfaces have another equilibrium, pressed on their asperities
            near = base if effect == "contact" else None
            found[effect] = round(change(base, scene.film(switch(fine), near)), 4)
        except ehd.EHDError:
            found[effect] = None
    return found


def complete(bearing: ehd.JournalBearing) -> ehd.JournalBearing:
    """The bearing with every effect on, on a grid of 144 x 12."""
    bearing = replace(bearing, film=ehd.FiniteLength(n_theta=144, n_z=12))
    for effect, (has, add, _) in EFFECTS.items():
        if effect != "rupture" and not has(bearing):
            bearing = add(bearing)
    return bearing


def complete_film(number: int) -> dict[str, float]:
    """Numbers of a scene's film with everything on, stored or solved for; `FilmError` without one."""
    for row in read(COMPLETE):
        if row["scene"] == number:
            return {n: row[n] for n in NUMBERS}
    scene = draw(number)
    film = scene.film(complete(scene.bearing))
    return {n: float(f"{getattr(film, n):.7g}") for n in NUMBERS}


def follow(number: int, rounds: int = 6) -> tuple[bool, int, dict[str, float]]:
    """Follow the advice: whether it ends at a clean audit, rounds, and differences to everything on."""
    scene = draw(number)
    bearing, clean, k = scene.bearing, False, 0
    for k in range(1, rounds + 1):  # noqa: B007
        film = scene.film(bearing)
        audit = film.audit()
        better = audit.improved(bearing)
        if better == bearing:
            clean = not any(f.advice for f in audit.findings)
            break
        bearing = better
    full = complete_film(number)
    return clean, k, {n: getattr(film, n) / full[n] - 1.0 for n in NUMBERS}


def flagged(scene: Scene) -> dict[str, bool]:
    """Findings of the audit of the scene's own film: does an effect matter?"""
    audit = scene.film(scene.bearing).audit()
    said = {f.effect: f.matters for f in audit.findings}
    grids = ("grid around", "grid along", "supply resolution")
    return {e: said[e] for e in EFFECTS if e in said} | {"grid": any(said.get(g, False) for g in grids)}


def read(file: pathlib.Path = FILE) -> list[dict[str, float | None]]:
    """Stored truths, one per scene; empty where the film on the converged grid carries no such load."""
    return [json.loads(line) for line in file.read_text().splitlines()] if file.exists() else []


def main() -> None:
    """See the module's docstring."""
    warnings.simplefilter("ignore")
    count = int(sys.argv[1])
    if "follow" in sys.argv:
        stored = {row["scene"] for row in read(COMPLETE)}
        for number in ORDER[:count]:
            begin = time.process_time()
            try:
                print(number, follow(number), f"{time.process_time() - begin:.1f} s", flush=True)
                if number not in stored:
                    with COMPLETE.open("a") as file:
                        file.write(json.dumps({"scene": number} | complete_film(number)) + "\n")
            except ehd.EHDError as error:
                print(number, str(error)[:100], flush=True)
        return
    for number in range(len(read()), count):
        try:
            row = truth(draw(number))
        except ehd.EHDError:  # more load than the converged film carries anywhere
            row = {}
        with FILE.open("a") as file:
            file.write(json.dumps(row) + "\n")


if __name__ == "__main__":
    main()
