"""Every pair of effects, with every closure: refused when described, or finite, balanced and differentiated exactly."""

import itertools
import math

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.joint.model.build import build_model
from tests.descriptions import CAVITATION, by_itself

CLEARANCE = 50e-6
SCALE = np.array([CLEARANCE, CLEARANCE, 2e-3, 2e-3, 1e-2, 1e-2, 0.5, 0.5, 300.0, 1.0])
MOTION = np.array([0.5, 0.45, 0.05, -0.1, 0.2, -0.1, 0.06, 0.02, 1.0, 0.5]) * SCALE

# What each effect adds to the bearing; "lubricant" entries go to its lubricant.
EFFECTS = {
    "barus": {"lubricant": {"pressure_law": ehd.BarusPressure(coefficient=2e-8)}},
    "roelands": {"lubricant": {"pressure_law": ehd.RoelandsPressure(coefficient=2e-8)}},
    "carreau": {"lubricant": {"shear_law": ehd.CarreauShear(relaxation_time=2e-6, exponent=0.8)}},
    "density": {"lubricant": {"density_law": ehd.DowsonHigginson()}},
    "groove": {"supply": (ehd.AxialGroove(angle=3.0, width_angle=0.4, length=0.02, pressure=2e5, depth=3e-4),)},
    "wall": {"contact": ehd.RegularisedWall(onset=0.35 * CLEARANCE, pressure=1e7)},
    "asperity": {"asperity": ehd.GreenwoodTripp(composite_roughness=5e-6, composite_modulus=1e9)},
    "roughness": {"roughness": ehd.PatirCheng(composite_roughness=5e-6)},
    "profile": {"profile": ehd.OutOfRound(order=2, amplitude=3e-6, phase=0.4)},
    "liner": {"bush": ehd.ElasticLiner(thickness=2e-3, youngs_modulus=1e10)},
    "elastic journal": {
        "journal": ehd.ElasticJournal(
            material=ehd.SaintVenantKirchhoff(youngs_modulus=2e10, poisson_ratio=0.3, density=1e3),
            span=(-0.03, 0.025),
            held=ehd.HeldEnds(),
            tolerance=0.2,
        )
    },
    "turbulent": {"turbulence": ehd.Hirs(onset=8.0, full=24.0, coefficient=2.0)},
    "lumped": {"thermal": ehd.LumpedThermal(supply_temperature=320.0)},
    "energy": {"thermal": ehd.FilmEnergy(supply_temperature=320.0)},
    "walls": {
        "thermal": ehd.FilmEnergy(
            supply_temperature=320.0,
            conductivity=0.13,
            bush=ehd.Conduction(thickness=0.02, conductance=1.0, initial_temperature=325.0, expansion=1e-5),
            journal=ehd.Conduction(thickness=0.025, conductance=1.0, initial_temperature=335.0, expansion=1e-5),
            carry_over=0.8,
        )
    },
    "across": {
        "thermal": ehd.FilmEnergy(
            supply_temperature=320.0,
            conductivity=0.13,
            bush=ehd.Conduction(thickness=0.02, conductance=1.0, initial_temperature=325.0, expansion=1e-5),
            journal=ehd.Conduction(thickness=0.025, conductance=1.0, initial_temperature=350.0, expansion=1e-5),
            across=2,
        )
    },
    "wear": {
        "asperity": ehd.GreenwoodTripp(composite_roughness=5e-6, composite_modulus=1e9),
        "wear": ehd.ArchardWear(wear_rate=1e-15),
    },
}
CLOSURES = {
    "full": ehd.FullSommerfeld(),
    "gumbel": ehd.Gumbel(cavity_pressure=-5e4),
    "swift": ehd.SwiftStieber(cavity_pressure=-5e4),
    "elrod": ehd.ElrodAdams(cavity_pressure=-5e4),
}
LINES = {
    "swift": ehd.SwiftStieber(cavity_pressure=-5e4, line_in_cells=True),
    "elrod": ehd.ElrodAdams(cavity_pressure=-5e4, line_in_cells=True),
}
CLOSURES |= {c.__name__: by_itself(c) for c in CAVITATION if c not in map(type, CLOSURES.values())}

# A liner's contact comes out of its film solve, so that everything that acts besides meets another program.
LINER_TRIPLES = [
    ("liner", contact, other) for contact in ("wall", "asperity") for other in ("groove", "profile", "lumped")
] + [
    ("liner", "groove", "profile"),
    ("liner", "wear", "profile"),
    *(("liner", *pair) for pair in itertools.combinations(("barus", "carreau", "roughness", "energy"), 2)),
    *(
        ("liner", law, contact)
        for law in ("barus", "carreau", "roughness", "energy", "density")
        for contact in ("wall", "asperity")
    ),
    *(("liner", "density", other) for other in ("barus", "roelands", "carreau", "roughness", "energy", "groove")),
]
# Their kernels take longer to compile than all other pairs to run.
RARE = [{"liner", "density"}, {"carreau", "density"}]
RARE += [{new, name} for new in ("elastic journal", "walls", "across") for name in set(EFFECTS) - {"profile"}]
PAIRS = [
    pytest.param(pair, marks=pytest.mark.slow if any(rare <= set(pair) for rare in RARE) else ())
    for pair in [*itertools.combinations(EFFECTS, 2), *LINER_TRIPLES]
]


