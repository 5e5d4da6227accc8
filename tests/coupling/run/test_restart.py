"""A run that is stopped, stored and taken up by a new system is the run that was never stopped."""

import dataclasses
import zipfile

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
import pytest
import scenes
from exudyn.utilities import RigidBodyInertia

import exudyn_ehd as ehd
from exudyn_ehd.coupling.run.joint_state import digest
from exudyn_ehd.coupling.run.restart import load_state
from tests.sampling import but_slow

CLEARANCE = 30e-6
PLAIN = ehd.JournalBearing(
    journal_radius=0.02,
    length=0.02,
    radial_clearance=CLEARANCE,
    lubricant=ehd.oil("ISO VG 32", temperature=313.15),
    film=ehd.FiniteLength(n_theta=48, n_z=6),
)
ROUGH = ehd.GreenwoodTripp(composite_roughness=1e-6, composite_modulus=2e10)
BEARINGS = {
    "plain": PLAIN,
    "oil content": dataclasses.replace(PLAIN, cavitation=ehd.ElrodAdams(cavity_pressure=-1e5)),
    "temperature": dataclasses.replace(PLAIN, thermal=ehd.LumpedThermal(supply_temperature=313.15, capacity=5.0)),
    "sump": dataclasses.replace(
        PLAIN,
        thermal=ehd.LumpedThermal(supply_temperature=ehd.Sump(conductance=5.0, ambient=293.15, heat_capacity=0.1)),
    ),
    "temperature field": dataclasses.replace(PLAIN, thermal=ehd.FilmEnergy(supply_temperature=313.15)),
    "compressed oil": dataclasses.replace(
        PLAIN,
        cavitation=ehd.ElrodAdams(cavity_pressure=-1e5),
        thermal=ehd.LumpedThermal(supply_temperature=313.15),
        lubricant=dataclasses.replace(PLAIN.lubricant, density_law=ehd.DowsonHigginson()),
    ),
    "pockets": dataclasses.replace(
        PLAIN,
        supply=tuple(
            ehd.Pocket(
                angle=a,
                width_angle=0.8,
                length=0.01,
                supply=ehd.Orifice(diameter=2e-4, supply_pressure=3e6, compressible_volume=1e-5, bulk_modulus=1e9),
            )
            for a in (0.0, 2.0, 4.0)
        ),
    ),
    "wear": dataclasses.replace(PLAIN, asperity=ROUGH, wear=ehd.ArchardWear(wear_rate=1e-14, acceleration=1e3)),
    "liner": dataclasses.replace(PLAIN, bush=ehd.ElasticLiner(thickness=1e-3, youngs_modulus=1e9)),
}
STEP, HALF, STEPS = 1e-4, 40, 100


def system(bearing):
    mbs = scenes.new_system()
    ground = mbs.CreateGround()
    body = mbs.AddNode(
        eii.NodeRigidBodyRxyz(
            referenceCoordinates=[0.0] * 6,
            initialCoordinates=[0, -0.3 * CLEARANCE, 0, 0, 0, 0],
            initialVelocities=[0, 0, 0, 0, 0, 200.0],
        )
    )
    body = mbs.AddObject(eii.ObjectRigidBody(mass=2.0, inertia=[2e-3, 2e-3, 1e-3, 0, 0, 0], nodeNumber=body))
    marker = mbs.AddMarker(eii.MarkerBodyPosition(bodyNumber=body, localPosition=[0, 0, 1e-3]))
    mbs.AddLoad(
        eii.LoadForceVector(
            markerNumber=marker,
            loadVector=[0, 0, 0],
            loadVectorUserFunction=lambda mbs, t, v: [800.0 * np.sin(300 * t), -1500.0, 0],
        )
    )
    joint = ehd.CreateLubricatedJoint(
        mbs,
        name="main",
        itemNumbers=[ground, body],
        position=[0, 0, 0],
        axis=[0, 0, 1],
        bearing=bearing,
        axial=ehd.Free(),
    )
    mbs.Assemble()
    return mbs, joint


def settings(first, last, rho=0.8, **options):
    s = scenes.settings(last * STEP, last - first)
    s.timeIntegration.startTime = first * STEP
    s.timeIntegration.generalizedAlpha.spectralRadius = rho
    return ehd.ConfigureSolver(s, relativeTolerance=1e-9, **options)


