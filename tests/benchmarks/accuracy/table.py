"""Tables of the bench: rows of errors and times, rows of costs; as text and as CSV.

Times of a shared machine differ from minute to minute by more than most effects cost. A factor is therefore that of
times from one block of runs, in which everything runs in turns; the table keeps the median over the blocks and the
quartiles as spread.
"""

from __future__ import annotations

import csv
import dataclasses
import math
import pathlib
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, TypeVar

import numpy as np

from exudyn_ehd.status import InputError
from exudyn_ehd.storage import replacing
from exudyn_ehd.tables import format_seconds

DATA = pathlib.Path(__file__).parent / "data"
_NONE = math.nan


@dataclasses.dataclass(frozen=True, kw_only=True)
class Row:
    """One setting and one quantity; errors are relative to the quantity's scale, times in s of processor time.

    Attributes
    ----------
    study, setting, family, model, quantity, unit : str
    value : float
        The largest absolute value where the quantity is an array.
    error : float
        Against the study's reference: error of the model and of its discretisation together.
    reference : str
        Model of that reference.
    reference_error : float
        Estimated error of that reference.
    own_error, own_reference_error : float
        Error of the discretisation alone, against the converged solution of the setting's own model, and that
        solution's own error; nan where the study has none.
    seconds, low, high : float
        Median and quartiles of the time; nan if it was not measured.
    setup, compile : float
        Building (modes, maps) once, with kernels loaded; the first run's surplus (compilation, or loading kernels).
    newton, films : float
        As in `Outcome`.
    failure : str
        What went wrong, else empty; the numbers are nan then.
    """

    study: str
    setting: str
    family: str
    model: str
    quantity: str
    unit: str
    value: float = _NONE
    error: float = _NONE
    reference: str = ""
    reference_error: float = _NONE
    own_error: float = _NONE
    own_reference_error: float = _NONE
    seconds: float = _NONE
    low: float = _NONE
    high: float = _NONE
    setup: float = _NONE
    compile: float = _NONE
    newton: float = _NONE
    films: float = _NONE
    failure: str = ""

    @property
    def timed(self) -> bool:
        """True if there is a time and an error."""
        return math.isfinite(self.seconds) and math.isfinite(self.error)

    @property
    def spread(self) -> float:
        """Half the distance between the quartiles of the time."""
        return 0.5 * (self.high - self.low)


@dataclasses.dataclass(frozen=True, kw_only=True)
class Cost:
    """Cost of one option or call.

    Attributes
    ----------
    what : str
        As a user writes or calls it.
    per : str
        What the time is the time of.
    base : str
        ``what`` of the row that ``factor`` is over, of the same ``per``; empty: no factor.
    seconds, low, high : float
        Median and quartiles of the time over the blocks, s.
    factor, factor_low, factor_high : float
        The same of the time over that of ``base`` in the same block.
    iterations, modes : float
        Newton iterations per step; modes of a bush; nan where there are none.
    failure : str
        What went wrong, else empty; the numbers are nan then.
    """

    what: str
    per: str
    base: str = ""
    seconds: float = _NONE
    low: float = _NONE
    high: float = _NONE
    factor: float = _NONE
    factor_low: float = _NONE
    factor_high: float = _NONE
    iterations: float = _NONE
    modes: float = _NONE
    failure: str = ""

    @property
    def spread(self) -> float:
        """Half the distance between the quartiles of the time."""
        return 0.5 * (self.high - self.low)

    @property
    def factor_spread(self) -> float:
        """Half the distance between the quartiles of the factor."""
        return 0.5 * (self.factor_high - self.factor_low)


Kind = TypeVar("Kind", Row, Cost)
# Significant digits in files: six of a row read back as they were written, costs scatter more.
DIGITS = {Row: 6, Cost: 4}


def _text_fields(kind: type[Row] | type[Cost]) -> set[str]:
    return {f.name for f in dataclasses.fields(kind) if f.type == "str"}


def write_table(path: pathlib.Path, kind: type[Kind], rows: Iterable[Kind], notes: Iterable[str] = ()) -> None:
    """Write rows of one kind as CSV with notes as leading lines ``# ...``; the file is replaced as a whole or not."""
    names, texts, digits = [f.name for f in dataclasses.fields(kind)], _text_fields(kind), DIGITS[kind]
    lines: list[list[str]] = [names]
    for row in rows:
        values = dataclasses.asdict(row)
        lines.append([values[n] if n in texts else number_text(values[n], digits) for n in names])
    write_rows(path, lines, notes)


