"""Studies over parameters: in this process, in several, by an executor; rows kept on disk.

=============  ==========================================  =============================================================
where          call                                        start
=============  ==========================================  =============================================================
this process   ``parameter_study(f, parameters)``          ``python study.py``
processes      ``..., processes=4``                        ``python study.py``; under ``if __name__ == "__main__":``
executor       ``..., executor=pool``                      any executor of processes that follows `concurrent.futures`,
                                                           as those of loky, ipyparallel, mpi4py.futures (MPI:
                                                           ``mpiexec -n 5 python -m mpi4py.futures study.py``), and
                                                           ``Client(...).get_executor()`` of dask (clusters)
=============  ==========================================  =============================================================

Set the environment variable ``OMP_NUM_THREADS=1`` for more than one process: every worker has its own linear algebra.
"""

from __future__ import annotations

import dataclasses
import itertools
import math
import numbers
import pathlib
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from typing import Any

import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.joint.static.equilibrium import equilibrium
from exudyn_ehd.pictures.records import Axes, Figure, Target
from exudyn_ehd.progress import is_shown
from exudyn_ehd.status import EHDError, InputError, did_you_mean, require_integer, require_number
from exudyn_ehd.studies.rows import WHERE, Row, RowFile, require_executor, rows_of
from exudyn_ehd.tables import Table


@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
class StudyTable(Table):
    """Results of a study, one row per combination of the parameters; the last parameter changes fastest.

    ``table["minimum_gap"]`` is a column, ``len(table)`` the number of rows, ``print(table)`` shows it.

    Attributes
    ----------
    columns : dict of (n,) arrays
        {name: column} of parameters, results and ``seconds`` (wall time of the row); nan where a row failed.
    parameters : tuple of str
        Names of the columns that are parameters.
    shape : tuple of int
        Number of values of every parameter.
    errors : tuple of str
        One text per row: why it failed, empty if it did not.
    units : dict
        {name: unit} of the columns whose unit was given to `parameter_study`.

    Examples
    --------
    After the example of `parameter_study`:

    >>> len(table), table.shape, table.parameters
    (4, (2, 2), ('length', 'speed'))
    >>> table.grid("power_loss").round(1)  # W, over length and speed
    array([[ 86.7, 301.9],
           [107.1, 395.8]])
    """

    columns: dict[str, np.ndarray]
    parameters: tuple[str, ...]
    shape: tuple[int, ...]
    errors: tuple[str, ...]
    units: dict[str, str]

    def __getitem__(self, name: str) -> np.ndarray:
        if name not in self.columns:
            raise KeyError(f"StudyTable has no column {name!r}; it has {', '.join(self.columns)}.")
        return self.columns[name]

    def __len__(self) -> int:
        return len(self.errors)

    def grid(self, name: str) -> np.ndarray:
        """A column as an array over the parameters, for contour plots and the like.

        Parameters
        ----------
        name : str
            Of the column.

        Returns
        -------
        ndarray
            One dimension for each parameter, in their order; SI units.

        Raises
        ------
        KeyError
            For a column that the table does not have.
        """
        return self[name].reshape(self.shape)

    def plot(self, name: str, *, along: str = "", ax: Axes | None = None, path: Target = None) -> Figure:
        """Draw a column over one parameter, with a curve for every combination of the others.

        Parameters
        ----------
        name : str
            Of the column.
        along : str, default ""
            The parameter; by default the first one.
        ax : matplotlib Axes or None, default None
            Where to draw; by default a new figure, which ``plt.show()`` shows.
        path : path or None, default None
            Where to write the figure.

        Returns
        -------
        matplotlib Figure

        Raises
        ------
        InputError
            For names that the study does not have, or more than ten curves.
        """
        from exudyn_ehd.pictures.curves import column, plot_curves

        along = along or self.parameters[0]
        if name not in self.columns or along not in self.parameters:
            raise InputError(
                f"StudyTable.plot: name must be one of {', '.join(self.columns)}, and along one of "
                f"{', '.join(self.parameters)}; got {name!r} and {along!r}."
            )
        axis = self.parameters.index(along)
        x, y = (np.moveaxis(self.grid(column), axis, -1).reshape(-1, self.shape[axis]) for column in (along, name))
        others = [other for other in self.parameters if other != along]
        if len(x) > 10:
            raise InputError(
                f"StudyTable.plot: {len(x)} curves, one for every combination of {', '.join(others)}, at most 10; "
                "draw table.grid(name) as contours, or a study of fewer values."
            )
        places = [np.moveaxis(self.grid(other), axis, -1).reshape(len(x), -1)[:, 0] for other in others]
        shown = [(*column(other, place, self.units), place) for other, place in zip(others, places, strict=True)]
        texts = [
            ", ".join(
                f"{text} = {float(unit(place[k])):.4g} {unit.symbol}".removesuffix(" -").rstrip()
                for text, unit, place in shown
            )
            for k in range(len(x))
        ]
        return plot_curves(list(zip(texts, x, y, strict=True)), (along, name), self.units, ax=ax, path=path)

    def _columns(self) -> dict[str, np.ndarray]:
        return self.columns

    def _units(self) -> Mapping[str, str]:
        return self.units

    def _remarks(self) -> Mapping[str, Sequence[str]]:
        return {"error": self.errors}

    def __repr__(self) -> str:
        names, failed = ", ".join(self.parameters), sum(map(bool, self.errors))
        return f"<StudyTable over {names}: {len(self)} rows, {failed} failed; print it for a table>"


