"""A run ends with one line per joint: what was thinnest and highest, when, and what was left out."""

import dataclasses
import itertools
import logging
import re
import subprocess
import sys
import warnings

import exudyn as exu
import numpy as np
import pytest
import scenes

import exudyn_ehd as ehd
from exudyn_ehd.coupling import doubts
from exudyn_ehd.coupling.element.rigid import FilmElement
from exudyn_ehd.coupling.record.history import error_of_pockets
from exudyn_ehd.joint.step_error import enough_steps


@pytest.fixture
def lines():
    """Lines of the package's logger; pytest's own handlers see none of them."""
    said = []
    handler = logging.Handler()
    handler.emit = lambda record: said.append(record.getMessage())
    logger = doubts.LOGGER
    logger.addHandler(handler)
    logger.setLevel(logging.INFO)
    logger.propagate = False
    yield said
    logger.removeHandler(handler)
    logger.setLevel(logging.NOTSET)
    logger.propagate = True


def scene(load=3000.0, **options):
    bearing = ehd.JournalBearing(
        journal_radius=0.025,
        length=0.025,
        radial_clearance=25e-6,
        lubricant=ehd.Lubricant(viscosity=0.02),
        film=ehd.FiniteLength(n_theta=32, n_z=6),
        **options,
    )
    mbs, joint = scenes.loaded_journal(bearing, [0.0, -load, 0.0])
    mbs.Assemble()
    return mbs, joint


def test_the_line_names_worst_values_and_times(lines):
    mbs, joint = scene()
    ehd.SolveDynamic(mbs, scenes.settings(0.02, 100, tolerance=1e-8))
    (line,) = lines
    history = joint.history
    assert lines == [line]
    assert "'bearing', 100 steps to t = 0.02 s" in line
    thin, high = int(np.argmin(history.minimum_gap)), int(np.argmax(history.peak_pressure))
    assert f"minimum film thickness {1e6 * history.minimum_gap[thin]:.3g} um at {history.time[thin]:.6g} s" in line
    assert f"peak pressure {1e-6 * history.peak_pressure[high]:.3g} MPa at {history.time[high]:.6g} s" in line
    assert "halved" not in line


def test_every_run_has_a_line_of_its_own_and_static_solves_too(lines):
    mbs, _ = scene()
    ehd.SolveDynamic(mbs, scenes.settings(0.002, 10, tolerance=1e-8))
    ehd.SolveDynamic(mbs, scenes.settings(0.004, 20, tolerance=1e-8))
    assert ["10 steps" in lines[0], "20 steps" in lines[1], len(lines)] == [True, True, 2]


def test_a_run_by_exudyn_itself_says_it_when_the_history_is_read_first(lines):
    mbs, joint = scene()
    mbs.SolveDynamic(scenes.settings(0.002, 10, tolerance=1e-8))
    assert not lines
    assert joint.history.time.size == 11
    assert joint.history.time.size == 11
    assert len(lines) == 1


def test_steps_that_a_run_chooses_are_not_halved(lines):
    mbs, joint = scene()
    ehd.SolveDynamic(mbs, ehd.ConfigureSolver(scenes.settings(0.02, 100)), stepControl=ehd.StepControl(error=0.02))
    assert np.ptp(np.diff(joint.history.time)) > 1e-4
    assert len(lines) == 1 and "halved" not in "".join(lines)
    assert not joint.element.steps.chosen


def test_steps_smaller_than_those_of_the_run_before_are_not_halved(lines):
    mbs, joint = scene()
    ehd.SolveDynamic(mbs, ehd.ConfigureSolver(scenes.settings(0.004, 40)), updateInitialValues=True)
    settings = ehd.ConfigureSolver(scenes.settings(0.008, 160))
    settings.timeIntegration.startTime = 0.004
    ehd.SolveDynamic(mbs, settings)
    assert joint.history.time.size == 201
    assert len(lines) == 2 and "200 steps" in lines[1] and "halved" not in "".join(lines)


