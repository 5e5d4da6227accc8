"""Runs that end badly: the package's own errors, what they say, and what stays readable."""

import dataclasses

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
import pytest
import scenes

import exudyn_ehd as ehd

CLEARANCE = 50e-6
BEARING = ehd.JournalBearing(
    journal_radius=0.025,
    length=0.025,
    radial_clearance=CLEARANCE,
    lubricant=ehd.Lubricant(viscosity=0.02),
    film=ehd.FiniteLength(n_theta=32, n_z=4),
)


def system(bearing=BEARING, load=lambda t: -500.0, offset=0.0):
    mbs = scenes.new_system()
    ground = mbs.CreateGround()
    node = mbs.AddNode(eii.NodeRigidBodyRxyz(referenceCoordinates=[0.0] * 6, initialVelocities=[0, 0, 0, 0, 0, 300.0]))
    body = mbs.AddObject(eii.ObjectRigidBody(mass=2.0, inertia=[1e-3, 1e-3, 1e-3, 0, 0, 0], nodeNumber=node))
    marker = mbs.AddMarker(eii.MarkerBodyPosition(bodyNumber=body, localPosition=[0, 0, offset]))
    mbs.AddLoad(
        eii.LoadForceVector(
            markerNumber=marker, loadVector=[0, 0, 0], loadVectorUserFunction=lambda mbs, t, v: [0, load(t), 0]
        )
    )
    joint = ehd.CreateLubricatedJoint(
        mbs, name="big end", itemNumbers=[ground, body], position=[0, 0, 0], axis=[0, 0, 1], bearing=bearing
    )
    mbs.Assemble()
    return mbs, joint


def settings(steps=100, **options):
    return ehd.ConfigureSolver(scenes.settings(steps * 1e-4, steps), **options)


def test_film_error_comes_through_exudyn():
    mbs, joint = system(load=lambda t: -8000.0, offset=0.02)
    with pytest.raises(ehd.FilmError) as caught:
        ehd.SolveDynamic(mbs, settings())
    text = str(caught.value)
    last = joint.history.time[-1]
    parts = [
        "'big end'",
        "t = ",
        "eccentricity ratio",
        "minimum gap",
        "gap closed",
        "contact=RegularisedWall",
        f"{last:.9g} s",
    ]
    for part in parts:
        assert part in text, (part, text)
    assert isinstance(caught.value.__cause__, exu.ExudynError)
    assert last > 0.0
    assert np.all(np.isfinite(joint.history.force))
    # and it is the touch: the last accepted gap is a sliver
    assert joint.history.minimum_gap[-1] < 0.01 * CLEARANCE


def test_static_solver_too():
    mbs, _ = system(load=lambda t: -8000.0, offset=0.02)
    with pytest.raises(ehd.EHDError, match=r"'big end'.*In a static solve .*no stiffness of their own"):
        ehd.SolveStatic(mbs, settings())


def test_errors_of_other_user_functions_pass():
    def load(t):
        if t > 2.05e-3:
            raise ValueError("no such load")
        return -500.0

    mbs, joint = system(load=load)
    with pytest.raises(exu.ExudynError) as caught:
        ehd.SolveDynamic(mbs, settings())
    assert not isinstance(caught.value, ehd.EHDError)
    assert isinstance(caught.value.__cause__, ValueError)
    assert joint.history.time[-1] == pytest.approx(2e-3, abs=2e-4)


def test_newton_that_does_not_converge_is_explained():
    mbs, joint = system()
    s = settings(relativeTolerance=1e-13)
    s.timeIntegration.newton.absoluteTolerance = 1e-300
    s.timeIntegration.newton.maxIterations = 1
    with pytest.raises(ehd.RunError) as caught:
        ehd.SolveDynamic(mbs, s)
    for part in ("'big end'", "t = ", "eccentricity ratio", "minimum film thickness", "ConfigureSolver", "StepControl"):
        assert part in str(caught.value)
    assert joint.history.time.size >= 1


def test_success_returns_true_and_options_arrive():
    mbs, joint = system()
    assert ehd.SolveDynamic(mbs, settings(20), solverType=exu.DynamicSolverType.TrapezoidalIndex2) is True
    assert joint.history.time.size == 21


def test_liner_is_advised_a_contact():
    import dataclasses

    liner = ehd.ElasticLiner(thickness=1e-3, youngs_modulus=1e8)
    mbs, _ = system(dataclasses.replace(BEARING, bush=liner), load=lambda t: -8000.0, offset=0.02)
    with pytest.raises(ehd.FilmError, match="RegularisedWall"):
        ehd.SolveDynamic(mbs, settings())


