"""Fixtures for all tests: examples as modules, no screen, a bearing, and measured errors."""

import functools
import gc
import importlib.util
import os
import pathlib
import sys
import time
from collections.abc import Callable

os.environ.setdefault("MPLBACKEND", "Agg")
# the matrices are small: threads of BLAS in every worker only wait for each other
os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import exudyn as exu
import matplotlib
import numpy as np
import pytest
from exudyn.utilities import InertiaCylinder
from matplotlib.figure import Figure
from matplotlib.text import Text

import exudyn_ehd as ehd
from exudyn_ehd.joint.model.build import build_model
from exudyn_ehd.solid.bush import bore_modes
from tests.sampling import is_long_to_compile

ROOT = pathlib.Path(__file__).resolve().parent.parent
RADIUS = 0.025
CLEARANCE = 25e-6
VISCOSITY = 0.02


def load_module(path):
    """Import a file by its path, once."""
    name = f"loaded_{path.stem}"
    if name not in sys.modules:
        spec = importlib.util.spec_from_file_location(name, path)
        module = importlib.util.module_from_spec(spec)
        sys.modules[name] = module
        spec.loader.exec_module(module)
    return sys.modules[name]


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config, log):
    """An idle worker of a parallel run takes over tests that wait for another one, such as the examples at the end."""
    from xdist.scheduler import WorkStealingScheduling

    return WorkStealingScheduling(config, log) if config.getoption("dist") == "load" else None


def pytest_itemcollected(item):
    """Tests whose kernels take long to compile are slow."""
    if is_long_to_compile(item.nodeid) and item.get_closest_marker("benchmark") is None:
        item.add_marker(pytest.mark.slow)


@pytest.fixture(scope="session", autouse=True)
def _own_cache(tmp_path_factory):
    """Tests neither read nor fill the user's cache; workers of a parallel run share one: modes of bushes."""
    parallel = "PYTEST_XDIST_WORKER" in os.environ
    folder = tmp_path_factory.getbasetemp().parent / "cache" if parallel else tmp_path_factory.mktemp("cache")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("EXUDYN_EHD_CACHE", str(folder))
        yield


def _use_of_film(**options):
    """Everything that a joint asks of a film."""
    motion = np.array([0.5 * CLEARANCE, 0.4 * CLEARANCE, 1e-4, 0.0, 1e-3, 0.0, 0.0, 0.0, 300.0, 0.1])
    plain = {
        "journal_radius": RADIUS,
        "length": 2.0 * RADIUS,
        "radial_clearance": CLEARANCE,
        "lubricant": ehd.Lubricant(viscosity=VISCOSITY),
        "film": ehd.FiniteLength(n_theta=32, n_z=6),
    }
    model = build_model(ehd.JournalBearing(**(plain | options)))
    evaluation = model.evaluate(motion, model.initial_history(motion), 1e-4)
    evaluation.tangent()
    evaluation.quantities()
    evaluation.history()


def _use_of_joint():
    """A step of a spinning journal in a housing that moves, on a film without kernels."""
    toy = load_module(ROOT / "tests" / "coupling" / "toy.py")
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    inertia = InertiaCylinder(7800.0, 0.1, RADIUS, 2)
    bodies = [mbs.CreateRigidBody(inertia=inertia, initialAngularVelocity=[0.0, 0.0, w]) for w in (1.0, 30.0)]
    toy.attach(mbs, bodies, toy.ToyFilm(), position=[0.0, 0.0, 0.0])
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.timeIntegration.numberOfSteps, settings.timeIntegration.endTime = 1, 1e-6
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    mbs.SolveDynamic(settings)


def _uses_of_kernels(slow):
    """Calls that compile the kernels of nearly all tests: a plain film, what no film uses, and two rows of films.

    ``slow``: of the slow tests too.

    What several films of a row share is compiled by the first of them, what both rows share at different times; the
    rows take as long as each other.
    """
    oil = {"viscosity": VISCOSITY, "temperature": 325.0}
    hot = ehd.ReynoldsTemperature(point=(325.0, VISCOSITY), coefficient=0.03)
    mesh = ehd.HollowCylinder(inner_radius=RADIUS, thickness=0.01, length=0.05, axial=1, radial=1, circumferential=8)
    steel = ehd.SaintVenantKirchhoff(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7800.0)
    conserving = {"cavitation": ehd.ElrodAdams(cavity_pressure=-1e5)}
    liner = {"bush": ehd.ElasticLiner(thickness=2e-3, youngs_modulus=1e10)}
    touching = {"asperity": ehd.GreenwoodTripp(composite_roughness=1e-6, composite_modulus=1e10)}
    rough = {"roughness": ehd.PatirCheng(composite_roughness=1e-6, journal_share=0.9)}
    thin = {"lubricant": ehd.Lubricant(**oil, shear_law=ehd.CarreauShear(relaxation_time=1e-6, exponent=0.6))}
    dense = {"lubricant": ehd.Lubricant(**oil, density_law=ehd.DowsonHigginson())}
    energy = {
        "lubricant": ehd.Lubricant(temperature=325.0, temperature_law=hot),
        "thermal": ehd.FilmEnergy(supply_temperature=320.0),
    }
    modal = {"bush": ehd.ModalBush(mesh=mesh, material=steel, tolerance=0.2)}
    nodal = {"bush": ehd.ANCFBush(mesh=mesh, material=steel)}
    rows = (
        [conserving, rough, touching, energy],
        [thin, modal, nodal],
    )
    if slow:
        rows[0].extend([conserving | modal, dense, conserving | dense])
        rows[1].extend([conserving | thin, liner, liner | touching, liner | energy, conserving | liner])
    return (
        {"plain": _use_of_film},
        {"joint": _use_of_joint, "solid": functools.partial(bore_modes, modal["bush"])},
        *(
            {f"film {n}{k}": functools.partial(_use_of_film, **x) for k, x in enumerate(row)}
            for n, row in enumerate(rows)
        ),
    )