@pytest.mark.parametrize("kick", [0.0, 3.0], ids=["control", "closed gap"])
def test_the_line_says_which_joint_halved_steps_why_and_how_often(lines, monkeypatch, kick):
    """Every step that a film was asked for and that was not accepted is one halved step with one reason."""
    asked, force = set(), FilmElement.force

    def spied(film, mbs, t, *rest):
        asked.add((mbs.systemData.GetTime(exu.ConfigurationType.StartOfStep), t))
        return force(film, mbs, t, *rest)

    monkeypatch.setattr(FilmElement, "force", spied)
    bearing = ehd.JournalBearing(
        journal_radius=0.025,
        length=0.025,
        radial_clearance=50e-6,
        lubricant=ehd.Lubricant(viscosity=0.02),
        film=ehd.FiniteLength(n_theta=32, n_z=4),
    )
    mbs = scenes.new_system()
    controls = {"quiet": None, "first": None if kick else ehd.StepControl(largest_gap_change=0.05)}
    for name, control in controls.items():
        body = scenes.add_body(
            mbs,
            "Rxyz",
            velocity=(0.0, -kick * (name == "first"), 0.0),
            spin=(0.0, 0.0, 300.0),
            gravity=[0.0, -500.0, 0.0],
        )
        joint = ehd.CreateLubricatedJoint(
            mbs,
            name=name,
            itemNumbers=[mbs.CreateGround(), body],
            position=[0, 0, 0],
            axis=[0, 0, 1],
            bearing=bearing,
            stepControl=control,
            axial=ehd.Held(),
            tilt=ehd.Held(),
        )
    mbs.Assemble()
    with warnings.catch_warnings():
        # the start is an impact
        warnings.simplefilter("ignore")
        ehd.SolveDynamic(mbs, ehd.ConfigureSolver(scenes.settings(0.01, 20)))
    refused = len({(a, b) for a, b in asked if b > a} - set(itertools.pairwise(joint.history.time)))
    assert refused > 1
    for line in lines:
        said = re.search(r", halved steps: (\d+) \((.*?)\)[,;.]", line)
        counts = {reason: int(count) for count, reason in re.findall(r"(\d+) x ([^;]*)", said[2])}
        assert int(said[1]) == sum(counts.values()) == refused
        assert not any("'quiet'" in reason for reason in counts)
        expected = "the gap closed somewhere" if kick else "the gap changed by more than StepControl.largest_gap_change"
        assert any(reason.startswith(f"in 'first' {expected}") for reason in counts)
    assert len(lines) == 2


def test_steps_for_which_no_film_is_to_blame_are_newtons(lines, monkeypatch):
    """Once per refused step, also by Exudyn's own call, of which the next run starts to count anew."""
    mbs, joint = scene()
    settings = ehd.ConfigureSolver(scenes.settings(0.004, 20, tolerance=1e-12))
    settings.timeIntegration.newton.maxIterations, settings.timeIntegration.newton.relativeTolerance = 3, 1e-14
    settings.timeIntegration.newton.absoluteTolerance = 1e-9
    for solve in (ehd.SolveDynamic, exu.MainSystem.SolveDynamic):
        solve(mbs, settings)
        assert joint.history.time[-1] == 0.004
    found = [re.search(r", halved steps: (\d+) \(\1 x Newton's method did not converge\)", line) for line in lines]
    assert len(found) == 2 and all(found)


def test_a_run_that_ends_with_an_error_has_its_line(lines):
    mbs, _ = scene()

    def fails(mbs, t, load):
        if t > 1e-3:
            raise ValueError("user")
        return [0.0, 0.0, 0.0]

    mbs.Reset()
    mbs, _ = scene()
    body = exu.ObjectIndex(1)
    mbs.CreateForce(itemNumber=body, loadVector=[0.0, 0.0, 0.0], loadVectorUserFunction=fails)
    mbs.Assemble()
    with pytest.raises(Exception, match="user"):
        ehd.SolveDynamic(mbs, scenes.settings(0.002, 10, tolerance=1e-8))
    assert len(lines) == 1


@pytest.mark.parametrize(
    ("load", "options", "named", "absent"),
    [
        (300.0, {}, (), ("elasticity", "piezoviscosity", "roughness")),
        (120e3, {}, ("elasticity", "piezoviscosity", "shear thinning", "roughness"), ()),
        (
            60e3,
            {"asperity": ehd.GreenwoodTripp(composite_roughness=3e-7, composite_modulus=1e11)},
            ("elasticity",),
            ("roughness",),
        ),
        (200e3, {"contact": ehd.RegularisedWall(onset=1e-5, pressure=1e8)}, ("thickness -", "thinning"), ("inf",)),
    ],
    ids=["light", "heavy", "rough", "pressed into a soft wall"],
)
def test_effects_left_out_are_named_where_they_matter(lines, load, options, named, absent):
    mbs, _ = scene(load, **options)
    ehd.SolveDynamic(mbs, scenes.settings(0.02, 100, tolerance=1e-8))
    (line,) = lines
    assert [name for name in named if name not in line] == []
    assert [name for name in absent if name in line] == []


@pytest.mark.slow
def test_effects_left_out_come_with_numbers(lines):
    """Sizes are those of the audit: a steel ring's deflection, an oil's thickening at the peak, the mean heating."""
    mbs, joint = scene(12e3)
    ehd.SolveDynamic(mbs, scenes.settings(0.02, 100, tolerance=1e-8))
    peak, thinnest = joint.history.peak_pressure.max(), joint.history.minimum_gap.min()
    ring = 0.7 * joint.bearing.journal_radius * peak / 2.1e11
    rise = re.search(r"rise of (\S+) K", joint.audit()["heating"].indicator)[1]
    said = lines[0].split("worth an audit (joint.audit()): ")[1]
    assert said == (
        f"elasticity: {1e6 * ring:.3g} um of a steel ring, piezoviscosity: viscosity x {np.exp(2e-8 * peak):.3g}, "
        f"heating: +{rise} K, shear thinning: {300.0 * 0.025 / thinnest:.3g} 1/s."
    )


