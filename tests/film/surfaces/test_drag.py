"""Drag on surfaces that share it unevenly: kernels against sums over the links in plain numpy."""

import numpy as np
import pytest

from exudyn_ehd.film.surfaces.drag import drag_pose_gradient, drag_rhs, drag_sums


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


def test_sums_and_weights(film, carriers):
    """The weights of the unknowns are the sums of unit pressures there, none where the pressure is clipped; they are
    added to what the rows hold."""
    f, shape = film, film["P"].shape
    gaps = carriers, f["gap"], f["link"], f["true_gap"], f["true_link"]
    x, z = f["link"] - f["true_link"], between(f["gap"] - f["true_gap"])
    if carriers is not None:
        x, z = carriers[0] - f["true_link"], carriers[1][:, :-1] - between(f["true_gap"])
    np.testing.assert_allclose(drag_sums(f["P"], gaps, f["mesh"]), drag_of(f, f["P"], x, z), rtol=1e-12, atol=1e-14)
    active = f["rng"].random(shape) < 0.8
    order = np.flatnonzero(f["rng"].random(shape) < 0.7)
    units = np.eye(active.size).reshape(-1, *shape)[order] * active
    rows = f["rng"].normal(size=(2, order.size))
    expected = rows + np.array([drag_of(f, unit, x, z) for unit in units]).T
    drag_rhs(order, order.size, active, gaps, f["mesh"], rows)
    np.testing.assert_allclose(rows, expected, rtol=1e-12, atol=1e-14)


def test_gradients_to_the_pose(film, carriers):
    """A pose moves the true gaps by -(x + z bx) cos - (y + z by) sin, the film's by their slopes times that, and the
    carriers by their slopes times the film's."""
    f, (n, m) = film, film["P"].shape
    steep = np.ones((2, n, m)) if carriers is None else np.array(carriers)
    at = (*f["rng"].normal(size=(4, n)), f["rng"].normal(size=m))
    start = f["rng"].normal(size=(2, 10))
    drag = start.copy()
    drag_pose_gradient(f["P"], *steep, f["slope"], f["face_slope"], f["mesh"], at, drag)
    cos_x, sin_x, cos_f, sin_f, z = at
    expected = start.copy()
    for q, tilt in enumerate((0.0 * z + 1.0, 0.0 * z + 1.0, z, z)):
        vertex, face = (-np.outer(v[q % 2], tilt) for v in ((cos_x, sin_x), (cos_f, sin_f)))
        along = (steep[0] * f["face_slope"] - 1.0) * face
        across = steep[1][:, :-1] * between(f["slope"] * vertex) - between(vertex)
        expected[:, q] += drag_of(f, f["P"], along, across)
    np.testing.assert_allclose(drag, expected, rtol=1e-12, atol=1e-13)