def assert_same(one, other, tolerance):
    for field in dataclasses.fields(one):
        a, b = np.asarray(getattr(one, field.name)), np.asarray(getattr(other, field.name))
        assert a.shape == b.shape, field.name
        scale = np.nanmax(np.abs(a), initial=0.0)
        # an estimate with the tangents of Newton's last iterations, which need not start alike, without the momentum
        # that the first step behind a restart has missed: up to 2e-4 of the largest estimate
        share = max(tolerance, 1e-3) if field.name == "step_error" else tolerance
        np.testing.assert_allclose(b, a, rtol=0.0, atol=share * scale, err_msg=field.name)


@pytest.mark.parametrize("what", but_slow(BEARINGS, "liner", "temperature", "temperature field", "wear"))
def test_run_goes_on(what, tmp_path):
    mbs, joint = system(BEARINGS[what])
    ehd.SolveDynamic(mbs, settings(0, STEPS))
    whole = joint.history
    mbs, _ = system(BEARINGS[what])
    ehd.SolveDynamic(mbs, settings(0, HALF))
    state = ehd.SaveState(mbs, tmp_path / "half.npz")
    assert state.time == pytest.approx(HALF * STEP)
    mbs, joint = system(BEARINGS[what])
    ehd.SolveDynamic(mbs, rest(), restart=tmp_path / "half.npz")
    again = joint.history
    assert again.time.size == STEPS + 1
    # times that sum up differently; liner and oil content stop at tolerances of their own
    assert_same(whole, again, 1e-9)
    assert mbs.GetPreStepUserFunction() in (0, None)


def rest():
    return settings(HALF, STEPS)


def test_restart_in_the_same_system_and_from_memory():
    mbs, joint = system(BEARINGS["oil content"])
    ehd.SolveDynamic(mbs, settings(0, STEPS))
    whole = joint.history
    ehd.SolveDynamic(mbs, settings(0, HALF))
    state = ehd.SystemState.of(mbs, [joint])
    ehd.SolveDynamic(mbs, settings(0, 10))
    ehd.SolveDynamic(mbs, rest(), restart=state)
    assert_same(whole, joint.history, 1e-9)


@pytest.mark.slow
def test_without_memory_the_run_is_another():
    """The film's history is needed: from coordinates alone a run starts with a bearing full of oil."""
    mbs, joint = system(BEARINGS["oil content"])
    ehd.SolveDynamic(mbs, settings(0, STEPS))
    whole = joint.history
    mbs, joint = system(BEARINGS["oil content"])
    ehd.SolveDynamic(mbs, settings(0, HALF))
    state = ehd.SystemState.of(mbs, [joint])
    forgetful = dataclasses.replace(state.joints[0], memory=None)
    mbs, joint = system(BEARINGS["oil content"])
    ehd.SolveDynamic(mbs, rest(), restart=dataclasses.replace(state, joints=(forgetful,)))
    assert np.abs(joint.history.motion[-1, :2] - whole.motion[-1, :2]).max() > 1e-6 * CLEARANCE


@pytest.mark.parametrize("what", ["oil content", "temperature", "wear"])
def test_later_run_from_the_old_initial_values_is_the_first_one_again(what):
    """Under a load that lasts, a run from the same initial values at a later time has the same film."""
    mbs, joint = system(BEARINGS[what])
    mbs.SetLoadParameter(0, "loadVectorUserFunction", 0)
    mbs.SetLoadParameter(0, "loadVector", [300.0, -1500.0, 0.0])
    ehd.SolveDynamic(mbs, settings(0, HALF))
    first = joint.history
    ehd.SolveDynamic(mbs, settings(HALF, 2 * HALF))
    again = joint.history
    assert again.time[0] == pytest.approx(HALF * STEP)
    assert_same(dataclasses.replace(first, time=again.time), again, 1e-9)


