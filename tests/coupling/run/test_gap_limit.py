"""Newton's method is kept within the films, and ends where it did."""

import math
from types import SimpleNamespace

import exudyn as exu
import numpy as np
import pytest
import scenes
from turning import spinning_ring

import exudyn_ehd as ehd
from exudyn_ehd.coupling.kinematics.relative import BoreGap
from exudyn_ehd.coupling.run import newton
from exudyn_ehd.coupling.run.newton import SHARE, SMALLEST_GAP_SHARE, allowed_part

C, LENGTH, CYCLE = 25e-6, 0.02, 0.02
BEARING = ehd.JournalBearing(
    journal_radius=0.01, length=LENGTH, radial_clearance=C, lubricant=ehd.Lubricant(viscosity=0.01)
)
BORE = BoreGap(BEARING)


def smallest_gap(motion):
    """Minimum film thickness at the ends of the length, m."""
    ends = [motion[:2] + z * motion[2:4] for z in (-0.5 * LENGTH, 0.5 * LENGTH)]
    return C - max(np.hypot(*end) for end in ends)


def test_part_of_a_step():
    """Random steps from anywhere, tilted too: half of the gap at most, and all that half allows."""
    rng = np.random.default_rng(3)
    scale, shortened = np.array([1.0, 1.0, 1.0 / LENGTH, 1.0 / LENGTH]), 0
    for _ in range(2000):
        before, after = np.zeros(10), np.zeros(10)
        before[:4] = rng.normal(size=4) * scale * rng.choice([[1, 1, 0, 0], [1, 1, 1, 1]])
        before[:4] *= C * rng.uniform(0.0, 0.9999) / (C - smallest_gap(before))
        after[:4] = before[:4] + rng.normal(size=4) * scale * C * 10.0 ** rng.uniform(-3.0, 2.0)
        gap, part = smallest_gap(before), allowed_part(BORE, before, after)
        if smallest_gap(after) >= (1.0 - SHARE) * gap or gap <= SMALLEST_GAP_SHARE * C:
            assert part == 1.0
            continue
        shortened += 1
        assert 0.0 < part < 1.0
        assert smallest_gap(before + part * (after - before)) == pytest.approx((1.0 - SHARE) * gap, rel=1e-6)
    assert shortened > 500


class Axis:
    """Film of a journal whose first two coordinates are its place."""

    model = SimpleNamespace(bearing=BEARING)

    def __init__(self, old, new):
        self.last = SimpleNamespace(bodies=self.of(old), status=None)
        self.new = new

    def motion(self, mbs, configuration):
        return self.of(self.new)

    @staticmethod
    def of(state):
        return np.r_[state[0][:2], np.zeros(8)]


def test_a_step_of_any_size_leaves_the_integrators_formulas(monkeypatch):
    """Divergence by 1e30 of the clearance is taken back to the film's half, not to zeros."""
    h, rng = 1e-3, np.random.default_rng(0)
    old = [rng.normal(size=3) * size for size in (1e-5, 1e-2, 1e2, 1.0)]
    for size in (1e-4, 1e3, 1e30):
        d = rng.normal(size=3) * size
        new = [old[0] + d, old[1] + 2.0 * d / h, old[2] + 4.0 * d / h**2, old[3] + 1e9 * d]

        limit, states = newton.GapLimit([Axis(old, new)]), [[values.copy() for values in old], new]
        monkeypatch.setattr(newton, "state_of", lambda _, states=states: states[0])
        limit.start(None)
        monkeypatch.setattr(newton, "state_of", lambda _, states=states: states[1])
        limit.shorten(None, np.array([1.0, 1.0, 1.0]))
        gaps = [smallest_gap(Axis.of(values)) for values in (old, new)]
        assert gaps[1] == pytest.approx((1.0 - SHARE) * gaps[0], rel=1e-6)
        moved = [after - before for after, before in zip(new, old, strict=True)]
        for rate, factor in ((1, 2.0 / h), (2, 4.0 / h**2), (3, 1e9)):
            assert moved[rate] == pytest.approx(factor * moved[0], rel=1e-6)


