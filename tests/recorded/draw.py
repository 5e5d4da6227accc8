"""Bearings of the records and of the contracts: a covering array over geometry, grid, closure and effects.

``bearings.csv`` holds one bearing a line: the name of one level of each factor. The first part is a covering array of
strength 2: every pair of levels of two factors is in some bearing, unless the package refuses it (`refused.csv` holds
the messages). The rest is drawn at random.

The array is built greedily (D. M. Cohen et al., The AETG system, IEEE Trans. Software Eng. 23 (1997) 437): of several
random candidates the one that covers most pairs not covered yet is taken.
"""

from __future__ import annotations

import csv
import itertools
import math
import pathlib
import warnings

import numpy as np

import exudyn_ehd as ehd
from exudyn_ehd.joint.model import build

HERE = pathlib.Path(__file__).parent
RADIUS, CLEARANCE = 0.025, 50e-6
STEEL = ehd.SaintVenantKirchhoff(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7800.0)
POLYMER = ehd.SaintVenantKirchhoff(youngs_modulus=2e10, poisson_ratio=0.35, density=1400.0)
ASPERITY = ehd.GreenwoodTripp(composite_roughness=4e-6, composite_modulus=1e9)
BUSH = {"thickness": 0.01, "axial": 2, "radial": 1, "circumferential": 16}
WARM = {"supply_temperature": 320.0}
SIDES = {
    "bush": ehd.Conduction(thickness=0.02, conductance=1.0, initial_temperature=325.0, expansion=1e-5),
    "journal": ehd.Conduction(thickness=0.025, conductance=1.0, initial_temperature=335.0, expansion=1e-5),
}


def _bush(length):
    mesh = ehd.HollowCylinder(inner_radius=RADIUS + CLEARANCE, length=length, **BUSH)
    return ehd.ModalBush(mesh=mesh, material=POLYMER, tolerance=0.2)


def _journal(length):
    return ehd.ElasticJournal(material=POLYMER, span=(-0.6 * length, 0.5 * length), held=ehd.HeldEnds(), tolerance=0.2)


