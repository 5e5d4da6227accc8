"""Structured and imported bush meshes."""

from types import SimpleNamespace

import numpy as np
import pytest

from exudyn_ehd.solid.elements.element import GAUSS27, HEX20, HEX_EDGES
from exudyn_ehd.solid.mesh import HollowCylinder
from exudyn_ehd.solid.mesh_import import OnCylinder, OnPlane, mesh_from_arrays, mesh_from_fem
from exudyn_ehd.status import InputError

CYLINDER = HollowCylinder(inner_radius=0.225, thickness=0.05, length=0.2, axial=4, radial=2, circumferential=40)
MESH = CYLINDER.mesh()


def test_counts_follow_the_serendipity_grid():
    assert MESH.elements.shape == (320, 20)
    # corners 3*40*5, mid-edge nodes along r 2*40*5, along theta 3*40*5, along z 3*40*4
    assert len(MESH.nodes) == 600 + 400 + 600 + 480
    assert MESH.bore.faces.shape == MESH.outer.faces.shape == (160, 8)
    assert MESH.end_low.faces.shape == MESH.end_high.faces.shape == (80, 8)
    assert len(MESH.boundary) == 480


def test_every_bore_and_outer_node_lies_on_its_cylinder_also_between_corners():
    for surface, radius in ((MESH.bore, 0.225), (MESH.outer, 0.275)):
        assert np.allclose(np.hypot(*surface.positions[:, :2].T), radius, rtol=1e-14)
    assert np.allclose(MESH.end_low.positions[:, 2], -0.1) and np.allclose(MESH.end_high.positions[:, 2], 0.1)


def test_volume_converges_to_the_cylinder_at_fourth_order():
    exact = np.pi * (0.275**2 - 0.225**2) * 0.2
    errors = []
    for around in (8, 16, 32):
        mesh = HollowCylinder(
            inner_radius=0.225, thickness=0.05, length=0.2, axial=1, radial=1, circumferential=around
        ).mesh()
        errors.append(abs(HEX20.reference_gradients(mesh.nodes[mesh.elements], GAUSS27)[1].sum() / exact - 1))
    # a parabola through three points of a circle errs in area at fourth order
    assert np.log2(errors[0] / errors[1]) == pytest.approx(4, abs=0.1)
    assert np.log2(errors[1] / errors[2]) == pytest.approx(4, abs=0.1)


def test_interpolation_on_the_bore_returns_angle_and_height():
    random = np.random.default_rng(2)
    theta, z = random.uniform(-7, 7, 500), random.uniform(-0.1, 0.1, 500)
    theta[0], z[0] = np.pi, -0.1  # the corner of the seam
    S = MESH.bore.interpolation(theta, z)
    x = S @ MESH.bore.positions
    assert S.shape == (500, len(MESH.bore.nodes))
    # Newton's method ends at rounding; the weights of every row sum to one
    assert np.allclose(np.cos(np.arctan2(x[:, 1], x[:, 0]) - theta), 1, atol=1e-13)
    assert np.allclose(x[:, 2], z, atol=1e-14)
    assert np.allclose(S.sum(axis=1), 1, atol=1e-13)


def test_radial_interpolation_measures_opening_and_carries_pressure_back():
    random = np.random.default_rng(21)
    theta, z = random.uniform(-3, 3, 50), random.uniform(-0.1, 0.1, 50)
    H = MESH.bore.radial_interpolation(theta, z)
    x, y, height = MESH.bore.positions.T
    # a quadratic ovalisation along z plus a shift: radial opening (1 + z) cos^2 - ..., exact up to the parabolic edges
    u = np.stack([1e-3 * x + 2e-4, -1e-3 * y * (1 + height), 0 * x], axis=1)
    expected = 1e-3 * 0.225 * (np.cos(theta) ** 2 - np.sin(theta) ** 2 * (1 + z)) + 2e-4 * np.cos(theta)
    assert np.allclose(H @ u.ravel(), expected, atol=1e-9)  # (pi/80)^4 of 2e-4 m
    assert np.allclose(u.ravel() @ (H.T @ np.ones(50)), (H @ u.ravel()).sum(), rtol=1e-12)


