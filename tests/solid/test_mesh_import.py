"""Bush meshes read from files: Abaqus input as CAD programs write it, and a format of meshio's."""

import dataclasses
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import exudyn_ehd as ehd
from exudyn_ehd.solid.mesh_files import read_abaqus
from exudyn_ehd.status import InputError
from tests.solid_tetrahedra import element_lines, node_lines, tet_mesh, tetrahedra

MESH = ehd.HollowCylinder(inner_radius=0.03, thickness=0.01, length=0.04, axial=2, radial=1, circumferential=8).mesh()
CYLINDER = ehd.HollowCylinder(inner_radius=0.03, thickness=0.01, length=0.04, axial=1, radial=1, circumferential=8)
TETS = tet_mesh(CYLINDER)


def write_inp(path, kind="C3D20R", nodes=True):
    """In millimetres, with numbers that have gaps, elements over two lines, and sets of every kind."""
    numbers = 10 * np.random.default_rng(4).permutation(len(MESH.nodes)) + 7
    lines = ["*Heading", "** made by hand", "*Part, name=bush", "*NODE, nset=All"]
    lines += [f"{n}, {', '.join(f'{1e3 * c:.12g}' for c in x)}" for n, x in zip(numbers, MESH.nodes, strict=True)]
    lines.append(f"*Element, type={kind},")
    lines.append("  elset=solid")
    for i, element in enumerate(MESH.elements):
        row = [str(i + 1), *(str(numbers[k]) for k in element)]
        lines += [", ".join(row[:12]) + ",", ", ".join(row[12:])]
    lines += ["*Element, type=S4", "9001, 7, 17, 27, 37"]
    outer = numbers[MESH.outer.nodes]
    lines.append("*Nset, nset=part-of-outer")
    lines += [", ".join(map(str, outer[i : i + 16])) for i in range(0, len(outer) - 5, 16)]
    lines += ["*NSET, NSET=Outer", "part-of-outer,", ", ".join(map(str, outer[-32:]))]
    lines += ["*Nset, nset=row, generate", "7, 47, 10", "*Material, name=steel", "*Elastic", "2.1e5, 0.3", "*End Part"]
    path.write_text("\n".join(lines))


def test_abaqus_input_is_read_with_its_numbers_units_and_node_sets(tmp_path):
    path = tmp_path / "bush.inp"
    write_inp(path)
    for held in ("outer", None, ehd.OnCylinder(radius=0.04)):
        mesh = ehd.mesh_from_file(path, bore_radius=0.03, scale=1e-3, held=held)
        for name in ("bore", "outer", "end_low", "end_high"):
            got, expected = getattr(mesh, name), getattr(MESH, name)
            assert got.faces.shape == expected.faces.shape
        order = np.lexsort(np.round(mesh.nodes, 9).T), np.lexsort(np.round(MESH.nodes, 9).T)
        np.testing.assert_allclose(mesh.nodes[order[0]], MESH.nodes[order[1]], atol=1e-12)
    assert len(read_abaqus("", path).sets["row"]) == 5


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
    with pytest.raises(InputError, match=r"instance is for Abaqus input files \(\.inp\), got 'bush' for bush.vtu"):
        ehd.mesh_from_file(path, bore_radius=0.03, instance="bush")
    meshio.Mesh(MESH.nodes, [("hexahedron20", MESH.elements), ("tetra10", MESH.elements[:, :10])]).write(path)
    with pytest.raises(InputError, match=r"of one kind, got \['hexahedron20', 'tetra10'\]"):
        ehd.mesh_from_file(path, bore_radius=0.03)


