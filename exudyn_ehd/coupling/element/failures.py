"""Messages for states without a valid film, or close to one: place, cause and remedy.

With a pressure law, a film of rigid surfaces exists only up to an end of q, the integral of dp / r(p) with the
viscosity ratio r. The end is 1 / alpha for Barus' law, and 5 % more for Roelands' law with 2e-8 1/Pa at 0.02 Pa s. A
film at a given speed, whose peak is at the share s of the end, carries the share 1 - (1 - s)^0.65 of its largest
possible load. The error of this share is below 0.03 for these two laws, from s = 0.5 on, for L/D of 0.25 to 1 and
eccentricity ratios of 0.5 to 0.97 at the end. It is up to 0.17 for Roelands' law with 1e-8 1/Pa at 0.2 Pa s, whose
actual share is larger. The mean pressure is a worse measure: at the end it is 0.2 to 0.9 of 1 / alpha.
"""

from __future__ import annotations

import math

import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.coupling.contract import Trial
from exudyn_ehd.coupling.kinematics.relative import BoreGap, eccentricity_ratios
from exudyn_ehd.coupling.record.history import FORCE, MINIMUM_GAP, PEAK_PRESSURE
from exudyn_ehd.film.lubricant.lubricant import transform_of
from exudyn_ehd.joint.balance.limits import (
    HIGHEST_MEAN,
    HIGHEST_PEAK,
    HOTTEST,
    NO_OIL,
    PRESSED_THROUGH,
    advice,
    hot_film,
    hottest,
    is_above,
    mean_pressure,
    outside_table,
    seized,
)
from exudyn_ehd.joint.solved_film import History
from exudyn_ehd.joint.thrust import ThrustEvaluation, no_film
from exudyn_ehd.status import FilmError, HotFilmWarning, InputError, MemoryWarning, Status, warn_user

# Share of the end of a pressure law above which a film causes a warning, at three quarters of its largest load;
# exponent of the formula above. A smaller share would warn of normal films with a pressure law too: half of the load is
# reached at a peak pressure of 1 / alpha, 50 MPa.
NEAR_END, EXPONENT = 0.9, 0.65
# Smallest ratio of mean and peak pressure of any film. If the mean pressure is below this share of the limit of the
# peak pressure, the peak is not computed.
SHARE = 0.01
# Messages advise about tilting first if the eccentricity ratio at an end exceeds both: this multiple of that in the
# mid-plane (from 2 on most of it comes from tilt), and this value (at 1 the surfaces touch). Larger: advised less
# often.
TILTED, NEAR = 2.0, 0.8


