"""Tables of what options cost: processor times, and factors over a base that is measured in turns with them.

Times of a shared machine differ from minute to minute by more than most effects cost. A factor is therefore that of times from one
block of runs, in which everything runs in turns; the table keeps the median over the blocks and the quartiles as spread.
"""

from __future__ import annotations

import csv
import dataclasses
import io
import math
import pathlib
from collections.abc import Iterable, Mapping, Sequence

import numpy as np

from exudyn_ehd.status import InputError
from exudyn_ehd.studies.table import format_seconds, write_atomic

_NONE = math.nan


@dataclasses.dataclass(frozen=True, kw_only=True)
class Cost:
    """What one thing costs.

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


FIELDS = [f.name for f in dataclasses.fields(Cost)]
_TEXT = {f.name for f in dataclasses.fields(Cost) if f.type == "str"}


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


def write_costs(path: pathlib.Path, costs: Iterable[Cost], notes: Iterable[str]) -> None:
    """CSV with notes as leading lines ``# ...``; four significant digits."""
    text = io.StringIO()
    for note in notes:
        text.write(f"# {note}\n")
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(FIELDS)
    for cost in costs:
        values = dataclasses.asdict(cost)
        writer.writerow(
            [v if n in _TEXT else "" if math.isnan(v) else f"{v:.4g}" for n, v in ((n, values[n]) for n in FIELDS)]
        )
    write_atomic(path, text.getvalue())


def read_costs(path: pathlib.Path) -> tuple[list[Cost], list[str]]:
    """Rows and notes of a file of `write_costs`.

    Raises
    ------
    InputError
        If the file has other columns.
    """
    lines = path.read_text(encoding="utf-8").splitlines()
    notes = [line[2:] for line in lines if line.startswith("# ")]
    reader = csv.DictReader(line for line in lines if not line.startswith("# "))
    if reader.fieldnames != FIELDS:
        raise InputError(f"read_costs: {path} must have the columns {FIELDS}, got {reader.fieldnames}.")
    rows = []
    for record in reader:
        values = {n: v if n in _TEXT else (float(v) if v else _NONE) for n, v in record.items()}
        rows.append(Cost(**values))  # type: ignore[arg-type]
    return rows, notes


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
