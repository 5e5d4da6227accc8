"""Input errors and messages of `SphericalBearing` and `steady_spherical`."""

import math

import numpy as np
import pytest

import exudyn_ehd as ehd

OIL = ehd.Lubricant(viscosity=0.1)
BALL = {"ball_radius": 0.015, "radial_clearance": 30e-6, "lubricant": OIL}


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"ball_radius": -1.0}, "ball_radius must be > 0"),
        ({"radial_clearance": 1e-3}, "twentieth of the ball's radius"),
        ({"socket_angles": (0.0, 90.0)}, "math.radians"),
        ({"socket_angles": (0.01, 1.0)}, "begin = 0 or >="),
        ({"socket_angles": (0.0, math.pi)}, "socket_angles must be"),
        ({"n_phi": 8}, "n_phi must be an integer >= 16"),
        ({"n_chi": 2}, "n_chi must be an integer >= 4"),
        ({"cavitation": ehd.Gumbel(cavity_pressure=1e5)}, "cavity_pressure <= 0"),
        ({"cavitation": ehd.ElrodAdams(line_in_cells=True)}, "line_in_cells=False"),
        ({"contact": ehd.RegularisedWall(onset=40e-6)}, "onset must be below"),
        (
            {"lubricant": ehd.Lubricant(viscosity=0.1, shear_law=ehd.CarreauShear(relaxation_time=1e-6, exponent=0.5))},
            "shear_law",
        ),
        (
            {
                "lubricant": ehd.Lubricant(viscosity=0.1, density_law=ehd.DowsonHigginson()),
                "cavitation": ehd.SwiftStieber(line_in_cells=True),
            },
            "line_in_cells=False",
        ),
    ],
)
def test_what_can_not_be_meant_is_refused(options, message):
    with pytest.raises(ehd.InputError, match=message):
        ehd.SphericalBearing(**BALL | options)


def test_films_beyond_reason_are_refused_or_warned_of():
    ball = ehd.SphericalBearing(**BALL)
    with pytest.raises(ehd.FilmError, match=r"steady_spherical: NO_FILM at place"):
        ehd.steady_spherical(ball, place=(0, 0, 31e-6))
    with pytest.warns(ehd.OverloadWarning, match="steady_spherical"):
        ehd.steady_spherical(ball, place=(0, 0, 29.9e-6), velocity=(0, 0, 10.0))
    with pytest.raises(ehd.FilmError, match="pressed through its contact"):
        stiff = ehd.SphericalBearing(**BALL, contact=ehd.RegularisedWall(onset=2e-6))
        ehd.steady_spherical(stiff, place=(0, 0, 65e-6))


def test_results_hold_force_torque_and_what_they_change_by():
    ball = ehd.SphericalBearing(**BALL, socket_angles=(0.0, 2.0))
    at = {"place": np.array([5e-6, 0.0, 12e-6]), "velocity": (0.0, 1e-4, 0.0), "angular_velocity": (0.0, 20.0, 5.0)}
    film = ehd.steady_spherical(ball, **at)
    assert film.pressure.shape == film.gap.shape == (film.phi.size, film.chi.size)
    assert film.minimum_gap == pytest.approx(30e-6 - math.hypot(5e-6, 12e-6))
    more = ehd.steady_spherical(ball, **at | {"velocity": (1e-9, 1e-4, 0.0)})
    assert (more.force - film.force) / 1e-9 == pytest.approx(
        film.tangent[:3, 3], rel=1e-4, abs=1e-3 * abs(film.tangent).max()
    )
