"""Thrust bearings with tilting pads in Exudyn models."""

import dataclasses
import math

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
import pytest
import scenes
from exudyn.utilities import RigidBodyInertia

import exudyn_ehd as ehd
from exudyn_ehd.joint.static.thrust_pads import axial
from tests.sampling import sample

PADS = ehd.TiltingThrustPads(
    inner_radius=0.05,
    outer_radius=0.1,
    pads=3,
    extent=0.65,
    pivot_radius=0.077,
    pivot_angle=0.39,
    clearance=60e-6,
    lubricant=ehd.Lubricant(viscosity=0.03),
    pad_mass=0.3,
    pad_inertia=(6e-5, 9e-5),
    n_theta=12,
    n_r=8,
)
SPEED, LOAD = 300.0, 12e3


def _with(**options):
    return dataclasses.replace(PADS, **options)


def _turn(axis):
    z = np.array(axis) / np.linalg.norm(axis)
    x = np.cross([0.3, 1.0, -0.2], z)
    x /= np.linalg.norm(x)
    return np.column_stack([x, np.cross(z, x), z])


def _shaft(mbs, turn, mass, *, height=0.0, at=(0.0, 0.0, 0.0), node="RotVec"):
    """A heavy body that spins about the axis, above its place in the reference configuration."""
    return mbs.CreateRigidBody(
        inertia=RigidBodyInertia(mass, 1e3 * mass * np.diag([1.0, 1.0, 1.5])),
        referencePosition=list(at),
        referenceRotationMatrix=turn,
        initialDisplacement=(height * turn[:, 2]).tolist(),
        initialAngularVelocity=(SPEED * turn[:, 2]).tolist(),
        # a steady spin is exact by rotation vectors
        nodeType=scenes.NODE_TYPES[node],
    )


def _scene(pads, *, axis=(0, 0, 1), mass=300.0, height=0.0, load=LOAD, housing=None):
    """A loaded shaft that a joint of Exudyn holds in all directions but along the axis and about it."""
    mbs, turn = scenes.new_system(), _turn(axis)
    ground, shaft = mbs.CreateGround(), _shaft(mbs, turn, mass, height=height)
    carrier = ground if housing is None else housing(mbs, ground)
    thrust = ehd.CreateTiltingPadThrustBearing(mbs, "thrust", [carrier, shaft], [0, 0, 0], turn[:, 2], pads)
    mbs.CreateGenericJoint(
        itemNumbers=[ground, shaft], position=[0, 0, 0], rotationMatrixAxes=turn, constrainedAxes=[1, 1, 0, 1, 1, 0]
    )
    mbs.CreateForce(itemNumber=shaft, loadVector=(-load * turn[:, 2]).tolist())
    mbs.Assemble()
    return mbs, thrust, shaft


def _run(mbs, end, steps):
    settings = ehd.ConfigureSolver(exu.SimulationSettings())
    settings.timeIntegration.endTime, settings.timeIntegration.numberOfSteps = end, steps
    assert ehd.SolveDynamic(mbs, settings)


@pytest.mark.parametrize("crown", (0.0, 10e-6))
def test_jacobian(crown):
    """Central differences of the force of a film on a pad and a shaft that both move."""
    mbs, turn = scenes.new_system(), _turn((0.2, 0.1, 1.0))
    shaft = _shaft(mbs, turn, 1.0, at=(0.0, 0.05, 0.1), node="EP")
    thrust = ehd.CreateTiltingPadThrustBearing(
        mbs, "thrust", [mbs.CreateGround(), shaft], [0, 0, 0], turn[:, 2], _with(crown=crown)
    )
    mbs.Assemble()
    element, rng = thrust.pads[1].element, np.random.default_rng(2)
    q, q_t = 3e-5 * rng.normal(size=14), 1e-2 * rng.normal(size=14)
    # the spin about the axis by Euler parameters of the reference rotation
    reference = mbs.GetNodeParameter(mbs.GetObject(shaft)["nodeNumber"], "referenceCoordinates")[3:]
    x, y, z = 0.5 * 200.0 * turn[:, 2]
    spin = np.array([[0, -x, -y, -z], [x, 0, -z, y], [y, z, 0, -x], [z, -y, x, 0]]) @ reference
    q_t[10:] += spin

    def force(q, q_t):
        return element.force(mbs, 0.0, 0, q.tolist(), q_t.tolist())

    first = force(q, q_t)
    assert np.all(np.isfinite(first)) and np.abs(first).max() > 1.0
    # pad and shaft are pushed apart, to rounding
    assert np.abs(first[:3] + first[7:10]).max() < 1e-12 * np.abs(first[:3]).max()
    kinds = np.r_[np.zeros(3), np.ones(4), np.zeros(3), np.ones(4)].astype(int)
    for f_q, f_qt, step in ((1.0, 0.0, 1e-9), (0.0, 1.0, 1e-6)):
        jacobian = element.jacobian(mbs, 0.0, 0, q.tolist(), q_t.tolist(), f_q, f_qt)
        columns = []
        for d in step * np.eye(14):
            plus, minus = (force(q + f_q * s * d, q_t + f_qt * s * d) for s in (1, -1))
            columns.append(-(plus - minus) / (2 * step))
        expected = np.array(columns).T
        for a in (0, 1):
            for b in (0, 1):
                block = np.ix_(kinds == a, kinds == b)
                assert np.abs(jacobian[block] - expected[block]).max() < 3e-6 * np.abs(expected[block]).max()


