"""Texts and tables of the READMEs from the shipped tables.

Every number about speed in them stands between markers and comes from here:

<!-- effect factors -->
...
<!-- end -->
"""

from __future__ import annotations

import math
import pathlib
import re
from collections.abc import Callable, Iterable, Sequence

from exudyn_ehd.status import InputError
from exudyn_ehd.storage import replacing
from exudyn_ehd.tables import format_seconds
from tests.benchmarks.accuracy.costs import bushes, effects, growth, once
from tests.benchmarks.accuracy.report import pictures
from tests.benchmarks.accuracy.table import Cost, Row, read_table

CHEAPEST = (
    ("steady_500_film", "load"),
    ("steady_500_film", "stiffness"),
    ("steady_500_film", "damping"),
    ("steady_500_film", "critical mass"),
    ("steady_600_fed_film", "load"),
    ("steady_600_fed_film", "supply flow"),
    ("steady_600_fed_film", "stiffness"),
    ("steady_600_fed_film", "damping"),
    ("steady_600_fed_film", "critical mass"),
    ("steady_800_film", "load"),
    ("steady_800_film", "peak pressure"),
    ("steady_800_film", "stiffness"),
    ("steady_800_film", "damping"),
    ("steady_950_film", "load"),
    ("steady_800_tilted_film", "load"),
    ("orbit_film", "path"),
    ("steady_800_bush", "peak pressure"),
    ("steady_800_bush", "minimum film thickness"),
    ("orbit_integration", "path"),
    ("slider_pin_film", "minimum film thickness"),
    ("slider_pin_integration", "minimum film thickness"),
    ("whirl_film", "growth"),
    ("start_stop_film", "friction work"),
    ("big_end_bush", "peak pressure"),
)
STEPS_FAMILY = "generalised alpha, rho 0.8"
EFFECT_FACTORS, BUSH_COSTS, PAID_ONCE = "effect_factors", "bush_costs", "paid_once"
ROOT = pathlib.Path(__file__).parents[4]
# What `renew` fills, and the picture that goes with it.
READMES = [ROOT / "README.md", ROOT / "exudyn_ehd/solid/README.md", ROOT / "tests/benchmarks/accuracy/README.md"]
PICTURE = ROOT / "examples/pictures/accuracy_against_time.png"
PICTURED = ("steady_800_film", "load")


def table(headings: Sequence[str], lines: Iterable[Sequence[str]]) -> str:
    """A Markdown table."""
    out = ["| " + " | ".join(headings) + " |", "|" + "---|" * len(headings)]
    return "\n".join([*out, *("| " + " | ".join(line) + " |" for line in lines)])


def machine_of(notes: Sequence[str]) -> str:
    """Cores and clock from a table's notes."""
    found = re.search(r"\d+ cores[^,;]*", " ; ".join(notes))
    return found.group(0).strip() if found else "unnamed machine"


def _source(name: str, notes: Sequence[str], what: str) -> str:
    return f"*{what}; {machine_of(notes)}, one thread; `{name}.csv`.*"


def _percent(value: float) -> str:
    return f"{100.0 * value:.2g} %"


def _row(rows: Sequence[Row], setting: str, quantity: str) -> Row:
    for row in rows:
        if row.setting == setting and row.quantity == quantity:
            return row
    raise InputError(f"guide: {rows[0].study} has no row {setting!r} for {quantity!r}; measure it again.")


def paper_text(folder: pathlib.Path) -> str:
    """The paper's scheme next to film models of this package."""
    rows, notes = read_table(folder / "steady_800_film.csv", Row)
    (paper,) = (row for row in rows if "(paper)" in row.setting and row.quantity == "load")
    coarse, default, film_map = (_row(rows, name, "load") for name in ("2D 48 x 6", "2D 96 x 10", "map"))
    return (
        "The scheme of the paper that this package starts from (finite differences, SOR, Gümbel, tolerance 1e-5; "
        "its film grid is not printed, here one point per node of its bush) "
        f"takes {format_seconds(paper.seconds)} and misses the load by {_percent(paper.error)}, nearly all of it for "
        f"the closure: against a converged Gümbel film it is {_percent(paper.own_error)} off. "
        f"`FiniteLength(n_theta=48, n_z=6)` takes {format_seconds(coarse.seconds)} for {_percent(coarse.error)}, "
        f"the default grid {format_seconds(default.seconds)} for {_percent(default.error)}, "
        f"an `ImpedanceMap` {format_seconds(film_map.seconds)} for {_percent(film_map.error)} once it is tabulated "
        f"({machine_of(notes)}, one thread)."
    )


