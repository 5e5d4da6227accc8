"""Models that the theory of rotors does not cover raise errors that name the cause."""

import exudyn as exu
import numpy as np
import pytest
from rigid_rotors import bearing, fixed, shaft, three_bodies

import exudyn_ehd as ehd

SPEED = 300.0


def refused(match, speeds=SPEED, error=ehd.InputError, rotors=None, ratios=None, **options):
    with pytest.raises(error, match=match):
        ehd.SolveEquilibrium(shaft(**options)[0], speeds, rotors=rotors, ratios=ratios)


def test_speeds_and_systems_are_checked():
    for wrong in (0.0, [1.0, np.nan], [], [[1.0]], [1.0, -1.0]):
        refused("speeds must be", speeds=wrong)
    refused("not assembled", assemble=False)
    empty = exu.SystemContainer().AddSystem()
    empty.Assemble()
    with pytest.raises(ehd.InputError, match="no lubricated joint"):
        ehd.SolveEquilibrium(empty, SPEED)
    with pytest.raises(ehd.InputError, match="must be an exudyn"):
        ehd.SolveEquilibrium(None, SPEED)
    refused("ratios must be 1 finite", ratios=[1.0, 2.0])
    refused("rotors and their bodies as numbers of .*, got 'shaft'", rotors=["shaft"])


@pytest.mark.parametrize(
    ("options", "match"),
    [
        ({"transverse": (2.0, 2.002)}, "mass matrix changes as the rotors turn, by 0.00035.* node 0"),
        ({"com": (1e-4, 0.0, 0.0)}, "changes as the rotors turn"),
        ({"com": (2e-7, 0.0, 0.0)}, "load of node 0 .* turns with the rotor, by .* unbalance_response"),
        ({"held": False}, "nothing holds node 0 'node0' along z; .*ehd.Held"),
        ({"axis": 0, "held": False}, "nothing holds node 0 'node0' along x"),
    ],
)
def test_rotors_must_be_the_same_in_all_directions_and_held(options, match):
    refused(match, **options)


def test_what_turns_with_the_rotor_or_keeps_it_from_turning():
    def side_spring(mbs, ground, body, turn):
        mbs.CreateCartesianSpringDamper(
            itemNumbers=[ground, body], localPosition0=[0.1, 0, 0], localPosition1=[0.1, 0, 0], stiffness=[1e6] * 3
        )

    def clamp(mbs, ground, body, turn):
        mbs.CreateGenericJoint(itemNumbers=[ground, body], position=[0, 0, 0], constrainedAxes=[0, 0, 0, 0, 0, 1])

    def pull(mbs, ground, body, turn):
        mbs.CreateForce(itemNumber=body, loadVector=[0, 30, 0], bodyFixed=True)

    refused("stiffness matrix changes as the rotors turn", extra=side_spring)
    refused("JointGeneric keeps a rotor from turning", extra=clamp)
    refused("turns with the rotor, by", extra=pull)


@pytest.mark.parametrize(
    ("options", "match"),
    [
        ({"squeeze": False}, "joint 'left' has squeeze=False and so no damping"),
        ({"cavitation": ehd.ElrodAdams()}, "joint 'left': a steady film with ElrodAdams needs oil from somewhere"),
        (
            {"supply": (ehd.Hole(angle=1.0, diameter=0.005, pressure=1e5, rotating=True),)},
            r"joint 'left': JournalBearing.supply\[0\] turns with the journal",
        ),
    ],
)
def test_films_without_a_position_of_rest_or_damping_are_refused(options, match):
    refused(match, film=bearing(**options))


def test_no_equilibrium_is_told_with_the_joints_and_leaves_the_system_as_it_was():
    """A weight that presses the journal through its film at this speed."""
    mbs, *_ = shaft(mass=3e8)
    before = np.array(mbs.systemData.GetODE2Coordinates())
    with pytest.raises(ehd.FilmError, match=r"at 300 rad/s; .* joint 'left' at an eccentricity ratio of .* tilt"):
        ehd.SolveEquilibrium(mbs, SPEED)
    np.testing.assert_array_equal(mbs.systemData.GetODE2Coordinates(), before)


def test_results_refuse_what_they_have_not():
    mbs, body, _ = shaft(place=0.05)
    result = ehd.SolveEquilibrium(mbs, SPEED)
    with pytest.raises(ehd.InputError, match=r"nodes \[0\] do"):
        result.unbalance_response({exu.ObjectIndex(0): 1e-4})
    for wrong in ({}, {body: np.nan}, 1e-4):
        with pytest.raises(ehd.InputError, match="must be a dict of finite kg m"):
            result.unbalance_response(wrong)
    with pytest.raises(ehd.InputError, match=r"UnbalanceResponse: no joint 'middle', there are \['left', 'right'\]"):
        result.unbalance_response({body: 1e-4}).amplitude("middle")
    with pytest.raises(ehd.InputError, match="speed must be one of"):
        result.place(mbs, 2.0 * SPEED)
    for wrong in (np.nan, np.inf, None):
        with pytest.raises(ehd.InputError, match=r"place: speed must be"):
            result.place(mbs, wrong)
    with pytest.raises(ehd.InputError, match="of 7 coordinates, got one of 21"):
        result.place(three_bodies(fixed)[0], SPEED)


def test_a_threshold_below_its_limits_is_refused_and_above_them_none():
    mbs, *_ = shaft(mass=20.0, transverse=0.3, polar=0.1)
    with pytest.raises(ehd.InputError, match="unstable at lowest = 2000 rad/s already"):
        ehd.SolveThreshold(mbs, 2000.0, 2500.0)
    assert ehd.SolveThreshold(mbs, 500.0, 600.0) is None
    table = ehd.stability_map(lambda speed: mbs, [1.0], lowest=500.0, highest=600.0)
    assert table.thresholds[0] == np.inf and np.isnan(table.whirl_ratios[0])
