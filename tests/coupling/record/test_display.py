"""Graphics that a joint gives Exudyn's renderer, requested without a window; sensors in Exudyn's own plots."""

import exudyn as exu
import matplotlib
import matplotlib.pyplot as plt
import numpy as np
import pytest
import scenes
from bodies import AGAINST_CONNECTOR
from rotor import CLEARANCE, LENGTH, RADIUS, rotor, run, steel_bush
from springs import joined

import exudyn_ehd as ehd
from exudyn_ehd.coupling.element.outputs import GREY, ring_triangles

TURN = scenes.rotation([0.4, -0.3, 0.5])


def drawn(mbs, number):
    """Triangles (points, colours) and lines of one object, as Exudyn builds them for its renderers."""
    scene = mbs.variables["container"].renderer.GetGraphicsData()
    out = []
    for kind in ("triangles", "lines"):
        own = scene[kind]["items"][:, 2] == int(number)
        own &= scene[kind]["items"][:, 1] == int(exu.ItemType.Object)
        out.append((np.asarray(scene[kind]["points"])[own], np.asarray(scene[kind]["colors"])[own]))
    return out


@pytest.mark.parametrize("share", [None, 0.0])
def test_film_is_a_layer_between_journal_and_bore_in_a_ring(share):
    """True radius of the journal, clearance and thickness by one factor; pressures on the bore, largest at the ends."""
    mbs, joint = rotor()
    mbs.Assemble()
    run(mbs)
    if share is not None:
        joint.display.clearance = share
    factor = 1.0 if share == 0.0 else 0.1 * RADIUS / CLEARANCE
    (points, colors), (edges, _) = drawn(mbs, joint.objectNumber)
    film = joint.film()
    n, m = film.pressure.shape
    ring = np.isclose(colors[:, 0, 3], GREY[3])
    assert edges.size > 0 and ring.sum() == 6 * n and (~ring).sum() == 2 * n * (m + 1)
    radius = (RADIUS + factor * CLEARANCE) / np.cos(np.pi / n)
    r, z = np.hypot(points[..., 0], points[..., 1]), points[..., 2]
    layer = slice(0, 2 * n * (m - 1))
    # Exudyn draws in single precision
    np.testing.assert_allclose(r[layer], radius, rtol=1e-6)
    palette = matplotlib.colormaps["viridis"]
    expected = palette((film.pressure / film.pressure.max()).ravel())[ring_triangles(n, m)]
    np.testing.assert_allclose(colors[layer], expected, atol=1e-6)
    corners = np.stack(np.broadcast_arrays(film.theta[:, None], film.z), axis=-1).reshape(-1, 2)[ring_triangles(n, m)]
    np.testing.assert_allclose(z[layer], corners[..., 1], atol=1e-6)
    np.testing.assert_allclose(points[layer][..., 0], radius * np.cos(corners[..., 0]), atol=1e-6)
    for place, k in ((slice(2 * n * (m - 1), 2 * n * m), 0), (slice(2 * n * m, 2 * n * (m + 1)), -1)):
        np.testing.assert_allclose(z[place], film.z[k], atol=1e-7)
        inner = r[place] < radius * (1.0 - 1e-6)
        angle = np.arctan2(points[place][..., 1], points[place][..., 0])[inner]
        where = np.argmin(np.abs(np.angle(np.exp(1j * (angle[:, None] - film.theta)))), axis=1)
        np.testing.assert_allclose(
            radius - r[place][inner], factor * film.gap[where, k], rtol=2e-2 if share == 0.0 else 1e-4
        )
        np.testing.assert_allclose(
            colors[place][inner], palette(film.pressure.max(axis=1) / film.pressure.max())[where], atol=1e-6
        )
    assert r[ring].min() == pytest.approx(radius, rel=1e-6)
    assert r[ring].max() == pytest.approx(radius + 0.2 * RADIUS, rel=1e-6)
    assert np.abs(z[ring]).max() == pytest.approx(0.5 * LENGTH, rel=1e-6)


def test_without_a_renderer_nothing_is_stored():
    mbs, joint = rotor()
    mbs.Assemble()
    run(mbs, steps=4)
    assert not joint.display.wanted and joint.display.pressure is None


def test_drawing_within_a_run_shows_the_last_accepted_step_and_changes_no_bit():
    motions = []
    for watched in (False, True):
        mbs, joint = rotor()
        joint.record_films()
        mbs.Assemble()
        display, shown = joint.display, []

        def look(mbs, t, number=joint.objectNumber, joint=joint, shown=shown):
            before = joint.element.evaluations
            drawn(mbs, number)
            if t > 0.0:
                assert joint.element.evaluations == before, "within a run the film belongs to the solver"
                shown.append(joint.display.pressure)
            return True

        if watched:
            mbs.SetPostStepUserFunction(look)
        run(mbs)
        motions.append(joint.history.motion)
        if watched:
            # after step k the film of its start is shown
            for pressure, film in zip(shown[1:], joint.element.steps.recorder.films[1:], strict=False):
                np.testing.assert_array_equal(pressure, film.pressure)
            assert len(shown) == 20 and display.wanted
    np.testing.assert_array_equal(*motions)


