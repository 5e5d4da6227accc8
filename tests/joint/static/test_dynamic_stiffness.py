"""Dynamic stiffness of mass-conserving films: limits, and the film's own response to a forced motion in time."""

import math

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.joint.model.build import build_study_model
from exudyn_ehd.joint.static.dynamic_stiffness import LOADS, response_of
from tests.sampling import but_slow, sample

R, L, C, SPEED, VISCOSITY = 0.025, 0.025, 25e-6, 300.0, 0.02
ELROD = ehd.ElrodAdams(cavity_pressure=-1e5)


def bearing(cavitation=ELROD, film=(96, 10), oil=None, **options):
    return ehd.JournalBearing(
        journal_radius=R,
        length=L,
        radial_clearance=C,
        lubricant=ehd.Lubricant(viscosity=VISCOSITY, **(oil or {})),
        cavitation=cavitation,
        film=ehd.FiniteLength(n_theta=film[0], n_z=film[1]),
        **options,
    )


def at_load(made, sommerfeld, angle=0.1):
    load = sommerfeld * 2 * R * L * VISCOSITY * SPEED / (C / R) ** 2
    return ehd.equilibrium(made, speed=SPEED, load=(load * math.cos(angle), load * math.sin(angle)))


def forced(made, position, frequency, steps, amplitude=1e-4, periods=5):
    """Z (2, 2) from motions along x and y, the film's oil from step to step."""
    model = build_study_model(made, 0.0)
    out, step = np.zeros((2, 2), complex), 2 * math.pi / frequency / steps
    for axis in (0, 1):
        motion = np.zeros(10)
        motion[:2], motion[8] = position, SPEED
        history, forces = model.evaluate(motion).history(), []
        times = step * np.arange(1, steps * periods + 1)
        for t in times:
            motion[:2] = position
            motion[axis] += amplitude * C * math.sin(frequency * t)
            motion[4:6] = 0.0
            motion[4 + axis] = amplitude * C * frequency * math.cos(frequency * t)
            evaluation = model.evaluate(motion, history, step)
            history = evaluation.history()
            forces.append(evaluation.wrench[:2])
        last = frequency * times[-steps:]
        parts = np.column_stack([np.sin(last), np.cos(last), np.ones(steps)])
        sine, cosine, _ = np.linalg.lstsq(parts, np.array(forces[-steps:]), rcond=None)[0]
        out[:, axis] = -(sine + 1j * cosine) / (amplitude * C)
    return out


SCENES = {
    "plain": {},
    "density": {"oil": {"density_law": ehd.DowsonHigginson()}},
    "barus": {"oil": {"pressure_law": ehd.BarusPressure(coefficient=2e-8)}},
    "rough": {"roughness": ehd.PatirCheng(composite_roughness=2e-6)},
    "turbulent": {"turbulence": ehd.Hirs(onset=8.0, full=24.0, coefficient=2.0)},
    "groove": {
        "cavitation": ehd.ElrodAdams(),
        "supply": (ehd.AxialGroove(angle=2.0, width_angle=0.5, length=0.02, pressure=1e5),),
    },
    "line in its cells": {"cavitation": ehd.ElrodAdams(cavity_pressure=-1e5, line_in_cells=True)},
    "shallow, line in its cells": {
        "cavitation": ehd.ElrodAdams(cavity_pressure=-1e5, line_in_cells=True),
        "contact": ehd.RegularisedWall(onset=1.2e-5),
    },
    "shallow": {"contact": ehd.RegularisedWall(onset=1.2e-5)},
    "shear, line in its cells": {
        "cavitation": ehd.ElrodAdams(cavity_pressure=-1e5, line_in_cells=True),
        "oil": {"shear_law": ehd.CarreauShear(relaxation_time=2e-6, exponent=0.6)},
    },
}


