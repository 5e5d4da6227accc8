"""Profiles: values, periodicity, sums and refusals."""

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.film.surfaces.profile import ProfileTerm

LENGTH = 0.04
THETA = np.linspace(0.0, 2 * np.pi, 24, endpoint=False)
Z = np.linspace(-LENGTH / 2, LENGTH / 2, 9)
GRID = ehd.bearing_grid(0.025, LENGTH, n_theta=24, n_z=8, stretch=0.0)


def test_out_of_round():
    d = ehd.OutOfRound(order=3, amplitude=2e-6, phase=0.4).depth(THETA, Z, LENGTH)
    np.testing.assert_allclose(d[:, 4], 2e-6 * np.cos(3 * (THETA - 0.4)), atol=1e-20)
    assert np.ptp(d, axis=1).max() == 0.0


def test_crown_and_edge_relief():
    crown = ehd.Crown(drop=3e-6, exponent=4.0).depth(THETA, Z, LENGTH)[0]
    np.testing.assert_allclose(crown, 3e-6 * (2 * Z / LENGTH) ** 4, atol=1e-20)
    relief = ehd.EdgeRelief(drop=3e-6, relief_length=0.01).depth(THETA, Z, LENGTH)[0]
    np.testing.assert_allclose(relief[[0, 1, 2, 4]], [3e-6, 0.75e-6, 0.0, 0.0], atol=1e-20)


def test_axial_profile_passes_through_its_points_and_stays_between_them():
    p = ehd.AxialProfile(positions=[-0.01, 0.0, 0.01], depths=[2e-6, 0.0, 0.0])
    d = p.depth(THETA, np.linspace(-0.02, 0.02, 41), LENGTH)[0]
    assert d[0] == d[10] == 2e-6 and d[20] == 0.0
    assert d.min() == 0.0 and d.max() == 2e-6


def test_table_is_periodic_and_exact_at_its_points():
    angles = np.linspace(0.3, 0.3 + 2 * np.pi, 36, endpoint=False)
    depths = 1e-6 * np.outer(np.cos(2 * angles), [1.0, 0.5, 0.2, 0.1])
    p = ehd.ProfileTable(angles=angles, positions=[-0.02, -0.005, 0.005, 0.02], depths=depths)
    np.testing.assert_allclose(p.depth(angles, np.array([-0.02, 0.005]), LENGTH), depths[:, [0, 2]], atol=1e-18)
    np.testing.assert_allclose(p.depth(THETA + 4 * np.pi, Z, LENGTH), p.depth(THETA, Z, LENGTH), atol=1e-18)
    # a peak between two of 18 points a wave is flattened to their value
    flattened = 1e-6 * (1.0 - np.cos(np.pi / 18))
    found = p.depth(THETA, np.array([-0.02]), LENGTH)[:, 0]
    np.testing.assert_allclose(found, 1e-6 * np.cos(2 * THETA), rtol=0.0, atol=flattened)


def test_table_stays_between_its_depths():
    """Random tables of depths 0 or 0.1 mm and between, with points from 1e-6 rad and 1e-7 m apart on.

    Every depth lies between those of the four points around it, also in the interval that closes the ring. Cubic
    splines gave -149 mm between 0 and 0.1 mm.
    """
    rng = np.random.default_rng(40)
    for _ in range(60):
        n, m = int(rng.integers(4, 30)), int(rng.integers(2, 12))
        steps = 10.0 ** rng.uniform(-6.0, 0.0, n)
        along = 10.0 ** rng.uniform(-5.0, 0.0, m - 1)
        angles = rng.uniform(-2 * np.pi, 0.0) + 2 * np.pi * np.cumsum(steps / steps.sum() * (1.0 - 1e-9))
        z = LENGTH * (np.append(0.0, np.cumsum(along)) / along.sum() - 0.5)
        depths = 1e-4 * rng.choice([0.0, 1.0, rng.uniform()], (n, m))
        theta, at = rng.uniform(-10.0, 10.0, 300), rng.uniform(-0.6 * LENGTH, 0.6 * LENGTH, 40)
        found = ehd.ProfileTable(angles=angles, positions=z, depths=depths).depth(theta, at, LENGTH)
        i = np.searchsorted(angles, angles[0] + (theta - angles[0]) % (2 * np.pi), side="right") - 1
        j = np.clip(np.searchsorted(z, at, side="right") - 1, 0, m - 2)
        corners = np.array([depths[np.ix_((i + a) % n, j + b)] for a in (0, 1) for b in (0, 1)])
        # round-off of the cubics' powers
        assert np.all(found >= corners.min(axis=0) - 1e-15) and np.all(found <= corners.max(axis=0) + 1e-15)


