"""Costs paid once: compiling the kernels, tabulating a map, building the modes of a bush; and reading them again."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable

from exudyn_ehd.film.solvers.impedance_map import ImpedanceMap
from exudyn_ehd.joint.model.build import build_model
from exudyn_ehd.solid.bush import bore_modes
from exudyn_ehd.status import EHDError
from tests.benchmarks.accuracy.costs import bushes, growth
from tests.benchmarks.accuracy.errors.study import Progress
from tests.benchmarks.accuracy.table import Cost, costs_of_blocks

EMPTY, FULL = "from an empty cache", "from the cache"
FIRST_FILM, MAP = "import and first film of a new Python, by the clock", "`ImpedanceMap`"
FIRST_RESULT = """
import exudyn_ehd as ehd
b = ehd.JournalBearing(journal_radius=.01, length=.02, radial_clearance=2e-5, lubricant=ehd.Lubricant(viscosity=.04))
ehd.steady(b, speed=314.0, eccentricity_ratio=0.6)
"""
TOLERANCE = 0.02


def first_result(kernels: str) -> float:
    """Seconds of a new interpreter up to its first film, with numba's cache in the folder ``kernels``."""
    start = time.perf_counter()
    subprocess.run(
        [sys.executable, "-c", FIRST_RESULT],
        check=True,
        capture_output=True,
        env=os.environ | {"NUMBA_CACHE_DIR": kernels},
    )
    return time.perf_counter() - start


def _map() -> None:
    build_model(growth.plain_bearing(film=ImpedanceMap()))


def _modes() -> None:
    bore_modes(bushes.modal(TOLERANCE, True))


def measure_once(*, turns: int = 2, progress: Progress = print) -> list[Cost]:
    """Times from an empty cache and from the cache; every turn begins with new folders, the user's are left alone."""
    count = float(bore_modes(bushes.modal(TOLERANCE, True)).count)
    modes = f"{count:.0f} modes of 4 x 2 x 40 elements"
    times: dict[str, dict[str, list[float]]] = {EMPTY: {}, FULL: {}}
    failures: dict[str, str] = {}
    kept = os.environ.get("EXUDYN_EHD_CACHE")
    _map()
    try:
        for turn in range(turns):
            progress(f"paid once: turn {turn + 1} of {turns}")
            with tempfile.TemporaryDirectory() as folder:
                os.environ["EXUDYN_EHD_CACHE"] = folder

                def first(folder: str = folder) -> float:
                    return first_result(folder)

                measured: dict[str, Callable[[], float]] = {
                    FIRST_FILM: first,
                    MAP: lambda: bushes.seconds(_map),
                    modes: lambda: bushes.seconds(_modes),
                }
                for name, measure in measured.items():
                    for per in (EMPTY, FULL):
                        try:
                            times[per].setdefault(name, []).append(measure())
                        except (EHDError, subprocess.SubprocessError) as error:
                            failures[name] = str(error).splitlines()[0]
    finally:
        if kept is None:
            os.environ.pop("EXUDYN_EHD_CACHE", None)
        else:
            os.environ["EXUDYN_EHD_CACHE"] = kept
    out = []
    for per, found in times.items():
        complete = {name: t for name, t in found.items() if name not in failures}
        out += costs_of_blocks(per, complete, {}, modes={modes: count})
    return out + [Cost(what=name, per=EMPTY, failure=text) for name, text in failures.items()]