def test_a_point_beside_the_bore_is_refused_with_the_bore_s_extent():
    with pytest.raises(InputError, match=r"z = 0.15 m must lie on the surface, which spans z = -0.1 to 0.1"):
        MESH.bore.interpolation(np.array([0.0]), np.array([0.15]))


def test_generatrix_runs_from_end_to_end():
    line = MESH.generatrix(MESH.outer, np.pi / 2)
    assert line.edges.shape == (4, 3) and len(line.nodes) == 9
    assert np.allclose(MESH.nodes[line.nodes, 1], 0.275)
    with pytest.raises(InputError, match="the nearest one is"):
        MESH.generatrix(MESH.outer, 0.01)


def user_arrays():
    """The structured mesh in a user's frame: axis along x, shifted, elements shuffled."""
    turn = np.array([[0.0, 0, 1], [1, 0, 0], [0, 1, 0]])
    nodes = MESH.nodes @ turn.T + [1.0, 2.0, 3.0]
    return nodes, np.random.default_rng(3).permutation(MESH.elements), turn


def test_an_imported_mesh_finds_bore_outer_surface_and_ends():
    nodes, elements, _ = user_arrays()
    mesh = mesh_from_arrays(nodes, elements, bore_radius=0.225, origin=(1.0, 2.0, 3.0), axis=(1.0, 0.0, 0.0))
    assert mesh.bore.faces.shape == mesh.outer.faces.shape == (160, 8)
    assert mesh.end_low.faces.shape == mesh.end_high.faces.shape == (80, 8)
    assert np.allclose(np.hypot(*mesh.bore.positions[:, :2].T), 0.225, rtol=1e-12)


def chamfered():
    """Positions of the structured mesh with both edges of its bore broken: the outermost layers open outwards."""
    x = MESH.nodes.copy()
    r, z = np.hypot(x[:, 0], x[:, 1]), np.abs(x[:, 2])
    edge = MESH.nodes[:, 2].max()
    layer = np.unique(np.round(z, 9))[-3]
    cut = 0.02 * np.clip((z - layer) / (edge - layer), 0.0, 1.0) * (0.275 - r) / 0.05
    x[:, :2] *= ((r + cut) / r)[:, None]
    return x


HELD = {
    "cylinder": OnCylinder(radius=0.275),
    "function": lambda x: np.hypot(x[:, 0], x[:, 1]) > 0.274,
    "numbers": MESH.outer.nodes,
    "flags": np.hypot(MESH.nodes[:, 0], MESH.nodes[:, 1]) > 0.274,
}


@pytest.mark.parametrize("kind", HELD)
def test_held_faces_are_those_that_the_user_names(kind):
    mesh = mesh_from_arrays(chamfered(), MESH.elements, bore_radius=0.225, held=HELD[kind])
    assert mesh.outer.faces.shape == (160, 8)
    assert np.hypot(*mesh.outer.positions[:, :2].T).min() > 0.2749
    # the chamfers' faces are neither held nor bore
    assert mesh.bore.faces.shape == (80, 8) and len(mesh.boundary) == 480


def test_a_held_chamfer_that_clamps_the_bore_warns():
    with pytest.warns(UserWarning, match=r"160 nodes of the bore belong to held faces .*held=OnCylinder"):
        mesh = mesh_from_arrays(chamfered(), MESH.elements, bore_radius=0.225)
    assert mesh.outer.faces.shape == (240, 8)


def test_a_flange_is_held_by_its_plane():
    """It reaches the bore's edge, which is said."""
    plane = OnPlane(point=(0.0, 0.0, MESH.nodes[:, 2].max()), normal=(0.0, 0.0, -2.0))
    with pytest.warns(UserWarning, match="80 nodes of the bore"):
        mesh = mesh_from_arrays(MESH.nodes, MESH.elements, bore_radius=0.225, held=plane)
    assert np.array_equal(mesh.outer.nodes, mesh.end_high.nodes)