def test_what_cannot_be_read_is_named(tmp_path):
    path = tmp_path / "bush.inp"
    with pytest.raises(InputError, match="there is no file"):
        ehd.mesh_from_file(path, bore_radius=0.03)
    write_inp(path, kind="C3D8R")
    with pytest.raises(InputError, match=r"20-node hexahedra .* or 10-node tetrahedra .* got \['C3D8R'\]"):
        ehd.mesh_from_file(path, bore_radius=0.03)
    write_inp(path, kind="S8R")
    with pytest.raises(InputError, match=r"of one kind, got \['S4', 'S8R'\]"):
        ehd.mesh_from_file(path, bore_radius=0.03)
    write_inp(path)
    with pytest.raises(InputError, match=r"no node set 'seat', it has \['All', 'Outer', 'part-of-outer', 'row'\]"):
        ehd.mesh_from_file(path, bore_radius=0.03, held="seat")
    # metres taken for millimetres
    with pytest.raises(InputError, match=r"nodes have radii 30 to 40 m\. Check units"):
        ehd.mesh_from_file(path, bore_radius=0.03)
    path.write_text("*Node\n1, 0, 0, 0\n*Element, type=C3D20\n1, 1, 2, 3\n")
    with pytest.raises(InputError, match="no 20 nodes for each"):
        ehd.mesh_from_file(path, bore_radius=0.03)
    (tmp_path / "bush.step").write_text("solid")
    pytest.importorskip("meshio")
    with pytest.raises(InputError, match=r"meshio can't read bush\.step"):
        ehd.mesh_from_file(tmp_path / "bush.step", bore_radius=0.03)


PLACE = Rotation.from_rotvec(np.radians(37.0) * np.array([1.0, 2.0, -2.0]) / 3.0)
SHIFT, POINT = np.array([0.3, -0.1, 0.2]), np.array([0.05, 0.02, -0.04])


def assembly(path, instances=("bush-1",), parts=("bush",), kind="C3D10M"):
    """Tetrahedra in a part, placed by its instances: moved, then turned by 37 degrees about an axis through a point."""
    nodes, elements = tetrahedra(CYLINDER)
    outer = np.flatnonzero(np.isclose(np.hypot(nodes[:, 0], nodes[:, 1]), 0.04)) + 1
    lines = ["*Heading"]
    for part in parts:
        lines += [f"*Part, name={part}", "*Node", *node_lines(nodes), f"*Element, type={kind}"]
        lines += [*element_lines(elements, first=101), "*Nset, nset=Seat", *map(str, outer), "*End Part"]
    lines += ["*Part, name=shell", "*Node", "1, , 1.D-2,", "*Element, type=S3", "1, 1, 1, 1", "*End Part"]
    lines += ["*Assembly, name=Assembly"]
    second = POINT + [1.0, 2.0, -2.0]
    for name, part in zip(instances, [*parts, *parts], strict=False):
        lines += [f"*Instance, name={name}, part={part.upper()}", ", ".join(map(str, SHIFT))]
        lines += [", ".join(map(str, [*POINT, *second, 37.0])), "*End Instance"]
    lines += ["*Instance, name=shell-1, part=shell", "*End Instance", "*Node", "1, 9., 9., 9."]
    lines += [f"*Nset, nset=Held, instance={instances[0]}", ", ".join(map(str, outer[:8])), "Seat"]
    lines += ["*Nset, nset=Dotted", f"1, {instances[0]}.Seat", "*Nset, nset=Seat, instance=" + instances[0], "1, 2"]
    path.write_text("\n".join([*lines, "*End Assembly"]))
    return PLACE.apply(nodes + SHIFT - POINT) + POINT, elements


def test_an_instance_of_an_assembly_lies_where_its_translation_and_rotation_put_it(tmp_path):
    path = tmp_path / "assembly.inp"
    nodes, elements = assembly(path)
    got = read_abaqus("", path)
    np.testing.assert_allclose(got.nodes, nodes, rtol=0, atol=1e-14)
    np.testing.assert_array_equal(got.elements, elements)
    np.testing.assert_array_equal(got.numbers, 101 + np.arange(len(elements)))
    assert len(got.sets["Held"]) > len(got.sets["bush-1.Seat"]) == len(got.sets["Dotted"]) > len(got.sets["Seat"]) == 2
    centre, axis = PLACE.apply(SHIFT - POINT) + POINT, PLACE.apply([0.0, 0.0, 1.0])
    for held in ("held", "bush-1.seat", "dotted", None):
        mesh = ehd.mesh_from_file(path, bore_radius=0.03, held=held, origin=tuple(centre), axis=tuple(axis))
        for name in ("bore", "outer", "end_low", "end_high"):
            assert len(getattr(mesh, name).faces) == len(getattr(TETS, name).faces)
        radii = np.unique(np.round(np.hypot(*mesh.nodes[:, :2].T), 9))
        np.testing.assert_allclose(radii, [0.03, 0.035, 0.04], rtol=1e-12)
        np.testing.assert_allclose(np.ptp(mesh.nodes[:, 2]), 0.04, rtol=1e-12)
    # where the part itself lies, there is nothing
    with pytest.raises(InputError, match="no boundary face lies there"):
        ehd.mesh_from_file(path, bore_radius=0.03)
    # a part by itself lies in its own frame
    text = path.read_text().split("*Part, name=shell")[0]
    path.write_text(text)
    np.testing.assert_allclose(ehd.mesh_from_file(path, bore_radius=0.03).nodes, TETS.nodes, rtol=0, atol=1e-15)