@pytest.mark.slow
@pytest.mark.parametrize("scene", SCENES)
def test_response_is_that_of_the_film_in_time(scene):
    """Backward Euler's error is of first order in the step: extrapolated, it leaves some thousandths."""
    made = bearing(**SCENES[scene])
    result = at_load(made, 0.3)
    for ratio in (0.3, 0.5):
        coarse, fine = (forced(made, result.position, ratio * SPEED, n) for n in (240, 480))
        (expected,) = result.dynamic_stiffness([ratio * SPEED])
        assert np.abs(2 * fine - coarse - expected).max() < 3e-3 * np.abs(expected).max()


def test_a_film_at_rest_is_the_steady_one_in_time():
    """The journal stands still: steps of any length change nothing, wherever the line lies in its cell."""
    model, rng, below = (
        build_study_model(bearing(**SCENES["line in its cells"], film=(48, 6)), 0.0),
        np.random.default_rng(4),
        0,
    )
    for _ in range(12):
        motion, e, a = np.zeros(10), rng.uniform(0.3, 0.9), rng.uniform(0.0, 2.0 * math.pi)
        motion[:2], motion[8] = e * C * np.array([math.cos(a), math.sin(a)]), SPEED
        steady = model.evaluate(motion)
        history, force = steady.history(), steady.wrench
        below += int((model.solver.oil_line.s < 0.25).any())
        # round-off of one film solve against another; then the fills of the vertices, as exact as their search is
        for limit in (1e-11, 1e-7):
            later = model.evaluate(motion, history, 10.0 ** rng.uniform(-5.0, -2.0))
            history = later.history()
            assert np.abs(later.wrench - force).max() < limit * np.abs(force).max()
    assert below > 3


LINERS = {
    "plain": {},
    "density": {"oil": {"density_law": ehd.DowsonHigginson(coefficient=5e-9)}},
    "shear": {"oil": {"shear_law": ehd.CarreauShear(relaxation_time=2e-6, exponent=0.6)}},
    "rough": {"asperity": ehd.GreenwoodTripp(composite_roughness=1.5e-6, composite_modulus=2e9)},
}
LINERS |= {
    f"{name}, line in its cells": {**scene, "cavitation": ehd.ElrodAdams(cavity_pressure=-1e5, line_in_cells=True)}
    for name, scene in LINERS.items()
}


IN_CELLS = [f"{name}, line in its cells" for name in ("density", "shear", "rough")]


@pytest.mark.parametrize("scene", but_slow(LINERS, *IN_CELLS))
def test_response_on_a_liner_is_that_of_the_film_in_time(scene):
    """Slow: the steady film's stiffness; at half the spin: steps, extrapolated; the threshold is where Z has it."""
    made = bearing(film=(48, 6), bush=ehd.ElasticLiner(thickness=1e-3, youngs_modulus=1e9), **LINERS[scene])
    result = at_load(made, 0.9 if scene.startswith("rough") else 0.35)
    coarse, fine = (forced(made, result.position, 0.5 * SPEED, n) for n in (120, 240))
    slow, half = result.dynamic_stiffness([0.0, 0.5 * SPEED])
    assert np.abs(2 * fine - coarse - half).max() < 1e-3 * np.abs(half).max()
    step, columns = 1e-4 * C, []
    for shift in step * np.eye(2):
        ends = [result.position + sign * shift for sign in (1.0, -1.0)]
        places = [(math.hypot(*end) / C, math.atan2(end[1], end[0])) for end in ends]
        force = [ehd.steady(made, speed=SPEED, eccentricity_ratio=e, direction=d).force[:2] for e, d in places]
        columns.append((force[1] - force[0]) / (2.0 * step))
    assert np.abs(np.transpose(columns) - slow).max() < 1e-3 * np.abs(slow).max()
    assert result.frequency == result.whirl_ratio * SPEED
    assert result.critical_mass_error < math.inf


