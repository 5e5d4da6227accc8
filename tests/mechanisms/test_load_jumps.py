"""Errors of steps in which loads jump, set in and knock: estimated, and kept by chosen steps, over random scenes.

A reference takes `FINE` times the steps and the load's mean over each of them, so that no jump is misplaced in it. Its
own error is below 1 % of the gap.

Measured on the seeds 0 to 299, 3000 to 3299, 4000 to 4129 and 5000 to 5199, of which the last were drawn when the
estimate was finished: 416 errors lie above 2 %. Their estimates are 0.69 to 1.8 times as large, half of them 0.98 to
1.02 times. `StepControl` keeps 1.4 times the error that is asked for, 2 or 5 %, in 659 of the 660 runs of the seeds
4000 to 4129 and 5000 to 5199; one jump ends at 1.56 times.
"""

import math

import exudyn as exu
import numpy as np
import pytest
from scipy.interpolate import CubicSpline

import exudyn_ehd as ehd
from tests.mechanisms.planar import PlanarRotor

FILM = ehd.FiniteLength(n_theta=40, n_z=5)
FINE, STEPS = 24, 44
KINDS = ("jump", "ramp", "pulse", "knock")


class Scene:
    """A journal in balance with its load, which changes once: at once, along a ramp, for a while, as half a sine.

    Its mass lies below half the critical ones before and behind, so that no whirl grows.
    """

    def __init__(self, seed):
        rng = np.random.default_rng(seed)

        def between(low, high):
            return float(np.exp(rng.uniform(math.log(low), math.log(high))))

        radius, self.speed = between(0.008, 0.04), between(60.0, 500.0)
        self.bearing = ehd.JournalBearing(
            journal_radius=radius,
            length=radius * rng.uniform(0.8, 2.0),
            radial_clearance=(clearance := radius * rng.uniform(0.6e-3, 2e-3)),
            lubricant=ehd.Lubricant(viscosity=between(0.008, 0.08)),
            film=FILM,
            cavitation=ehd.Gumbel() if rng.random() < 0.25 else ehd.SwiftStieber(),
            contact=ehd.RegularisedWall(onset=0.05 * clearance),
        )
        film = ehd.steady(self.bearing, speed=self.speed, eccentricity_ratio=rng.uniform(0.3, 0.8))
        self.load = np.array([0.0, -math.hypot(*film.force[:2])])
        self.step = 2.0 * math.pi / self.speed / between(12.0, 160.0)
        self.kind, self.radius = KINDS[rng.choice(4, p=(0.5, 0.2, 0.15, 0.15))], float(rng.choice([0.6, 0.6, 0.9]))
        # nothing happens before, and the table above begins after 20 steps
        self.begin = (4 + rng.uniform()) * self.step
        self.last = (
            float(rng.uniform(*{"ramp": (0.1, 4.0), "pulse": (1.2, 12.0)}.get(self.kind, (1.5, 10.0)))) * self.step
        )
        turn = rng.uniform(-1.5, 1.5) if rng.random() < 0.4 else 0.0
        self.change = (
            float(rng.choice([0.3, 0.5, 2.0, 3.0, 5.0]))
            * self.load
            @ np.array([[math.cos(turn), math.sin(turn)], [-math.sin(turn), math.cos(turn)]])
            - self.load
        )
        critical = [
            ehd.equilibrium(self.bearing, speed=self.speed, load=tuple(load)).critical_mass
            for load in (self.load, self.load + self.change)
        ]
        # none is critical at large eccentricities; no journal weighs more than ten times its load
        self.mass = between(0.005, 0.5) * min(*critical, 20.0 * math.hypot(*self.load) / 9.81)

    def share(self, time):
        """Share of the change of load that has set in."""
        s = time - self.begin
        if s <= 0.0:
            return 0.0
        if self.kind == "jump":
            return 1.0
        if self.kind == "ramp":
            return min(s / self.last, 1.0)
        if s >= self.last:
            return 0.0
        return 1.0 if self.kind == "pulse" else math.sin(math.pi * s / self.last)

    def total(self, time):
        """Integral of the share, s."""
        s, last = max(time - self.begin, 0.0), self.last
        if self.kind == "jump":
            return s
        if self.kind == "ramp":
            return 0.5 * s * s / last if s < last else s - 0.5 * last
        s = min(s, last)
        return s if self.kind == "pulse" else last / math.pi * (1.0 - math.cos(math.pi * s / last))

    def run(self, fine=1, **options):
        """History with the scene's steps, or with ``fine`` times as many and mean loads."""
        h = self.step / fine

        def load(time):
            share = self.share(time) if fine == 1 else (self.total(time + 0.5 * h) - self.total(time - 0.5 * h)) / h
            return (self.load + share * self.change).tolist()

        rotor = PlanarRotor(self.bearing, mass=self.mass, speed=self.speed, load=load)
        rotor.joint.place_in_equilibrium(load=tuple(self.load))
        settings = exu.SimulationSettings()
        settings.timeIntegration.endTime, settings.timeIntegration.numberOfSteps = STEPS * self.step, STEPS * fine
        settings.solution.file.write = False
        ehd.ConfigureSolver(settings, spectralRadius=self.radius if fine == 1 else 0.6)
        ehd.SolveDynamic(rotor.mbs, settings, **options)
        return rotor.joint.history

    def reference(self):
        """Place of the journal (n, 2) at any times (n,)."""
        history = self.run(FINE)
        return CubicSpline(history.time, history.eccentricity)