# Levels of each factor: what they add to the bearing, as a function of its length where they depend on it. Names that
# end in "_law" go to the lubricant. The first level is the effect's absence.
FACTORS = {
    "length": {"1": 0.05, "0.5": 0.025, "0.25": 0.0125, "2": 0.1},
    "film": {
        "40 x 6": {"film": ehd.FiniteLength(n_theta=40, n_z=6)},
        "60 x 8": {"film": ehd.FiniteLength(n_theta=60, n_z=8)},
        "45 x 5": {"film": ehd.FiniteLength(n_theta=45, n_z=5)},
        "short": {"film": ehd.ShortBearing(n_theta=48)},
        # a film without axial flow needs a line of given pressure
        "long": lambda L: {
            "film": ehd.LongBearing(n_theta=48),
            "supply": (ehd.AxialGroove(angle=2.8, width_angle=0.3, length=L, pressure=1e5),),
        },
    },
    "closure": {
        "swift": {"cavitation": ehd.SwiftStieber()},
        "swift at -50 kPa": {"cavitation": ehd.SwiftStieber(cavity_pressure=-5e4)},
        "swift in cells": {"cavitation": ehd.SwiftStieber(cavity_pressure=-5e4, line_in_cells=True)},
        "swift on vertices": {"cavitation": ehd.SwiftStieber(line_in_cells=False, cavity_shear=0.4)},
        "full": {"cavitation": ehd.FullSommerfeld()},
        "gumbel": {"cavitation": ehd.Gumbel(cavity_pressure=-5e4)},
        "gumbel in cells": {"cavitation": ehd.Gumbel(cavity_pressure=-5e4, line_in_cells=True)},
        "elrod": {"cavitation": ehd.ElrodAdams(cavity_pressure=-5e4)},
        "elrod in cells": {"cavitation": ehd.ElrodAdams(cavity_pressure=-1e5, line_in_cells=True)},
    },
    "ends": {
        "ambient": {},
        "under pressure": {"end_pressures": (2e5, 5e4)},
        "one end": {"end_pressures": (0.0, 3e6)},
    },
    "supply": {
        "none": {},
        "axial": lambda L: {"supply": (ehd.AxialGroove(angle=3.0, width_angle=0.4, length=0.5 * L, pressure=2e5),)},
        "two axial": lambda L: {
            "supply": tuple(
                ehd.AxialGroove(angle=a, width_angle=0.5, length=0.7 * L, pressure=p)
                for a, p in ((0.3, 1e5), (0.3 + math.pi, 0.0))
            )
        },
        "circumferential": lambda L: {"supply": (ehd.CircumferentialGroove(width=0.15 * L, pressure=1e5),)},
        "hole": lambda L: {"supply": (ehd.Hole(angle=2.0, diameter=0.35 * L, pressure=3e5),)},
        "pocket": lambda L: {
            "supply": (ehd.Pocket(angle=4.2, width_angle=0.8, length=0.5 * L, pressure=5e5, depth=1e-3),)
        },
        "turning hole": lambda L: {"supply": (ehd.Hole(angle=1.0, diameter=0.35 * L, pressure=3e5, rotating=True),)},
    },
    "surfaces": {
        "rigid": {},
        "liner": {"bush": ehd.ElasticLiner(thickness=2e-3, youngs_modulus=1e10)},
        "soft liner": {"bush": ehd.ElasticLiner(thickness=3e-3, youngs_modulus=5e8)},
        "modal bush": lambda L: {"bush": _bush(L)},
        "elastic journal": lambda L: {"journal": _journal(L)},
        "both": lambda L: {"bush": _bush(L), "journal": _journal(L)},
    },
    "pressure": {
        "none": {},
        "barus": {"pressure_law": ehd.BarusPressure(coefficient=1e-8)},
        "roelands": {"pressure_law": ehd.RoelandsPressure(coefficient=2e-8)},
    },
    "density": {"none": {}, "dowson": {"density_law": ehd.DowsonHigginson()}},
    "shear": {"none": {}, "carreau": {"shear_law": ehd.CarreauShear(relaxation_time=2e-6, exponent=0.8)}},
    "roughness": {"none": {}, "patir": {"roughness": ehd.PatirCheng(composite_roughness=4e-6, pattern=3.0)}},
    "contact": {
        "none": {},
        "wall": {"contact": ehd.RegularisedWall(onset=0.3 * CLEARANCE, pressure=1e7)},
        "asperity": {"asperity": ASPERITY},
        "wear": {"asperity": ASPERITY, "wear": ehd.ArchardWear(wear_rate=1e-13)},
    },
    "profile": {
        "none": {},
        "oval": {"profile": ehd.OutOfRound(order=2, amplitude=3e-6, phase=0.4)},
        "crown": lambda L: {"profile": (ehd.Crown(drop=5e-6), ehd.EdgeRelief(drop=4e-6, relief_length=0.3 * L))},
    },
    "turbulence": {
        "none": {},
        "hirs": {"turbulence": ehd.Hirs(onset=8.0, full=24.0, coefficient=2.0)},
        "ng pan": {"turbulence": ehd.NgPan(onset=8.0, full=24.0)},
    },
    "thermal": {
        "none": {},
        "lumped": {"thermal": ehd.LumpedThermal(**WARM, capacity=5.0, carry_over=0.8)},
        "energy": {"thermal": ehd.FilmEnergy(**WARM, bush_coefficient=2e4)},
        "walls": {"thermal": ehd.FilmEnergy(**WARM, **SIDES, conductivity=0.13, carry_over=0.8)},
        "across": {"thermal": ehd.FilmEnergy(**WARM, **SIDES, conductivity=0.13, across=2)},
    },
    "squeeze": {"on": {}, "off": {"squeeze": False}},
}
NAMES = tuple(FACTORS)


def bearing_of(row):
    """Return the bearing of a row.

    Parameters
    ----------
    row : dict
        Name of a level of every factor; factors left out have their first level.

    Returns
    -------
    JournalBearing

    Raises
    ------
    InputError
        For combinations that the package refuses.
    """
    length = FACTORS["length"][row.get("length", "1")]
    options, laws = {}, {}
    for factor in NAMES[1:]:
        levels = FACTORS[factor]
        level = levels[row.get(factor, next(iter(levels)))]
        for name, value in (level(length) if callable(level) else level).items():
            (laws if name.endswith("_law") else options)[name] = value
    if "thermal" in options:
        laws["temperature_law"] = ehd.ReynoldsTemperature(point=(320.0, 0.02), coefficient=0.03)
        laws["temperature"] = 320.0
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return ehd.JournalBearing(
            journal_radius=RADIUS,
            length=length,
            radial_clearance=CLEARANCE,
            lubricant=ehd.Lubricant(viscosity=0.02, **laws),
            **options,
        )