def write_rows(path: str | pathlib.Path, rows: Iterable[Sequence[object]], notes: Iterable[str] = ()) -> None:
    """Write rows, the first of them heads, as CSV; ``notes`` stand above them as lines ``# ...``."""
    with replacing(path) as file:
        file.writelines(f"# {note}\n" for note in notes)
        csv.writer(file, lineterminator="\n").writerows(rows)


def read_rows(path: str | pathlib.Path, head: Sequence[str]) -> tuple[list[dict[str, str]], list[str]]:
    """Rows by head, and the notes, of a file of `write_rows`.

    Raises
    ------
    InputError
        If the file has other columns than ``head``.
    """
    lines = pathlib.Path(path).read_text(encoding="utf-8").splitlines()
    reader = csv.DictReader(line for line in lines if not line.startswith("# "))
    if list(reader.fieldnames or ()) != list(head):
        raise InputError(f"{path} must have the columns {list(head)}, got {reader.fieldnames}.")
    return list(reader), [line.removeprefix("# ") for line in lines if line.startswith("# ")]


def number_text(value: float, digits: int) -> str:
    """Significant digits; empty for nan."""
    return "" if math.isnan(value) else f"{value:.{digits}g}"


def read_table(path: pathlib.Path, kind: type[Kind]) -> tuple[list[Kind], list[str]]:
    """Rows and notes of a file of `write_table`."""
    records, notes = read_rows(path, [f.name for f in dataclasses.fields(kind)])
    texts = _text_fields(kind)
    rows = []
    for record in records:
        values: dict[str, Any] = {n: v if n in texts else float(v or _NONE) for n, v in record.items()}
        rows.append(kind(**values))
    return rows, notes


def costs_of_blocks(
    per: str, blocks: Mapping[str, Sequence[float]], bases: Mapping[str, str], **more: Mapping[str, float]
) -> list[Cost]:
    """Rows of times by block.

    Parameters
    ----------
    per : str
    blocks : mapping
        Times by name, one per block, s.
    bases : mapping
        Name of the base by name; names that are missing here have none.
    more : mappings
        Further fields of `Cost` by name.
    """
    out = []
    for name, times in blocks.items():
        low, median, high = np.quantile(times, (0.25, 0.5, 0.75)).tolist()
        values = {"seconds": median, "low": low, "high": high}
        base = bases.get(name, "") if bases.get(name, "") in blocks else ""
        if base:
            factors = np.divide(times, blocks[base])
            low, median, high = np.quantile(factors, (0.25, 0.5, 0.75)).tolist()
            values |= {"factor": median, "factor_low": low, "factor_high": high}
        values |= {field: known[name] for field, known in more.items() if name in known}
        out.append(Cost(what=name, per=per, base=base, **values))
    return out


def format_rows(rows: Iterable[Row]) -> str:
    """Table for people, one block per quantity."""
    blocks: dict[str, list[Row]] = {}
    for row in rows:
        blocks.setdefault(row.quantity, []).append(row)
    out = []
    for quantity, block in blocks.items():
        reference = next((r for r in block if not r.failure), block[0])
        own = f"itself good to {_percent(reference.reference_error)}"
        out.append(f"{reference.study}: {quantity}; error against {reference.reference}, {own}")
        out.append(
            f"  {'setting':34s}{'family':26s}{'value':>11s}{'error':>10s}{'own error':>11s}"
            f"{'time':>11s}{'spread':>8s}{'newton':>8s}{'films':>7s}"
        )
        for row in block:
            start = f"  {row.setting:34s}{row.family:26s}"
            if row.failure:
                out.append(start + " " + row.failure)
                continue
            time, spread = "-", "-"
            if row.timed:
                time, spread = format_seconds(row.seconds), f"{row.spread / row.seconds:.0%}"
            out.append(
                f"{start}{row.value:11.4g}{_percent(row.error):>10s}{_percent(row.own_error):>11s}{time:>11s}{spread:>8s}"
                f"{row.newton:8.2f}{row.films:7.2f}"
            )
        out.append("")
    return "\n".join(out)


def _percent(value: float) -> str:
    return "-" if math.isnan(value) else f"{100.0 * value:.2g} %"


def format_costs(costs: Iterable[Cost]) -> str:
    """Table for people."""
    out = [f"  {'':48s}{'per':26s}{'time':>10s}{'spread':>8s}{'factor':>9s}{'spread':>8s}{'over':>4s}"]
    for c in costs:
        start = f"  {c.what:48s}{c.per:26s}"
        if c.failure:
            out.append(start + c.failure)
            continue
        factor = "" if math.isnan(c.factor) else f"{c.factor:9.3f}{c.factor_spread:8.3f}    {c.base}"
        out.append(f"{start}{format_seconds(c.seconds):>10s}{c.spread / c.seconds:8.1%}{factor}")
    return "\n".join(out)