@pytest.mark.parametrize("wrong", [None, "mbs", 1, exu.SystemContainer()], ids=str)
def test_what_is_no_system(wrong):
    with pytest.raises(ehd.InputError, match=r"CreateLubricatedJoint\.mbs must be an exudyn\.MainSystem"):
        ehd.CreateLubricatedJoint(wrong, bearing=BEARING)
    for call in (
        lambda: ehd.CreateFlexibleBush(wrong, bush=None, outer=None),
        lambda: ehd.ReplaceJoint(wrong, 0, bearing=BEARING),
        lambda: ehd.ReplaceJoints(wrong, bearing=BEARING),
        lambda: ehd.SaveState(wrong, "state.npz"),
        lambda: ehd.SolveDynamicSparse(wrong),
    ):
        with pytest.raises(ehd.InputError, match=r"\.mbs must be an exudyn\.MainSystem"):
            call()
    for solve in (ehd.SolveDynamic, ehd.SolveStatic):
        with pytest.raises(ehd.InputError, match=rf"{solve.__name__}\.mbs must be"):
            solve(wrong, settings())
        with pytest.raises(ehd.InputError, match=rf"{solve.__name__}\.simulationSettings must be"):
            solve(scenes.new_system(), wrong)
    with pytest.raises(ehd.InputError, match=r"ConfigureSolver\.simulationSettings must be"):
        ehd.ConfigureSolver(wrong)


@pytest.mark.parametrize("argument", ["useGlobalFrame", "show", "returnDict"])
@pytest.mark.parametrize("wrong", ["x", None, 2, 0.5, [], np.zeros((3, 3)), float("nan")], ids=str)
def test_flags_that_are_none(argument, wrong):
    mbs = scenes.new_system()
    items = [mbs.CreateGround(), scenes.add_body(mbs, "Rxyz")]
    with pytest.raises(ehd.InputError, match=rf"CreateLubricatedJoint\.{argument} must be True or False"):
        ehd.CreateLubricatedJoint(
            mbs, itemNumbers=items, position=[0, 0, 0], axis=[0, 0, 1], bearing=BEARING, **{argument: wrong}
        )
    with pytest.raises(ehd.InputError, match="useModifiedNewton must be True or False"):
        ehd.ConfigureSolver(exu.SimulationSettings(), useModifiedNewton=wrong)


def test_name_of_another_joint():
    mbs = scenes.new_system()
    items = [mbs.CreateGround(), scenes.add_body(mbs, "Rxyz")]
    made = [
        ehd.CreateLubricatedJoint(mbs, itemNumbers=items, position=[0, 0, z], axis=[0, 0, 1], bearing=BEARING)
        for z in (0.0, 0.1)
    ]
    assert made[0].name != made[1].name
    with pytest.raises(ehd.InputError, match=f"name '{made[0].name}' is taken"):
        ehd.CreateLubricatedJoint(
            mbs, made[0].name, itemNumbers=items, position=[0, 0, 0.2], axis=[0, 0, 1], bearing=BEARING
        )


@pytest.mark.parametrize("path", [5, b"state.npz", [], 1.5], ids=str)
def test_restart_from_what_is_no_path(path):
    mbs, _ = system()
    with pytest.raises(ehd.InputError, match=r"SolveDynamic\.restart must be a SystemState or the path"):
        ehd.SolveDynamic(mbs, settings(), restart=path)


def test_run_without_time():
    mbs, _ = system()
    nothing = settings()
    nothing.timeIntegration.endTime = 0.0
    with pytest.raises(ehd.InputError, match=r"endTime must be after startTime = 0 s, got 0 s"):
        ehd.SolveDynamic(mbs, nothing)


@pytest.mark.parametrize("solve", [ehd.SolveDynamic, ehd.SolveDynamicSparse])
def test_an_integrator_that_amplifies_is_refused(solve):
    """Exudyn takes spectral radii above 1, with which every fast vibration grows."""
    mbs, _ = system()
    growing = settings()
    growing.timeIntegration.generalizedAlpha.spectralRadius = 1.5
    with pytest.raises(ehd.InputError, match=rf"{solve.__name__}.*spectralRadius must be between 0 and 1, got 1\.5"):
        solve(mbs, growing)


def test_state_before_assemble():
    mbs = scenes.new_system()
    items = [mbs.CreateGround(), scenes.add_body(mbs, "Rxyz")]
    joint = ehd.CreateLubricatedJoint(
        mbs, itemNumbers=items, position=[0, 0, 0], axis=[0, 0, 1], bearing=BEARING, name="early"
    )
    with pytest.raises(ehd.InputError, match="'early' is not assembled"):
        joint.state()