@pytest.fixture(scope="session", autouse=True)
def _kernels_compiled_once(request, _own_cache, tmp_path_factory):
    """The workers of a parallel run share the compilation of the kernels, and find each other's in numba's cache.

    Else every worker compiles nearly all of them. What one has taken the others leave out, but all films wait for the
    plain one's kernels. A worker goes along its own row of films, and then along the other row from its end.
    """
    worker = os.environ.get("PYTEST_XDIST_WORKER")
    if worker is None:
        return
    folder = tmp_path_factory.getbasetemp().parent
    slow = any(item.get_closest_marker("slow") for item in request.session.items)
    plain, apart, *rows = _uses_of_kernels(slow)
    own = int(worker.removeprefix("gw")) % 2
    start = apart | plain if own else plain
    # what the compiler and all tests are made of stays: a tenth of the time goes into looking for what could go
    gc.disable()
    for name, use in (start | rows[own] | dict(reversed(rows[1 - own].items())) | apart).items():
        try:
            (folder / f"{name} taken").mkdir()
        except FileExistsError:
            if name in plain:
                _wait_for(folder / f"{name} compiled")
        else:
            use()
            (folder / f"{name} compiled").touch()
    gc.enable()
    gc.collect()
    gc.freeze()


def _wait_for(path, limit=300.0):
    """Until another worker has written a file."""
    end = time.monotonic() + limit
    while not path.exists() and time.monotonic() < end:
        time.sleep(0.05)


@pytest.fixture(scope="session")
def example():
    """Function that imports an example by its name."""
    return lambda name: load_module(ROOT / "examples" / f"{name}.py")


@pytest.fixture
def tidy_pictures(monkeypatch):
    """Pictures keep their own type under settings that Exudyn's plots leave behind, and lie within their page."""
    write = Figure.savefig

    def checked(figure, *args, **options):
        figure.draw_without_rendering()
        sizes = {text.get_fontsize() for text in figure.findobj(Text) if text.get_text()}
        assert max(sizes) <= 10.0, f"type of {max(sizes)} pt in a picture"
        page, drawn = figure.bbox_inches, figure.get_tightbbox()
        outside = max(page.x0 - drawn.x0, page.y0 - drawn.y0, drawn.x1 - page.x1, drawn.y1 - page.y1)
        assert outside < 0.02, f"a picture reaches {outside:.2f} inch beyond its page"
        write(figure, *args, **options)

    monkeypatch.setattr(Figure, "savefig", checked)
    with matplotlib.rc_context({"font.size": 16.0}):
        yield


@pytest.fixture(scope="session")
def planar_rotor():
    """The scene `PlanarRotor` of mechanisms/planar.py."""
    return load_module(ROOT / "tests" / "mechanisms" / "planar.py").PlanarRotor


@pytest.fixture(scope="session")
def make_bearing() -> Callable[..., ehd.JournalBearing]:
    """A bearing of R = 25 mm, psi = 0.001, mu = 0.02 Pa s; everything can be replaced."""

    def make(length_to_diameter: float = 1.0, **options: object) -> ehd.JournalBearing:
        values = {
            "journal_radius": RADIUS,
            "radial_clearance": CLEARANCE,
            "lubricant": ehd.Lubricant(viscosity=VISCOSITY),
        } | options
        values.setdefault("length", 2.0 * length_to_diameter * values["journal_radius"])
        return ehd.JournalBearing(**values)

    return make


@pytest.fixture
def measured() -> Callable[[str, float, float], None]:
    """Assert that a measured error is below its limit, and print both (shown by ``pytest -rP``)."""

    def check(what: str, value: float, limit: float) -> None:
        print(f"{what}: {value:.3g} (limit {limit:g})")
        assert value <= limit, f"{what}: {value:.4g} exceeds {limit:g}"

    return check
