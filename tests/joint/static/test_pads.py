"""`TiltingPads` and `equilibrium` with them."""

import dataclasses
import itertools
import warnings

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.joint.static.pads import Pad

PLAIN = {
    "journal_radius": 0.05,
    "length": 0.05,
    "radial_clearance": 60e-6,
    "lubricant": ehd.Lubricant(viscosity=0.02),
    "pad_thickness": 0.015,
}
PADS = ehd.TiltingPads(**PLAIN, preload=0.4, pad_mass=0.3, pad_inertia=1e-4)
SPEED, LOAD = 300.0, 4000.0


def rotation(angle):
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s], [s, c]])


def loads(pad, u, u_t=None):
    """Forces on x and y of the journal, on tilt and shift of a pad, from the wrench of its film alone."""
    phi = np.exp(1j * np.arctan2(pad.radial[1], pad.radial[0]))
    pivot = complex(*pad.pivot)

    def place(u):
        return np.exp(-1j * u[2]) * (complex(u[0], u[1]) - pivot - u[3] * phi) + pad.arm * phi

    u_t, step = np.zeros(4) if u_t is None else u_t, 1e-4
    p, p_t = place(u), (place(u + step * u_t) - place(u - step * u_t)) / (2.0 * step)
    motion = np.array([p.real, p.imag, 0, 0, p_t.real, p_t.imag, 0, 0, pad.speed - u_t[2], 0.0])
    wrench = pad.model.evaluate(motion).wrench
    force = np.exp(1j * u[2]) * complex(wrench[0], wrench[1])
    # the pad gets the opposite force and moment about its centre of curvature
    lever = -pad.arm * phi * np.exp(1j * u[2])
    about_pivot = -wrench[5] - (np.conj(lever) * force).imag
    outward = -(np.conj(phi) * force).real - pad.stiffness * u[3]
    return np.array([force.real, force.imag, about_pivot, outward])


@pytest.mark.parametrize("seed", range(6))
def test_tangents_against_differences(seed):
    rng = np.random.default_rng(seed)
    pads = dataclasses.replace(
        PADS,
        pivot_offset=rng.uniform(0.4, 0.65),
        pivot_stiffness=None if seed % 2 else 3e8,
        first_pivot=rng.uniform(-3.0, 3.0),
        edge_pressures=(2e4, 1e4) if seed > 3 else (0.0, 0.0),
    )
    pad = Pad(pads, int(rng.integers(5)), rng.choice([-1.0, 1.0]) * SPEED)
    across = np.sign(pad.speed) * 2e-5 / pad.arm
    place = 1e-5 * rng.uniform(-1.0, 1.0, 2) + 1e-5 * pad.radial
    u = np.array([*place, across * rng.uniform(0.5, 1.5), 2e-6])
    found = pad.at(u[:2], u[3], u[2])
    np.testing.assert_allclose(found.forces, loads(pad, u), rtol=1e-12, atol=1e-9)
    assert np.abs(found.forces[:2]).max() > 10.0
    units = np.array([1.0, 1.0, 1.0 / pad.arm, 1.0])
    scale = np.outer(1.0 / units, 1.0 / units)
    for matrix, step, rates in ((found.stiffness, 2e-9, False), (found.damping, 1e-6, True)):
        columns = []
        for k, unit in enumerate(units):
            d = step * unit * np.eye(4)[k]
            ends = [loads(pad, u, sign * d) if rates else loads(pad, u + sign * d) for sign in (1.0, -1.0)]
            columns.append((ends[1] - ends[0]) / (2.0 * step * unit))
        error = np.abs(matrix - np.transpose(columns)) / scale
        assert error.max() < 2e-5 * np.abs(matrix / scale).max()


