"""Contract of every effect of the surfaces, with every closure that supports it:
exact tangent, no cost when off, limits, robustness."""

import math

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.joint.model.build import build_model
from tests.sampling import sample

R, L, C, SPEED = 0.02, 0.03, 20e-6, 200.0
SIGMA = 0.4e-6
ASPERITY = ehd.GreenwoodTripp(composite_roughness=SIGMA, composite_modulus=5e10)
ROUGHNESS = ehd.PatirCheng(composite_roughness=SIGMA, pattern=1 / 3, journal_share=0.8)
PROFILE = (
    ehd.OutOfRound(order=3, amplitude=2e-6, phase=0.3),
    ehd.Crown(drop=2e-6),
    ehd.ProfileTable(
        angles=np.arange(6) * 1.0, positions=[-0.01, 0.0, 0.01], depths=1e-6 * np.cos(np.arange(18.0).reshape(6, 3))
    ),
)
LINER = ehd.ElasticLiner(thickness=0.002, youngs_modulus=3e9)
EFFECTS = {
    "asperity": {"asperity": ASPERITY},
    "roughness": {"roughness": ROUGHNESS},
    "profile": {"profile": PROFILE},
    "liner": {"bush": LINER},
    "mixed": {"asperity": ASPERITY, "roughness": ROUGHNESS},
    "worn": {"asperity": ASPERITY, "wear": ehd.ArchardWear(wear_rate=1e-12), "profile": PROFILE},
    "liner_profile": {"bush": LINER, "profile": PROFILE},
    "liner_asperity": {"bush": LINER, "asperity": ASPERITY},
    "liner_wall": {"bush": LINER, "contact": ehd.RegularisedWall(onset=0.1 * C)},
    "liner_worn": {"bush": LINER, "asperity": ASPERITY, "wear": ehd.ArchardWear(wear_rate=1e-12), "profile": PROFILE},
}
CLOSURES = {
    "full": ehd.FullSommerfeld(),
    "gumbel": ehd.Gumbel(),
    "swift": ehd.SwiftStieber(cavity_pressure=-2e4),
    "elrod": ehd.ElrodAdams(cavity_pressure=-2e4),
}
PAIRS = [(e, c) for e in EFFECTS for c in CLOSURES]
every_pair = pytest.mark.parametrize(("effect", "closure"), PAIRS, ids="-".join)


def bearing(n_theta=48, n_z=8, **options):
    return ehd.JournalBearing(
        journal_radius=R,
        length=L,
        radial_clearance=C,
        lubricant=ehd.Lubricant(viscosity=0.03),
        film=ehd.FiniteLength(n_theta=n_theta, n_z=n_z),
        **({"end_pressures": (1e5, 2e5)} | options),
    )


def motion(eps, angle=0.7, speed=SPEED, tilt=0.02, rate=0.1):
    """Tilted, squeezing, sliding motion; tilt as share of the clearance at the ends."""
    e, b = eps * C, tilt * 2 * C / L
    return np.array(
        [
            e * math.cos(angle),
            e * math.sin(angle),
            b,
            -0.5 * b,
            rate * C * 100,
            -2 * rate * C * 100,
            b * 20,
            b * 50,
            speed,
            0.3,
        ]
    )


SCALE = np.array([C, C, C / L, C / L, C * SPEED, C * SPEED, C / L * SPEED, C / L * SPEED, SPEED, R * SPEED])


def worst_tangent_error(model, at, history, step):
    """Largest difference between the tangent and central differences, each row
    in its largest entry, each column in its unit."""
    tangent = model.evaluate(at, history, step).tangent() * SCALE
    difference = np.empty((6, 10))
    for k in range(10):
        d = np.zeros(10)
        d[k] = 1e-6 * SCALE[k]
        difference[:, k] = (
            model.evaluate(at + d, history, step).wrench - model.evaluate(at - d, history, step).wrench
        ) / 2e-6
    return float((np.abs(tangent - difference) / np.abs(difference).max(axis=1, keepdims=True)).max())