def test_explicit_solver_goes_on():
    kind = {"solverType": exu.DynamicSolverType.RK44}
    mbs, joint = system(PLAIN)
    # 2 kg on 4.4e5 N s/m: a quarter of RK44's limit
    fine = STEP / 25

    def part(first, last):
        s = settings(0, 10)
        s.timeIntegration.startTime, s.timeIntegration.endTime = first * fine, last * fine
        s.timeIntegration.numberOfSteps = last - first
        return s

    ehd.SolveDynamic(mbs, part(0, 60), **kind)
    whole = joint.history
    mbs, joint = system(PLAIN)
    ehd.SolveDynamic(mbs, part(0, 30), **kind)
    state = ehd.SystemState.of(mbs, [joint])
    mbs, joint = system(PLAIN)
    ehd.SolveDynamic(mbs, part(30, 60), restart=state, **kind)
    assert_same(whole, joint.history, 1e-10)


def test_state_of_a_failed_run_is_the_last_accepted_one(tmp_path):
    mbs, joint = system(BEARINGS["oil content"])
    count = [0]

    def stop(mbs, t):
        count[0] += 1
        if count[0] == HALF + 1:
            raise ValueError("enough")
        return True

    mbs.SetPreStepUserFunction(stop)
    with pytest.raises(exu.ExudynError):
        ehd.SolveDynamic(mbs, settings(0, STEPS))
    state = ehd.SaveState(mbs, tmp_path / "stopped.npz")
    assert state.time == pytest.approx(HALF * STEP)
    mbs, joint = system(BEARINGS["oil content"])
    ehd.SolveDynamic(mbs, settings(0, STEPS))
    whole = joint.history
    mbs, joint = system(BEARINGS["oil content"])
    calls = []
    mbs.SetPreStepUserFunction(lambda mbs, t: calls.append(t) or True)
    ehd.SolveDynamic(mbs, rest(), restart=tmp_path / "stopped.npz")
    assert_same(whole, joint.history, 1e-9)
    # the user's own hook is called in every step, and stays
    assert len(calls) == STEPS - HALF
    assert callable(mbs.GetPreStepUserFunction()["function"])