def numbers_text(folder: pathlib.Path) -> str:
    """Five key numbers as a list, for the start of the guide."""
    rows, notes = read_table(folder / "steady_800_film.csv", Row)
    coarse, default, film_map = (_row(rows, name, "load") for name in ("2D 48 x 6", "2D 96 x 10", "map"))
    (paper,) = (row for row in rows if "(paper)" in row.setting and row.quantity == "load")
    found, _ = growth.read_growths(folder / "growth.csv")
    (joints,) = (g for g in found if g.size_name == "joints")
    once_paid, _ = read_table(folder / f"{PAID_ONCE}.csv", Cost)
    first = once_paid[0]
    return "\n".join(
        [
            f"- The default film takes {format_seconds(default.seconds)} with its tangent; its load is "
            f"{_percent(default.error)} off the converged one.",
            f"- `FiniteLength(n_theta=48, n_z=6)` takes {format_seconds(coarse.seconds)} for {_percent(coarse.error)}, "
            f"an `ImpedanceMap` {format_seconds(film_map.seconds)} for {_percent(film_map.error)}.",
            f"- Finite differences with SOR and Gümbel's condition take {format_seconds(paper.seconds)} for "
            f"{_percent(paper.error)}.",
            f"- A step of one rotor on its film takes {format_seconds(joints.seconds[0])}, a step of "
            f"{joints.sizes[-1]:.0f} of them {format_seconds(joints.seconds[-1])}.",
            f"- The first film of a new installation takes {format_seconds(first.seconds)} by the clock. "
            f"(All else is processor time, {machine_of(notes)}, one thread.)",
        ]
    )


def cheapest_text(folder: pathlib.Path) -> str:
    """The cheapest setting within an error, by scene and quantity."""
    lines, last = [], ""
    for name, quantity in CHEAPEST:
        path = folder / f"{name}.csv"
        if path.exists():
            rows, notes = read_table(path, Row)
            for title, *rest in pictures.summary_rows([([r for r in rows if r.quantity == quantity], notes[0])]):
                lines.append(["" if title == last else title, *rest])
                last = title
    return table(pictures.HEADINGS, lines)


def _missed(row: Row) -> str:
    """A row's error, as far as its reference can tell."""
    return f"{'' if row.error > row.reference_error else 'below '}{_percent(max(row.error, row.reference_error))}"


def step_text(folder: pathlib.Path) -> str:
    """Table of the step errors that runs estimate, next to their true errors."""
    lines: list[list[str]] = []
    for name in ("orbit", "slider_pin", "big_end"):
        rows, notes = read_table(folder / f"{name}_integration.csv", Row)
        for row in (r for r in rows if r.family == STEPS_FAMILY and r.quantity == "film thickness"):
            told = _row(rows, row.setting, "step error")
            path = _row(rows, row.setting, "path")
            title = "" if lines and lines[-1][-1] == name else notes[0].split(":")[0]
            steps = row.setting.split()[0]
            told_and_missed = _percent(told.value), _missed(row), _missed(path)
            lines.append([title, steps, format_seconds(row.seconds), *told_and_missed, name])
    head = ["scene", "steps", "run", "the run tells", "film thickness", "path, over the clearance"]
    return table(head, [line[:-1] for line in lines])


def growth_text(folder: pathlib.Path) -> str:
    """Exponents of growth, and explicit against implicit integration."""
    found, notes = growth.read_growths(folder / "growth.csv")
    lines = []
    for g in found:
        first, last = (
            f"{n} {g.size_name}: {format_seconds(t)}"
            for n, t in ((g.sizes[0], g.seconds[0]), (g.sizes[-1], g.seconds[-1]))
        )
        lines.append([g.name, f"({g.size_name})^{g.exponent:.1f}", f"^{g.last_exponent:.1f}", first, last])
    head = ["cost of", "grows with", "between the two largest", "smallest", "largest"]
    text = table(head, lines) + "\n\n" + _source("growth", notes, "Processor time, exponents fitted over all sizes")
    rows, _ = read_table(folder / "orbit_integration.csv", Row)
    explicit = next(row for row in rows if row.family == "explicit Runge-Kutta" and row.quantity == "path")
    implicit = min(
        (r for r in rows if r.quantity == "path" and r.family == STEPS_FAMILY and r.error < 1e-3),
        key=lambda r: r.seconds,
    )
    return text + (
        "\n\nThe journal under a step load takes explicit Runge-Kutta, stable from "
        f"{explicit.setting.split()[1]} steps on, {format_seconds(explicit.seconds)}; "
        f"generalised alpha {format_seconds(implicit.seconds)} for {implicit.setting.split()[0]} steps "
        f"and {_percent(implicit.error)} of the clearance."
    )


def _factor(cost: Cost | None) -> str:
    if cost is None:
        return ""
    if cost.failure:
        return "failed"
    if math.isnan(cost.factor):
        return "1"
    digits = 3 if cost.factor < 0.1 else 2 if cost.factor < 10.0 else 0
    return f"{cost.factor:.{digits}f} ± {max(cost.factor_spread, 0.5 * 0.1**digits):.{digits}f}"


