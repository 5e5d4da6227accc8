"""Results of a joint: its film at the last accepted state, pictures."""

import numpy as np
import pytest
import scenes

import exudyn_ehd as ehd
from exudyn_ehd.joint.model.build import build_model
from exudyn_ehd.status import InputError

SPEED = 300.0


def rotor(bearing):
    return scenes.loaded_journal(bearing, (300.0, -800.0, 0.0), SPEED)


def run(mbs, end_time=2e-3, steps=20):
    mbs.SolveDynamic(scenes.settings(end_time, steps, tolerance=1e-8))


@pytest.fixture(scope="module")
def finished(make_bearing):
    """A short run of a plain film."""
    mbs, joint = rotor(make_bearing(film=ehd.FiniteLength(n_theta=48, n_z=6)))
    mbs.Assemble()
    run(mbs)
    return joint


def test_film_is_that_of_the_last_row(finished):
    film, history = finished.film(), finished.history
    assert film.time == history.time[-1] == pytest.approx(2e-3)
    np.testing.assert_array_equal(film.motion, history.motion[-1])
    np.testing.assert_array_equal(film.force, history.force[-1])
    model = build_model(finished.bearing)
    again = model.evaluate(history.motion[-1]).film
    # the warm start of the joint's model changes the way to the solution, not the solution beyond rounding
    np.testing.assert_allclose(film.pressure, again.oil.P * again.scales.pressure, atol=1e-9 * film.pressure.max())
    assert film.gap.min() >= history.minimum_gap[-1]
    assert film.fill is None and film.temperature is None and film.bore_displacement is None


def test_reading_the_film_leaves_the_run_alone(make_bearing, finished):
    """A film read before and between two halves of a run changes no bit of a film without memory."""
    mbs, joint = rotor(make_bearing(film=ehd.FiniteLength(n_theta=48, n_z=6)))
    with pytest.raises(InputError, match=r"not assembled; call mbs.Assemble\(\) first"):
        joint.film()
    mbs.Assemble()
    assert joint.film().time == 0.0
    run(mbs)
    np.testing.assert_array_equal(joint.history.motion, finished.history.motion)


def test_mass_conserving_film_carries_its_fill(make_bearing):
    bearing = make_bearing(film=ehd.FiniteLength(n_theta=48, n_z=6), cavitation=ehd.ElrodAdams())
    mbs, joint = rotor(bearing)
    mbs.Assemble()
    run(mbs)
    film = joint.film()
    np.testing.assert_array_equal(film.force, joint.history.force[-1])
    assert film.fill.shape == film.pressure.shape
    assert 0.0 < film.fill.min() < 1.0
    # full where there is pressure
    assert film.fill[film.pressure > 1.0].min() > 1.0 - 1e-9


def test_film_behind_an_impedance_map(make_bearing, monkeypatch, tmp_path):
    monkeypatch.setenv("EXUDYN_EHD_CACHE", str(tmp_path))
    table = ehd.ImpedanceMap(n_theta=64, n_eccentricity=21, n_direction=41)
    mbs, joint = rotor(make_bearing(film=table))
    mbs.Assemble()
    run(mbs)
    film = joint.film()
    assert film.pressure.shape == (64, 11)
    # the error of so coarse a map, mostly the film's ripple with the grid
    np.testing.assert_allclose(film.force[:2], joint.history.force[-1, :2], rtol=0.02)


@pytest.mark.slow
def test_pictures_of_a_joint(finished, tmp_path):
    for draw in ("plot_pressure", "plot_gap", "plot_bearing", "plot_orbit", "plot_load", "plot_traces"):
        getattr(finished, draw)(path=tmp_path / f"{draw}.png")
        assert (tmp_path / f"{draw}.png").stat().st_size > 5_000
    (ax,) = finished.plot_orbit().axes
    line = next(one for one in ax.lines if one.get_label() == "mid-plane")
    np.testing.assert_allclose(np.column_stack(line.get_data()), 1e6 * finished.history.eccentricity, rtol=1e-12)
    with pytest.raises(InputError, match="no film fraction"):
        finished.plot_fill()