@pytest.mark.parametrize(
    ("held", "message"),
    [
        (OnCylinder(radius=0.5), "0 nodes are chosen.*radii 0.225 to 0.275 m.*Check units"),
        (MESH.outer.nodes[:3], "3 nodes are chosen"),
        (MESH.bore.nodes, "besides the bore"),
        (lambda x: x[:, 0], "one bool for each"),
    ],
)
def test_held_faces_that_do_not_exist_are_refused(held, message):
    with pytest.raises(InputError, match=rf"mesh_from_arrays\.held.*{message}"):
        mesh_from_arrays(MESH.nodes, MESH.elements, bore_radius=0.225, held=held)


def test_import_reads_the_layout_of_exudyn_s_fem_interface():
    fem = SimpleNamespace(nodes={"Position": MESH.nodes}, elements=[{"Name": "bush", "Hex20": MESH.elements}])
    assert np.array_equal(mesh_from_fem(fem, bore_radius=0.225).elements, MESH.elements)
    fem.elements.append({"Name": "lug", "Tet10": np.zeros((1, 10), dtype=int)})
    with pytest.raises(InputError, match=r"must hold Hex20 or Tet10 elements, of one kind, got \['Hex20', 'Tet10'\]"):
        mesh_from_fem(fem, bore_radius=0.225)


def test_wrong_bore_radius_and_inverted_elements_are_named():
    with pytest.raises(InputError, match="no boundary face lies there"):
        mesh_from_arrays(MESH.nodes, MESH.elements, bore_radius=0.2)
    upside_down = MESH.elements[:, [4, 5, 6, 7, 0, 1, 2, 3, 12, 13, 14, 15, 8, 9, 10, 11, 16, 17, 18, 19]]
    with pytest.raises(InputError, match="320 inverted or degenerate ones"):
        mesh_from_arrays(MESH.nodes, upside_down, bore_radius=0.225)


@pytest.mark.parametrize(
    ("argument", "value", "message"),
    [
        ("thickness", -0.05, r"HollowCylinder.thickness must be > 0 m, got -0.05"),
        ("circumferential", 2, r"HollowCylinder.circumferential must be an integer >= 3, got 2"),
        ("length", float("nan"), r"HollowCylinder.length must be > 0 m, got nan"),
    ],
)
def test_impossible_cylinders_are_refused(argument, value, message):
    arguments = {"inner_radius": 0.2, "thickness": 0.05, "length": 0.2} | {argument: value}
    with pytest.raises(InputError, match=message):
        HollowCylinder(**arguments)


def test_middle_nodes_lie_half_way_in_cylinder_coordinates():
    a, b, middle = np.moveaxis(MESH.nodes[MESH.elements[:, HEX_EDGES]], 2, 0)
    radius = [np.hypot(*x[..., :2].reshape(-1, 2).T) for x in (a, b, middle)]
    assert np.allclose((radius[0] + radius[1]) / 2, radius[2], rtol=1e-13)


def test_sizes_and_numbers_that_can_not_be_meant():
    with pytest.raises(InputError, match="its elements must be at most 100000, got 10000000000000"):
        HollowCylinder(inner_radius=0.02, thickness=5e-3, length=0.02, axial=10**5, radial=10**4, circumferential=10**4)
    mesh = HollowCylinder(inner_radius=0.02, thickness=5e-3, length=0.02, axial=1, circumferential=8).mesh()
    for elements in (mesh.elements + 1, mesh.elements - 1, mesh.elements[:0]):
        with pytest.raises(InputError, match=r"mesh_from_arrays.elements must be .*count from 1"):
            mesh_from_arrays(mesh.nodes, elements, bore_radius=0.02)