def _carrier(mbs, ground):
    """A heavy free housing that starts turned and tilted about the bearing's centre, and turns on."""
    turned, place = scenes.rotation([2e-5, -3e-5, 0.4]), np.array([0.1, 0.2, 0.3])
    return mbs.CreateRigidBody(
        name="carrier",
        inertia=RigidBodyInertia(5000.0, 200.0 * np.eye(3)),
        referencePosition=place.tolist(),
        initialRotationMatrix=turned,
        initialDisplacement=(turned @ place - place).tolist(),
        initialVelocity=np.cross([0.0, 0.0, 5.0], turned @ place).tolist(),
        initialAngularVelocity=[0.0, 0.0, 5.0],
    )


@pytest.mark.parametrize(
    ("axis", "options"),
    sample(
        (
            ((0, 0, 1), {}),
            ((0.4, -1.0, 0.3), {"pivot_stiffness": 3e8, "pivot_damping": 1e5}),
            ((1, 0, 0), {"pivot_angle": 0.325, "crown": 20e-6}),
        ),
        1,
    ),
)
def test_pads_come_to_rest_where_equilibrium_says(axis, options):
    """Film thickness, tilts, loss and load of a heavy spinning shaft after its pads have settled, along any axis."""
    pads = _with(**options)
    rest = ehd.equilibrium(pads, speed=SPEED, load=LOAD)
    mbs, thrust, shaft = _scene(pads, axis=axis, mass=300.0)
    _run(mbs, 0.04, 120)
    assert thrust.film_thickness.shape[1] == 3
    assert thrust.film_thickness[-1] == pytest.approx(rest.film_thickness, rel=1e-3)
    assert sum(pad.history.thrust_force[-1] for pad in thrust.pads) == pytest.approx(LOAD, rel=1e-3)
    for pad in thrust.pads:
        history = pad.history
        assert history.thrust_minimum_gap[-1] == pytest.approx(rest.minimum_gap, rel=1e-3)
        assert -history.motion[-1, 2:4] == pytest.approx(rest.inclination, abs=1e-3 * np.abs(rest.inclination).max())
        assert history.thrust_power_loss[-1] == pytest.approx(rest.power_loss / 3, rel=2e-3)
        assert np.isnan(history.step_error).all()
    # what the pivots give
    sunk = 0.0 if pads.pivot_stiffness is None else LOAD / 3 / pads.pivot_stiffness
    position = mbs.GetObjectOutputBody(shaft, exu.OutputVariableType.Displacement, [0, 0, 0])
    expected = rest.film_thickness - pads.pivot_film - sunk
    assert _turn(axis)[:, 2] @ position == pytest.approx(expected, abs=2e-3 * rest.film_thickness)