@every_pair
@pytest.mark.parametrize(("eps", "speed"), [(0.6, SPEED), (0.93, -0.7 * SPEED)])
def test_tangent_is_exact(effect, closure, eps, speed):
    """Below 1e-6 of each row's largest entry, with and without a history;
    differences of step 1e-6 are good to about 1e-8."""
    options = EFFECTS[effect]
    if effect == "roughness" or "profile" in effect:
        eps = min(eps, 0.8)
    model = build_model(bearing(cavitation=CLOSURES[closure], **options))
    at = motion(eps, speed=speed)
    history = model.initial_history(0.97 * at)
    cases = [(None, 0.0)] if history is None else [(None, 0.0), (history, 1e-4)]
    if closure == "elrod":
        cases = cases[1:]
    for start, step in cases:
        assert worst_tangent_error(model, at, start, step) < 1e-6


@pytest.mark.parametrize("closure", CLOSURES)
def test_tangent_in_contact(closure):
    """A journal pressed into the bore, in mixed lubrication, forward and reversed; tolerance as above."""
    for effect in ("asperity", "mixed"):
        for eps, speed in ((0.99, SPEED), (1.03, -0.01 * SPEED)):
            model = build_model(bearing(cavitation=CLOSURES[closure], **EFFECTS[effect]))
            at = motion(eps, speed=speed, rate=0.01)
            history = model.initial_history(at)
            assert model.evaluate(at, history, 1e-4).quantities()["contact_load"] > 0.0
            assert worst_tangent_error(model, at, history, 1e-4) < 1e-6


@pytest.mark.parametrize("closure", CLOSURES)
def test_absent_effects_leave_every_seam_empty(closure):
    """Empty seams call nothing, see test_absent.py."""
    off = bearing(cavitation=CLOSURES[closure], asperity=None, roughness=None, profile=None, wear=None, bush=None)
    effects = build_model(off).effects
    assert (effects.gap_terms, effects.contacts, effects.flux) == ((), (), ())
    assert effects.limiter is effects.shear_factor is effects.wear is effects.liner is None


def vanishing(effect, amplitude):
    """The effect with its amplitude scaled."""
    if effect == "roughness":
        return {"roughness": ehd.PatirCheng(composite_roughness=amplitude * C, pattern=9.0)}
    if effect == "profile":
        return {"profile": ehd.OutOfRound(order=2, amplitude=amplitude * C)}
    return {"bush": ehd.ElasticLiner(thickness=amplitude * 1e-2, youngs_modulus=1e10)}


@pytest.mark.parametrize(
    ("effect", "amplitudes", "rate"),
    [
        ("profile", (4e-4, 2e-4, 1e-4), 1.0),
        ("liner", (4e-3, 2e-3, 1e-3), 1.0),
        ("roughness", (8e-4, 4e-4, 2e-4), 1.5),
    ],
)
def test_vanishing_amplitude_recovers_the_plain_film(effect, amplitudes, rate):
    """First order in the amplitude; order 1.5 by 1 + 0.87 H^-1.5 for surfaces
    with ridges along the motion. 0.06 for the next order."""
    at = motion(0.7)
    plain = build_model(bearing()).evaluate(at).wrench
    errors = [
        np.linalg.norm(build_model(bearing(**vanishing(effect, a))).evaluate(at).wrench[:2] - plain[:2])
        for a in amplitudes
    ]
    rates = np.log2(np.array(errors[:-1]) / errors[1:])
    np.testing.assert_allclose(rates, rate, atol=0.06)


def test_vanishing_isotropic_roughness_and_asperities_leave_nothing():
    """Their factors fall exponentially: at h = 60 sigma and more the force is
    the plain film's to 1e-9, the contact exactly nothing."""
    at = motion(0.7)
    plain = build_model(bearing()).evaluate(at).wrench
    small = 0.25 * C / 80
    mixed = bearing(
        asperity=ehd.GreenwoodTripp(composite_roughness=small, composite_modulus=1e11),
        roughness=ehd.PatirCheng(composite_roughness=small),
    )
    evaluation = build_model(mixed).evaluate(at)
    np.testing.assert_allclose(evaluation.wrench[:2], plain[:2], rtol=1e-9)
    assert evaluation.quantities()["contact_load"] == 0.0


