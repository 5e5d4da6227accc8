"""Cost of effects, closures and reduced films as factors over their base film; ``-m benchmark``.

Cases and measure are those of the shipped table.

Factors are of every state's best time in rounds that alternate between the cases, which is what a shared machine leaves
undisturbed. Limits are the targets (roughness 1.1, asperities 1.15, liner 2, laws of pressure and shear at one state
1.25, of density 1.5, lumped heat 1.05, field of heat 2.5), for others what was measured plus a twentieth, all times
1.02: so far do two runs on a shared machine differ.
"""

import math
import time

import numpy as np
import pytest

from exudyn_ehd.joint.model.build import build_model
from exudyn_ehd.joint.model.effects import Effects
from tests.benchmarks.accuracy.costs import effects
from tests.benchmarks.accuracy.costs.growth import plain_bearing
from tests.benchmarks.accuracy.table import format_costs

pytestmark = pytest.mark.benchmark

EVALUATION_LIMITS = {
    "`VogelTemperature`": 1.05,
    "`PatirCheng`": 1.1,
    "`NgPan`": 1.45,
    "`GreenwoodTripp`": 1.15,
    "`PatirCheng`, `GreenwoodTripp`": 1.2,
    "`Crown`": 1.1,
    "`GreenwoodTripp`, `ArchardWear`": 1.25,
    "`ElasticLiner`": 2.0,
    "`RegularisedWall`": 1.1,
    "`squeeze=False`": 1.05,
    "`PatirCheng`, unequally rough": 1.35,
    "`BarusPressure`": 1.2,
    "`RoelandsPressure`": 1.2,
    "`CarreauShear`": 9.2,
    "`DowsonHigginson`": 1.5,
    "`DowsonHigginson`, `BarusPressure`": 1.5,
    "`ElrodAdams`, `DowsonHigginson`": 1.5,
    "`ElrodAdams`, `DowsonHigginson`, `BarusPressure`": 1.5,
    "`AxialGroove`": 1.5,
    "`CircumferentialGroove`": 1.14,
    "`Hole`": 1.11,
    "`Pocket`": 1.28,
    "`Gumbel`": 1.25,
    "`FullSommerfeld`": 1.2,
    "`ElrodAdams`": 2.5,
    "`ShortBearing`": 0.7,
    "`LongBearing`": 0.87,
    "`ImpedanceMap`": 0.025,
    "`ClassicSOR`, `Gumbel`": 4.05,
}
# Of an accepted step at one state, so that all cavities rest: on the orbit a compressible film follows its cavity by
# more solves.
STEP_LIMITS = {
    "`BarusPressure`": 1.25,
    "`RoelandsPressure`": 1.25,
    "`CarreauShear`": 4.3,
    "`DowsonHigginson`": 1.5,
    "`DowsonHigginson`, `BarusPressure`": 1.5,
    "`LumpedThermal`": 1.05,
    "`FilmEnergy`": 2.5,
}
MARGIN = 1.02
SMALLER = {"journal_radius": 0.025, "length": 0.05, "radial_clearance": 25e-6, "end_pressures": (1e5, 1e5)}
AT_REST = np.tile([13e-6, 5e-6, 1e-4, -1.5e-4, 1e-3, -1e-3, 0.05, 0.02, 250.0, 0.3], (3, 1))


def test_effects_on_the_orbit():
    found = effects.measure_effects(EVALUATION_LIMITS, blocks=3, rounds=12, progress=lambda text: None)
    print("\n" + format_costs(found))
    factors = {cost.what: cost.factor for cost in found if cost.per == effects.EVALUATION}
    assert not [cost for cost in found if cost.failure]
    slow = {name: (factors[name], limit) for name, limit in EVALUATION_LIMITS.items() if factors[name] > MARGIN * limit}
    assert not slow, "\n".join(f"{name}: {factor:.3f}, limit {limit}" for name, (factor, limit) in slow.items())


@pytest.mark.parametrize("name", STEP_LIMITS)
@pytest.mark.parametrize("base", [effects.PLAIN, effects.CONSERVING], ids=["swift", "elrod"])
def test_law_at_rest(name, base):
    """Only two models in turns: a lumped temperature's short history feels what else the processor's cache holds."""
    law = name if base == effects.PLAIN else f"{base}, {name}"
    models = {n: build_model(plain_bearing(**SMALLER, **effects.CASES[n].options)) for n in (base, law)}
    times = effects.block(models, AT_REST, 80)
    factor = times[law][1] / times[base][1]
    print(f"{law}: {factor:.2f}")
    assert factor < MARGIN * STEP_LIMITS[name]


def test_impedance_map_in_microseconds():
    """Target 5 us per evaluation, with its tangent."""
    model = build_model(plain_bearing(**effects.CASES["`ImpedanceMap`"].options))
    states = effects.orbit()
    best = math.inf
    for _ in range(8):
        start = time.process_time()
        for state in states:
            model.evaluate(state).tangent()
        best = min(best, (time.process_time() - start) / len(states))
    print(f"{1e6 * best:.2f} us per evaluation with tangent")
    assert best < 5e-6


def test_off_costs_nothing():
    """A bearing that spells every option out as None against a model without effects: a few per cent of noise."""
    off = dict.fromkeys(("contact", "asperity", "roughness", "wear", "profile", "thermal", "bush"))
    described = build_model(plain_bearing(**off, supply=()))
    models = {"described": described, "bare": type(described)(described.bearing, effects=Effects())}
    times = effects.block(models, effects.orbit(), 40)
    ratio = times["described"][0] / times["bare"][0]
    print(f"{ratio:.3f}")
    assert abs(ratio - 1.0) < 0.03
