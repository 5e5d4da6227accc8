"""Any valid bearing evaluates to finite numbers in balance; any argument of the
studies and of the joint is taken or refused by name."""

from __future__ import annotations

import dataclasses
import math
import warnings

import numpy as np
import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

import exudyn_ehd as ehd

COMMON = {"deadline": None, "suppress_health_check": list(HealthCheck), "derandomize": True, "database": None}
OIL = ehd.Lubricant(viscosity=0.02)
PLAIN = ehd.JournalBearing(
    journal_radius=0.02, length=0.02, radial_clearance=2e-5, lubricant=OIL, film=ehd.FiniteLength(n_theta=32, n_z=4)
)
NUMBERS = st.one_of(st.floats(), st.sampled_from([0, 1, -1, math.nan, math.inf, 1e300, 5e-324, 10**400]))
ANYTHING = st.one_of(
    NUMBERS, st.none(), st.booleans(), st.text(max_size=4), st.tuples(NUMBERS, NUMBERS), st.just(object())
)


def powers(low, high):
    """Numbers uniform in their logarithm."""
    return st.floats(low, high).map(lambda x: 10.0**x)


@st.composite
def bearings(draw):
    """Sizes over decades, every closure, and options that go together."""
    radius = draw(powers(-3.5, 0.5))
    clearance = radius * draw(powers(-4.5, -1.5))
    ratio = draw(powers(-1.0, 0.7))
    closure = draw(
        st.sampled_from(
            [
                ehd.SwiftStieber(),
                ehd.Gumbel(),
                ehd.Gumbel(cavity_shear=0.0),
                ehd.FullSommerfeld(),
                ehd.ElrodAdams(cavity_pressure=-1e5),
            ]
        )
    )
    film = draw(
        st.sampled_from(
            [ehd.FiniteLength(n_theta=32, n_z=4), ehd.FiniteLength(n_theta=33, n_z=7), ehd.ShortBearing(n_theta=48)]
        )
    )
    options = {}
    if draw(st.booleans()):
        options["end_pressures"] = draw(st.tuples(st.floats(0, 1e6), st.floats(0, 1e6)))
    if draw(st.booleans()) and isinstance(film, ehd.FiniteLength):
        options["supply"] = (
            ehd.AxialGroove(angle=draw(st.floats(0, 6.2)), width_angle=0.7, pressure=draw(st.floats(0, 1e6))),
        )
    if draw(st.booleans()):
        options["contact"] = ehd.RegularisedWall(onset=0.05 * clearance)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        return ehd.JournalBearing(
            journal_radius=radius,
            # longer ones are refused as typed in other units
            length=min(2.0 * radius * ratio, 10.0),
            radial_clearance=clearance,
            film=film,
            cavitation=closure,
            lubricant=ehd.Lubricant(viscosity=draw(powers(-5.0, 1.0))),
            **options,
        )


def unknown(speed):
    """Names of results that a film without load, restrictors or speed does not have."""
    loads = {"sommerfeld_number", "attitude_angle", "characteristic_number", "friction_number"}
    return loads | {"restrictor_flows"} | (set() if speed else {"inlet_flow"})


def check_film(bearing, eps, speed, tilt, direction):
    half = 0.5 * bearing.length
    size = tilt * (1.0 - eps) * bearing.radial_clearance / half
    film = ehd.steady(
        bearing,
        speed=speed,
        eccentricity_ratio=eps,
        direction=direction,
        tilt=(size * math.cos(1.0), size * math.sin(1.0)),
    )
    for field in dataclasses.fields(film):
        value = getattr(film, field.name)
        if isinstance(value, (float, np.ndarray)) and field.name not in unknown(speed):
            assert np.all(np.isfinite(value)), field.name
    p, p_c = film.pressure, bearing.cavitation.cavity_pressure
    assert p.min() >= p_c - 1e-9 * np.abs(p).max()
    # force of the pressures by quadrature of our own, trapezoidal in z: the film's own weights are of higher
    # order, so that a parabola on four intervals differs by several per cent; far below a lost sign, factor or row
    R = bearing.journal_radius
    dz = (
        np.trapezoid(p * np.cos(film.theta)[:, None], film.z, axis=1),
        np.trapezoid(p * np.sin(film.theta)[:, None], film.z, axis=1),
    )
    own = -R * 2.0 * np.pi / film.theta.size * np.array([v.sum() for v in dz])
    scale = R * bearing.length * np.abs(p).mean() + 1e-300
    if film.contact_load == 0.0:
        assert np.hypot(*(own - film.force[:2])) < 0.35 * scale * 2.0 * np.pi
    # a steady film dissipates what the shaft puts in
    assert math.isclose(film.power_loss, -film.friction_torque * speed, rel_tol=1e-9, abs_tol=1e-300)
    if not any(bearing.end_pressures) and not bearing.supply:
        assert film.power_loss >= 0.0
    # oil: what the areas feed is what leaks
    if bearing.cavitation.conserves_mass or isinstance(bearing.cavitation, ehd.FullSommerfeld):
        fed = float(film.supply_flows.sum())
        moved = abs(speed) * bearing.length * R * bearing.radial_clearance
        # pressures are counted from the cavity's, to its rounding at some hundred links
        cavity = abs(bearing.cavitation.cavity_pressure) if bearing.cavitation.conserves_mass else 0.0
        moved += max(np.abs(p).max(), 1e-6 * cavity) * bearing.radial_clearance**3 / bearing.lubricant.viscosity
        assert abs(fed - film.leakage) <= 1e-7 * moved