@pytest.mark.parametrize("effect", EFFECTS)
def test_force_turns_with_the_model(effect):
    """Turning a whole bearing, with its profile, by a grid column turns the
    force; 1e-10 is rounding through the solver."""
    if "profile" in EFFECTS[effect]:
        options = EFFECTS[effect] | {"profile": ehd.OutOfRound(order=2, amplitude=2e-6, phase=0.0)}
        turn = math.pi
    else:
        options, turn = EFFECTS[effect], 2 * math.pi * 5 / 48
    model = build_model(bearing(**options))
    c, s = math.cos(turn), math.sin(turn)
    T = np.kron(np.eye(2), [[c, -s, 0], [s, c, 0], [0, 0, 1]])
    at = motion(0.8)
    turned = at.copy()
    for k in (0, 2, 4, 6):
        turned[k : k + 2] = [[c, -s], [s, c]] @ at[k : k + 2]
    first = model.evaluate(at).wrench
    model.forget()
    np.testing.assert_allclose(model.evaluate(turned).wrench, T @ first, atol=1e-10 * np.abs(first).max())


@pytest.mark.slow
@pytest.mark.parametrize("closure", sample(list(CLOSURES), 0, 1))
def test_random_states_in_mixed_lubrication(closure):
    """Eccentricity to 1.05 anywhere along the bearing, tilt, squeeze, reversed
    and zero speed: always a finite film and tangent."""
    rng = np.random.default_rng(11)
    for effect in ("asperity", "mixed", "worn", "liner_asperity", "liner_wall"):
        model = build_model(bearing(cavitation=CLOSURES[closure], n_theta=40, n_z=6, **EFFECTS[effect]))
        for _ in range(60):
            reach, share = 1.05 * rng.random() ** 0.3, rng.choice([0.0, rng.random()])
            at = motion(
                reach * (1 - share),
                rng.uniform(0, 6.3),
                SPEED * rng.choice([-1, 0, 0.01, 1, 5]),
                reach * share,
                rng.choice([0.0, 0.1, 1.0]),
            )
            history = model.initial_history(at)
            evaluation = model.evaluate(at, history, 1e-4)
            assert evaluation.status is ehd.Status.CONVERGED, at
            assert np.isfinite(evaluation.wrench).all() and np.isfinite(evaluation.tangent()).all()
            assert all(math.isfinite(v) for v in evaluation.quantities().values())


@pytest.mark.parametrize("effect", ["asperity", "roughness", "mixed", "worn", "liner", "profile"])
@pytest.mark.parametrize("closure", ["gumbel", "swift"])
def test_friction_takes_power(effect, closure):
    """A turning journal at rest otherwise loses power to film and contact,
    whatever its position, and the contact never gives any."""
    rng = np.random.default_rng(5)
    cavitation = ehd.Gumbel() if closure == "gumbel" else ehd.SwiftStieber()
    model = build_model(bearing(cavitation=cavitation, end_pressures=(0.0, 0.0), **EFFECTS[effect]))
    largest = 1.03 if "asperity" in EFFECTS[effect] else 0.85
    for _ in range(40):
        at = motion(largest * rng.random() ** 0.3, rng.uniform(0, 6.3), SPEED * rng.choice([-1.0, 0.02, 1.0]), rate=0.0)
        at[4:8] = 0.0
        q = model.evaluate(at).quantities()
        assert q["power_loss"] > 0.0
        assert q["contact_power_loss"] >= 0.0


@pytest.mark.parametrize("modulus", [1e9, 1e10, 1e12])
@pytest.mark.parametrize("closure", ["gumbel", "swift"])
def test_random_states_on_a_liner(closure, modulus):
    """Transient steps from the steady film nearby: eccentricity to 0.99, tilt,
    squeeze up to the journal's own speed, reversed spin."""
    rng = np.random.default_rng(23)
    bush = ehd.ElasticLiner(thickness=0.002, youngs_modulus=modulus)
    model = build_model(bearing(cavitation=CLOSURES[closure], n_theta=40, n_z=6, bush=bush))
    for _ in range(60):
        reach, share = 0.99 * rng.random() ** 0.3, rng.choice([0.0, rng.random()])
        at = motion(
            reach * (1 - share),
            rng.uniform(0, 6.3),
            SPEED * rng.choice([-1, 0.1, 1, 5]),
            0.9 * reach * share,
            rng.choice([0.0, 0.1, 1.0]),
        )
        history = model.initial_history(0.95 * at)
        evaluation = model.evaluate(at, history, rng.choice([1e-5, 1e-4, 1e-3]))
        assert evaluation.status is ehd.Status.CONVERGED, at
        assert np.isfinite(evaluation.wrench).all() and np.isfinite(evaluation.tangent()).all()
        assert evaluation.quantities()["minimum_gap"] > 0.0
