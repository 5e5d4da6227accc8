"""The table of a study: one row per setting and quantity, as text and as CSV."""

from __future__ import annotations

import csv
import dataclasses
import io
import math
import os
import pathlib
import tempfile
from collections.abc import Iterable

from exudyn_ehd.status import InputError

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
        Error of the discretisation alone, against the converged solution of the setting's own model, and that solution's own
        error; nan where the study has none.
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
        """Whether there is a time and an error."""
        return math.isfinite(self.seconds) and math.isfinite(self.error)

    @property
    def spread(self) -> float:
        """Half the distance between the quartiles of the time."""
        return 0.5 * (self.high - self.low)


FIELDS = [f.name for f in dataclasses.fields(Row)]
_TEXT = {f.name for f in dataclasses.fields(Row) if f.type == "str"}


def write_rows(path: str | os.PathLike[str], rows: Iterable[Row], notes: Iterable[str] = ()) -> None:
    """Write rows as CSV with notes as leading lines ``# ...``; the file is replaced as a whole or not at all.

    Numbers keep six significant digits.
    """
    text = io.StringIO()
    for note in notes:
        text.write(f"# {note}\n")
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(FIELDS)
    for row in rows:
        values = dataclasses.asdict(row)
        writer.writerow([values[n] if n in _TEXT else _number(values[n]) for n in FIELDS])
    write_atomic(path, text.getvalue())


def write_atomic(path: str | os.PathLike[str], text: str) -> None:
    """Write a text file through a temporary file beside it, so that a reader never meets half of it."""
    target = pathlib.Path(path)
    target.parent.mkdir(parents=True, exist_ok=True)
    handle, name = tempfile.mkstemp(dir=target.parent, prefix=target.name, suffix=".part")
    try:
        with os.fdopen(handle, "w", encoding="utf-8") as file:
            file.write(text)
        os.chmod(name, 0o644)
        os.replace(name, target)
    except BaseException:
        pathlib.Path(name).unlink(missing_ok=True)
        raise


def _number(value: float) -> str:
    return "" if math.isnan(value) else f"{value:.6g}"


def read_rows(path: str | os.PathLike[str]) -> tuple[list[Row], list[str]]:
    """Rows and notes of a file of `write_rows`.

    Raises
    ------
    InputError
        If the file has other columns.
    """
    lines = pathlib.Path(path).read_text(encoding="utf-8").splitlines()
    notes = [line[2:] for line in lines if line.startswith("# ")]
    reader = csv.DictReader(line for line in lines if not line.startswith("# "))
    if reader.fieldnames != FIELDS:
        raise InputError(f"read_rows: {path} must have the columns {FIELDS}, got {reader.fieldnames}.")
    rows = []
    for record in reader:
        values = {n: v if n in _TEXT else (float(v) if v else _NONE) for n, v in record.items()}
        rows.append(Row(**values))  # type: ignore[arg-type]
    return rows, notes


def format_rows(rows: Iterable[Row]) -> str:
    """Table for people, one block per quantity."""
    blocks: dict[str, list[Row]] = {}
    for row in rows:
        blocks.setdefault(row.quantity, []).append(row)
    out = []
    for quantity, block in blocks.items():
        reference = next((r for r in block if not r.failure), block[0])
        out.append(
            f"{reference.study}: {quantity}; error against {reference.reference}, itself good to {_percent(reference.reference_error)}"
        )
        out.append(
            f"  {'setting':34s}{'family':26s}{'value':>11s}{'error':>10s}{'own error':>11s}{'time':>11s}{'spread':>8s}{'newton':>8s}{'films':>7s}"
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


def format_seconds(value: float) -> str:
    """Time with a unit."""
    for unit, size in (("s", 1.0), ("ms", 1e-3), ("us", 1e-6)):
        if value >= size:
            return f"{value / size:.3g} {unit}"
    return f"{value * 1e9:.3g} ns"


def _percent(value: float) -> str:
    return "-" if math.isnan(value) else f"{100.0 * value:.2g} %"
