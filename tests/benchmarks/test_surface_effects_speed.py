"""Cost of the surface effects as factors over the plain film; ``-m benchmark``.

The journal moves along an orbit, one degree per evaluation, evaluated with its exact tangent, as in a time integration. Factors are of
every state's best time in rounds that alternate between the bearings, which is what a shared machine leaves undisturbed. Targets: roughness
and asperities 1.1, both 1.15, liner 2; limits are these plus a tenth, others what was measured plus a fifth.
"""

import math
import time

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.joint.build import build_model

pytestmark = pytest.mark.benchmark

R, C, SPEED = 0.02, 20e-6, 300.0
ASPERITY = ehd.GreenwoodTripp(composite_roughness=0.4e-6, composite_modulus=2e10)
ROUGHNESS = ehd.PatirCheng(composite_roughness=0.4e-6)
CASES = {
    "off": ({}, 1.1),
    "roughness": ({"roughness": ROUGHNESS}, 1.2),
    "asperity": ({"asperity": ASPERITY}, 1.2),
    "roughness and asperity": ({"roughness": ROUGHNESS, "asperity": ASPERITY}, 1.25),
    "profile": ({"profile": ehd.Crown(drop=1e-6)}, 1.5),
    "wear": ({"asperity": ASPERITY, "wear": ehd.ArchardWear(wear_rate=1e-15)}, 1.65),
    "liner": ({"bush": ehd.ElasticLiner(thickness=0.002, youngs_modulus=1e10)}, 2.1),
}


def make(**options):
    return build_model(
        ehd.JournalBearing(
            journal_radius=R, length=0.03, radial_clearance=C, lubricant=ehd.Lubricant(viscosity=0.03),
            film=ehd.FiniteLength(n_theta=96, n_z=10), **options,
        )
    )  # fmt: skip


def orbit(count=60):
    k = np.radians(np.arange(count))
    e = C * (0.85 + 0.05 * np.sin(5 * k))
    v = 0.3 * SPEED * e
    zero = np.zeros(count)
    rows = [e * np.cos(k), e * np.sin(k), zero, zero, -v * np.sin(k), v * np.cos(k), zero, zero, zero + SPEED, zero]
    return np.stack(rows, axis=1)


def best_times(models, motions, rounds=40):
    """Mean over the orbit of every state's best time, s; the order of states is kept, as every one starts from the one before."""
    best = {name: np.full(len(motions), math.inf) for name in models}
    for _ in range(rounds):
        for name, model in models.items():
            for k, motion in enumerate(motions):
                start = time.process_time()
                model.evaluate(motion).tangent()
                best[name][k] = min(best[name][k], time.process_time() - start)
    return {name: times.mean() for name, times in best.items()}


def test_factors_over_the_plain_film():
    models = {"plain": make()} | {name: make(**options) for name, (options, _) in CASES.items()}
    best = best_times(models, orbit())
    for name, (_, limit) in CASES.items():
        factor = best[name] / best["plain"]
        print(f"{name}: {1e3 * best[name]:.3f} ms, factor {factor:.2f} (limit {limit})")
    for name, (_, limit) in CASES.items():
        assert best[name] / best["plain"] < limit, name
