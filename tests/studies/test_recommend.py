"""`recommend`: what it says holds for bearings that were not measured; where nothing was measured it says nothing."""

import dataclasses
import math

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.joint.model.build import build_model
from exudyn_ehd.status import InputError
from exudyn_ehd.studies.accuracy_table import bore_compliance, elasticity_parameter
from tests.benchmarks.accuracy.scenes.steady import QUANTITIES, measure_motions, motion_at

SPEED = 200.0


def _bearing(ratio, **options):
    # another size, clearance and oil than the measured ones: only the dimensionless numbers count
    values = {
        "journal_radius": 0.02,
        "length": 0.04 * ratio,
        "radial_clearance": 30e-6,
        "lubricant": ehd.Lubricant(viscosity=0.05),
    }
    return ehd.JournalBearing(**(values | options))


def _true_error(bearing, film, quantity, eps, tilt, fine):
    """Largest error over some directions against a fine grid."""
    (q,) = (q for q in QUANTITIES if q.name == quantity)
    motions = np.array([motion_at(bearing, SPEED, eps, tilt, d) for d in 1.0 + np.radians(np.arange(0.0, 11.0, 2.2))])
    values = [
        measure_motions(build_model(dataclasses.replace(bearing, film=f)), motions)[0][quantity] for f in (film, fine)
    ]
    return q.distance(*values)


def _check(rng, count, *, make, tilts, fine):
    found = 0
    for _ in range(count):
        eps, tilt = rng.uniform(0.4, 0.9), float(rng.choice(tilts))
        bearing = make(rng.uniform(0.5, 1.0), rng.uniform(0.001, 0.02))
        quantity = str(rng.choice(["load", "attitude", "friction", "leakage", "stiffness"]))
        error = float(rng.choice([0.05, 0.01, 0.003]))
        advice = ehd.recommend(bearing, error, quantity, eccentricity_ratio=eps, tilt_ratio=tilt, speed=SPEED)
        if not advice.found:
            assert "no measured setting keeps" in advice.reason
            continue
        found += 1
        assert advice.error <= error
        assert advice.evidence
        true = _true_error(bearing, advice.film, quantity, eps, tilt, fine)
        assert true <= error, f"{quantity} at eps {eps:.3f}, tilt {tilt:.2f}: {true:.2g} > {error:g} with {advice.film}"
    assert found >= count // 2


def _rigid(ratio, kappa):
    return _bearing(ratio)


def _liner(ratio, kappa):
    liner = ehd.ElasticLiner(thickness=0.003, youngs_modulus=1e9)
    modulus = 1e9 * elasticity_parameter(_bearing(ratio), liner.compliance, SPEED) / kappa
    return _bearing(ratio, bush=dataclasses.replace(liner, youngs_modulus=modulus))


def _solid(ratio, kappa, kind=ehd.ModalBush, **options):
    thickness = 0.012
    modulus = elasticity_parameter(_bearing(ratio), bore_compliance(thickness, 0.02, 1.0, 0.3), SPEED) / kappa
    if kind is ehd.ModalBush:
        options = {"tilted": True, "tolerance": 0.08} | options
    bush = kind(
        mesh=ehd.HollowCylinder(
            inner_radius=0.02, thickness=thickness, length=0.04 * ratio, axial=4, radial=2, circumferential=32
        ),
        material=ehd.SaintVenantKirchhoff(youngs_modulus=modulus, poisson_ratio=0.3, density=7800.0),
        **options,
    )
    return _bearing(ratio, bush=bush)


@pytest.mark.slow
def test_random_bearings():
    # the fine grid is good to a tenth of the smallest error asked for
    rng = np.random.default_rng(7)
    _check(rng, 6, make=_rigid, tilts=[0.0, 0.2, 0.5], fine=ehd.FiniteLength(n_theta=256, n_z=24))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("make", "tilts", "count"), [(_rigid, [0.0, 0.2, 0.5], 20), (_liner, [0.0, 0.2], 10), (_solid, [0.0, 0.2], 4)]
)
def test_many_random_bearings(make, tilts, count):
    rng = np.random.default_rng(11)
    _check(rng, count, make=make, tilts=tilts, fine=ehd.FiniteLength(n_theta=256, n_z=24))


