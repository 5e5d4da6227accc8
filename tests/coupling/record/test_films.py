"""Films kept over a run: which instants, bounded memory, what they hold; their animation and VTK files."""

import dataclasses
import math
import sys
import xml.etree.ElementTree as ET

import numpy as np
import pytest
from PIL import Image
from rotor import CLEARANCE, LENGTH, RADIUS, rotor, run, steel_bush

import exudyn_ehd as ehd
from exudyn_ehd.coupling.record.record import FilmRecorder
from exudyn_ehd.joint.model.build import build_model
from exudyn_ehd.pictures import files
from exudyn_ehd.status import InputError
from tests.sampling import sample
from tests.solid_tetrahedra import tet_mesh


@pytest.fixture(scope="module")
def recorded():
    mbs, joint = rotor()
    joint.record_films(period=5e-4)
    mbs.Assemble()
    run(mbs)
    return joint


def test_films_stand_at_their_instants_and_belong_to_their_rows(recorded):
    films, history = recorded.films, recorded.history
    np.testing.assert_allclose([film.time for film in films], [0.0, 5e-4, 1e-3, 1.5e-3, 2e-3], atol=1e-15)
    model = build_model(recorded.bearing)
    for film in films:
        k = int(np.argmin(np.abs(history.time - film.time)))
        np.testing.assert_array_equal(film.motion, history.motion[k])
        np.testing.assert_array_equal(film.force, history.force[k])
        again = model.evaluate(film.motion).film
        expected = again.oil.P * again.scales.pressure
        # a film that fades at the start has rounding only
        np.testing.assert_allclose(film.pressure, expected, atol=1e-9 * max(expected.max(), 1.0))


def test_films_of_a_run_are_none_of_a_state_that_was_changed_since():
    """A linearisation leaves the system at its initial values: what was kept stays, the present film is none of it."""
    mbs, joint = rotor()
    joint.record_films(period=5e-4)
    mbs.Assemble()
    run(mbs)
    before = joint.films
    mbs.ComputeLinearizedSystem()
    assert [film.time for film in joint.films] == [film.time for film in before[:-1]]
    for read in (joint.film, joint.plot_pressure):
        with pytest.raises(InputError, match=r"film: the system is at t = 0 s.*read or store it right behind the run"):
            read()


def test_forget_drops_the_films_of_earlier_runs():
    mbs, joint = rotor()
    joint.record_films(period=5e-4)
    mbs.Assemble()
    run(mbs)
    assert len(joint.films) == 5
    joint.forget()
    assert len(joint.films) <= 1


def test_recording_changes_no_bit_of_the_run(recorded):
    mbs, joint = rotor()
    mbs.Assemble()
    run(mbs)
    assert joint.films == () and joint.element.steps.recorder is None
    np.testing.assert_array_equal(joint.history.motion, recorded.history.motion)
    np.testing.assert_array_equal(joint.history.force, recorded.history.force)


@pytest.mark.parametrize(("period", "steps"), [(0.0, 100), (0.02, 100), (0.013, 77)])
def test_memory_is_bounded_and_films_span_the_run_evenly(period, steps):
    recorder = FilmRecorder(period, 8)
    for time in np.linspace(0.0, 1.0, steps + 1):
        recorder.offer(time, lambda time=time: time)
        assert len(recorder.films) <= 8
    times = np.array(recorder.films)
    assert times[0] == 0.0 and len(times) >= 4
    spacing = np.diff(times)
    # instants are met to within a step
    assert spacing.max() - spacing.min() <= 1.0 / steps + 1e-12
    assert times[-1] + spacing.max() + 1.0 / steps >= 1.0 - 1e-9


def test_an_earlier_time_starts_a_new_record():
    recorder = FilmRecorder(0.0, 8)
    for time in (0.0, 0.1, 0.1, 0.2, 0.0, 0.05):
        recorder.offer(time, lambda time=time: time)
    assert recorder.films == [0.0, 0.05]


