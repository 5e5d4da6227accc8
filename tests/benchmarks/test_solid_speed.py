"""Time of the solid's kernels and of the hollow cylinder's run; ``-m benchmark``.

Run with one thread for the numeric libraries (OMP_NUM_THREADS=1), so that only the kernels' own threads count. Limits
are those of a 2 GHz core; ratios are measured in the same run.
"""

import time

import numba
import numpy as np
import pytest

from exudyn_ehd.solid.elements.element import GAUSS27, IRONS14
from tests.benchmarks.accuracy.costs.bushes import assembly_run as assembly
from tests.benchmarks.accuracy.costs.bushes import deformed_solid

pytestmark = pytest.mark.benchmark


def best(function, repeats=20):
    """Shortest of several runs [s]: the machine's noise only adds."""
    function()
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        function()
        times.append(time.perf_counter() - start)
    return min(times)


@pytest.mark.parametrize(("rule", "limit"), [(GAUSS27, 20e-3), (IRONS14, 12e-3)], ids=["27", "14"])
def test_force_tangent_and_csr_fill_on_one_thread(benchmark, rule, limit):
    both = assembly(rule)
    both()
    benchmark(both)
    assert best(both) < limit


def test_force_alone_on_one_thread(benchmark):
    solid, displacements = deformed_solid(IRONS14)
    solid.force(displacements)
    benchmark(solid.force, displacements)
    assert best(lambda: solid.force(displacements)) < 0.6e-3


@pytest.mark.skipif(numba.config.NUMBA_NUM_THREADS < 2, reason="needs two threads")
@pytest.mark.parametrize("rule", [GAUSS27, IRONS14], ids=["27", "14"])
def test_two_threads_are_faster(rule):
    numba.set_num_threads(2)
    serial, parallel = best(assembly(rule)), best(assembly(rule, parallel=True))
    print(f"one thread {1e3 * serial:.2f} ms, two {1e3 * parallel:.2f} ms, ratio {serial / parallel:.2f}")
    assert serial / parallel > 1.6


def test_assembly_against_an_established_package():
    """Compare with FElupe on one element, point rule and material; tensortrax differentiates its material."""
    felupe = pytest.importorskip("felupe")
    solid, displacements = deformed_solid(GAUSS27)
    lam, mu = solid.material.lame
    mesh = felupe.Mesh(solid.mesh.nodes, solid.mesh.elements, "hexahedron20")
    field = felupe.FieldContainer([felupe.Field(felupe.RegionQuadraticHexahedron(mesh), dim=3)])
    field[0].values[:] = displacements
    body = felupe.SolidBody(felupe.Hyperelastic(felupe.saint_venant_kirchhoff, mu=mu, lmbda=lam), field)

    def theirs():
        return body.assemble.vector(field), body.assemble.matrix(field)

    ours = assembly(GAUSS27)
    force, tangent = ours()
    their_force, their_tangent = theirs()
    assert np.allclose(their_force.toarray().ravel(), force.ravel(), atol=1e-12 * np.abs(force).max())
    assert abs(their_tangent - tangent).max() < 1e-12 * abs(tangent).max()
    own, other = best(ours), best(theirs, repeats=8)
    print(f"here {1e3 * own:.1f} ms, there {1e3 * other:.1f} ms, ratio {other / own:.1f}")
    assert other / own > 2.5


def test_thousand_steps_of_the_hollow_cylinder(capsys):
    """Paper's first case, mesh 4 x 2 x 40, step 1e-3 s: at most 30 s."""
    import importlib.util
    from pathlib import Path

    path = Path(__file__).parents[2] / "examples" / "hollow_cylinder.py"
    spec = importlib.util.spec_from_file_location("hollow_cylinder", path)
    example = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(example)
    case = example.simulate((4, 2, 40), 1e-3, 1.0, [])
    with capsys.disabled():
        print(case["run"].report())
    assert case["run"].seconds < 30
