"""First films from an empty cache and where nothing can be written, against a film of this process."""

import os
import pathlib
import shutil
import subprocess
import sys

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.compilation import MESSAGE

ROOT = pathlib.Path(__file__).resolve().parents[2]
FILM = """
import exudyn_ehd as ehd
b = ehd.JournalBearing(journal_radius=.01, length=.02, radial_clearance=2e-5, lubricant=ehd.Lubricant(viscosity=.04))
print(*ehd.steady(b, speed=314.0, eccentricity_ratio=0.6).force)
"""


def expected():
    """The film's force in this process, N."""
    oil = ehd.Lubricant(viscosity=0.04)
    b = ehd.JournalBearing(journal_radius=0.01, length=0.02, radial_clearance=2e-5, lubricant=oil)
    return ehd.steady(b, speed=314.0, eccentricity_ratio=0.6).force


def first_film(folder, **environment):
    """Force of a first film in a new process, and its messages."""
    done = subprocess.run(
        [sys.executable, "-c", FILM], env=os.environ | environment, cwd=folder, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    return np.array(done.stdout.split(), dtype=float), done.stderr


@pytest.mark.slow
def test_kernels_are_compiled_once(tmp_path):
    """First films are those of this process; a run ahead adds its own kernels to theirs."""
    # a second process with the first's cache has nothing to compile
    for line in (f"{MESSAGE}\n", ""):
        force, errors = first_film(ROOT, NUMBA_CACHE_DIR=str(tmp_path))
        assert errors == line
        # arrays lie elsewhere in every process, which a vectorised sum rounds otherwise
        np.testing.assert_allclose(force, expected(), rtol=1e-12, atol=1e-9)
    environment, call = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path)}, [sys.executable, "-m", "exudyn_ehd", "film"]
    first, second = (subprocess.run(call, env=environment, capture_output=True, text=True, check=True) for _ in "12")
    assert "kernels compiled in" in first.stdout and first.stderr.count(MESSAGE) == 1
    assert "film: all kernels are in the cache" in second.stdout and MESSAGE not in second.stderr


@pytest.mark.slow
def test_a_first_film_where_nothing_can_be_written(tmp_path):
    # not by root either: files in the places of folders
    shutil.copytree(ROOT / "exudyn_ehd", tmp_path / "exudyn_ehd", ignore=lambda *_: {"__pycache__"})
    for folder, _, _ in list(os.walk(tmp_path / "exudyn_ehd")):
        (pathlib.Path(folder) / "__pycache__").touch()
    nowhere = {"HOME": os.devnull, "XDG_CACHE_HOME": os.devnull, "TMPDIR": str(tmp_path), "PYTHONPATH": str(tmp_path)}
    force, errors = first_film(tmp_path, NUMBA_CACHE_DIR=f"{os.devnull}/kernels", **nowhere)
    assert "numba can write its cache neither" in errors
    np.testing.assert_allclose(force, expected(), rtol=1e-12, atol=1e-9)
    assert not list(tmp_path.glob("exudyn_ehd_kernels*")), "the folder of a process goes with it"