@pytest.mark.parametrize("between, stiffness", [*itertools.product((True, False), (None, 4e8))])
def test_load_on_and_between_pads(between, stiffness):
    pads = dataclasses.replace(PADS, load_between_pads=between, pivot_stiffness=stiffness)
    rest = ehd.equilibrium(pads, speed=SPEED, load=(0.0, -LOAD))
    assert rest.residual < 1e-8
    on_pad = np.isclose(np.cos(pads.pivots + 0.5 * np.pi), 1.0)
    assert on_pad.sum() == (0 if between else 1)
    # the journal moves along the load, as pads hardly couple: shear turns it by less than a hundredth
    assert abs(rest.position[0]) < 0.01 * abs(rest.position[1])
    # every pad's film pushes its pivot
    directions = np.array([np.cos(pads.pivots), np.sin(pads.pivots)])
    assert directions @ rest.pad_forces == pytest.approx([0.0, -LOAD], abs=0.005 * LOAD)
    largest = np.sort(rest.pad_forces)[::-1]
    assert largest[1] == pytest.approx(largest[0], rel=0.02) if between else largest[1] < 0.5 * largest[0]
    expected = np.zeros(5) if stiffness is None else rest.pad_forces / stiffness
    assert rest.pivot_displacements == pytest.approx(expected, abs=1e-12)
    # a load on one pad stiffens its direction more than one between two pads
    K, C = rest.reduced()
    assert (K[1, 1] / K[0, 0] < 1.7) == between
    assert np.all(np.linalg.eigvalsh(K + K.T) > 0.0) and np.all(np.linalg.eigvalsh(C + C.T) > 0.0)


def test_preload_keeps_all_pads_loaded():
    """Without preload the pads above a heavy journal are unloaded; with it they push back and stiffen the bearing."""
    found = [
        ehd.equilibrium(dataclasses.replace(PADS, preload=m), speed=SPEED, load=(0.0, -LOAD)) for m in (0.0, 0.2, 0.5)
    ]
    assert [rest.loaded.sum() for rest in found] == [2, 4, 5]
    sway = [rest.reduced()[0][0, 0] for rest in found]
    assert sway[0] < sway[1] < sway[2]
    gap = dataclasses.replace(PADS, preload=0.5)
    assert gap.machined_clearance == pytest.approx(2.0 * gap.radial_clearance)
    # the gap at the pivot of a concentric journal is the assembled clearance
    pad = Pad(gap, 0, SPEED)
    a = pad.radial @ pad.place(np.zeros(2), 0.0, 0.0)
    assert gap.machined_clearance - a == pytest.approx(gap.radial_clearance, rel=1e-9)


def test_unloaded_pads_are_reported():
    pads = dataclasses.replace(PADS, preload=0.0)
    with pytest.warns(UserWarning, match="no pad is loaded"):
        rest = ehd.equilibrium(pads, speed=SPEED, load=(0.0, 0.0))
    assert not rest.loaded.any()
    numbers = (rest.position, rest.tilts, rest.minimum_gaps, rest.stiffness, rest.damping, *rest.reduced())
    assert all(np.isfinite(part).all() for part in numbers)
    heavy = ehd.equilibrium(pads, speed=SPEED, load=(0.0, -10 * LOAD))
    assert heavy.loaded.tolist() == [True, False, False, False, True]
    assert repr(heavy).endswith("unloaded pads 2, 3, 4>")
    above = [film for film, loaded in zip(heavy.films, heavy.loaded, strict=True) if not loaded]
    # their films press nowhere, and widen along the motion
    for film in above:
        assert film.peak_pressure == 0.0
        assert np.all(np.diff(film.gap[:, 0]) > -1e-12)
    # what hardly carries is tipped over by its shear
    with pytest.raises(ehd.FilmError, match="tipped over by friction"):
        ehd.equilibrium(pads, speed=SPEED, load=(0.0, -1.0))


@pytest.mark.slow
def test_a_pad_that_would_carry_too_little_is_tipped_over():
    """On flexible pivots the upper pad carries 96 N, and less at no position: under more load it is unloaded."""
    pads = dataclasses.replace(PADS, pivot_stiffness=3e8, film=ehd.FiniteLength(n_theta=64, n_z=6))
    found = [ehd.equilibrium(pads, speed=SPEED, load=(1000.0 * f, -4000.0 * f)) for f in (0.8, 0.85, 0.9)]
    assert [rest.loaded[2] for rest in found] == [True, False, False]
    assert found[0].pad_forces[2] > 50.0 > 1.0 > found[1].pad_forces[2]
    assert all(rest.residual < 1e-8 for rest in found)


def test_contact_holds_a_pad_that_sprags():
    wall = ehd.RegularisedWall(onset=3e-6)
    rest = ehd.equilibrium(dataclasses.replace(PADS, preload=0.0, contact=wall), speed=SPEED, load=(0.0, -LOAD))
    assert rest.loaded.all()
    # it rests on its leading edge
    assert rest.minimum_gaps[2] < 3e-6
    assert np.argmin(rest.films[2].gap[:, 5]) == 0