def test_profiles_add_up():
    one, two = ehd.Crown(drop=1e-6), ehd.OutOfRound(order=2, amplitude=2e-6)
    both = ProfileTerm((one, two), GRID, LENGTH, 20e-6).field(None)
    np.testing.assert_allclose(both * 20e-6, one.depth(THETA, Z, LENGTH) + two.depth(THETA, Z, LENGTH), atol=1e-20)


@pytest.mark.parametrize(
    ("profile", "name"),
    [
        (ehd.EdgeRelief(drop=2e-6, relief_length=1e-4), "n_z"),
        (ehd.OutOfRound(order=24, amplitude=2e-6), "n_theta"),
        (ehd.OutOfRound(order=96, amplitude=2e-6), "n_theta"),
    ],
)
def test_what_falls_between_vertices_is_told(profile, name):
    """Relieved ends of no length took 6.7 % of the load of the default film, 24 lobes on 24 columns were none."""
    with pytest.warns(ehd.PlausibilityWarning, match=f"take a larger {name},"):
        ProfileTerm((profile,), GRID, LENGTH, 20e-6)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: ehd.OutOfRound(order=1, amplitude=1e-6), "OutOfRound.order"),
        (lambda: ehd.Crown(drop=1e-6, exponent=0.5), "Crown.exponent"),
        (lambda: ehd.EdgeRelief(drop=1e-6, relief_length=0.0), "EdgeRelief.relief_length"),
        (lambda: ehd.AxialProfile(positions=[0.0, 0.0], depths=[1e-6, 2e-6]), "AxialProfile.positions"),
        (lambda: ehd.AxialProfile(positions=[0.0, 1.0], depths=[1e-6, 2e-6, 3e-6]), "AxialProfile.depths"),
        (lambda: ehd.AxialProfile(positions=[0.0, 1.0], depths=[1e-6, np.nan]), "AxialProfile.depths"),
        (lambda: ehd.AxialProfile(positions=10**400, depths=[1e-6, 2e-6]), "AxialProfile.positions must be finite"),
        (lambda: ehd.AxialProfile(positions=[0.0, 1.0], depths=[0, 10**400]), "AxialProfile.depths must be finite"),
        (
            lambda: ehd.AxialProfile(positions=[-1.7e308, 1.7e308], depths=[0, 1e-6]),
            "AxialProfile.positions must be between",
        ),
        (lambda: ehd.AxialProfile(positions=[0.0, 5e-324], depths=[0, 1e-6]), "AxialProfile.positions .* apart"),
        (lambda: ehd.AxialProfile(positions=[0.0, 1.0], depths=[-1e308, 1e308]), "AxialProfile.depths must be between"),
        (lambda: ehd.ProfileTable(angles=[0, 3, 6, 9], positions=[0, 1], depths=np.zeros((4, 2))), "2 pi"),
        (lambda: ehd.ProfileTable(angles=[0, 1, 2, 3], positions=[0, 1], depths=np.zeros((2, 4))), "transpose"),
        (lambda: ProfileTerm((ehd.Crown(drop=-30e-6),), GRID, LENGTH, 20e-6), "closes the gap"),
    ],
)
def test_refused_values(make, message):
    with pytest.raises(ehd.InputError, match=message):
        make()