def test_a_journal_of_finite_elements_goes_on_turning_where_newtons_method_diverges():
    """Steps of 0.15 rad with factors that are some steps old: it came to rest where it had started, in one step."""
    mbs, ring, _ = spinning_ring(300.0)
    start = ring.momentum()[1][2]
    settings = ehd.ConfigureSolver(scenes.settings(2.5e-3, 5))
    settings.linearSolver.solverType = exu.LinearSolverType.EigenSparse
    settings.timeIntegration.newton.useModifiedNewton = True
    ehd.SolveDynamic(mbs, settings)
    assert 0.98 * start < ring.momentum()[1][2] < start


@pytest.mark.parametrize("motion", [np.full(10, np.nan), np.r_[C, np.zeros(9)], np.r_[2.0 * C, np.zeros(9)]])
def test_nothing_to_keep(motion):
    """Journals on the wall, behind it, or nowhere."""
    assert allowed_part(BORE, motion, np.zeros(10)) == 1.0
    assert allowed_part(BORE, np.zeros(10), np.full(10, np.nan)) == 1.0


def thrown(planar_rotor, steps):
    """History of a journal that a load throws to and fro through a film with cavities."""
    bearing = ehd.JournalBearing(
        journal_radius=0.01,
        length=LENGTH,
        radial_clearance=C,
        lubricant=ehd.Lubricant(viscosity=0.01),
        film=ehd.FiniteLength(n_theta=48, n_z=6),
        cavitation=ehd.ElrodAdams(cavity_pressure=-1e5),
    )
    turn = 2.0 * math.pi / CYCLE
    rotor = planar_rotor(
        bearing,
        mass=0.5,
        speed=(lambda t: 300.0 * t, lambda t: 300.0),
        position=(0.0, -0.5 * C),
        load=lambda t: (0.0, 3000.0 * math.tanh(20.0 * math.sin(turn * t))),
    )
    settings = exu.SimulationSettings()
    settings.timeIntegration.endTime, settings.timeIntegration.numberOfSteps = 2.0 * CYCLE, 2 * steps
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    ehd.SolveDynamic(rotor.mbs, ehd.ConfigureSolver(settings, spectralRadius=0.9))
    return rotor.joint.history


@pytest.mark.slow
def test_steps_are_not_halved_for_newtons_method(planar_rotor, monkeypatch):
    """A step that would go through the wall is not halved; where no step goes there nothing changes."""
    coarse, fine = thrown(planar_rotor, 100), thrown(planar_rotor, 400)
    assert coarse.minimum_gap.min() == pytest.approx(fine.minimum_gap.min(), rel=0.02)
    monkeypatch.setattr(newton, "allowed_part", lambda *_: 1.0)
    halved, same = thrown(planar_rotor, 100), thrown(planar_rotor, 400)
    # 200 steps; without the limit sixty are added
    assert coarse.time.size < 225 < 250 < halved.time.size
    assert np.array_equal(fine.force, same.force)


def test_newtons_method_does_not_swing_about_the_end_of_a_pressure_law(planar_rotor):
    """A journal pressed with nearly all that a film of Roelands' oil carries: no step is halved, and none stops."""
    bearing = ehd.JournalBearing(
        journal_radius=0.01,
        length=0.022,
        radial_clearance=1e-5,
        lubricant=ehd.Lubricant(viscosity=0.0087, pressure_law=ehd.RoelandsPressure(coefficient=1.5e-8)),
        film=ehd.FiniteLength(n_theta=48, n_z=6),
    )
    time, load, steps = 5e-3, 30e3, 100
    rotor = planar_rotor(
        bearing,
        mass=0.5,
        speed=(lambda t: 20.0 * t, lambda t: 20.0),
        position=(3e-7, -3e-6),
        load=lambda t: (0.0, -load * math.sin(math.pi * t / time) ** 2),
    )
    settings = exu.SimulationSettings()
    settings.timeIntegration.endTime, settings.timeIntegration.numberOfSteps = time, steps
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    ehd.SolveDynamic(rotor.mbs, ehd.ConfigureSolver(settings))
    history = rotor.joint.history
    assert history.time.size == steps + 1
    assert np.linalg.norm(history.force, axis=1).max() == pytest.approx(load, rel=1e-3)