@pytest.mark.filterwarnings("error")
def test_turns_and_mirrors():
    pads = dataclasses.replace(PADS, pivot_stiffness=3e8, pivot_offset=0.6)
    base = ehd.equilibrium(pads, speed=SPEED, load=(1000.0, -LOAD))
    turn = rotation(7.0)
    turned = dataclasses.replace(pads, first_pivot=pads.pivots[0] + 7.0)
    rest = ehd.equilibrium(turned, speed=SPEED, load=tuple(turn @ [1000.0, -LOAD]))
    assert rest.position == pytest.approx(turn @ base.position, rel=1e-6)
    assert rest.tilts == pytest.approx(base.tilts, rel=1e-6)
    for one, other in zip(rest.reduced(200.0), base.reduced(200.0), strict=True):
        assert one == pytest.approx(turn @ other @ turn.T, rel=1e-5, abs=1e-6 * np.abs(other).max())
    # seen from behind, the spin is negative, and the pivots count from the other edge
    mirror = dataclasses.replace(pads, pivot_offset=0.4, first_pivot=np.pi - pads.pivots[0])
    rest = ehd.equilibrium(mirror, speed=-SPEED, load=(-1000.0, -LOAD))
    assert rest.position == pytest.approx([-1.0, 1.0] * base.position, rel=1e-6)
    assert np.sort(rest.tilts) == pytest.approx(np.sort(-base.tilts), rel=1e-6)
    assert rest.power_loss == pytest.approx(base.power_loss, rel=1e-9)


def test_reduced_matrices_eliminate_the_pads():
    pads = dataclasses.replace(PADS, preload=0.5, pivot_stiffness=1e9)
    rest = ehd.equilibrium(pads, speed=SPEED, load=(0.0, -LOAD))
    assert rest.loaded.all()
    assert rest.coordinates == ("x", "y", *(f"{what} {k}" for what in ("tilt", "shift") for k in range(1, 6)))
    assert np.diag(rest.mass).tolist() == [0.0, 0.0, *[1e-4] * 5, *[0.3] * 5]
    nu = 700.0
    Z = rest.stiffness + 1j * nu * rest.damping - nu**2 * rest.mass
    # the journal's compliance with free pads is that of the whole
    compliance = np.linalg.inv(Z)[:2, :2]
    K, C = rest.reduced(nu)
    np.testing.assert_allclose(np.linalg.inv(K + 1j * nu * C), compliance, rtol=1e-8, atol=1e-9 * abs(compliance).max())
    # slow motions: the journal's position under a little more load
    more = ehd.equilibrium(pads, speed=SPEED, load=(1.0, -LOAD - 1.0))
    assert more.position - rest.position == pytest.approx(np.linalg.solve(rest.reduced(1e-3)[0], [1.0, -1.0]), rel=1e-3)
    assert rest.reduced()[1] == pytest.approx(rest.reduced(SPEED)[1])


@pytest.mark.parametrize(
    "change, message",
    [
        ({"pads": 2}, "TiltingPads.pads must be an integer >= 3"),
        ({"extent": 1.3}, "TiltingPads.extent: 5 pads of 1.3 rad overlap; take at most 4 pads of this extent"),
        ({"extent": 60.0}, "TiltingPads.extent must be between"),
        ({"preload": 1.0}, "TiltingPads.preload must be between 0 and 1"),
        ({"preload": -0.1}, "TiltingPads.preload must be >= 0"),
        ({"pivot_offset": 0.0}, "TiltingPads.pivot_offset must be > 0"),
        ({"pivot_offset": 1.0}, "TiltingPads.pivot_offset must be between 0 and 1"),
        ({"pad_thickness": -0.01}, "TiltingPads.pad_thickness must be >= 0 m"),
        ({"pivot_stiffness": 0.0}, "TiltingPads.pivot_stiffness must be > 0 N/m"),
        ({"pad_mass": -1.0}, "TiltingPads.pad_mass must be >= 0 kg"),
        ({"edge_pressures": 1e5}, "TiltingPads.edge_pressures must be 2 finite numbers in Pa"),
        ({"pads": 10**400}, "TiltingPads.pads must be between 3 and 20000"),
        (
            {"radial_clearance": 60e-3},
            "TiltingPads: a pad has no film: JournalBearing.radial_clearance must be at most",
        ),
        ({"film": ehd.ShortBearing()}, "TiltingPads: a pad has no film: .* JournalBearing.film"),
    ],
)
def test_bad_pads_by_name(change, message):
    with pytest.raises(ehd.InputError, match=message):
        ehd.TiltingPads(**PLAIN | change)