def test_what_can_not_be_recorded_is_refused(make_bearing):
    _, joint = rotor()
    with pytest.raises(InputError, match=r"record_films: period must be .* -1"):
        joint.record_films(period=-1.0)
    with pytest.raises(InputError, match="record_films: frames must be an integer >= 2"):
        joint.record_films(frames=1)
    with pytest.raises(
        InputError, match=r"no films of joint 'bearing' were kept; call joint.record_films\(\) before the run"
    ):
        joint.animate("a.gif")


@pytest.mark.slow
def test_animation_shows_every_film(recorded, tmp_path):
    recorded.animate(tmp_path / "bearing.gif", frames_per_second=5)
    with Image.open(tmp_path / "bearing.gif") as gif:
        assert gif.n_frames == 5
        # Pillow may merge nothing here: every frame differs
        assert gif.info["duration"] == 200
    frames = files.Frames(recorded.films, recorded.history)
    film = recorded.films[-1]
    frames.show(film)
    np.testing.assert_allclose(
        np.column_stack(frames.trail.get_data()), 1e6 * recorded.history.eccentricity, rtol=1e-12
    )
    assert np.asarray(frames.image.get_array()).max() == pytest.approx(1e-6 * film.pressure.max(), rel=1e-9)
    assert frames.title.get_text().startswith("t = 2.000 ms")
    with pytest.raises(InputError, match=r"must end in \.gif or \.mp4"):
        recorded.animate(tmp_path / "bearing.avi")


def test_mp4_needs_ffmpeg(recorded, tmp_path, monkeypatch):
    monkeypatch.setattr(files.animation.FFMpegWriter, "isAvailable", classmethod(lambda cls: False))
    with pytest.raises(InputError, match=r"needs the program ffmpeg.*write a \.gif"):
        recorded.animate(tmp_path / "bearing.mp4")


@pytest.mark.parametrize("kind", sample([ehd.ModalBush, ehd.ANCFBush], 0), ids=lambda kind: kind.__name__)
def test_bush_and_film_in_vtk_files(kind, tmp_path):
    meshio = pytest.importorskip("meshio")
    mbs, joint = rotor(steel_bush(kind))
    joint.record_films(period=1e-3)
    mbs.Assemble()
    run(mbs, steps=4)
    written = joint.export_vtk(tmp_path / "out" / "bearing.pvd", magnification=100.0)
    films = joint.films
    assert [path.name for path in written] == ["bearing.pvd"] + [
        f"{name}_{k:05d}.vtu" for k in range(3) for name in ("film", "bush")
    ]
    sets = ET.parse(written[0]).getroot().findall("./Collection/DataSet")
    assert [float(one.get("timestep")) for one in sets] == [film.time for film in films for _ in range(2)]
    assert all((written[0].parent / one.get("file")).exists() for one in sets)

    film = films[-1]
    surface = meshio.read(written[-2])
    np.testing.assert_array_equal(surface.point_data["pressure [Pa]"].reshape(film.pressure.shape), film.pressure)
    np.testing.assert_array_equal(surface.point_data["gap [m]"].reshape(film.gap.shape), film.gap)
    r = np.hypot(*surface.points[:, :2].T).reshape(film.gap.shape)
    np.testing.assert_allclose(r, RADIUS + CLEARANCE + 100.0 * film.bore_displacement, rtol=1e-12)
    (quads,) = surface.cells
    # the closed ring of quadrilaterals covers the bore: its area is that of the 48-gon, to the magnified displacement
    corner = surface.points[quads.data]
    area = 0.5 * np.linalg.norm(np.cross(corner[:, 2] - corner[:, 0], corner[:, 3] - corner[:, 1]), axis=1).sum()
    assert area == pytest.approx(48 * 2 * math.sin(math.pi / 48) * (RADIUS + CLEARANCE) * LENGTH, rel=5e-3)
    normal = np.cross(corner[:, 2] - corner[:, 0], corner[:, 3] - corner[:, 1])
    assert np.all(np.einsum("qi,qi->q", normal[:, :2], corner.mean(axis=1)[:, :2]) < 0.0), "normals point to the axis"

    solid = meshio.read(written[-1])
    mesh = joint.bearing.bush.build_mesh()
    u = solid.point_data["displacement [m]"]
    np.testing.assert_allclose(solid.points, mesh.nodes + 100.0 * u, rtol=0, atol=1e-15)
    assert solid.cells[0].type == "hexahedron20"
    # VTK's order: nodes 8 .. 19 halve the edges 01 12 23 30, 45 56 67 74, 04 15 26 37 (in radius to the arc's height)
    ends = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]
    x = mesh.nodes[solid.cells[0].data]
    for k, (a, b) in enumerate(ends):
        np.testing.assert_allclose(x[:, 8 + k], 0.5 * (x[:, a] + x[:, b]), atol=0.02 * 0.04)
    # at the bore's nodes the mesh moves as the film's bore: radially by delta there
    bore = mesh.bore.nodes
    moved = np.einsum("ni,ni->n", u[bore, :2], mesh.nodes[bore, :2]) / np.hypot(*mesh.nodes[bore, :2].T)
    largest = np.abs(film.bore_displacement).max()
    assert moved.max() == pytest.approx(film.bore_displacement.max(), abs=0.1 * largest)
    # fixed to the housing, to rounding of the nodes' positions
    assert np.abs(u[mesh.outer.nodes]).max() < 1e-15
    stress = solid.point_data["von Mises stress [Pa]"]
    # of the order of the pressure that makes it
    assert 0.2 * film.pressure.max() < stress.max() < 2.0 * film.pressure.max()