def model_of(row):
    """Return the model of a row's bearing."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return build.build_model(bearing_of(row))


def refusal(row):
    """Message with which the package refuses a row; empty if it takes it."""
    try:
        model_of(row)
    except ehd.EHDError as error:
        return f"{type(error).__name__}: {error}"
    return ""


def pairs_of(row):
    """Pairs of levels of two factors that a row has."""
    return {((a, row[a]), (b, row[b])) for a, b in itertools.combinations(NAMES, 2)}


def all_pairs():
    """All pairs of levels of two factors."""
    return {
        ((a, la), (b, lb))
        for a, b in itertools.combinations(NAMES, 2)
        for la, lb in itertools.product(FACTORS[a], FACTORS[b])
    }


def covering_array(rng, known=(), candidates=40):
    """Rows that cover every pair of levels that the package takes, and the refusals of those that it does not.

    ``known``: rows whose pairs need no other row.
    """
    plain = {name: next(iter(FACTORS[name])) for name in NAMES}
    levels = {name: list(FACTORS[name]) for name in NAMES}
    refused = {}
    todo = all_pairs()
    for pair in sorted(todo):
        if message := refusal(plain | dict(pair)):
            refused[pair] = message
    todo -= refused.keys() | set().union(*map(pairs_of, known))
    rows = []
    while todo:
        best, covered = None, set()
        pairs = sorted(todo)
        for _ in range(candidates):
            row = dict(pairs[rng.integers(len(pairs))])
            for name in rng.permutation([n for n in NAMES if n not in row]):
                choices = [str(x) for x in rng.permutation(levels[name])]
                free = [
                    c for c in choices if not any(_key(name, c, other, row[other]) in refused for other in row)
                ] or [plain[name]]
                row[name] = max(free, key=lambda c: sum(_key(name, c, o, row[o]) in todo for o in row))
            gain = pairs_of({n: row[n] for n in NAMES}) & todo
            if len(gain) > len(covered):
                best, covered = row, gain
        row = {name: best[name] for name in NAMES}
        # a triple may be refused though its pairs are not: back to the absence of effects one by one
        fixed = {name for pair in covered for name, _ in pair}
        for name in rng.permutation(list(NAMES)):
            if not refusal(row):
                break
            if len(covered) > 1 or name not in fixed:
                row[name] = plain[name]
        if refusal(row):
            row = plain | dict(sorted(covered)[0])
        rows.append(row)
        todo -= pairs_of(row)
    return rows, refused


def _key(a, la, b, lb):
    return ((a, la), (b, lb)) if NAMES.index(a) < NAMES.index(b) else ((b, lb), (a, la))


def random_row(rng):
    """Return a row that the package takes; each effect is absent in half of the rows."""
    while True:
        row = {}
        for name, levels in FACTORS.items():
            names = list(levels)
            always = name in ("length", "film", "closure", "supply")
            row[name] = names[0] if not always and rng.random() < 0.5 else names[rng.integers(len(names))]
        if not refusal(row):
            return row


def rows():
    """Rows of ``bearings.csv``: (whether it belongs to the covering array, row)."""
    with open(HERE / "bearings.csv", newline="", encoding="utf-8") as file:
        read = list(csv.DictReader(file))
    return [(row.pop("covers") == "1", row) for row in read]


def refused():
    """Messages of ``refused.csv`` by pair of levels."""
    with open(HERE / "refused.csv", newline="", encoding="utf-8") as file:
        return {((a, la), (b, lb)): message for a, la, b, lb, message in list(csv.reader(file))[1:]}


def main(count=0):
    """Write ``bearings.csv`` with ``count`` rows, and ``refused.csv``; 0: add rows for pairs that no row has yet."""
    # whether a bearing is taken does not hang on its kernels
    build.compile_kernels = lambda model: None
    rng = np.random.default_rng(41)
    known = [] if count else rows()
    array, refused = covering_array(rng, [row for covers, row in known if covers])
    drawn = [random_row(rng) for _ in range(max(count - len(array), 0))]
    with open(HERE / "bearings.csv", "w", newline="", encoding="utf-8") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["covers", *NAMES])
        all_rows = [*known, *((True, row) for row in array), *((False, row) for row in drawn)]
        table.writerows([f"{covers:d}", *row.values()] for covers, row in all_rows)
    with open(HERE / "refused.csv", "w", newline="", encoding="utf-8") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["factor", "level", "other factor", "level", "message"])
        table.writerows([*first, *second, message] for (first, second), message in sorted(refused.items()))
    print(f"{len(array)} bearings cover all pairs, {len(drawn)} are random, {len(refused)} pairs are refused")