class Failures:
    """Errors of one joint.

    Parameters
    ----------
    name : str
        Name of the joint.
    bearing : JournalBearing

    Attributes
    ----------
    largest_force, largest_pressure : float
        Limits above which an accepted step ends the run, N and Pa; infinite and `HIGHEST_PEAK` by default.
    near_end : float
        Peak pressure close to the end of the oil's pressure law, Pa; infinite where surfaces deflect, or without a law.
    axes : int
        Number of directions in which the film has damping.
    refused : dict
        Reason why a step of the run was repeated with a smaller size, by its start and its end, s. All joints share one
        dict in a run that a function of this package has started.
    """

    axes = 2
    refused: dict[tuple[float, float], str]

    def __init__(self, name: str, bearing: JournalBearing) -> None:
        self.name, self.bearing = name, bearing
        self.bore, self._per_force = BoreGap(bearing), mean_pressure(bearing, 1.0)
        self.largest_force, self.largest_pressure = math.inf, HIGHEST_PEAK
        # bearings of a user's models may have no lubricant
        law = self._law = transform_of(bearing.lubricant) if getattr(bearing, "yielding", bearing) is None else None
        self.near_end = math.inf if law is None else float(np.interp(NEAR_END * law.q[-1], law.q, law.p))

    def blame(self, start: float, time: float, reason: str) -> None:
        """Store that this film rejects a step, unless another film has: its nan appears in the states of all films."""
        self.refused.setdefault((start, time), f"in '{self.name}' {reason}")

    def ask(self, start: float, time: float, last: float) -> None:
        """Store a step tried by a solver: one that ends before the ``last`` one, s, repeats it with a smaller size."""
        if time < last:
            self.refused.setdefault((start, last), "Newton's method did not converge")

    def no_film(self, time: float, trial: Trial, *, explicit: bool) -> FilmError:
        """Error of a film that cannot be evaluated, if the solver cannot repeat the step."""
        if trial.faces is not None and trial.faces.status is not Status.CONVERGED:
            where = f"LubricatedJoint '{self.name}' can't be evaluated at t = {time:.9g} s"
            return FilmError(no_film(trial.faces, where))
        if np.all(np.isfinite(trial.motion)):
            state = self.place(trial.motion)
        elif trial.status == Status.NOT_FINITE:
            state = "the state is not finite; "
        else:
            state = "the journal's axis has left the bearing's (tilt near 90 degrees); "
        message = f"can't be evaluated at t = {time:.9g} s: {state}{advice(trial.status, self.bearing)}"
        if explicit:
            message += " An explicit solver can't repeat a step: use smaller ones, or an implicit solver."
        return FilmError(f"LubricatedJoint '{self.name}' {message}")

    def warn_of_end(self, time: float, trial: Trial) -> None:
        """Warn that the last state of a run has no film."""
        text = f"{self.no_film(time, trial, explicit=False)} The run ended there: history leaves this state out."
        warn_user(text, UserWarning)

    def no_mass(self) -> InputError:
        """Error of massless modes under an explicit solver, which would integrate their numerical mass."""
        kind = type(self.bearing.yielding if self.bearing.journal is None else self.bearing.journal).__name__
        return InputError(
            f"LubricatedJoint '{self.name}': the modes of its {kind} have no mass, which explicit solvers can't "
            "integrate: forces and motion would be wrong; use an implicit solver "
            "(exu.DynamicSolverType.GeneralizedAlpha)."
        )

    def chatter(self, time: float, trial: Trial, *, step: float, miss: float) -> FilmError:
        """Error of an explicit solver whose ``step`` (s) exceeds its stability limit.

        ``miss`` (m): displacement in the step minus the integral of the rates.
        """
        damping = -trial.found.tangent()[: self.axes, 4 : 4 + self.axes]
        largest = float(np.linalg.eigvalsh(0.5 * (damping + damping.T))[-1])
        return self._at(
            time,
            f"the explicit solver's step of {step:.3g} s is too large for this film, the journal chatters: in the last "
            f"step its displacement and its velocities disagree by {miss:.3g} m; {self.place(trial.motion)}with the "
            f"journal's mass m and the film's damping C, here about {largest:.2g} N s/m, steps must stay below 2 m / C "
            "with forward Euler and 2.8 m / C with RK44, tilting motions alike: use smaller steps, DOPRI5 with its "
            "automatic steps, or an implicit solver.",
        )

    def absurd(self, time: float, row: np.ndarray, trial: Trial) -> FilmError | None:
        """Error of an accepted step that no bearing can have; None if the step is valid."""
        film = getattr(trial.evaluation, "film", None)
        if message := seized(getattr(film, "walls", None)) or outside_table(film):
            return self._at(time, message)
        # the mean pressure of film and contacts, if it is larger than the peak or if there is no peak
        pressure = max(self._mean(row[FORCE]), float(row[PEAK_PRESSURE]))
        if pressure > self._bearable:
            return FilmError(self.overloaded(time, row, trial.motion))
        on_faces = None if trial.faces is None else self._absurd_faces(time, trial.faces)
        return on_faces or self._beyond_limit(time, row, trial, pressure) or self._pressed_through(time, row, trial)

    def _absurd_faces(self, time: float, faces: ThrustEvaluation) -> FilmError | None:
        """Error of a collar that penetrates its contact too deeply, or with too high a pressure; None if valid."""
        gap, peak = faces.minimum_gap, faces.quantities()["thrust_peak_pressure"]
        assert self.bearing.thrust is not None
        if gap < -self.bearing.thrust.clearance:
            return self._at(
                time,
                f"a collar is pressed through its thrust face, smallest gap {gap:.4g} m; check load, mass and units, "
                "give ThrustFaces.contact more stiffness (RegularisedWall.pressure), or take smaller steps.",
            )
        if peak > self.largest_pressure:
            return self._at(
                time,
                f"its thrust faces have a film that neither oil nor steel bears: peak pressure {peak:.4g} Pa, axial "
                f"force {faces.wrench[2]:.4g} N, smallest gap {gap:.4g} m; check masses, loads and units, take more "
                "steps, or name ThrustFaces.contact; joint.stop_at(pressure=...) allows more.",
            )
        return None

    def crushes(self, trial: Trial) -> bool:
        """Return whether the film's pressure exceeds the limit for accepted steps."""
        if trial.evaluation is None or trial.status != Status.CONVERGED:
            return False
        mean = self._mean(trial.evaluation.wrench[:3])
        if mean < SHARE * self._bearable:
            return False
        return max(mean, trial.evaluation.quantities().get("peak_pressure", 0.0)) > self._bearable

    @property
    def _bearable(self) -> float:
        """Pressure above which smaller steps are tried, Pa; a lower limit of the user ends the run at once."""
        return max(HIGHEST_PEAK, self.largest_pressure)

    def _mean(self, force: np.ndarray) -> float:
        """Mean pressure of a force (3,) on the projected area, Pa."""
        return math.hypot(*force.tolist()) * self._per_force

    def thrown(self, time: float, trial: Trial, force: float, mean: float) -> FilmError:
        """Error of a run that rings with a ``force``, N, many times as large as its ``mean``, N, over three steps."""
        return self._at(
            time,
            f"the film's force is out of all proportion to the inertia and loads at hand: it alternates from step to "
            f"step with up to {force:.4g} N, while its mean over three steps, which moves the bodies and carries their "
            f"loads, is {mean:.4g} N; {self.place(trial.motion)}the time integration causes forces and pressures of "
            "the last steps: use ehd.ConfigureSolver(simulationSettings), or a spectral radius of 0.6 or less, "
            "ehd.SolveDynamic in place of mbs.SolveDynamic, and more steps until none is halved.",
        )

    def _beyond_limit(self, time: float, row: np.ndarray, trial: Trial, peak: float) -> FilmError | None:
        """Error of an accepted step whose film exceeds a limit of the user; None if it does not."""
        force = float(np.linalg.norm(row[FORCE]))
        if not (force > self.largest_force or peak > self.largest_pressure):
            return None
        return self._at(
            time,
            f"the accepted step has a film beyond the limits of joint.stop_at(force={self.largest_force:g}, "
            f"pressure={self.largest_pressure:g}): force {force:.4g} N, peak pressure {peak:.4g} Pa; "
            f"{self.place(trial.motion)}check masses, loads and units, take more steps, or a larger limit.",
        )

    def check_heat(self, time: float, trial: Trial, memory: History | None, limit: float) -> float:
        """Warn of a film hotter than ``limit`` (K), which oil does not bear for long; return the limit of later calls.

        Raises
        ------
        FilmError
            If the film is hotter than any oil.
        """
        T = getattr(memory, "temperature", None)
        film = None if T is None else getattr(trial.evaluation, "film", None)
        if T is None or film is None or not is_above(limit, T):
            return limit
        if is_above(HOTTEST, T):
            rubs = "; asperities rub, and heat spots through which hardly any oil flows"
            contact = "" if getattr(self.bearing, "asperity", None) is None else rubs
            place = f"{hottest(T, film.grid)}, {self.place(trial.motion)}"
            raise self._at(time, f"the film is at {place}{NO_OIL}{contact}")
        where = f"LubricatedJoint '{self.name}' at t = {time:.9g} s"
        warn_user(hot_film(T, film.grid, where), HotFilmWarning)
        return HOTTEST

    def warn_of_memory(self, start: float, end: float) -> None:
        """Warn that a run starts at a state that is neither the start nor the end of the previous run."""
        warn_user(
            f"LubricatedJoint '{self.name}': the run from t = {start:.9g} s starts at a state that no run has led to; "
            f"its film goes on with what it remembers of t = {end:.9g} s (oil content, wear, temperature, deflection). "
            "Call joint.forget() before a run whose film shall start anew.",
            MemoryWarning,
        )

    def _pressed_through(self, time: float, row: np.ndarray, trial: Trial) -> FilmError | None:
        """Error of a journal that is deeper in its bore than any contact explains; None if it is not."""
        # nan for pads, which have no bore
        if not row[MINIMUM_GAP] < -self.bearing.radial_clearance:
            return None
        return self._at(
            time,
            f"{PRESSED_THROUGH}; {self.place(trial.motion)}check load, mass and units; give the contact more "
            "stiffness (RegularisedWall.pressure), or take smaller steps or a StepControl if the step has overshot.",
        )

    def overload(self, row: np.ndarray) -> float:
        """Largest ratio of a pressure of an accepted step to its limit: by materials, or near a pressure law's end."""
        # nan for film models without a peak pressure
        return max(self._mean(row[FORCE]) / HIGHEST_MEAN, float(row[PEAK_PRESSURE]) / min(HIGHEST_PEAK, self.near_end))

    def overloaded(self, time: float, row: np.ndarray, motion: np.ndarray) -> str:
        """Return the message for an accepted step near a pressure law's end, or above the limits of oil and steel."""
        force, mean, peak = float(np.linalg.norm(row[FORCE])), self._mean(row[FORCE]), float(row[PEAK_PRESSURE])
        if self._law is not None and self.near_end < peak <= HIGHEST_PEAK and mean <= HIGHEST_MEAN:
            left = 1.0 - float(np.interp(peak, self._law.p, self._law.q)) / self._law.q[-1]
            return (
                f"LubricatedJoint '{self.name}' at t = {time:.9g} s: the film is close to the largest load that it can "
                f"carry between rigid surfaces with {self.bearing.lubricant.pressure_law}: the peak pressure is "
                f"{1e-6 * peak:.3g} MPa, the mean pressure (force / diameter / length) {1e-6 * mean:.3g} MPa of about "
                f"{1e-6 * mean / (1.0 - left**EXPONENT):.3g} MPa, beyond which no "
                "finite pressure carries it and the run ends; give the bearing a bush that deflects "
                "(bush=ModalBush(...)), more length or a larger radius, or check load, viscosity and the law's "
                "coefficient."
            )
        return (
            f"LubricatedJoint '{self.name}' at t = {time:.9g} s: the accepted step has a film that neither oil nor "
            f"steel bears: peak pressure {1e-6 * peak:.4g} MPa, force {force:.4g} N, {1e-6 * mean:.4g} "
            f"MPa on the projected area; {self.place(motion)}if loads and inertia forces of the model are much "
            "smaller, the time integration has thrown the film: use ehd.SolveDynamic, "
            "ConfigureSolver(simulationSettings), more steps, or a StepControl; if they are not, check masses, loads, "
            "initial velocities and units, or give the bearing a bush that deflects; joint.stop_at(pressure=...) "
            "allows more."
        )

    def _at(self, time: float, message: str) -> FilmError:
        return FilmError(f"LubricatedJoint '{self.name}' at t = {time:.9g} s: {message}")

    def place(self, motion: np.ndarray) -> str:
        """Describe the journal's position at a motion (10,), followed by `tilting`, for messages."""
        bearing = self.bearing
        mid, largest = eccentricity_ratios(motion, bearing.radial_clearance, bearing.length)
        gap, is_pad = self.bore.smallest(motion), getattr(bearing, "thrust", None) is bearing
        ratios = f"eccentricity ratio {mid:.6g} in the mid-plane, {largest:.6g} at an end"
        # pads have no bore
        return "" if is_pad else f"{ratios}, minimum gap of the rigid surfaces {gap:.6g} m; {self.tilting(motion)}"

    def tilting(self, motion: np.ndarray) -> str:
        """Advice for a journal that touches because of its tilt, at a motion (10,); empty if it does not."""
        mid, largest = eccentricity_ratios(motion, self.bearing.radial_clearance, self.bearing.length)
        if largest <= max(TILTED * mid, NEAR):
            return ""
        return (
            "the journal has tilted into its bore: first give the joint tilt=ehd.Held() (CreateLubricatedJoint, "
            "ReplaceJoint), unless other joints of its body carry the tilting moment; "
        )