def effect_text(folder: pathlib.Path) -> str:
    """Factors of effects over the plain film, and of laws over the mass-conserving one."""
    costs, notes = read_table(folder / f"{EFFECT_FACTORS}.csv", Cost)
    by_name = {(cost.what, cost.per): cost for cost in costs}
    lines = []
    names = [n for n in dict.fromkeys(cost.what for cost in costs) if n not in effects.WITH_CONSERVING]
    for name in names:
        with_oil = f"{effects.CONSERVING}, {name}"
        places = [(n, per) for n in (name, with_oil) for per in (effects.EVALUATION, effects.STEP)]
        lines.append([name, *(_factor(by_name.get(place)) for place in places)])
    plain = by_name[effects.PLAIN, effects.EVALUATION]
    head = [
        "option",
        "evaluation",
        "accepted step",
        "evaluation, over `ElrodAdams`",
        "accepted step, over `ElrodAdams`",
    ]
    each = f"{format_seconds(plain.seconds)} per evaluation with exact tangent, grid 96 x 10"
    text = f"Time over that of the plain film ({each}), ± half the distance of the quartiles"
    return table(head, lines) + "\n\n" + _source(EFFECT_FACTORS, notes, text)


def bush_text(folder: pathlib.Path) -> str:
    """Steps on every bore."""
    costs, notes = read_table(folder / f"{BUSH_COSTS}.csv", Cost)
    jacobians = {cost.what: cost for cost in costs if cost.per == bushes.JACOBIAN}
    lines = []
    for cost in costs:
        if cost.per != bushes.STEP_TIME:
            continue
        if cost.failure:
            lines.append([cost.what, "failed", "", "", "", ""])
            continue
        modes = "" if math.isnan(cost.modes) else f"{cost.modes:.0f}"
        jacobian = format_seconds(jacobians[cost.what].seconds) if cost.what in jacobians else ""
        over = f"{_factor(cost)}" + (" (tilted)" if "tilted" in cost.base else "") if cost.base else ""
        lines.append([cost.what, modes, format_seconds(cost.seconds), over, f"{cost.iterations:.1f}", jacobian])
    head = ["bore", "modes", "per step", "over the rigid bore", "Newton / step", "film Jacobian"]
    return table(head, lines) + "\n\n" + _source(BUSH_COSTS, notes, "Processor time")


def assembly_text(folder: pathlib.Path) -> str:
    """Assembly of the bush's elements."""
    costs, notes = read_table(folder / f"{BUSH_COSTS}.csv", Cost)
    found = [c for c in costs if c.per == bushes.ASSEMBLY and not c.failure]
    times = " and ".join(f"{format_seconds(c.seconds)} ({c.what})" for c in found)
    return f"Force, tangent and sparse matrix take {times}; {machine_of(notes)}, one thread."


def once_text(folder: pathlib.Path) -> str:
    """Table of the costs paid once."""
    costs, notes = read_table(folder / f"{PAID_ONCE}.csv", Cost)
    lines = []
    for name in dict.fromkeys(cost.what for cost in costs):
        times = [c for per in (once.EMPTY, once.FULL) for c in costs if c.what == name and c.per == per]
        lines.append([name, *("failed" if c.failure else format_seconds(c.seconds) for c in times)])
    head = ["paid once", once.EMPTY, once.FULL]
    return table(head, lines) + "\n\n" + _source(PAID_ONCE, notes, "Processor time, where it does not say by the clock")


BLOCKS: dict[str, Callable[[pathlib.Path], str]] = {
    "five numbers": numbers_text,
    "paper against package": paper_text,
    "cheapest settings": cheapest_text,
    "step errors": step_text,
    "growth": growth_text,
    "effect factors": effect_text,
    "bush costs": bush_text,
    "assembly": assembly_text,
    "paid once": once_text,
}


def guide_texts(folder: pathlib.Path) -> dict[str, str]:
    """The text of every block from the tables of a folder."""
    return {name: make(folder) for name, make in BLOCKS.items()}


def renew(paths: Sequence[pathlib.Path], folder: pathlib.Path, picture: pathlib.Path) -> None:
    """Put the texts of the tables between the markers of Markdown files, and draw the picture that goes with them.

    Raises
    ------
    InputError
        If a marker is in none of the files or in several; the files stay as they are.
    """
    texts = {path: path.read_text(encoding="utf-8") for path in paths}
    for name, block in guide_texts(folder).items():
        marked = re.compile(rf"(<!-- {re.escape(name)} -->\n).*?(<!-- end -->)", re.DOTALL)
        places = [path for path, text in texts.items() if marked.search(text)]
        if len(places) != 1:
            raise InputError(
                f"--guide: one of {[*map(str, paths)]} must have the markers <!-- {name} --> and <!-- end -->."
            )
        new = marked.sub(lambda m, block=block: f"{m.group(1)}\n{block}\n\n{m.group(2)}", texts[places[0]])  # type: ignore[misc]
        texts[places[0]] = new
    for path, text in texts.items():
        with replacing(path) as file:
            file.write(text)
    name, quantity = PICTURED
    rows, notes = read_table(folder / f"{name}.csv", Row)
    shown = [row for row in rows if row.quantity == quantity]
    pictures.save(pictures.work_precision(shown, notes[0], pictures.unit_of(notes)), picture)
