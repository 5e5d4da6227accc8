"""Unrolled maps show the film's values at their places, with units."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from matplotlib.figure import Figure

import exudyn_ehd as ehd
from exudyn_ehd.pictures import maps
from exudyn_ehd.status import InputError
from tests.sampling import sample


def bilinear(film, values, degrees, z):
    """Readable twin of the picture's interpolation: linear in theta on the closed ring, linear in z."""
    theta = np.append(film.theta, film.theta[0] + 2.0 * math.pi)
    ring = np.vstack([values, values[:1]])
    angle = film.theta[0] + (math.radians(degrees) - film.theta[0]) % (2.0 * math.pi)
    column = [np.interp(angle, theta, ring[:, j]) for j in range(values.shape[1])]
    return np.interp(z, film.z, column)


@pytest.mark.parametrize(
    ("name", "factor", "offset", "text"),
    [
        ("pressure", 1e-6, 0.0, "pressure [MPa]"),
        ("gap", 1e6, 0.0, "gap [µm]"),
        ("temperature", 1.0, -273.15, "film temperature [°C]"),
    ],
)
def test_map_shows_the_field_in_its_unit(fed_film, name, factor, offset, text):
    figure = getattr(fed_film, f"plot_{name}")()
    ax, bar = figure.axes
    assert bar.get_ylabel() == text
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("angle θ [°]", "z [mm]")
    image = ax.images[0]
    shown = np.asarray(image.get_array())
    assert np.isfinite(shown).all()
    assert image.get_extent() == pytest.approx([0.0, 360.0, -25.0, 25.0])
    values = factor * getattr(fed_film, name) + offset
    for i, j in ((0, 0), (100, 31), (719, 90), (720, 120)):
        expected = bilinear(fed_film, values, 0.5 * i, 1e-3 * (-25.0 + 50.0 * j / 120))
        # interpolation in another order of operations
        assert shown[j, i] == pytest.approx(expected, rel=1e-9, abs=1e-9 * abs(values).max())
    # the vertices of the 48-vertex ring are points of the picture, so that the peak is shown
    assert shown.max() >= values[:, 3].max() * (1.0 - 1e-9)


def test_fill_map_runs_from_0_to_1_and_leaves_the_surroundings_out(fed_film):
    figure = fed_film.plot_fill()
    image = figure.axes[0].images[0]
    assert image.get_clim() == (0.0, 1.0)
    assert figure.axes[1].get_ylabel() == "film fraction [-]"
    shown = np.asarray(image.get_array())
    np.testing.assert_allclose(shown[0], bilinear_row(fed_film, 1), rtol=1e-9)


def bilinear_row(film, j):
    """Film fraction of grid row j along the picture's angles."""
    return np.array([bilinear(film, film.fill, 0.5 * i, film.z[j]) for i in range(721)])


def test_rupture_line_bounds_the_pressure(film):
    ax = Figure().add_subplot()
    outline = maps.draw_rupture(ax, film)
    degrees = np.concatenate([path.vertices[:, 0] for path in outline.get_paths()])
    under_pressure = np.degrees(film.theta[film.pressure[:, 3] > 0.0])
    # the line lies between the last vertex under pressure and the next one, 7.5 degrees on
    assert degrees.min() > under_pressure.min() - 60.0
    assert degrees.max() < under_pressure.max() + 30.0
    row = [bilinear(film, (film.pressure > 0.0).astype(float), d, 0.0) for d in under_pressure]
    assert min(row) == 1.0


def test_missing_fields_are_named(film):
    with pytest.raises(InputError, match=r"plot_fill: this film has no film fraction.*ElrodAdams"):
        film.plot_fill()
    with pytest.raises(InputError, match=r"plot_temperature.*thermal=FilmEnergy"):
        film.plot_temperature()


def test_uniform_fields_have_a_colour_range():
    low, high = maps.colour_limits(np.full((4, 3), 40.0))
    assert low < 40.0 < high
    low, high = maps.colour_limits(np.zeros((4, 3)))
    assert low < 0.0 < high


def test_maps_can_share_a_figure_and_are_written(film, tmp_path):
    figure = Figure(figsize=(7, 5))
    axes = figure.subplots(2, 1)
    assert film.plot_pressure(ax=axes[0]) is figure
    film.plot_gap(ax=axes[1], path=tmp_path / "new" / "both.png")
    assert len(figure.axes) == 4
    assert (tmp_path / "new" / "both.png").stat().st_size > 10_000


@pytest.mark.slow
@pytest.mark.parametrize(
    "options",
    sample(
        [
            {"film": ehd.ShortBearing()},
            {"film": ehd.LongBearing(), "inlet": ehd.MaximumGap()},
            {"film": ehd.ClassicSOR(n_theta=48, n_z=12), "cavitation": ehd.Gumbel()},
            {"film": ehd.FiniteLength(n_theta=48, n_z=6), "inlet": ehd.MaximumGap()},
            {"film": ehd.FiniteLength(n_theta=48, n_z=6), "cavitation": ehd.FullSommerfeld()},
        ],
        1,
        2,
    ),
    ids=lambda options: "-".join(type(option).__name__ for option in options.values()),
)
def test_every_film_model_can_be_drawn(make_bearing, options, tmp_path):
    """The map and the bearing in space of every film; the map's peak is the field's, wherever the ring starts."""
    film = ehd.steady(make_bearing(**options), speed=300.0, eccentricity_ratio=0.6, direction=0.4)
    shown = np.asarray(film.plot_pressure(path=tmp_path / "map.png").axes[0].images[0].get_array())
    assert np.isfinite(shown).all()
    # a vertex may fall between the picture's points, half a degree apart
    assert shown.max() == pytest.approx(1e-6 * film.pressure.max(), rel=5e-3)
    assert shown.min() == pytest.approx(1e-6 * film.pressure.min(), abs=5e-3 * shown.max())
    film.plot_gap(path=tmp_path / "gap.png")
    film.plot_bearing(path=tmp_path / "bearing.png")


def test_contact_and_wear_of_a_joints_film(film):
    with pytest.raises(InputError, match=r"has no contact pressure.*asperity=GreenwoodTripp"):
        film.plot_contact_pressure()
    with pytest.raises(InputError, match=r"has no wear depth.*wear=ArchardWear"):
        film.plot_wear_depth()
    fields = SimpleNamespace(**vars(film), contact_pressure=0.01 * film.pressure, wear_depth=2e-8 * (film.gap < 1e-5))
    for name, text in (("contact_pressure", "contact pressure [MPa]"), ("wear_depth", "wear depth [nm]")):
        assert maps.plot_map(fields, maps.FIELDS[name]).axes[1].get_ylabel() == text