@dataclasses.dataclass(frozen=True, kw_only=True)
class EquilibriumPoint:
    """A function for `parameter_study`: equilibrium of a bearing under a load, with parameters replaced by name.

    Names that the study may vary: the bearing's ``journal_radius``, ``length``, ``radial_clearance`` (m);
    ``viscosity`` of its lubricant (Pa s); ``speed`` (rad/s); ``load`` (its size, N, at least 0; the direction stays,
    and is -y for a load of 0).

    Parameters
    ----------
    bearing : JournalBearing
    speed : float
        Spin of the journal against the housing, rad/s.
    load : (float, float)
        External force (x, y) on the journal, joint frame, N.

    Examples
    --------
    After the example of `JournalBearing`:

    >>> point = ehd.EquilibriumPoint(bearing=bearing, speed=314.0, load=(0.0, -2000.0))
    >>> round(1e6 * point({"radial_clearance": 30e-6})["minimum_gap"], 2)  # um
    13.92
    """

    bearing: JournalBearing
    speed: float
    load: tuple[float, float]

    def __call__(self, parameters: Mapping[str, float]) -> dict[str, float]:
        """Figures of the equilibrium, SI units."""
        own = dict(parameters)
        speed, load = own.pop("speed", self.speed), np.array(self.load)
        if "load" in own:
            size = require_number("EquilibriumPoint: load", own.pop("load"), "N", at_least=0.0)
            # a load without a direction acts along -y
            load = np.array([0.0, -size]) if not load.any() else load / np.hypot(*load) * size
        bearing = varied(self.bearing, own)
        eq = equilibrium(bearing, speed=speed, load=(float(load[0]), float(load[1])))
        names = ("minimum_gap", "peak_pressure", "friction_torque", "power_loss", "leakage", "sommerfeld_number")
        return {
            "eccentricity_ratio": eq.eccentricity_ratio,
            "attitude_angle": eq.attitude_angle,
            **{name: float(getattr(eq.film, name)) for name in names},
            "whirl_ratio": eq.whirl_ratio,
            "critical_mass": eq.critical_mass,
            "critical_mass_error": eq.critical_mass_error,
        }


def varied(bearing: JournalBearing, parameters: Mapping[str, float]) -> JournalBearing:
    """Return a bearing with dimensions and ``viscosity`` (of its lubricant) replaced by name.

    Parameters
    ----------
    bearing : JournalBearing
    parameters : dict
        ``journal_radius``, ``length``, ``radial_clearance`` (m), ``viscosity`` (Pa s), or some of them.

    Returns
    -------
    JournalBearing
        A new one.

    Raises
    ------
    InputError
        For names that it does not have.

    Examples
    --------
    After the example of `JournalBearing`:

    >>> ehd.varied(bearing, {"radial_clearance": 30e-6}).radial_clearance
    3e-05
    """
    values: dict[str, Any] = dict(parameters)
    known = ("journal_radius", "length", "radial_clearance", "viscosity")
    if unknown := sorted(set(values) - set(known)):
        raise InputError(
            f"varied: parameters must be among {', '.join(known)} (of an EquilibriumPoint also speed, load), got "
            f"{', '.join(unknown)}; "
            + (f"did you mean {meant}? For others " if (meant := did_you_mean(unknown[0], known)) else "")
            + "write a function of your own."
        )
    if "viscosity" in values:
        lubricant = dataclasses.replace(bearing.lubricant, viscosity=values.pop("viscosity"))
        bearing = dataclasses.replace(bearing, lubricant=lubricant)
    return dataclasses.replace(bearing, **values)