def true_error(history, reference):
    return float(np.max(np.hypot(*(history.eccentricity - reference(history.time)).T) / history.minimum_gap))


def told_and_true(scene, reference):
    history = scene.run()
    return float(np.nanmax(history.step_error)), true_error(history, reference)


def test_a_jump_is_told_and_kept():
    """An error of 5 %, of which 1 % is told without its jump; chosen steps keep 2 %, 1.5 times at most."""
    scene = Scene(8)
    reference = scene.reference()
    told, true = told_and_true(scene, reference)
    assert true > 0.04 and 0.5 < told / true < 2.5
    assert true_error(scene.run(stepControl=ehd.StepControl(error=0.02)), reference) < 0.03


@pytest.mark.slow
def test_a_pulse_of_a_single_state_is_two_jumps():
    """An error of 4 %, told at 0.4 of its size if the load is taken to go back along the line of its jump.

    Chosen steps keep 2 %, 1.5 times at most; a pulse that begins and ends within one of them ends at 2.9 times.
    """
    scene = Scene(87)
    told, true = told_and_true(scene, scene.reference())
    assert scene.kind == "pulse" and scene.last < 1.5 * scene.step
    assert true > 0.04 and 0.5 < told / true < 2.5
    assert true_error(scene.run(stepControl=ehd.StepControl(error=0.02)), scene.reference()) < 0.03


@pytest.mark.slow
def test_a_film_that_lifts_in_the_step_of_the_jump():
    """An error of 7 % of a film that lifts by a third in the step of the jump and the next one.

    With the stiffness and damping of the end of each step it is told at 0.4 of its size. Chosen steps keep 2 %, 1.5
    times at most.
    """
    scene = Scene(4060)
    reference = scene.reference()
    told, true = told_and_true(scene, reference)
    assert true > 0.06 and 0.5 < told / true < 2.5
    assert true_error(scene.run(stepControl=ehd.StepControl(error=0.02)), reference) < 0.03


@pytest.mark.slow
def test_told_and_chosen_errors_of_many():
    """Seeds that were not drawn for the table above, with bounds around it.

    Every error above 2 % is told at 0.5 to 2.5 times its size, half of them at 0.9 to 1.1 times. Chosen steps keep 1.5
    times what is asked for, pulses within one of them included.
    """
    ratios, kept = [], []
    for seed in range(1000, 1040):
        scene = Scene(seed)
        reference = scene.reference()
        told, true = told_and_true(scene, reference)
        if true > 0.02:
            ratios.append(told / true)
        kept += [
            true_error(scene.run(stepControl=ehd.StepControl(error=error)), reference) / error for error in (0.02, 0.05)
        ]
    ratios = np.array(ratios)
    assert len(ratios) > 10 and ratios.min() > 0.5 and ratios.max() < 2.5
    assert np.mean((ratios > 0.9) & (ratios < 1.1)) > 0.5
    assert len(kept) == 80 and max(kept) < 1.5
