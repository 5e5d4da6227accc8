"""Bush meshes read from files: Abaqus input as CAD programs write it, and a format of meshio's."""

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.status import InputError

MESH = ehd.HollowCylinder(inner_radius=0.03, thickness=0.01, length=0.04, axial=2, radial=1, circumferential=8).mesh()


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
    from exudyn_ehd.solid.mesh_import import read_abaqus

    assert len(read_abaqus(path).sets["row"]) == 5


@pytest.mark.parametrize(("ending", "kind"), [("vtu", "vtu"), ("msh", "gmsh")])
def test_meshio_reads_other_formats(tmp_path, ending, kind):
    meshio = pytest.importorskip("meshio")
    path = tmp_path / f"bush.{ending}"
    meshio.Mesh(MESH.nodes, [("hexahedron20", MESH.elements)]).write(path, file_format=kind)
    mesh = ehd.mesh_from_file(path, bore_radius=0.03)
    np.testing.assert_allclose(mesh.nodes[mesh.elements], MESH.nodes[MESH.elements], atol=1e-12)


def test_what_cannot_be_read_is_named(tmp_path):
    path = tmp_path / "bush.inp"
    with pytest.raises(InputError, match="there is no file"):
        ehd.mesh_from_file(path, bore_radius=0.03)
    write_inp(path, kind="C3D10")
    with pytest.raises(InputError, match=r"20-node hexahedra .* got \['C3D10', 'S4'\]"):
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