def parameter_study(
    function: Callable[[dict[str, Any]], Any],
    parameters: Mapping[str, Sequence[float]],
    *,
    processes: int = 1,
    executor: Executor | None = None,
    file: str | pathlib.Path | None = None,
    units: Mapping[str, str] | None = None,
    show_progress: bool | None = None,
    mpi: bool = False,
    hosts: Sequence[str] = (),
) -> StudyTable:
    """Evaluate a function at every combination of parameters, in one or many processes.

    Parameters
    ----------
    function : callable
        Takes a dict {name: number} of one combination and returns a number or a dict {name: number} of results. It
        builds its own model. To run in other processes it must be importable: a function, or an instance of a class,
        that is defined at the top of a module.
    parameters : dict
        {name: sequence of numbers}, SI units.
    processes : int, default 1
        Number of processes on this machine.
    executor : Executor or None, default None
        An executor of processes, from `concurrent.futures` or with its interface, in place of ``processes``; it stays
        open.
    mpi, hosts : not supported any more, default False, ()
        An `InputError` names the executor that takes their place.
    file : path or None, default None
        File for finished rows, each written at once. A second call reads them and computes the rest: interrupted,
        failed and added rows. It raises `InputError` if the function or what it holds, such as its bearing, has
        changed. It does not notice a change of other functions that it calls: delete the file then.
    units : dict or None, default None
        {name: unit} of parameters and results, for print and CSV; common names have one already.
    show_progress : bool or None, default None
        True prints a line for every finished row; None: on a terminal and in notebooks (`show_progress`).

    Returns
    -------
    StudyTable
        A row that fails does not end the study: it holds nan, and ``errors`` says why. If a process dies, the rows that
        its executor has not finished fail too; with ``file`` the next call computes them.

    Raises
    ------
    InputError
        For parameters that are no lists of numbers, functions that can't be sent to other processes, ``processes``
        together with an executor, executors of threads, files of another function.
    EHDError
        If every row failed.

    Examples
    --------
    After the example of `EquilibriumPoint`:

    >>> table = ehd.parameter_study(point, {"length": [0.02, 0.03], "speed": [200.0, 400.0]}, show_progress=False)
    >>> (1e6 * table["minimum_gap"]).round(2)
    array([ 8.3 , 11.6 , 13.88, 17.91])
    """
    lists = _checked_parameters(parameters)
    told = is_shown() if show_progress is None else show_progress
    _require_place(processes, executor, mpi, hosts)
    points = [dict(zip(lists, values, strict=True)) for values in itertools.product(*lists.values())]
    kept = None if file is None else RowFile(file, function)
    stored = [None if kept is None else kept.find(point) for point in points]
    rows = {index: row for index, row in enumerate(stored) if row is not None}
    left = {index: point for index, point in enumerate(points) if index not in rows}
    if told and rows:
        print(f"{len(rows)} of {len(points)} rows are taken from {file}", flush=True)
    for index, row in rows_of(function, left, processes, executor) if left else ():
        rows[index] = row
        if kept is not None:
            kept.add(points[index], row)
        if told:
            given = ", ".join(f"{name} = {value:.5g}" for name, value in points[index].items())
            print(f"[{index + 1}/{len(points)}] {given}: {row.error or 'done'} ({row.seconds:.2f} s)", flush=True)
    own = {name: np.array([point[name] for point in points], dtype=float) for name in lists}
    return _table(own, lists, [rows[index] for index in range(len(points))], dict(units or {}))


def _checked_parameters(parameters: Mapping[str, Sequence[float]]) -> dict[str, list[float]]:
    lists: dict[str, list[float]] = {}
    for name, values in dict(parameters).items():
        numbers_only = np.ndim(values) == 1 and all(isinstance(v, numbers.Real) for v in values)
        if not isinstance(name, str) or name in ("seconds", "error") or not numbers_only or len(values) == 0:
            raise InputError(
                f"{WHERE}.parameters must be a dict of names and lists of numbers, got {name!r}: {values!r}."
            )
        whole = all(isinstance(v, numbers.Integral) for v in values)
        lists[name] = [int(v) if whole else float(v) for v in values]
    if not lists:
        raise InputError(f"{WHERE}.parameters is empty; give at least one list, e.g. {{'speed': [100.0, 200.0]}}.")
    return lists


def _require_place(processes: int, executor: Executor | None, mpi: bool, hosts: Sequence[str]) -> None:
    require_integer(f"{WHERE}: processes", processes, at_least=1)
    if mpi or hosts:
        raise InputError(
            f"{WHERE}: mpi and hosts are not supported any more; give executor=mpi4py.futures.MPIPoolExecutor() for "
            "MPI, or executor=dask.distributed.Client(...).get_executor() for hosts."
        )
    if executor is not None:
        if processes > 1:
            raise InputError(f"{WHERE}: only one of processes and executor can be given, got both.")
        require_executor(executor)


def _table(
    places: dict[str, np.ndarray], lists: dict[str, list[float]], rows: list[Row], units: dict[str, str]
) -> StudyTable:
    if all(row.error for row in rows):
        raise EHDError(f"{WHERE}: all {len(rows)} rows failed, the first with {rows[0].error}")
    names = list(dict.fromkeys(name for row in rows for name in row.results))
    if shared := sorted(set(names) & set(places)):
        raise InputError(f"{WHERE}.function must not return results named as parameters, got {', '.join(shared)}.")
    columns = places | {name: np.array([row.results.get(name, math.nan) for row in rows]) for name in names}
    columns["seconds"] = np.array([row.seconds for row in rows])
    return StudyTable(
        columns=columns,
        parameters=tuple(lists),
        shape=tuple(len(values) for values in lists.values()),
        errors=tuple(row.error for row in rows),
        units=units,
    )