def test_interrupt_ends_the_run_as_one():
    """Ctrl-C in the middle of a run: Exudyn wraps it like an error of a model."""

    def load(t):
        if t > 2.05e-3:
            raise KeyboardInterrupt
        return -500.0

    mbs, joint = system(load=load)
    with pytest.raises(KeyboardInterrupt, match="last accepted state"):
        ehd.SolveDynamic(mbs, settings())
    assert joint.history.time.size == 21
    # and the system goes on
    ehd.SolveDynamic(system(load=lambda t: -500.0)[0], settings(20))


@pytest.mark.parametrize("dynamic", [False, True])
def test_journal_pressed_through_its_contact(dynamic):
    """A load beyond any contact, as from wrong units, must not be carried by a wall that yields for ever."""
    wall = dataclasses.replace(BEARING, contact=ehd.RegularisedWall(onset=2e-6))
    mbs, joint = system(wall, load=lambda t: -1e9 if dynamic else -1e9 * min(t / 5e-3, 1.0))
    joint.stop_at(pressure=1e12)
    with pytest.raises(ehd.FilmError, match=r"'big end' at t = .* pressed through its contact .* units") as caught:
        ehd.SolveDynamic(mbs, settings())
    assert "eccentricity ratio" in str(caught.value)
    assert joint.history.largest_eccentricity_ratio[-1] > 2.0


def test_explicit_solver_that_loses_its_film_names_itself():
    mbs, _ = system(load=lambda t: -1e6)
    with pytest.raises(ehd.FilmError, match=r"gap closed .* explicit solver can't repeat a step"):
        ehd.SolveDynamic(mbs, settings(), solverType=exu.DynamicSolverType.RK44)


def test_lengths_in_millimetres():
    size = {"lubricant": ehd.Lubricant(viscosity=0.02)}
    with pytest.raises(ehd.InputError, match=r"journal_radius must be between .* got 25.0; .* in mm, give 0.025"):
        ehd.JournalBearing(journal_radius=25.0, length=25.0, radial_clearance=0.05, **size)
    with pytest.raises(ehd.InputError, match=r"radial_clearance must be at most 0.1 of .* metres"):
        ehd.JournalBearing(journal_radius=0.025, length=0.025, radial_clearance=0.05, **size)


@pytest.mark.slow
def test_static_solution_of_a_bush_that_nothing_holds_names_it():
    mbs = scenes.new_system()
    mesh = ehd.HollowCylinder(inner_radius=0.03, thickness=0.012, length=0.03, axial=1, radial=1, circumferential=8)
    steel = ehd.SaintVenantKirchhoff(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7850.0)
    ehd.CreateFlexibleBush(
        mbs,
        "ring",
        bush=ehd.ANCFBush(mesh=mesh, material=steel),
        outer=ehd.FreeOuter(),
        loads=[ehd.Gravity(acceleration=(0, -9.81, 0))],
    )
    mbs.Assemble()
    with pytest.raises(ehd.RunError, match=r"SolveStatic: .*FlexibleBush 'ring', which no support or carrier holds"):
        ehd.SolveStatic(mbs, settings())


@pytest.mark.parametrize("thermal", [ehd.LumpedThermal, ehd.FilmEnergy])
def test_temperatures_in_degrees_celsius(thermal):
    with pytest.raises(ehd.InputError, match=r"thermal\.supply_temperature = 40.0 K: .* kelvin"):
        dataclasses.replace(BEARING, lubricant=ehd.oil("ISO VG 46"), thermal=thermal(supply_temperature=40.0))
    assert dataclasses.replace(BEARING, lubricant=ehd.oil("ISO VG 46"), thermal=thermal(supply_temperature=313.0))


def test_static_solution_without_stiffness_says_what_is_missing():
    mbs = scenes.new_system()
    ground = mbs.CreateGround()
    body = scenes.add_body(mbs, "2D", gravity=[0, -9.81, 0])
    ehd.CreateLubricatedJoint(
        mbs, name="still", itemNumbers=[ground, body], position=[0, 0, 0], axis=[0, 0, 1], bearing=BEARING
    )
    mbs.Assemble()
    with pytest.raises(ehd.RunError, match=r"SolveStatic: .*'still'.*no stiffness of their own: give speeds"):
        ehd.SolveStatic(mbs, settings())


