"""Bush meshes read from files through meshio: Abaqus input as CAD programs write it, and other formats."""

import dataclasses
from types import SimpleNamespace

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.status import InputError
from tests.solid_tetrahedra import tet_mesh, tetrahedra

MESH = ehd.HollowCylinder(inner_radius=0.03, thickness=0.01, length=0.04, axial=2, radial=1, circumferential=8).mesh()
CYLINDER = ehd.HollowCylinder(inner_radius=0.03, thickness=0.01, length=0.04, axial=1, radial=1, circumferential=8)
TETS = tet_mesh(CYLINDER)


def write_inp(path, kind="C3D20R"):
    """In millimetres, with numbers that have gaps, elements over two lines, and sets of numbers."""
    numbers = 10 * np.random.default_rng(4).permutation(len(MESH.nodes)) + 7
    lines = ["*Heading", "** made by hand", "*Part, name=bush", "*NODE, nset=All"]
    lines += [f"{n}, {', '.join(f'{1e3 * c:.12g}' for c in x)}" for n, x in zip(numbers, MESH.nodes, strict=True)]
    lines.append(f"*Element, type={kind}, elset=solid")
    for i, element in enumerate(MESH.elements):
        row = [str(i + 1), *(str(numbers[k]) for k in element)]
        lines += [", ".join(row[:12]) + ",", ", ".join(row[12:])]
    lines += ["*Element, type=S4", "9001, 7, 17, 27, 37"]
    outer = numbers[MESH.outer.nodes]
    lines.append("*Nset, nset=Outer")
    lines += [", ".join(map(str, outer[i : i + 16])) for i in range(0, len(outer), 16)]
    lines += ["*Nset, nset=row, generate", "7, 47, 10", "*Material, name=steel", "*Elastic", "2.1e5, 0.3", "*End Part"]
    lines += ["*Assembly, name=a", "*Instance, name=bush-1, part=bush", "*End Instance", "*End Assembly"]
    path.write_text("\n".join([*lines, "*Step", "*Node output", "U", "*End Step"]))


def test_abaqus_input_is_read_with_its_numbers_units_and_node_sets(tmp_path):
    pytest.importorskip("meshio")
    path = tmp_path / "bush.inp"
    write_inp(path)
    for held in ("outer", None, ehd.OnCylinder(radius=0.04)):
        mesh = ehd.mesh_from_file(path, bore_radius=0.03, scale=1e-3, held=held)
        for name in ("bore", "outer", "end_low", "end_high"):
            got, expected = getattr(mesh, name), getattr(MESH, name)
            assert got.faces.shape == expected.faces.shape
        order = np.lexsort(np.round(mesh.nodes, 9).T), np.lexsort(np.round(MESH.nodes, 9).T)
        np.testing.assert_allclose(mesh.nodes[order[0]], MESH.nodes[order[1]], atol=1e-12)
    with pytest.raises(InputError, match=r"instance is not supported any more, got 'bush-1'; .*ImportFromAbaqusInput"):
        ehd.mesh_from_file(path, bore_radius=0.03, instance="bush-1")


@pytest.mark.parametrize(("ending", "kind"), [("vtu", "vtu"), ("msh", "gmsh")])
@pytest.mark.parametrize("own", [MESH, TETS], ids=["hex20", "tet10"])
def test_meshio_reads_other_formats(tmp_path, ending, kind, own):
    meshio = pytest.importorskip("meshio")
    path = tmp_path / f"bush.{ending}"
    meshio.Mesh(own.nodes, [(own.element.meshio, own.elements)]).write(path, file_format=kind)
    mesh = ehd.mesh_from_file(path, bore_radius=0.03)
    np.testing.assert_allclose(mesh.nodes[mesh.elements], own.nodes[own.elements], atol=1e-12)


def test_meshio_s_elements_on_surfaces_are_passed_over_and_mixed_solids_refused(tmp_path):
    meshio = pytest.importorskip("meshio")
    path = tmp_path / "bush.vtu"
    meshio.Mesh(TETS.nodes, [("triangle6", TETS.boundary), ("tetra10", TETS.elements)]).write(path)
    np.testing.assert_array_equal(ehd.mesh_from_file(path, bore_radius=0.03).elements, TETS.elements)
    meshio.Mesh(MESH.nodes, [("hexahedron20", MESH.elements), ("tetra10", MESH.elements[:, :10])]).write(path)
    with pytest.raises(InputError, match=r"of one kind, got \['hexahedron20', 'tetra10'\]"):
        ehd.mesh_from_file(path, bore_radius=0.03)