@pytest.mark.parametrize("line_in_cells", [True, False])
def test_slow_motions_meet_the_damping_of_a_liner_on_which_surfaces_touch(line_in_cells):
    """First derivative of Z to the frequency, of a film without account of its oil: the damping of slow motions."""
    asperity = ehd.GreenwoodTripp(composite_roughness=2e-6, composite_modulus=1e11)
    liner = ehd.ElasticLiner(thickness=1e-3, youngs_modulus=1e9)
    closure = ehd.SwiftStieber(cavity_pressure=-5e4, line_in_cells=line_in_cells)
    model = build_study_model(bearing(film=(48, 6), bush=liner, asperity=asperity, cavitation=closure), 0.0)
    follows = 0.0
    for eccentricity in (0.6, 0.9, 1.1):
        motion = np.append(eccentricity * C * np.array([0.8, -0.6]), np.zeros(8))
        motion[8] = SPEED
        film = model.evaluate_steady(motion)
        (stiffness, damping), response = response_of(film)
        low, double = (response.at(nu).imag / nu for nu in (1e-3 * SPEED, 2e-3 * SPEED))
        assert response.at(0.0).real == pytest.approx(stiffness, rel=1e-12, abs=1e-12 * np.abs(stiffness).max())
        assert np.abs((4.0 * low - double) / 3.0 - damping).max() < 1e-9 * np.abs(damping).max()
        follows = max(follows, float(np.abs(film.film.parts.liner.gap_slopes.D_r).max()))
    # the contact is no softer than the liner
    assert follows > 0.3


def test_on_a_hard_liner_as_on_a_rigid_bore():
    hard = ehd.ElasticLiner(thickness=1e-3, youngs_modulus=1e16)
    rigid, lined = (at_load(bearing(film=(48, 6), bush=bush), 0.35) for bush in (None, hard))
    nu = [1e-3, 0.5 * SPEED, 2.0 * SPEED]
    np.testing.assert_allclose(lined.dynamic_stiffness(nu), rigid.dynamic_stiffness(nu), rtol=1e-5)
    for name in ("stiffness", "damping", "frequency", "whirl_ratio", "critical_mass", "critical_mass_error"):
        np.testing.assert_allclose(getattr(lined, name), getattr(rigid, name), rtol=1e-5, err_msg=name)


@pytest.mark.parametrize("scene", but_slow(SCENES, "plain", "rough", "turbulent", "groove", "shear, line in its cells"))
def test_slow_and_fast_limits(scene):
    """Slow: the steady film's stiffness, by differences of its force. Fast: the damping of a sudden velocity."""
    made = bearing(**SCENES[scene])
    result = at_load(made, 0.3)
    slow, fast = result.dynamic_stiffness([0.0, 1e6 * SPEED])
    assert np.abs(slow.imag).max() == 0.0
    step = 1e-5 * C
    for axis in (0, 1):
        forces = []
        for sign in (1.0, -1.0):
            x, y = result.position + sign * step * np.eye(2)[axis]
            film = ehd.steady(made, speed=SPEED, eccentricity_ratio=math.hypot(x, y) / C, direction=math.atan2(y, x))
            forces.append(film.force[:2])
        slope = -(forces[0] - forces[1]) / (2 * step)
        assert np.abs(slope - slow[:, axis].real).max() < 1e-4 * np.abs(slow).max()
    model = build_study_model(made, 0.0)
    motion = np.zeros(10)
    motion[:2], motion[8] = result.position, SPEED
    sudden = -model.evaluate(motion, model.evaluate(motion).history()).tangent()[:2, 4:6]
    if made.lubricant.density_law is None:
        assert np.abs(fast.imag / (1e6 * SPEED) - sudden).max() < 1e-3 * np.abs(sudden).max()