def test_files_are_whole_and_foreign_ones_are_refused(tmp_path):
    mbs, _ = system(PLAIN)
    with pytest.raises(ehd.InputError, match="no run"):
        ehd.SaveState(mbs, tmp_path / "early.npz")
    ehd.SolveDynamic(mbs, settings(0, 3))
    good = tmp_path / "good.npz"
    ehd.SaveState(mbs, good)
    assert [p.name for p in tmp_path.iterdir()] == ["good.npz"]
    with pytest.raises(ehd.InputError, match="npz"):
        ehd.SaveState(mbs, tmp_path / "state.txt")
    raw = good.read_bytes()
    damaged = bytearray(raw)
    damaged[len(raw) // 2] ^= 0xFF
    files = {
        "empty": b"",
        "text": b"not a state",
        "cut": raw[: len(raw) // 2],
        "damaged": bytes(damaged),
    }
    np.savez(tmp_path / "other.npz", a=np.zeros(3))
    for name, content in files.items():
        (tmp_path / f"{name}.npz").write_bytes(content)
    with zipfile.ZipFile(tmp_path / "zip.npz", "w") as file:
        file.writestr("readme", "hello")
    for name in (*files, "other", "zip"):
        mbs, _ = system(PLAIN)
        with pytest.raises(ehd.InputError, match=rf"{name}\.npz"):
            ehd.SolveDynamic(mbs, settings(3, 6), restart=tmp_path / f"{name}.npz")
    with pytest.raises(FileNotFoundError):
        ehd.SolveDynamic(mbs, settings(3, 6), restart=tmp_path / "absent.npz")
    with pytest.raises(ehd.InputError, match=r"restore_state: state must be JointState.*restart=path"):
        system(PLAIN)[1].restore_state(good)


def test_a_state_that_was_changed_since_the_run_is_not_stored(tmp_path):
    """A linearisation leaves the system at its initial values, the films at the end of the run."""
    mbs, joint = system(PLAIN)
    ehd.SolveDynamic(mbs, settings(0, 3))
    mbs.ComputeLinearizedSystem()
    for store in (lambda: ehd.SaveState(mbs, tmp_path / "state.npz"), joint.state):
        with pytest.raises(ehd.InputError, match=r"the system is at t = 0 s, and its last run has ended at .*changed"):
            store()
    assert not list(tmp_path.iterdir())


def test_states_of_other_systems_are_refused():
    mbs, joint = system(PLAIN)
    ehd.SolveDynamic(mbs, settings(0, 3))
    state = ehd.SystemState.of(mbs, [joint])
    other, _ = system(dataclasses.replace(PLAIN, length=0.021))
    with pytest.raises(ehd.InputError, match="another bearing"):
        ehd.SolveDynamic(other, settings(3, 6), restart=state)
    renamed = dataclasses.replace(state, joints=(dataclasses.replace(state.joints[0], name="x"),))
    with pytest.raises(ehd.InputError, match="'x'"):
        ehd.SolveDynamic(mbs, settings(3, 6), restart=renamed)
    with pytest.raises(ehd.InputError, match="another system"):
        ehd.SolveDynamic(mbs, settings(3, 6), restart=dataclasses.replace(state, joints=()))
    short = dataclasses.replace(state, coordinates=(np.zeros(2), *state.coordinates[1:]))
    with pytest.raises(ehd.InputError, match="another system"):
        ehd.SolveDynamic(mbs, settings(3, 6), restart=short)
    with pytest.raises(ehd.InputError, match="endTime"):
        ehd.SolveDynamic(mbs, settings(0, 2), restart=state)


def other_bearings():
    """Pairs of bearings that number the same coordinates and the same vertices, and are not the same."""
    mesh = {"inner_radius": 0.02 + CLEARANCE, "thickness": 5e-3, "length": 0.02, "axial": 2, "circumferential": 16}
    steel = {"youngs_modulus": 2e11, "poisson_ratio": 0.3, "density": 7800.0}

    def modal(mesh_of=(), material_of=()):
        return ehd.ModalBush(
            mesh=ehd.HollowCylinder(**{**mesh, "radial": 1, **dict(mesh_of)}),
            material=ehd.SaintVenantKirchhoff(**{**steel, **dict(material_of)}),
            tolerance=0.2,
        )

    angles, places = np.linspace(0, 2 * np.pi, 60, endpoint=False), np.linspace(-0.01, 0.01, 21)
    depths = 1e-6 * np.cos(2 * angles)[:, None] * np.ones(21)
    other = depths.copy()
    other[10:50] *= -3.0
    table = {"angles": angles, "positions": places}
    moved = modal().build_mesh()
    nodes = moved.nodes.copy()
    nodes[moved.outer.nodes[3]] *= 1.0 + 1e-9
    imported = [ehd.mesh_from_arrays(x, moved.elements, bore_radius=0.02 + CLEARANCE) for x in (moved.nodes, nodes)]
    yield "material", *({"bush": modal(material_of={"youngs_modulus": e})} for e in (2e11, 2e9))
    yield "thickness", *({"bush": modal({"thickness": t})} for t in (5e-3, 6e-3))
    yield "table", *({"profile": ehd.ProfileTable(**table, depths=d)} for d in (depths, other))
    yield "one node", *({"bush": dataclasses.replace(modal(), mesh=mesh)} for mesh in imported)


def test_states_of_other_bushes_materials_and_tables_are_refused():
    """Descriptions count by content: numpy's text of 1260 numbers leaves out nearly all of them."""
    for what, one, other in other_bearings():
        marks = [digest(dataclasses.replace(PLAIN, **options)) for options in (one, one, other)]
        assert marks[0] == marks[1] and marks[0] != marks[2], what


@pytest.mark.slow
def test_another_bush_is_refused_in_a_run(tmp_path):
    _, one, other = next(other_bearings())
    mbs, joint = system(dataclasses.replace(PLAIN, **one))
    ehd.SolveDynamic(mbs, settings(0, 3))
    ehd.SaveState(mbs, tmp_path / "state.npz")
    with pytest.raises(ehd.InputError, match="'main' comes from another bearing"):
        ehd.SolveDynamic(system(dataclasses.replace(PLAIN, **other))[0], settings(3, 6), restart=tmp_path / "state.npz")
    again, joint = system(dataclasses.replace(PLAIN, **one))
    ehd.SolveDynamic(again, settings(3, 6), restart=tmp_path / "state.npz")
    assert joint.history.time.size == 7
    # an eigenvalue problem that was solved again may have turned a mode around
    state = load_state(tmp_path / "state.npz")
    modes = state.joints[0].modes.copy()
    modes[:-1, 2] *= -1.0
    turned = dataclasses.replace(state, joints=(dataclasses.replace(state.joints[0], modes=modes),))
    with pytest.raises(ehd.InputError, match="modes of joint 'main' are others"):
        ehd.SolveDynamic(system(dataclasses.replace(PLAIN, **one))[0], settings(3, 6), restart=turned)


def test_stored_memory_is_checked(tmp_path):
    """Without the oil's mass a run would go on flooded, with other shapes numpy's own errors come through."""
    mbs, joint = system(BEARINGS["oil content"])
    ehd.SolveDynamic(mbs, settings(0, 3))
    good = ehd.SaveState(mbs, tmp_path / "good.npz")
    with np.load(tmp_path / "good.npz") as file:
        arrays = dict(file)
    spoilt = {
        "memory": (
            {"0 memory mass": None},
            {"0 memory mass": np.ones((3, 3))},
            {"0 memory void": np.full((48, 7), np.nan)},
        ),
        "begin": ({"0 begin motion": np.zeros(4)}, {"0 begin step": None}),
    }
    for what, changes in spoilt.items():
        for change in changes:
            left = {name: array for name, array in (arrays | change).items() if array is not None}
            np.savez(tmp_path / "bad.npz", **left)
            with pytest.raises(ehd.InputError, match=f"{what} of joint 'main' must hold finite numbers of the shapes"):
                ehd.SolveDynamic(mbs, settings(3, 6), restart=tmp_path / "bad.npz")
    ehd.SolveDynamic(mbs, settings(3, 6), restart=good)
    assert joint.history.time.size == 7


@pytest.mark.parametrize("thermal", [None, ehd.LumpedThermal(supply_temperature=313.15)], ids=("isothermal", "heated"))
@pytest.mark.filterwarnings("ignore:SolveStatic.*balance of heat:UserWarning")
def test_a_run_after_a_static_solution_starts_with_its_film(thermal):
    """Oil content and temperature of the static film: the journal stays where it is, but for the warming."""
    warm = ehd.ReynoldsTemperature(point=(313.15, 0.02), coefficient=0.03)
    bearing = ehd.JournalBearing(
        journal_radius=0.025,
        length=0.03,
        radial_clearance=30e-6,
        film=ehd.FiniteLength(n_theta=48, n_z=6),
        lubricant=ehd.Lubricant(temperature_law=warm) if thermal else ehd.Lubricant(viscosity=0.02),
        cavitation=ehd.ElrodAdams(cavity_pressure=-1e5),
        thermal=thermal,
    )
    mbs = scenes.new_system()
    ground = mbs.CreateGround()
    # heavy about its axis, so that the spring hardly changes the spin in the run
    inertia = RigidBodyInertia(mass=2.0, inertiaTensor=np.diag([1e4] * 3))
    shaft = mbs.CreateRigidBody(
        inertia=inertia, initialAngularVelocity=[0, 0, 300.0], nodeType=exu.NodeType.RotationRxyz
    )
    # the spin has no stiffness of its own
    places = [
        mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=node, coordinate=k))
        for node, k in ((mbs.AddNode(eii.NodePointGround()), 0), (mbs.GetObject(shaft)["nodeNumber"], 5))
    ]
    mbs.AddObject(eii.CoordinateSpringDamper(markerNumbers=places, stiffness=1e5))
    mbs.CreateForce(itemNumber=shaft, loadVector=[0, -2000.0, 0])
    joint = ehd.CreateLubricatedJoint(
        mbs, "main", [ground, shaft], [0, 0, 0], [0, 0, 1], bearing, axial=ehd.Held(), tilt=ehd.Held()
    )
    mbs.Assemble()
    settings = ehd.ConfigureSolver(scenes.settings(1e-5, 5))
    ehd.SolveStatic(mbs, settings, updateInitialValues=True)
    still = joint.history
    ehd.SolveDynamic(mbs, settings)
    np.testing.assert_allclose(joint.history.force[:, :2], [[0.0, 2000.0]] * 6, rtol=0, atol=2.0)
    np.testing.assert_allclose(joint.history.power_loss, still.power_loss[-1], rtol=1e-3)