def test_pads_start_with_their_housing():
    """A housing that starts turned, tilted and shifted takes its pads along; they follow as they do on ground."""
    mbs, thrust, _ = _scene(_with(pads=2), housing=_carrier)
    start = thrust.film_thickness[0]
    # tilts of 3e-5 rad at 77 mm
    assert np.abs(start - PADS.clearance).max() < 3e-6 and np.ptp(start) > 1e-7
    angles = [pad.element.sides[0] for pad in thrust.pads]
    assert np.allclose(angles[0].frame[:, :3] @ np.diag([-1, -1, 1]), angles[1].frame[:, :3], atol=1e-12)
    _run(mbs, 2e-3, 8)
    # nothing pulls at the pivots before the films do
    assert np.abs(thrust.film_thickness[1] - start).max() < 3e-6
    rates = [pad.history.motion[0, 8] for pad in thrust.pads]
    carrier = exu.OutputVariableType.AngularVelocity, [0.0, 0.0, 0.0], exu.ConfigurationType.Initial
    spin = mbs.GetObjectOutputBody(mbs.GetObjectNumber("carrier"), *carrier)[2]
    assert rates == pytest.approx([SPEED - spin] * 2, rel=1e-6) and spin > 4.0


@pytest.mark.slow
@pytest.mark.parametrize(
    ("options", "mass"),
    (({}, 2e4), ({"pivot_stiffness": 2e8, "pivot_damping": 1e5}, 2e4), ({"pad_inertia": (0.05, 0.05)}, 1e4)),
)
def test_free_vibration(options, mass):
    """Decay and frequency of a mass on the pads: M s^2 + Z(s) = 0, to 1 %, at amplitudes below 0.2 % of the film."""
    pads = _with(pads=2, **options)
    rest = ehd.equilibrium(pads, speed=SPEED, load=LOAD)
    s = 1j * math.sqrt(rest.stiffness / mass)
    for _ in range(20):

        def lacks(s):
            return mass * s * s + axial(pads, rest.pad_stiffness, rest.pad_damping, -1j * s)

        d = 1e-6 * abs(s)
        s -= lacks(s) * 2 * d / (lacks(s + d) - lacks(s - d))
    # as slow motions at its frequency have it, without the decay
    there = rest.dynamic_stiffness([abs(s.imag)])[0]
    assert there.imag / abs(s.imag) / mass == pytest.approx(-2 * s.real, rel=0.04)
    sunk = 0.0 if pads.pivot_stiffness is None else LOAD / 2 / pads.pivot_stiffness
    mbs, thrust, _ = _scene(pads, mass=mass, height=rest.film_thickness - pads.pivot_film - sunk)
    # steps of 0.05 rad make 0.03 % of decay
    end = 9.0 / abs(s.real)
    steps = math.ceil(end * abs(s.imag) / 0.05)
    _run(mbs, end, steps)
    film = thrust.film_thickness[:, 0] / rest.film_thickness - 1.0
    y, k = film[np.flatnonzero(np.abs(film) > 2e-3)[-1] + 1 :], 4
    step = k * end / steps
    ahead = np.linalg.lstsq(np.column_stack([y[k:-k], y[: -2 * k], np.ones(y.size - 2 * k)]), y[2 * k :], rcond=None)[0]
    found = np.log(np.roots([1.0, -ahead[0], -ahead[1]]).astype(complex)) / step
    found = found[found.imag > 0.0][0]
    assert found.imag == pytest.approx(abs(s.imag), rel=0.01)
    assert found.real == pytest.approx(s.real, rel=0.01)


def test_markers_and_sensors():
    """Markers, also ones elsewhere on the axis, hold the same bearing as bodies; sensors read the films."""
    ends = []
    for height in (None, 0.0, 0.05):
        mbs = scenes.new_system()
        ground, shaft = mbs.CreateGround(), _shaft(mbs, np.eye(3), 300.0)
        items, position = [ground, shaft], [0, 0, 0.1]
        if height is not None:
            places = ((ground, 0.1), (shaft, 0.1 + height))
            markers = [eii.MarkerBodyRigid(bodyNumber=body, localPosition=[0, 0, z]) for body, z in places]
            items, position = [mbs.AddMarker(marker) for marker in markers], []
        thrust = ehd.CreateTiltingPadThrustBearing(mbs, "thrust", items, position, [0, 0, 1], _with(pads=2))
        names = "thrust_minimum_gap", exu.OutputVariableType.ForceLocal
        sensors = [thrust.pads[0].AddSensor(name) for name in names]
        mbs.CreateGenericJoint(itemNumbers=[ground, shaft], position=[0, 0, 0], constrainedAxes=[1, 1, 0, 1, 1, 0])
        mbs.CreateForce(itemNumber=shaft, loadVector=[0, 0, -LOAD])
        mbs.Assemble()
        _run(mbs, 2e-3, 8)
        history = thrust.pads[0].history
        gap, load = (mbs.GetSensorStoredData(sensor)[-1] for sensor in sensors)
        assert gap[1] == history.thrust_minimum_gap[-1]
        assert load[3] == pytest.approx(-history.thrust_force[-1])
        ends.append(thrust.film_thickness)
    assert ends[1] == pytest.approx(ends[0], rel=1e-9) and ends[2] == pytest.approx(ends[0], rel=1e-7)
    with pytest.raises(ehd.InputError, match="holds a ball or a thrust pad"):
        ehd.SolveDynamic(mbs, exu.SimulationSettings(), until_periodic=ehd.UntilPeriodic(period=1e-3))