STATE = {
    "bearing": bearings(),
    "eps": st.floats(0.0, 0.99),
    "speed": st.one_of(st.just(0.0), powers(-3.0, 4.0), powers(-3.0, 4.0).map(lambda x: -x)),
    "tilt": st.sampled_from([0.0, 0.5, 0.9]),
    "direction": st.floats(-3.2, 3.2),
}


@settings(max_examples=80, **COMMON)
@given(**STATE)
def test_any_bearing(bearing, eps, speed, tilt, direction):
    check_film(bearing, eps, speed, tilt, direction)


@pytest.mark.slow
@settings(max_examples=4000, **COMMON)
@given(**STATE)
def test_many_bearings(bearing, eps, speed, tilt, direction):
    check_film(bearing, eps, speed, tilt, direction)


def refuses_or_gives(call, name):
    """Finite numbers, or one of the package's errors with the argument's or the function's name."""
    try:
        result = call()
    except ehd.EHDError as error:
        assert name in str(error), str(error)
        return
    assert np.all(np.isfinite(result))


@pytest.mark.parametrize("argument", ["speed", "eccentricity_ratio", "direction", "tilt", "velocity", "axial_speed"])
@settings(max_examples=25, **COMMON)
@given(value=ANYTHING)
def test_arguments_of_steady(argument, value):
    good = {"speed": 300.0, "eccentricity_ratio": 0.6}
    refuses_or_gives(lambda: ehd.steady(PLAIN, **(good | {argument: value})).force, "steady")


@pytest.mark.parametrize("argument", ["speed", "load", "tilt"])
@settings(max_examples=25, **COMMON)
@given(value=ANYTHING)
def test_arguments_of_equilibrium(argument, value):
    good = {"speed": 300.0, "load": (0.0, -200.0)}
    refuses_or_gives(lambda: ehd.equilibrium(PLAIN, **(good | {argument: value})).position, "equilibrium")


@pytest.mark.parametrize(
    "argument",
    [
        "name",
        "itemNumbers",
        "position",
        "axis",
        "bearing",
        "rotationMatrixAxes",
        "axial",
        "stepControl",
        "useGlobalFrame",
        "color",
    ],
)
@settings(max_examples=15, **COMMON)
@given(value=ANYTHING)
def test_arguments_of_the_joint(argument, value):
    import exudyn as exu

    container = exu.SystemContainer()
    mbs = container.AddSystem()
    ground = mbs.CreateGround()
    body = mbs.CreateRigidBody(create2D=True, inertia=_inertia())
    good = {"itemNumbers": [ground, body], "position": [0, 0, 0], "axis": [0, 0, 1], "bearing": PLAIN}
    assume(not (argument == "useGlobalFrame" and isinstance(value, bool)))
    try:
        ehd.CreateLubricatedJoint(mbs, **(good | {argument: value}))
    except ehd.EHDError as error:
        assert argument in str(error) or "outside the bore" in str(error), str(error)


@pytest.mark.parametrize("number", [2**31 - 1, 2**31, -(10**400)])
def test_numbers_beyond_those_of_exudyn(number):
    import exudyn as exu

    container = exu.SystemContainer()
    mbs = container.AddSystem()
    mbs.CreateGround()
    with pytest.raises(ehd.InputError, match=r"CreateLubricatedJoint\.itemNumbers\[1\]"):
        ehd.CreateLubricatedJoint(mbs, itemNumbers=[0, number], position=[0, 0, 0], axis=[0, 0, 1], bearing=PLAIN)


@pytest.mark.parametrize("study", ["steady", "equilibrium", "stribeck"])
@pytest.mark.parametrize(
    "bearing", [None, "x", ehd.SphericalBearing(ball_radius=0.015, radial_clearance=3e-5, lubricant=OIL)]
)
def test_studies_of_journals_take_nothing_else(study, bearing):
    arguments = {
        "steady": {"speed": 300.0, "eccentricity_ratio": 0.5},
        "equilibrium": {"speed": 300.0, "load": (0.0, -100.0)},
        "stribeck": {"speeds": [300.0], "load": 100.0},
    }[study]
    with pytest.raises(ehd.InputError, match=f"{study}: bearing must be JournalBearing"):
        getattr(ehd, study)(bearing, **arguments)


def _inertia():
    from exudyn.utilities import InertiaCuboid

    return InertiaCuboid(1000.0, [0.1, 0.1, 0.1])