def test_image_of_the_ray_tracer_needs_no_display(monkeypatch):
    monkeypatch.delenv("DISPLAY", raising=False)
    mbs, _ = rotor()
    mbs.Assemble()
    run(mbs)
    container = mbs.variables["container"]
    container.visualizationSettings.view0.window.renderWindowSize = [160, 120]
    # the first image sets the view from the settings
    container.renderer.RedrawAndGetImage(True)
    container.renderer.SetModelView(zoom=0.05, rotationVector=[-0.9, 0.5, 0.0])
    image = np.array(container.renderer.RedrawAndGetImage(True))
    assert image.shape == (120, 160, 3)
    # the hue of the map's yellow end (253, 231, 37), however much light falls on it; nothing else in the scene is
    # yellow
    red, green, blue = (image[..., k].astype(int) for k in range(3))
    assert np.count_nonzero((red > 40) & (green > 0.7 * red) & (blue < 0.4 * red)) > 20


@pytest.mark.parametrize("node", ["EP", "2D"])
def test_film_moves_with_its_housing(node):
    mbs = scenes.new_system()
    matrix = scenes.rotation([0.0, 0.0, 0.7]) if node == "2D" else TURN
    place = np.array([0.3, 0.2, 0.0])
    housing = scenes.add_body(mbs, node, place, matrix)
    journal = scenes.add_body(mbs, node, place, matrix)
    bearing = ehd.JournalBearing(
        journal_radius=RADIUS, length=0.05, radial_clearance=CLEARANCE, lubricant=ehd.Lubricant(viscosity=0.02)
    )
    axis = matrix[:, 2]
    joint = ehd.CreateLubricatedJoint(mbs, itemNumbers=[housing, journal], position=place, axis=axis, bearing=bearing)
    mbs.Assemble()
    _, (edges, _) = drawn(mbs, joint.objectNumber)
    local = (edges.reshape(-1, 3) - place) @ matrix
    np.testing.assert_allclose(np.abs(local[:, 2]), 0.025, atol=1e-6)
    np.testing.assert_allclose(np.hypot(local[:, 0], local[:, 1]), 1.1 * RADIUS / np.cos(np.pi / 96), rtol=1e-5)


@pytest.mark.parametrize("name", AGAINST_CONNECTOR)
def test_frame_of_every_kind_of_housing(name):
    """The drawing stands where the joint is, in the state that the renderer shows."""
    mbs, _, joint = joined(AGAINST_CONNECTOR[name], role="housing")
    mbs.Assemble()
    element, kind = joint.element, exu.ConfigurationType
    element.look(mbs, 0.0, kind.Current)
    start = element.sides[0].frame.copy()
    np.testing.assert_allclose(joint.display._frame(mbs), start, atol=1e-14)
    mbs.SolveDynamic(scenes.settings(2e-3, 4, tolerance=1e-6, full_newton=False))
    mbs.systemData.SetSystemState(mbs.systemData.GetSystemState(kind.Current), kind.Visualization)
    element.look(mbs, mbs.systemData.GetTime(kind.Current), kind.Current)
    frame = element.sides[0].frame
    assert np.abs(frame - start).max() > 0.0
    # position and rotation; rates aren't drawn
    np.testing.assert_allclose(joint.display._frame(mbs)[:, :4], frame[:, :4], atol=1e-14)


@pytest.mark.slow
def test_modal_bush_is_drawn_around_the_film():
    mbs, joint = rotor(steel_bush(ehd.ModalBush))
    mbs.Assemble()
    drawn(mbs, joint.objectNumber)
    run(mbs, steps=4)
    (points, colors), _ = drawn(mbs, joint.objectNumber)
    bush = np.isclose(colors[:, 0, 3], GREY[3])
    mesh = joint.element.model.bore.modes.mesh
    assert bush.sum() == 6 * len(mesh.boundary)
    r = np.hypot(points[bush][..., 0], points[bush][..., 1])
    # its bore where the film is drawn, its own thickness, deflections by the film's factor
    factor, deflection = 0.1 * RADIUS / CLEARANCE, np.abs(joint.display.bush).max()
    assert 0.0 < factor * deflection < 0.02 * RADIUS
    assert r.max() == pytest.approx(1.1 * RADIUS + 0.015, abs=factor * deflection)
    assert r.min() == pytest.approx(1.1 * RADIUS, abs=2.0 * factor * deflection)


def test_sensors_in_exudyns_plots():
    """`mbs.PlotSensor` draws a joint's sensors: the lines hold the history."""
    mbs, joint = rotor()
    force = joint.AddSensor(ehd.Quantity.FORCE)
    gap = joint.AddSensor(ehd.Quantity.MINIMUM_GAP)
    mbs.Assemble()
    settings = scenes.settings(2e-3, 20, tolerance=1e-8)
    settings.solution.sensors.writePeriod = 1e-4
    mbs.SolveDynamic(settings)
    mbs.PlotSensor(
        sensorNumbers=[force, gap], components=[1, 0], labels=["force y", "film"], newFigure=True, closeAll=True
    )
    try:
        lines = plt.gcf().axes[0].lines
        history = joint.history
        assert len(lines) == 2
        np.testing.assert_allclose(lines[0].get_xdata(), history.time, atol=1e-15)
        np.testing.assert_array_equal(lines[0].get_ydata(), history.force[:, 1])
        np.testing.assert_array_equal(lines[1].get_ydata(), history.minimum_gap)
    finally:
        plt.close("all")