def _bearing(names, closure, closures=CLOSURES):
    options, lubricant = {}, {}
    for name in names:
        for key, value in EFFECTS[name].items():
            if key == "lubricant":
                lubricant |= value
            else:
                options[key] = value
    if "thermal" in options:
        lubricant |= {
            "temperature_law": ehd.ReynoldsTemperature(point=(320.0, 0.02), coefficient=0.03),
            "temperature": 320.0,
        }
    return ehd.JournalBearing(
        journal_radius=0.025,
        length=0.04,
        radial_clearance=CLEARANCE,
        lubricant=ehd.Lubricant(viscosity=0.02, **lubricant),
        film=ehd.FiniteLength(n_theta=40, n_z=6),
        cavitation=closures[closure],
        **options,
    )


def _loads(evaluation):
    """The wrench, and the loads on the modes of an elastic surface."""
    return np.concatenate((evaluation.wrench, getattr(evaluation, "bore_load", np.zeros(0))))


def _differences(model, motion, history, step, change, h=1e-6):
    plus = _loads(model.evaluate(motion + h * change, history, step))
    minus = _loads(model.evaluate(motion - h * change, history, step))
    return (plus - minus) / (2 * h)


@pytest.mark.parametrize("closure", CLOSURES)
@pytest.mark.parametrize("pair", PAIRS, ids="-".join)
def test_pair(pair, closure):
    _check_pair(pair, closure, CLOSURES)


def _check_pair(pair, closure, closures):
    try:
        model = build_model(_bearing(pair, closure, closures))
    except ehd.InputError as error:
        # refused when described, with both options' names or a next step in the text
        assert len(str(error)) > 60
        return
    start = MOTION - 0.002 * SCALE
    start[4:8] = 0.0
    history, step = model.initial_history(start), 2e-4
    k, rng = model.bore.size if model.flexible else 0, np.random.default_rng(3)
    unit = np.concatenate((SCALE, np.full(k, CLEARANCE), np.full(k, 1e-2)))
    motion = np.concatenate((MOTION, 0.02 * unit[10:] * rng.normal(size=2 * k)))
    evaluation = model.evaluate(motion, history, step)
    assert evaluation.status is ehd.Status.CONVERGED
    tangent = evaluation.tangent()
    values = evaluation.quantities()
    assert np.all(np.isfinite(evaluation.wrench))
    assert np.all(np.isfinite(tangent))
    assert all(math.isfinite(v) for v in values.values())
    if model.bearing.cavitation.conserves_mass:
        _check_mass(model, evaluation, history, step)
    for _ in range(3):
        change = rng.normal(size=unit.size) * unit
        expected = _differences(model, motion, history, step, change)
        got = tangent @ change
        scale = np.abs(tangent * unit).max(axis=1)
        # central differences with h = 1e-6 of the scales: truncation 1e-9 and rounding 1e-9 of smooth states
        assert np.all(np.abs(got - expected) < 1e-6 * scale)


LINE_PAIRS = [p for p in itertools.combinations(EFFECTS, 2) if {"carreau", "density", "liner", "turbulent"} & set(p)]


@pytest.mark.slow
@pytest.mark.parametrize("pair", [*LINE_PAIRS, *LINER_TRIPLES], ids="-".join)
def test_pair_with_a_line_in_its_cells(pair):
    _check_pair(pair, "swift", LINES)


@pytest.mark.slow
@pytest.mark.parametrize("pair", list(itertools.combinations(EFFECTS, 2)), ids="-".join)
def test_pair_with_a_line_of_oil_in_its_cells(pair):
    _check_pair(pair, "elrod", LINES)


def _check_mass(model, evaluation, history, step):
    """What flows in at prescribed vertices is what the film's content gains, to rounding of the flows."""
    after, s = evaluation.history(), model.solver
    inflow = s.inflow()
    gain = np.sum((after.mass - history.mass) * s.area) / step
    assert inflow.sum() == pytest.approx(gain, abs=1e-10 * np.abs(inflow).sum() + 1e-10 * abs(gain) + 1e-9)


@pytest.mark.slow
def test_most_pairs_are_allowed(monkeypatch):
    """The refusals are exceptions: the same slot twice."""
    monkeypatch.setattr("exudyn_ehd.joint.model.build.compile_kernels", lambda model: None)
    refused = []
    for pair in itertools.combinations(EFFECTS, 2):
        try:
            build_model(_bearing(pair, "swift"))
        except ehd.InputError:
            refused.append(pair)
    laminar = {"barus", "roelands", "carreau", "density", "roughness", "walls", "across"}
    both = {"liner", "elastic journal"}
    kept = [pair for pair in refused if set(pair) not in (both, {"carreau", "across"})]
    assert all("wall" in pair or ("turbulent" in pair and laminar & set(pair)) for pair in kept), refused
