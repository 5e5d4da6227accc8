"""Drag on surfaces that share it unevenly, against sums over the links."""

import numpy as np
import pytest

from exudyn_ehd.film.reynolds.gap import on_links
from exudyn_ehd.film.surfaces.roughness import drag_by_gap, drag_weights


@pytest.fixture(params=[(24, 7, 1), (9, 4, 2), (5, 2, 3)])
def film(request):
    """Random film with a link that is missing each way, and a part whose gap is not limited."""
    n, m, seed = request.param
    rng = np.random.default_rng(seed)
    f = {"P": rng.normal(size=(n, m)), "gap": rng.random((n, m)), "link": rng.random((n, m)), "rng": rng}
    near = rng.random((2, n, m)) * (rng.random((2, n, 1)) < 0.5)
    f["true_gap"], f["true_link"] = f["gap"] - near[0], f["link"] - near[1]
    f["slope"], f["face_slope"] = 1.0 - rng.random((2, n, m)) * (near > 0.0)
    f["mesh"] = tuple(rng.random(size) + 0.1 for size in (n, m, n, m - 1))
    if seed > 1:
        f["mesh"][2][rng.integers(n)] = 0.0
    if seed == 2:
        f["mesh"][3][rng.integers(m - 1)] = 0.0
    return f


def between(field):
    """On the links in z."""
    return 0.5 * (field[:, :-1] + field[:, 1:])


def drag_of(f, P, x, z):
    """(E_x, E_z) with what carriers have more than the true gap, x (n, m) and z (n, m - 1) on the links."""
    width_x, width_z, link_x, link_z = f["mesh"]
    along = (link_x != 0.0)[:, None] * width_z * (P - np.roll(P, -1, axis=0))
    across = (link_z != 0.0) * width_x[:, None] * (P[:, :-1] - P[:, 1:])
    return np.array([np.sum(x * along), np.sum(z * across)])


@pytest.fixture(params=["the film's gap", "carriers"])
def carriers(request, film):
    """None, where the film's gap carries, or carriers of both axes."""
    shape = film["P"].shape
    return None if request.param == "the film's gap" else tuple(film["rng"].random((2, *shape)))


def widths(f):
    """Widths (2, n, m) of the links, as of `FilmGrid.link_widths`."""
    width_x, width_z, link_x, link_z = f["mesh"]
    return np.array((np.outer(link_x != 0.0, width_z), np.outer(width_x, np.append(link_z != 0.0, False))))


def test_weights(film, carriers):
    """The weights of the pressures are the sums of unit pressures there."""
    f, shape = film, film["P"].shape
    along, across = (f["link"], on_links(f["gap"])[1]) if carriers is None else carriers
    x, z = along - f["true_link"], across[:, :-1] - between(f["true_gap"])
    units = np.eye(f["P"].size).reshape(-1, *shape)
    expected = np.array([drag_of(f, unit, x, z) for unit in units]).T.reshape(2, *shape)
    found = drag_weights((along, across), f["true_gap"], f["true_link"], widths(f))
    np.testing.assert_allclose(found, expected, rtol=1e-12, atol=1e-14)


def test_gradients_to_the_gap(film, carriers):
    """A change of the true gaps moves the film's by their slopes times that, and the carriers by their slopes times the
    film's."""
    f, shape = film, film["P"].shape
    steep = np.ones((2, *shape)) if carriers is None else np.array(carriers)
    face, cell = drag_by_gap(f["P"], tuple(steep), f["slope"], f["face_slope"], widths(f))
    vertex, link = f["rng"].normal(size=(2, *shape))
    along = (steep[0] * f["face_slope"] - 1.0) * link
    across = steep[1][:, :-1] * between(f["slope"] * vertex) - between(vertex)
    found = np.sum(face * link), np.sum(cell * vertex)
    np.testing.assert_allclose(found, drag_of(f, f["P"], along, across), rtol=1e-12, atol=1e-13)