def test_cheaper_for_less():
    def advice(error, quantity="peak pressure"):
        return ehd.recommend(_bearing(0.7), error, quantity, eccentricity_ratio=0.7)

    coarse, fine = advice(0.1), advice(0.005)
    assert coarse.film.n_theta < fine.film.n_theta
    assert coarse.seconds <= fine.seconds
    assert "eps 0.6" in str(coarse)
    # a range counts with its worst end
    wide = ehd.recommend(_bearing(0.7), 0.02, "peak pressure", eccentricity_ratio=(0.3, 0.92))
    assert wide.film.n_theta >= advice(0.02).film.n_theta


@pytest.mark.parametrize(
    ("change", "place", "words"),
    [
        ({"cavitation": ehd.Gumbel()}, {}, "cavitation"),
        ({"thermal": ehd.LumpedThermal(supply_temperature=300.0)}, {}, "thermal"),
        ({"supply": (ehd.AxialGroove(angle=0.0, width_angle=0.2),)}, {}, "supply"),
        (
            {"lubricant": ehd.Lubricant(viscosity=0.05, pressure_law=ehd.BarusPressure(coefficient=1e-8))},
            {},
            "pressure_law",
        ),
        ({}, {"eccentricity_ratio": 0.97}, "eccentricity_ratio is measured from"),
        ({"length": 0.2}, {}, "length_to_diameter is measured from"),
        ({}, {"tilt_ratio": 0.9}, "tilt_ratio is measured from"),
    ],
)
def test_says_when_it_has_no_evidence(change, place, words):
    advice = ehd.recommend(_bearing(0.7, **change), **({"eccentricity_ratio": 0.7} | place))
    assert not advice.found
    assert advice.film is None
    assert "no evidence" in advice.reason
    assert words in advice.reason
    assert math.isnan(advice.error)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"tolerance": 0.005}, "modes were measured down to tolerance 0.02, not 0.005"),
        ({"kind": ehd.ANCFBush}, "measured as ModalBush only, not as ANCFBush"),
    ],
)
def test_says_when_it_has_no_evidence_for_a_bush(options, words):
    advice = ehd.recommend(_solid(0.7, 0.01, **options), eccentricity_ratio=0.7, speed=SPEED)
    assert not advice.found
    assert words in advice.reason


def test_tilted_solid_bush():
    advice = ehd.recommend(_solid(0.7, 0.01), 0.02, eccentricity_ratio=0.7, tilt_ratio=0.2, speed=SPEED)
    assert advice.found
    assert all("tilt 0" in line for line in advice.evidence)
    assert any("tilt 0.35" in line for line in advice.evidence)


def test_impossible_accuracy():
    advice = ehd.recommend(_bearing(0.7), 1e-7, "damping", eccentricity_ratio=0.9)
    assert not advice.found
    assert "the best gives" in advice.reason


def test_refuses():
    with pytest.raises(InputError, match="eccentricity_ratio"):
        ehd.recommend(_bearing(0.7))
    with pytest.raises(InputError, match="quantity"):
        ehd.recommend(_bearing(0.7), quantity="colour", eccentricity_ratio=0.5)
    with pytest.raises(InputError, match="error"):
        ehd.recommend(_bearing(0.7), 1.5, eccentricity_ratio=0.5)
    with pytest.raises(InputError, match="speed"):
        ehd.recommend(_liner(0.7, 0.01), eccentricity_ratio=0.5)


def test_compliance_of_a_thick_cylinder():
    """A thin layer deflects like a column held sideways; a thick one towards the infinite solid, a (1 + nu) / E."""
    nu = 0.3
    column = (1 + nu) * (1 - 2 * nu) / (1 - nu)
    # terms of first order in thickness over radius
    assert bore_compliance(1e-4, 1.0, 1.0, nu) == pytest.approx(1e-4 * column, rel=1e-3)
    assert bore_compliance(1e3, 1.0, 1.0, nu) == pytest.approx(1 + nu, rel=1e-5)
