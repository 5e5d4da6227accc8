"""The pressure of a socket, seen along its axis."""

import matplotlib.pyplot as plt
import pytest

import exudyn_ehd as ehd


@pytest.mark.parametrize("angles", [(0.0, 1.5), pytest.param((0.5, 2.5), marks=pytest.mark.slow)])
def test_patches_are_drawn_from_pole_or_edge_to_edge(angles, tmp_path):
    ball = ehd.SphericalBearing(
        ball_radius=0.015, radial_clearance=30e-6, lubricant=ehd.Lubricant(viscosity=0.1), socket_angles=angles
    )
    film = ehd.steady_spherical(ball, place=(1e-5, 0, 1e-5), angular_velocity=(0, 10, 0))
    figure = film.plot_pressure(title="socket", path=tmp_path / "socket.png")
    assert (tmp_path / "socket.png").stat().st_size > 5_000
    title = figure.axes[0].get_title()
    assert title.startswith("socket") and "peak pressure" in title
    with pytest.raises(ehd.InputError, match="polar"):
        film.plot_pressure(ax=plt.figure().add_subplot())