def test_what_cannot_be_read_is_named(tmp_path):
    path = tmp_path / "bush.inp"
    with pytest.raises(InputError, match="there is no file"):
        ehd.mesh_from_file(path, bore_radius=0.03)
    pytest.importorskip("meshio")
    write_inp(path)
    with pytest.raises(InputError, match=r"no node set 'seat', it has \['Outer', 'row'\]"):
        ehd.mesh_from_file(path, bore_radius=0.03, held="seat")
    # metres taken for millimetres
    with pytest.raises(InputError, match=r"nodes have radii 30 to 40 m\. Check units"):
        ehd.mesh_from_file(path, bore_radius=0.03)
    path.write_text("*Node\n1, 0, 0, 0\n*Element, type=C3D20\n1, 1, 2, 3\n")
    with pytest.raises(InputError, match=r"meshio can't read bush\.inp"):
        ehd.mesh_from_file(path, bore_radius=0.03)
    (tmp_path / "bush.step").write_text("solid")
    with pytest.raises(InputError, match=r"meshio can't read bush\.step"):
        ehd.mesh_from_file(tmp_path / "bush.step", bore_radius=0.03)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("*NODE, nset=All\n", "*Node, system=C\n"),
        ("*NODE", "*Include, input=nodes.txt\n*Node"),
        ("*NODE", "*System\n1., 0., 0.\n*Node"),
        ("*Element, type=S4", "*Elgen\n1, 2\n*Element, type=S4"),
        ("*Instance, name=bush-1, part=bush\n", "*Instance, name=bush-1, part=bush\n1., 0., 0.\n"),
        ("*End Part", "*Node\n1, 0., 0., 0.\n*End Part"),
        ("*Nset, nset=Outer\n", "*Nset, nset=Outer\n7,\nrow,\n"),
    ],
)
def test_what_meshio_would_read_wrongly_is_refused(tmp_path, old, new):
    pytest.importorskip("meshio")
    path = tmp_path / "bush.inp"
    write_inp(path)
    text = path.read_text()
    assert text.count(old) == 1
    path.write_text(text.replace(old, new))
    with pytest.raises(InputError, match=r"meshio reads one body from an Abaqus file, .* bush\.inp has \d such blocks"):
        ehd.mesh_from_file(path, bore_radius=0.03)


def test_inverted_tetrahedra_are_named():
    nodes, elements = tetrahedra(CYLINDER)
    for change in (lambda row: row[[1, 0, 2, 3, 4, 6, 5, 8, 7, 9]], lambda row: row[[0, 1, 2, 3, 5, 4, 6, 7, 8, 9]]):
        wrong = elements.copy()
        wrong[5] = change(wrong[5])
        with pytest.raises(InputError, match=r"got 1 inverted or degenerate ones, the first is element 5; .*C3D10"):
            ehd.mesh_from_arrays(nodes, wrong, bore_radius=0.03)
    with pytest.raises(InputError, match="must be arrays of numbers, all elements of one kind"):
        ehd.mesh_from_arrays(nodes, [*elements.tolist(), MESH.elements[0].tolist()], bore_radius=0.03)
    # Gmsh's order of the last two nodes
    with pytest.raises(InputError, match="48 inverted or degenerate ones"):
        ehd.mesh_from_arrays(nodes, elements[:, [0, 1, 2, 3, 4, 5, 6, 7, 9, 8]], bore_radius=0.03)
    fem = SimpleNamespace(nodes={"Position": nodes}, elements=[{"Name": "bush", "Tet10": elements}])
    np.testing.assert_array_equal(ehd.mesh_from_fem(fem, bore_radius=0.03).elements, TETS.elements)


def test_straight_edges_are_faces_of_the_bore_and_held_faces_that_miss_their_middle_nodes_are_counted():
    """Chords of 17 degrees lie 1.1 % of the radius off the cylinder."""
    nodes, elements = tetrahedra(dataclasses.replace(CYLINDER, circumferential=32), shift=0.25, straight=True)
    mesh = ehd.mesh_from_arrays(nodes, elements, bore_radius=0.03)
    assert len(mesh.bore.faces) == len(mesh.outer.faces) == 64
    S = mesh.bore.interpolation(np.linspace(-3.0, 3.0, 50), np.linspace(-0.02, 0.02, 50))
    np.testing.assert_allclose(S.sum(axis=1), 1.0, rtol=0, atol=1e-12)
    with pytest.warns(UserWarning, match=r"held: \d+ faces have their corners, but not all of their nodes"):
        part = ehd.mesh_from_arrays(nodes, elements, bore_radius=0.03, held=ehd.OnCylinder(radius=0.04))
    assert len(part.outer.faces) < 64
    whole = ehd.mesh_from_arrays(nodes, elements, bore_radius=0.03, held=ehd.OnCylinder(radius=0.04, tolerance=0.02))
    assert len(whole.outer.faces) == 64
