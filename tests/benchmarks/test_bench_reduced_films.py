"""Time of the reduced film models and of the paper's scheme beside the two-dimensional film; R 25 mm, L/D 1, eps 0.8."""

from __future__ import annotations

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.joint.build import build_model


@pytest.fixture(scope="module", autouse=True)
def cache(tmp_path_factory):
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("EXUDYN_EHD_CACHE", str(tmp_path_factory.mktemp("maps")))
        yield


pytestmark = pytest.mark.benchmark
GUMBEL = ehd.Gumbel()
FILMS = {
    "finite volumes 96x10, Swift-Stieber": {"film": ehd.FiniteLength()},
    "finite volumes 96x10, Gumbel": {"film": ehd.FiniteLength(), "cavitation": GUMBEL},
    "classic 96x24, tolerance 1e-5": {"film": ehd.ClassicSOR(n_theta=96, n_z=24), "cavitation": GUMBEL},
    "classic 96x24, tolerance 1e-9": {"film": ehd.ClassicSOR(n_theta=96, n_z=24, tolerance=1e-9), "cavitation": GUMBEL},
    "short bearing": {"film": ehd.ShortBearing()},
    "long bearing": {"film": ehd.LongBearing(), "supply": (ehd.AxialGroove(angle=0.0, width_angle=0.2),)},
    "impedance map": {"film": ehd.ImpedanceMap()},
}


def _motion(k):
    angle = 1e-3 * k
    motion = np.zeros(10)
    motion[:2] = 20e-6 * np.cos(angle), 20e-6 * np.sin(angle)
    motion[8] = 150.0
    return motion


@pytest.mark.parametrize("name", FILMS)
@pytest.mark.parametrize("tangent", [False, True], ids=["force", "force and tangent"])
def test_evaluation(benchmark, make_bearing, name, tangent):
    model = build_model(make_bearing(**FILMS[name]))
    state = {"k": 0}

    def step():
        state["k"] += 1
        evaluation = model.evaluate(_motion(state["k"]))
        if tangent:
            evaluation.tangent()

    benchmark.pedantic(step, rounds=200, warmup_rounds=10)


def test_impedance_map_build(benchmark, tmp_path, monkeypatch, make_bearing):
    """Target: 10 s."""
    monkeypatch.setenv("EXUDYN_EHD_CACHE", str(tmp_path))
    benchmark.pedantic(build_model, args=(make_bearing(film=ehd.ImpedanceMap()),), rounds=1)
