"""Film grids: metrics, weights, halving, validation."""

from __future__ import annotations

import numpy as np
import pytest

from exudyn_ehd import FiniteLength, InputError, ShortBearing, bearing_grid, slider_grid
from exudyn_ehd.film.grid import axial_vertices


@pytest.mark.parametrize("stretch", (0.0, 0.5, 0.75, 0.95))
@pytest.mark.parametrize("n_z", (4, 5, 6, 7, 10, 16))
def test_axial_weights_integrate_an_even_quartic_exactly_and_converge(n_z, stretch):
    z, w = axial_vertices(n_z, 0.8, stretch)
    assert z.size == n_z + 1
    assert z[0] == -0.8
    assert z[-1] == 0.8
    assert (np.diff(z) > 0).all()
    assert (w > 0).all()
    np.testing.assert_allclose(z, -z[::-1], atol=1e-15)
    np.testing.assert_allclose(w, w[::-1], rtol=1e-12)
    for power in (0, 2, 4):
        assert (w * z**power).sum() == pytest.approx(2 * 0.8 ** (power + 1) / (power + 1), rel=1e-12)


def test_axial_weights_are_of_fourth_order():
    errors = []
    for n_z in (12, 24, 48):
        z, w = axial_vertices(n_z, 1.0, 0.75)
        errors.append(abs((w * np.cosh(3.0 * z)).sum() - 2.0 * np.sinh(3.0) / 3.0))
    slopes = np.log2(np.array(errors[:-1]) / errors[1:])
    assert (slopes > 3.5).all(), slopes


@pytest.mark.parametrize("n_z", (1, 2, 3))
def test_few_intervals_use_the_trapezoidal_rule(n_z):
    z, w = axial_vertices(n_z, 0.5, 0.75)
    assert w.sum() == pytest.approx(1.0, rel=1e-14)
    assert (w * z).sum() == pytest.approx(0.0, abs=1e-15)


def test_stretching_refines_towards_the_ends():
    z, _ = axial_vertices(10, 1.0, 0.75)
    steps = np.diff(z)
    assert (np.diff(steps[:5]) > 0).all()


def test_bearing_grid_metric():
    g = bearing_grid(0.03, 0.06, 24, 6, start_angle=0.5)
    assert g.shape == (24, 7)
    assert g.reference_length == 0.03
    np.testing.assert_allclose(g.x, 0.5 + 2 * np.pi * np.arange(24) / 24)
    np.testing.assert_allclose(g.x_face - g.x, np.pi / 24, rtol=1e-12)
    assert g.width_x.sum() == pytest.approx(2 * np.pi)
    assert g.width_z.sum() == pytest.approx(2.0)
    assert g.weight.sum() == pytest.approx(4 * np.pi, rel=1e-12)
    np.testing.assert_allclose(g.link_x * g.width_x, 1.0)
    np.testing.assert_allclose(g.link_z * np.diff(g.z), 1.0)
    assert g.fixed[:, [0, -1]].all()
    assert not g.fixed[:, 1:-1].any()
    assert bearing_grid(0.03, 0.06, 24, 6, open_ring=True).fixed[0].all()


def test_slider_grid():
    g = slider_grid(0.1, 0.05, 10, 6)
    assert g.shape == (12, 7)
    assert g.x[0] == 0.0
    assert g.x[-1] == pytest.approx(1.0)
    assert g.width_x[0] == g.width_x[-1] == 0.0
    assert g.link_x[-1] == 0.0  # no link from the outlet back to the inlet
    assert g.width_x.sum() == pytest.approx(1.0)
    assert g.weight.sum() == pytest.approx(0.5, rel=1e-12)
    assert g.fixed[[0, -1]].all()
    assert g.fixed[:, [0, -1]].all()
    sealed = slider_grid(0.1, 0.05, 10, 1, sealed_sides=True, reference_length=0.05)
    assert not sealed.fixed[1:-1].any()
    assert sealed.weight.sum() * 0.05**2 == pytest.approx(0.1 * 0.05, rel=1e-12)


@pytest.mark.parametrize("spec", (FiniteLength, ShortBearing))
@pytest.mark.parametrize(
    "options",
    [
        {"n_theta": 15},
        {"n_z": 3},
        {"n_theta": 32.0},
        {"n_theta": True},
        {"n_z": "8"},
        {"stretch": -0.1},
        {"stretch": 0.96},
        {"stretch": float("nan")},
    ],
)
def test_validation(spec, options):
    with pytest.raises(InputError, match=rf"{spec.__name__}\.{next(iter(options))}"):
        spec(**options)
    with pytest.raises(InputError, match=rf"{spec.__name__} takes its arguments by name, n_theta=\.\.\., got 96"):
        spec(96, 10)


@pytest.mark.parametrize(
    "options",
    [{"n": 0}, {"n": 24.0}, {"n_z": 0}, {"n_z": True}, {"stretch": -0.5}, {"stretch": 1.5}, {"stretch": float("nan")}],
)
def test_grids_of_no_kind_are_refused(options):
    given = {"n": 24, "n_z": 6} | options
    n, name = given.pop("n"), next(iter(options))
    with pytest.raises(InputError, match=f"bearing_grid: {name}"):
        bearing_grid(0.03, 0.06, n, **given)
    with pytest.raises(InputError, match=f"slider_grid: {name}"):
        slider_grid(0.03, 0.06, n, **given)
    with pytest.raises(InputError, match="sealed_sides must be True or False"):
        slider_grid(0.03, 0.06, 24, 6, sealed_sides="no")


def test_smallest_grids_are_accepted():
    assert FiniteLength(n_theta=16, n_z=4, stretch=0.0).n_theta == 16
    assert ShortBearing(n_theta=np.int64(16), n_z=4, stretch=0.95).n_z == 4