@pytest.mark.slow
def test_a_film_that_heats_beyond_any_oil_ends_the_run():
    """Asperities rub where hardly any oil flows, between adiabatic surfaces: a viscosity of nothing would follow
    without a sign."""
    oil = ehd.oil("ISO VG 32", temperature=313.15)
    made = dataclasses.replace(
        BEARING,
        lubricant=oil,
        thermal=ehd.FilmEnergy(supply_temperature=313.15),
        film=ehd.FiniteLength(n_theta=48, n_z=4),
        asperity=ehd.GreenwoodTripp(composite_roughness=8e-7, composite_modulus=2e10),
    )
    mbs, joint = system(made, load=lambda t: -40e3)
    with pytest.raises(ehd.FilmError) as caught:
        ehd.SolveDynamic(mbs, settings(500))
    for part in ("'big end'", "t = ", "theta = ", "700 K", "asperities", "eccentricity ratio", "bush_coefficient"):
        assert part in str(caught.value), part
    assert 313.0 < joint.history.peak_temperature.max() < 4000.0
    cooled = dataclasses.replace(
        made, thermal=ehd.FilmEnergy(supply_temperature=313.15, bush_coefficient=2e4, journal_coefficient=2e4)
    )
    mbs, joint = system(cooled, load=lambda t: -40e3)
    ehd.SolveDynamic(mbs, settings(500))
    assert joint.history.contact_load.max() > 10.0
    assert joint.history.peak_temperature.max() < 1000.0


def test_a_film_without_pressure_is_told_by_its_law():
    for law in (ehd.BarusPressure(coefficient=2e-8), ehd.RoelandsPressure(coefficient=2e-8)):
        oil = ehd.Lubricant(viscosity=0.02, pressure_law=law)
        mbs, _ = system(dataclasses.replace(BEARING, lubricant=oil), load=lambda t: -4e6)
        said = rf"with {type(law).__name__} no finite .* 1 / coefficient = 50 MPa.* name an elastic liner or bush"
        with pytest.raises(ehd.FilmError, match=said):
            ehd.SolveDynamic(mbs, settings())


def test_solver_that_is_not_stored():
    """Films ask the solver at work for its rule and its step size; one that they do not know is told of."""
    mbs, joint = system()
    mbs.SolveDynamic(settings(20))
    expected = joint.history.motion
    mbs, joint = system()
    ehd.SolveDynamic(mbs, settings(20), storeSolver=False)
    np.testing.assert_allclose(joint.history.motion, expected, rtol=0.0, atol=1e-5 * np.abs(expected).max())
    for put in (True, False):
        mbs, joint = system()
        solver = exu.MainSolverImplicitSecondOrder()
        if put:
            mbs.sys["dynamicSolver"] = solver
            solver.SolveSystem(mbs, settings(20))
            np.testing.assert_array_equal(joint.history.motion, expected)
        else:
            with pytest.warns(UserWarning, match=r"'big end': the solver at work is not in mbs\.sys") as told:
                solver.SolveSystem(mbs, settings(20))
            assert len(told) == 1
    mbs, joint = system()
    with pytest.warns(UserWarning, match="the solver at work"):
        mbs.SolveDynamic(settings(20), storeSolver=False)


def test_what_exudyn_refuses_is_not_explained_by_newton():
    mbs, _ = system()
    inverse = settings(20)
    inverse.timeIntegration.explicit.computeMassMatrixInversePerBody = True
    with pytest.raises(ehd.RunError, match=r"SolveDynamic: .*computeMassMatrixInversePerBody") as caught:
        ehd.SolveDynamic(mbs, inverse, solverType=exu.DynamicSolverType.RK44)
    assert "Newton" not in str(caught.value) and isinstance(caught.value.__cause__, exu.ExudynError)


@pytest.mark.parametrize("path", [None, 3, "."], ids=str)
def test_paths_that_are_none(path):
    mbs, joint = system()
    ehd.SolveDynamic(mbs, settings(3))
    calls = (lambda p: ehd.SaveState(mbs, p), joint.save, joint.to_csv, ehd.load_history)
    for call in calls:
        with pytest.raises(ehd.InputError, match="path must be"):
            call(path)
    with pytest.raises(ehd.InputError, match=r"SolveDynamic\.restart.* must be"):
        ehd.SolveDynamic(mbs, settings(3), restart=3 if path is None else path)


def test_bush_and_outer_in_each_others_place():
    mesh = ehd.HollowCylinder(inner_radius=0.02, thickness=0.005, length=0.02, circumferential=8)
    steel = ehd.SaintVenantKirchhoff(youngs_modulus=2e11, poisson_ratio=0.3, density=7800.0)
    bush = ehd.ANCFBush(mesh=mesh, material=steel)
    mbs = scenes.new_system()
    with pytest.raises(ehd.InputError, match=r"CreateFlexibleBush\.bush must be ANCFBush\(\.\.\.\), got FixedOuter"):
        ehd.CreateFlexibleBush(mbs, "b", bush=ehd.FixedOuter(), outer=bush)
    with pytest.raises(ehd.InputError, match=r"CreateFlexibleBush\.outer must be FreeOuter"):
        ehd.CreateFlexibleBush(mbs, "b", bush=bush, outer=None)