@pytest.mark.slow
def test_steps_that_are_too_coarse_are_named(lines):
    """Step errors from 5 % of the film thickness on are named, with a sufficient number of steps; so does the audit."""
    mbs, joint = scene(30e3)
    ehd.SolveDynamic(mbs, scenes.settings(0.02, 400, tolerance=1e-8))
    history = joint.history
    assert np.nanmax(history.step_error) < 0.05 and "time steps" not in lines[0]
    assert not joint.audit()["time step"].matters
    coarse = dataclasses.replace(history, step_error=history.step_error.copy())
    coarse.step_error[40] = 0.08
    needed = enough_steps(coarse.time, coarse.motion[:, 8], coarse.step_error)
    said = f"error of the time steps 8 % of the minimum film thickness at {history.time[40]:.6g} s: take {needed}"
    assert said in doubts.line("bearing", joint.bearing, coarse)


def test_pressures_behind_restrictors_that_settle_within_few_steps_are_named(lines):
    """Backward Euler of dp/dt = -p / T from p_0 with steps h: an error of some p_0 (h / T)^2 / 2 in a step."""
    feed = ehd.Orifice(diameter=4e-4, supply_pressure=3e6, compressible_volume=1e-6)
    mbs, joint = scene(supply=(ehd.Pocket(angle=1.0, width_angle=0.6, length=0.01, supply=feed),))
    ehd.SolveDynamic(mbs, scenes.settings(2e-3, 100, tolerance=1e-8))
    history, bearing = joint.history, joint.bearing
    steps = np.arange(history.time.size)
    for over, said in ((0.03, False), (0.5, True)):
        pressure = 2e6 / (1.0 + over) ** steps
        made = dataclasses.replace(history, lowest_pocket_pressure=0.5 * pressure, highest_pocket_pressure=pressure)
        error, k = error_of_pockets(bearing, made)
        true = pressure[k] - pressure[k - 1] * np.exp(-over)
        assert error == pytest.approx(true / 2e6, rel=over)
        text = f"error of the pressure behind a restrictor {100.0 * error:.0f} % of the highest one in the step to "
        assert (text in doubts.line("bearing", bearing, made)) == said
    rigid = dataclasses.replace(bearing.supply[0], supply=dataclasses.replace(feed, compressible_volume=0.0))
    assert error_of_pockets(dataclasses.replace(bearing, supply=(rigid,)), made) == (0.0, 0)


@pytest.mark.parametrize(("spin", "needed"), [(0.0, "800 steps in all"), (-20.0 * np.pi, "400 steps per turn")])
def test_number_of_steps_that_would_do(spin, needed):
    """An error of 8 % falls to 2 % with twice the 400 equal steps of 0.2 s, which are two turns at the spin."""
    error = np.full(401, np.nan)
    error[3:] = 0.01
    error[200] = 0.08
    found = enough_steps(np.linspace(0.0, 0.2, 401), np.full(401, spin), error)
    assert found.startswith(needed)


def test_one_switch_turns_the_lines_off(lines):
    doubts.LOGGER.setLevel(logging.WARNING)
    mbs, joint = scene()
    ehd.SolveDynamic(mbs, scenes.settings(0.002, 10, tolerance=1e-8))
    assert joint.history.time.size == 11
    assert not lines


PROGRAM = """
import logging, sys
if "configured" in sys.argv:
    logging.basicConfig(stream=sys.stdout, level=logging.INFO, format="own %(message)s")
from exudyn_ehd.coupling.element.rigid import FilmElement
from exudyn_ehd.coupling.record.history import error_of_pockets
from exudyn_ehd.coupling import doubts
if "off" in sys.argv:
    logging.getLogger("exudyn_ehd").setLevel("WARNING")
if doubts.is_on():
    doubts.LOGGER.info("line")
if doubts.is_on():
    doubts.LOGGER.info("second")
"""


@pytest.mark.parametrize(
    ("argument", "out", "err"),
    [
        ("plain", "", "exudyn_ehd: line\nexudyn_ehd: second\n"),
        ("configured", "own line\nown second\n", ""),
        ("off", "", ""),
    ],
)
@pytest.mark.slow
def test_a_program_without_handlers_gets_one(argument, out, err):
    run = subprocess.run([sys.executable, "-c", PROGRAM, argument], capture_output=True, text=True, check=True)
    assert (run.stdout, run.stderr) == (out, err)
