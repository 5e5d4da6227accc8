"""Tables of named columns: as text in engineers' units, as CSV in SI; units of the names that the package uses."""

from __future__ import annotations

import csv
import html
import pathlib
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from exudyn_ehd.status import InputError
from exudyn_ehd.storage import replacing, require_path

if TYPE_CHECKING:
    from pandas import DataFrame

# SI units by name; a name of several words may end in one of these.
UNITS = {
    "time": "s",
    "start": "s",
    "end": "s",
    "seconds": "s",
    "journal_radius": "m",
    "length": "m",
    "radial_clearance": "m",
    "viscosity": "Pa s",
    "speed": "rad/s",
    "load": "N",
    "eccentricity_ratio": "-",
    "attitude_angle": "rad",
    "minimum_gap": "m",
    "bore_displacement": "m",
    "minimum_gap_z": "m",
    "minimum_gap_angle": "rad",
    "peak_pressure": "Pa",
    "peak_angle": "rad",
    "friction_torque": "N m",
    "contact_torque": "N m",
    "power_loss": "W",
    "stored_power": "W",
    "step_error": "-",
    "leakage": "m3/s",
    "supply_flow": "m3/s",
    "lowest_pocket_pressure": "Pa",
    "highest_pocket_pressure": "Pa",
    "contact_load": "N",
    "axial_position": "m",
    "thrust_force": "N",
    "thrust_minimum_gap": "m",
    "thrust_peak_pressure": "Pa",
    "thrust_torque": "N m",
    "thrust_power_loss": "W",
    "thrust_contact_load": "N",
    "wear_depth": "m",
    "worn_volume": "m3",
    "film_temperature": "K",
    "sump_temperature": "K",
    "peak_temperature": "K",
    "bush_temperature": "K",
    "journal_temperature": "K",
    "clearance": "m",
    "sommerfeld_number": "-",
    "whirl_ratio": "-",
    "critical_mass": "kg",
    "force_x": "N",
    "force_y": "N",
    "force_z": "N",
    "moment_x": "N m",
    "moment_y": "N m",
    "moment_z": "N m",
}
# Engineers' units of printed tables with the factor from SI, by SI unit, and by name for lengths far larger than a film
# is thick. Other units are printed in SI.
PRINTED = {
    "m": ("um", 1e6),
    "Pa": ("MPa", 1e-6),
    "m3/s": ("l/min", 6e4),
    "rad": ("deg", 180.0 / np.pi),
    **dict.fromkeys(("journal_radius", "length", "minimum_gap_z", "axial_position"), ("mm", 1e3)),
}


def unit_of(name: str, more: Mapping[str, str] | None = None) -> str | None:
    """SI unit of a column's name, None if it is not known; ``more`` comes first."""
    if more and name in more:
        return more[name]
    if name.endswith("_time"):
        return "s"
    for prefix in ("mean_", "largest_", "smallest_"):
        name = name.removeprefix(prefix)
    return UNITS.get(name)


def printed(
    columns: Mapping[str, np.ndarray], more: Mapping[str, str] | None = None
) -> tuple[dict[str, np.ndarray], dict[str, str]]:
    """Columns (n,) in SI units as they are printed, in engineers' units, and these units by name."""
    known = {name: unit for name in columns if (unit := unit_of(name, more)) is not None}
    units = {name: PRINTED.get(name, PRINTED.get(unit, (unit, 1.0))) for name, unit in known.items()}
    scaled = {name: units.get(name, ("", 1.0))[1] * np.asarray(values) for name, values in columns.items()}
    return scaled, {name: unit for name, (unit, _) in units.items()}


def format_seconds(value: float) -> str:
    """Time with a unit, three digits."""
    for unit, size in (("s", 1.0), ("ms", 1e-3), ("us", 1e-6)):
        if value >= size:
            return f"{value / size:.3g} {unit}"
    return f"{value * 1e9:.3g} ns"


def rows_of(
    columns: Mapping[str, np.ndarray],
    write: Callable[[float], str],
    more: Mapping[str, str] | None = None,
    remarks: Mapping[str, Sequence[str]] | None = None,
) -> Iterator[list[str]]:
    """Yield heads with units, then a row of texts per line of columns (n,): numbers by ``write``, and the remarks."""
    remarks = remarks or {}
    units = {name: unit_of(name, more) for name in columns}
    yield [*(name if unit is None else f"{name} [{unit}]" for name, unit in units.items()), *remarks]
    for k, row in enumerate(zip(*columns.values(), strict=True)):
        yield [*(write(value) for value in row), *(texts[k] for texts in remarks.values())]


def html_table(rows: Sequence[Sequence[str]]) -> str:
    """Rows of texts, the first of them heads, as HTML for notebooks."""
    lines = []
    for k, row in enumerate(rows):
        tag = "th" if k == 0 else "td"
        lines.append("<tr>" + "".join(f"<{tag}>{html.escape(text)}</{tag}>" for text in row) + "</tr>")
    return "<table>" + "\n".join(lines) + "</table>"


def data_frame(columns: Mapping[str, object]) -> DataFrame:
    """Columns (n,) as a pandas DataFrame, SI units.

    Raises
    ------
    InputError
        Without pandas.
    """
    try:
        # imported here: nothing else needs it
        import pandas
    except ImportError:
        raise InputError(
            "to_dataframe needs the package pandas: pip install pandas; to_csv writes the same table without it."
        ) from None
    return pandas.DataFrame(columns)


class Table:
    """Named columns (n,) of numbers in SI units, as are CSV and data frame; print and notebooks show um, MPa, l/min."""

    def to_csv(self, path: str | pathlib.Path) -> None:
        """Write the table in SI units: a header of names with units, a row per line, remarks last.

        Parameters
        ----------
        path : path
        """
        write_csv(path, self._columns(), more=self._units(), remarks=self._remarks())

    def to_dataframe(self) -> DataFrame:
        """The table as a pandas DataFrame; needs pandas.

        Returns
        -------
        pandas DataFrame
            SI units, remarks in columns of their own.
        """
        return data_frame({**self._columns(), **self._remarks()})

    def __str__(self) -> str:
        count, (head, *rows) = len(self._columns()), self._rows()
        widths = [max(len(row[i]) for row in [head, *rows]) for i in range(count)]
        texts = [[text.rjust(w) for text, w in zip(row, widths, strict=False)] for row in [head, *rows]]
        remarks = [[], *(row[count:] for row in rows)]
        return "\n".join("  ".join(row + more).rstrip() for row, more in zip(texts, remarks, strict=True))

    def _repr_html_(self) -> str:
        return html_table(self._rows())

    def _rows(self) -> list[list[str]]:
        columns, units = printed(self._columns(), self._units())
        return list(rows_of(columns, "{:.5g}".format, units, self._remarks()))

    def _columns(self) -> dict[str, np.ndarray]:
        raise NotImplementedError

    def _units(self) -> Mapping[str, str]:
        return {}

    def _remarks(self) -> Mapping[str, Sequence[str]]:
        return {}


def write_csv(
    path: str | pathlib.Path,
    columns: Mapping[str, np.ndarray],
    *,
    more: Mapping[str, str] | None = None,
    remarks: Mapping[str, Sequence[str]] | None = None,
) -> None:
    """Write columns (n,) as CSV under heads with units.

    Numbers read back bit for bit; ``remarks`` are columns of text at the end.
    """
    require_path("to_csv", path)
    with replacing(path) as file:
        csv.writer(file).writerows(rows_of(columns, lambda value: repr(float(value)), more, remarks))