def test_several_instances_are_told_apart_by_name(tmp_path):
    path = tmp_path / "assembly.inp"
    for instances, parts in ((("left", "right"), ("bush",)), (("left", "right"), ("bush", "lug"))):
        nodes, _ = assembly(path, instances, parts)
        with pytest.raises(InputError, match=r"2 bodies .* \['left', 'right'\]; name the bush, e.g. instance='left'"):
            ehd.mesh_from_file(path, bore_radius=0.03)
        np.testing.assert_allclose(read_abaqus("", path, "RIGHT").nodes, nodes, rtol=0, atol=1e-14)
        with pytest.raises(InputError, match=r"instance: assembly.inp has no 'bush', it has \['left', 'right', 'sh"):
            ehd.mesh_from_file(path, bore_radius=0.03, instance="bush")
        with pytest.raises(InputError, match=r"of one kind, got \['S3'\]"):
            ehd.mesh_from_file(path, bore_radius=0.03, instance="shell-1")
    text = path.read_text()
    path.write_text(text.replace(", ".join(map(str, SHIFT)) + "\n", ""))
    with pytest.raises(InputError, match=r"the instance 'left' .* must have a line of three numbers, its translation"):
        ehd.mesh_from_file(path, bore_radius=0.03, instance="left")
    path.write_text(text.replace("part=LUG", "part=cap"))
    with pytest.raises(InputError, match=r"instance 'right' .* got 'cap'; the parts are \['bush', 'lug', 'shell'\]"):
        ehd.mesh_from_file(path, bore_radius=0.03)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("*Node\n", "*Node, system=C\n", r"bush.inp has \*Node with data that are not read"),
        ("*Node\n", "*Include, input=nodes.txt\n*Node\n", r"\*Include with data that are not read"),
        ("*Node\n", "*System\n1., 0., 0.\n*Node\n", r"\*System with data"),
        ("*Element, type=C3D10M", "*Elgen\n1, 2\n*Element, type=C3D10M", r"\*Elgen with data"),
        ("*Element, type=C3D10M", "*Element, type=C3D4\n7, 1, 2, 3, 4\n*Element, type=C3D10M", "of one kind, got"),
        ("*Nset, nset=Seat\n", "*Nset, nset=Seat\nnowhere\n", "names 'nowhere', which is not defined before it"),
        ("*Nset, nset=Seat\n", "*Nset, nset=Seat, instance=x\n", "a node set of 'x', which is no instance"),
        ("*Node\n1,", "*Node\n1, here,", "a data line of bush.inp can't be read"),
    ],
)
def test_what_would_be_read_wrongly_is_refused(tmp_path, old, new, message):
    path = tmp_path / "bush.inp"
    assembly(path)
    text = path.read_text().split("*Part, name=shell")[0]
    assert text.count(old) == 1
    path.write_text(text.replace(old, new))
    with pytest.raises(InputError, match=message):
        ehd.mesh_from_file(path, bore_radius=0.03)


def test_inverted_tetrahedra_are_named_by_the_file_s_numbers(tmp_path):
    path = tmp_path / "bush.inp"
    nodes, elements = tetrahedra(CYLINDER)
    for change in (lambda row: row[[1, 0, 2, 3, 4, 6, 5, 8, 7, 9]], lambda row: row[[0, 1, 2, 3, 5, 4, 6, 7, 8, 9]]):
        wrong = elements.copy()
        wrong[5] = change(wrong[5])
        path.write_text("\n".join(["*Node", *node_lines(nodes), "*Element, type=C3D10", *element_lines(wrong, 41)]))
        with pytest.raises(InputError, match=r"got 1 inverted or degenerate ones, the first is element 46; .*C3D10"):
            ehd.mesh_from_file(path, bore_radius=0.03)
        with pytest.raises(InputError, match=r"the first is element 5;"):
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