def test_wall():
    """Pads on a collar that does not turn come to rest on their walls, parallel to it."""
    pads = _with(pads=2, contact=ehd.RegularisedWall(onset=10e-6, pressure=2e7))
    mbs, thrust, shaft = _scene(pads, height=-45e-6)
    node = mbs.GetObject(shaft)["nodeNumber"]
    mbs.SetNodeParameter(node, "initialVelocities", [0.0] * 6)
    mbs.Assemble()
    _run(mbs, 0.3, 150)
    for pad in thrust.pads:
        assert pad.history.thrust_contact_load[-1] == pytest.approx(LOAD / 2, rel=0.1)
        assert pad.history.thrust_force[-1] == pytest.approx(LOAD / 2, rel=1e-3)
        assert 0.0 < pad.history.thrust_minimum_gap[-1] < 10e-6


def test_restart(tmp_path):
    """A run that goes on from a stored state ends as one that was not stopped."""
    ends = []
    for parts in (1, 2):
        mbs, thrust, _ = _scene(_with(pads=2))
        _run(mbs, 4e-3 / parts, 16 // parts)
        if parts == 2:
            ehd.SaveState(mbs, tmp_path / "state.npz")
            mbs, thrust, _ = _scene(_with(pads=2))
            settings = ehd.ConfigureSolver(exu.SimulationSettings())
            settings.timeIntegration.endTime, settings.timeIntegration.numberOfSteps = 4e-3, 8
            ehd.SolveDynamic(mbs, settings, restart=tmp_path / "state.npz")
        ends.append(thrust.film_thickness)
    assert ends[0].shape == ends[1].shape == (17, 2)
    assert ends[1] == pytest.approx(ends[0], rel=1e-9)


def test_refused():
    def create(pads=PADS, at=(0.0, 0.0, 0.0), shaft=None, housing=None, **options):
        mbs = scenes.new_system()
        body = _shaft(mbs, np.eye(3), 1.0) if shaft is None else shaft(mbs)
        base = mbs.CreateGround() if housing is None else housing(mbs)
        arguments = {"position": at, "axis": [0, 0, 1], "bearing": pads} | options
        return mbs, ehd.CreateTiltingPadThrustBearing(mbs, "thrust", [base, body], **arguments)

    def sunk(mbs):
        return _shaft(mbs, np.eye(3), 1.0, height=-1e-4)

    def planar(mbs):
        return mbs.CreateRigidBody(inertia=RigidBodyInertia(1.0, np.eye(3)), create2D=True)

    def point(mbs):
        return mbs.CreateMassPoint(mass=1.0)

    for wrong, message in (
        ({"bearing": None}, r"bearing must be TiltingThrustPads\(\.\.\.\)"),
        ({"shaft": sunk}, "the shaft is outside the thrust faces of 'thrust pad 1'"),
        ({"shaft": planar}, "not planar bodies"),
        ({"housing": point}, "as housing no mass point"),
        ({"axis": []}, "axis is missing"),
        ({"gravity": (0.0, 0.0)}, "gravity must be 3 finite numbers"),
    ):
        with pytest.raises(ehd.InputError, match=f"CreateTiltingPadThrustBearing.*{message}"):
            create(**wrong)
    mbs, thrust = create()
    with pytest.raises(ehd.InputError, match="'thrust pad 1' is taken"):
        ehd.CreateTiltingPadThrustBearing(mbs, "thrust", [mbs.CreateGround(), sunk(mbs)], [0, 0, 0], [0, 0, 1], PADS)
    mbs.Assemble()
    assert "3 pads, outer diameter 200 mm" in repr(thrust)
    for method, message in (("film", "has no film around a journal"), ("audit", "bearing must be JournalBearing")):
        with pytest.raises(ehd.InputError, match=message):
            if method == "audit":
                _run(mbs, 1e-5, 2)
            getattr(thrust.pads[0], method)()