@pytest.mark.slow
def test_bush_of_tetrahedra_in_vtk_files_and_the_renderer(tmp_path):
    meshio = pytest.importorskip("meshio")
    bush = steel_bush(ehd.ModalBush)
    mbs, joint = rotor(dataclasses.replace(bush, mesh=tet_mesh(bush.mesh), quadrature=None))
    joint.record_films(period=1e-3)
    mbs.Assemble()
    run(mbs, steps=4)
    solid = meshio.read(joint.export_vtk(tmp_path / "bearing.pvd")[-1])
    mesh = joint.bearing.bush.build_mesh()
    assert solid.cells[0].type == "tetra10"
    np.testing.assert_array_equal(solid.cells[0].data, mesh.elements)
    stress, peak = solid.point_data["von Mises stress [Pa]"], joint.films[-1].pressure.max()
    assert 0.2 * peak < stress.max() < 2.0 * peak
    scene = mbs.variables["container"].renderer.GetGraphicsData()["triangles"]
    own = scene["items"][:, 2] == int(joint.objectNumber)
    n, m = joint.films[-1].pressure.shape
    assert np.count_nonzero(own) == 2 * n * (m + 1) + 4 * len(mesh.boundary)


def test_vtk_of_a_rigid_bearing_at_one_instant(tmp_path):
    meshio = pytest.importorskip("meshio")
    mbs, joint = rotor()
    mbs.Assemble()
    run(mbs, steps=4)
    written = joint.export_vtk(tmp_path / "now.pvd")
    assert len(written) == 2
    surface = meshio.read(written[1])
    assert set(surface.point_data) == {"pressure [Pa]", "gap [m]", "unbroken"}
    with pytest.raises(InputError, match=r"must end in \.pvd, got '.*now\.vtu'"):
        joint.export_vtk(tmp_path / "now.vtu")


def test_without_meshio_the_error_says_what_to_install(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "meshio", None)
    mbs, joint = rotor()
    mbs.Assemble()
    with pytest.raises(InputError, match=r"needs the package meshio.*pip install meshio"):
        joint.export_vtk(tmp_path / "now.pvd")