def test_bad_questions_by_name():
    with pytest.raises(TypeError, match="pad_thickness"):
        ehd.TiltingPads(**{name: value for name, value in PLAIN.items() if name != "pad_thickness"})
    with pytest.raises(ehd.InputError, match="not for TiltingPads"):
        ehd.equilibrium(PADS, speed=SPEED, load=(0.0, -LOAD), tilt=(1e-4, 0.0))
    with pytest.raises(ehd.InputError, match="speed must not be zero"):
        ehd.equilibrium(PADS, speed=0.0, load=(0.0, -LOAD))
    rest = ehd.equilibrium(PADS, speed=SPEED, load=(0.0, -LOAD))
    for frequency in (0.0, np.nan):
        with pytest.raises(ehd.InputError, match="frequency"):
            rest.reduced(frequency)


HEAT = {"lumped": ehd.LumpedThermal(supply_temperature=313.0), "field": ehd.FilmEnergy(supply_temperature=313.0)}


@pytest.mark.parametrize("name", ["lumped", pytest.param("field", marks=pytest.mark.slow)])
def test_heat_of_every_pad_is_that_of_its_film(name):
    """Every film has the temperature and the force of a fixed pad in its place, and colder oil carries more."""
    pads = dataclasses.replace(PADS, lubricant=ehd.oil("ISO VG 46"), film=ehd.FiniteLength(n_theta=64, n_z=6))
    hot = dataclasses.replace(pads, thermal=HEAT[name])
    cold, rest = (ehd.equilibrium(p, speed=SPEED, load=(0.0, -LOAD)) for p in (pads, hot))
    assert rest.minimum_gap < 0.9 * cold.minimum_gap
    assert rest.residual < 1e-9
    for k, film in enumerate(rest.films):
        x, y = film.motion[:2]
        alone = ehd.steady(
            hot.pad(k),
            speed=SPEED,
            eccentricity_ratio=np.hypot(x, y) / hot.machined_clearance,
            direction=float(np.arctan2(y, x)),
        )
        assert film.peak_temperature == pytest.approx(alone.peak_temperature, abs=1e-4)
        np.testing.assert_allclose(film.force, alone.force, rtol=0, atol=1e-6 * LOAD)
    assert np.ptp([film.peak_temperature for film in rest.films]) > 1.0


def slowly(rest):
    """Eigenvalues of the journal's stiffness for slow motions."""
    return np.linalg.eigvals(rest.reduced(1e-3 * abs(rest.speed))[0]).real


@pytest.mark.slow
def test_a_journal_falls_off_a_single_pad():
    """Three pads of little preload, and a load about the pivot of one of them: a second one carries as well."""
    three = ehd.TiltingPads(**PLAIN, pads=3, extent=1.42, preload=0.02, pivot_stiffness=3e8)
    rest = ehd.equilibrium(three, speed=SPEED, load=(635 * np.sin(1.041), -635 * np.cos(1.041)))
    assert rest.residual < 1e-8 and slowly(rest).min() > 0.0


@pytest.mark.parametrize("seed", [pytest.param(k, marks=[pytest.mark.slow] if k > 3 else []) for k in range(24)])
def test_no_unstable_position_without_a_word(seed):
    rng = np.random.default_rng(100 + seed)
    count, force = int(rng.integers(3, 6)), 10 ** rng.uniform(2.0, 4.3)
    shape = {"extent": 2.0 * np.pi / count * rng.uniform(0.5, 0.9), "preload": rng.uniform(0.0, 0.3)}
    pivot = 10 ** rng.uniform(0.0, 2.0) * force / 60e-6 if rng.random() < 0.4 else None
    pads = ehd.TiltingPads(**PLAIN, pads=count, **shape, pivot_stiffness=pivot)
    angle = rng.choice([0.0, np.pi / count]) + 0.03 * rng.normal()
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        try:
            rest = ehd.equilibrium(pads, speed=SPEED, load=(force * np.sin(angle), -force * np.cos(angle)))
        except ehd.FilmError:
            return
    said = [str(warning.message) for warning in told]
    assert any("rests unstably" in text or "no pad is loaded" in text for text in said) or slowly(rest).min() > 0.0


@pytest.mark.slow
def test_an_unstable_position_is_returned_with_a_warning():
    three = dataclasses.replace(PADS, pads=3, extent=1.3, preload=0.05)
    with pytest.warns(UserWarning, match="rests unstably"):
        rest = ehd.equilibrium(three, speed=SPEED, load=(2222.0, -1333.0))
    assert rest.residual < 1e-8 and slowly(rest).min() < 0.0