@pytest.mark.parametrize("tilt", [(0.0, 0.0), (3e-4, -2e-4)])
def test_slow_and_fast_limits_of_tilts(tilt):
    """Places and slopes together: slow by the steady tangent's columns, fast by those of a sudden motion."""
    model, motion = build_study_model(bearing(film=(48, 6)), 0.0), np.zeros(10)
    motion[:4], motion[8] = (0.3 * C, -0.4 * C, *tilt), SPEED
    sizes = np.outer([1.0, 1.0, L, L], [1.0, 1.0, L, L])
    (stiffness, _), response = response_of(model.evaluate(motion))
    scale = np.abs(stiffness / sizes).max() * sizes
    sudden = -LOADS @ model.evaluate(motion, model.evaluate(motion).history()).tangent()
    assert np.all(np.abs(response.at(0.0) - stiffness) < 1e-10 * scale)
    slow, fast = 1e-4 * SPEED, 1e7 * SPEED
    model.evaluate(motion)
    assert np.abs((response.at(fast).imag / fast - sudden[:, 4:8]) / sizes).max() < 1e-4 * np.abs(sudden[:2, 4:6]).max()
    for k in range(4):
        forces = [
            LOADS @ model.evaluate(motion + sign * np.eye(10)[k] * (1e-5 * C if k < 2 else 1e-5 * C / L)).wrench
            for sign in (1.0, -1.0)
        ]
        slope = (forces[1] - forces[0]) / (2e-5 * C if k < 2 else 2e-5 * C / L)
        assert np.all(np.abs(response.at(slow).real[:, k] - slope) < 2e-3 * scale[:, k]), k


def test_without_memory_there_is_one_stiffness_and_one_damping():
    result = at_load(bearing(ehd.SwiftStieber()), 0.3)
    assert result.frequency == 0.0
    nu = np.array([0.0, 100.0, 700.0])
    expected = result.stiffness + 1j * nu[:, None, None] * result.damping
    assert np.array_equal(result.dynamic_stiffness(nu), expected)


@pytest.mark.parametrize("sommerfeld", sample([0.1, 0.3, 1.0], 1))
def test_threshold_is_where_the_returned_matrices_have_theirs(sommerfeld):
    """det(K + i nu C - M nu^2) = 0 with K and C at nu, and a load in another direction changes nothing."""
    result = at_load(bearing(), sommerfeld)
    nu = result.whirl_ratio * SPEED
    assert result.frequency == nu
    (Z,) = result.dynamic_stiffness([nu])
    assert np.allclose(result.stiffness + 1j * nu * result.damping, Z, rtol=1e-12)
    values = np.linalg.eigvals(Z)
    real = values[np.argmin(np.abs(values.imag))]
    assert abs(real.imag) < 1e-6 * abs(real)
    assert real.real / nu**2 == pytest.approx(result.critical_mass, rel=1e-9)
    turned = at_load(bearing(), sommerfeld, angle=0.1 + math.pi / 2)
    assert turned.critical_mass == pytest.approx(result.critical_mass, rel=1e-6)


def test_frequencies_are_checked():
    result = at_load(bearing(), 0.3)
    with pytest.raises(ehd.InputError, match=r"frequencies must be a list of finite numbers in rad/s"):
        result.dynamic_stiffness([math.nan])
    assert result.dynamic_stiffness([]).shape == (0, 2, 2)


@pytest.mark.parametrize(("volume", "youngs_modulus"), sample([(1e-7, 1e9), (1e-6, 5e9), (1e-5, 1e9)], 1))
def test_threshold_with_pockets_on_a_liner_is_the_same_with_the_line_in_its_cells(volume, youngs_modulus):
    """Frequencies far above the pockets' rates, at which nothing vibrates, tell no threshold."""
    orifice = ehd.Orifice(diameter=7e-4, supply_pressure=1e6, compressible_volume=volume, bulk_modulus=1e9)
    pockets = tuple(ehd.Pocket(angle=a, width_angle=0.8, length=0.012, supply=orifice) for a in (5.5, 2.4))
    liner = ehd.ElasticLiner(thickness=1e-3, youngs_modulus=youngs_modulus)
    found = [
        at_load(
            bearing(ehd.ElrodAdams(cavity_pressure=-1e5, line_in_cells=line), (48, 6), bush=liner, supply=pockets), 0.3
        )
        for line in (False, True)
    ]
    # errors of the coarse grid with the line on its vertices
    assert found[0].critical_mass == pytest.approx(found[1].critical_mass, rel=0.1)
    assert found[0].whirl_ratio == pytest.approx(found[1].whirl_ratio, rel=0.05)
    assert found[0].whirl_ratio < 1.0
