"""Scenes: journals that move in an Exudyn model. The time of a run is that of Exudyn's solver alone."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import exudyn as exu
import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.coupling.exudyn_solvers import ConfigureSolver
from exudyn_ehd.coupling.record.history import JointHistory
from exudyn_ehd.coupling.run.solve import SolveDynamic
from exudyn_ehd.status import InputError, require_integer, require_number
from tests.benchmarks.accuracy.scenes.mechanisms import Built
from tests.benchmarks.accuracy.scenes.setting import Integration, Outcome, QuantityOfInterest, Setting

Observe = Callable[[JointHistory, np.ndarray], dict[str, Any]]
# What ladders of steps alone are about.
STEP_ERROR = "step error"


@dataclass(frozen=True, kw_only=True)
class MovingScene:
    """A bearing in a mechanism.

    Parameters
    ----------
    name, title : str
    bearing : JournalBearing
        The rungs replace its options.
    build : function of a bearing
        Gives the assembled model and the joint, as in `mechanisms`.
    end : float
        Duration, s.
    steps : int
        Of the whole run, a multiple of ``samples``.
    samples : int
        Instants that curves are compared at, evenly spread up to the end; steps that are multiples of it meet them.
    start : float
        Share of the run that is left out of all quantities.
    observe : function of a history and the instants
        Gives the values of the quantities.
    quantities : tuple of QuantityOfInterest
    """

    name: str
    title: str
    bearing: JournalBearing
    build: Callable[[JournalBearing], Built]
    end: float
    steps: int
    samples: int
    observe: Observe
    quantities: tuple[QuantityOfInterest, ...] = field(repr=False)
    start: float = 0.0
    per: str = "run"

    def __post_init__(self) -> None:
        require_number("MovingScene.end", self.end, "s", above=0.0)
        require_integer("MovingScene.samples", self.samples, at_least=1)
        if self.steps % self.samples != 0:
            raise InputError(f"MovingScene.steps must be a multiple of samples = {self.samples}, got {self.steps}.")

    def instants(self) -> np.ndarray:
        """Instants of comparison, s."""
        all_of_them = self.end * np.arange(1, self.samples + 1) / self.samples
        return all_of_them[all_of_them >= self.start * self.end * (1.0 + 1e-9)]

    @property
    def of_models(self) -> tuple[str, ...]:
        """The quantities but what steps alone are to blame for."""
        return tuple(q.name for q in self.quantities if q.name != STEP_ERROR)

    def prepare(self, setting: Setting) -> Callable[[], Outcome]:
        """Build the model; every run starts anew from its initial state."""
        mbs, joint = self.build(setting.bearing(self.bearing))
        steps = self.steps if setting.integration.steps is None else setting.integration.steps
        settings, solver = _settings(setting.integration, self.end, steps)
        element = joint.element

        def run() -> Outcome:
            before = element.evaluations
            start = time.process_time()
            SolveDynamic(mbs, settings, solverType=solver)
            seconds = time.process_time() - start
            explicit = setting.integration.runge_kutta
            values = self.observe(joint.history, self.instants())
            return Outcome(
                values={name: np.asarray(v, dtype=float) for name, v in values.items() if np.all(np.isfinite(v))},
                seconds=seconds,
                newton=0.0 if explicit else mbs.sys["dynamicSolver"].it.newtonStepsCount / steps,
                films=(element.evaluations - before) / steps,
            )

        return run


def _settings(integration: Integration, end: float, steps: int) -> tuple[Any, Any]:
    settings = exu.SimulationSettings()
    time_integration: Any = settings.timeIntegration
    time_integration.endTime = end
    time_integration.numberOfSteps = steps
    time_integration.verboseMode = 0
    settings.solution.file.write = False
    ConfigureSolver(
        settings,
        integration.newton_tolerance,
        integration.modified_newton,
        spectralRadius=integration.spectral_radius,
    )
    kinds = exu.DynamicSolverType
    return settings, kinds.RK44 if integration.runge_kutta else kinds.GeneralizedAlpha


def at(history: JointHistory, instants: np.ndarray, name: str) -> np.ndarray:
    """A column of the history at the instants: (k,) or (k, components)."""
    values = getattr(history, name)
    if values.ndim == 1:
        return np.interp(instants, history.time, values)
    return np.stack([np.interp(instants, history.time, column) for column in values.T], axis=1)


def extremes(history: JointHistory, instants: np.ndarray) -> dict[str, Any]:
    """Minimum film thickness, peak pressure, mean loss and step error from the first instant on, path and film
    thickness at the instants."""
    kept = history.time >= instants[0] * (1.0 - 1e-9)
    span = history.time[kept]
    loss = np.trapezoid(history.power_loss[kept], span) / (span[-1] - span[0])
    return {
        "path": at(history, instants, "eccentricity"),
        "minimum film thickness": history.minimum_gap[kept].min(),
        "peak pressure": history.peak_pressure[kept].max(),
        "mean loss": loss,
        # as relative errors
        "film thickness": np.log(at(history, instants, "minimum_gap")),
        STEP_ERROR: np.max(np.nan_to_num(history.step_error[kept], nan=-np.inf)),
    }


def extremes_quantities(clearance: float) -> tuple[QuantityOfInterest, ...]:
    """Quantities of interest that `extremes` returns."""
    return (
        QuantityOfInterest(
            name="path", unit="m", scale=clearance, text="path of the journal, error over the clearance"
        ),
        QuantityOfInterest(name="minimum film thickness", unit="m", text="minimum film thickness of the run"),
        QuantityOfInterest(name="peak pressure", unit="Pa", text="largest pressure of the run"),
        QuantityOfInterest(name="mean loss", unit="W", text="mean friction loss"),
        QuantityOfInterest(
            name="film thickness", unit="1", scale=1.0, text="minimum film thickness over time, largest relative error"
        ),
        QuantityOfInterest(name=STEP_ERROR, unit="1", scale=1.0, text="error of the steps as the run tells it"),
    )


def growth(history: JointHistory, instants: np.ndarray, offset: tuple[float, float], spin: float) -> dict[str, float]:
    """Growth rate and frequency, over the spin, of a small vibration released at ``offset`` (m) from its centre.

    Of a linear vibration in one mode, ``u = exp(g t) (a cos w t + b sin w t)``, the swept area ``|u x du/dt| = w |a x
    b| exp(2 g t)`` grows without ripple; the angle of the ellipse, stretched to a circle, is w t.
    """
    kept = history.time >= instants[0] * (1.0 - 1e-9)
    centre = history.eccentricity[0] - np.array(offset)
    t, signal = history.time[kept], (history.eccentricity - centre)[kept]
    rate = history.motion[kept, 4:6]
    area = np.abs(signal[:, 0] * rate[:, 1] - signal[:, 1] * rate[:, 0])
    rate_of_growth = 0.5 * np.polyfit(t, np.log(area), 1)[0]
    z = signal[:, 0] / np.ptp(signal[:, 0]) + 1j * signal[:, 1] / np.ptp(signal[:, 1])
    frequency = abs(np.polyfit(t, np.unwrap(np.angle(z)), 1)[0])
    return {"growth": float(rate_of_growth / spin), "frequency": float(frequency / spin)}


def mixed(history: JointHistory, instants: np.ndarray) -> dict[str, Any]:
    """Friction torque at the instants, its work, path and contact load."""
    t, spin = history.time, history.motion[:, 8]
    torque = np.abs(history.friction_torque)
    return {
        "friction torque": at(history, instants, "friction_torque"),
        "friction work": np.trapezoid(torque * np.abs(spin), t),
        "path": at(history, instants, "eccentricity"),
        "contact load": at(history, instants, "contact_load"),
    }


def mixed_quantities(clearance: float) -> tuple[QuantityOfInterest, ...]:
    """Quantities of interest that `mixed` returns."""
    return (
        QuantityOfInterest(name="friction torque", unit="Nm", text="friction torque, largest error of the run"),
        QuantityOfInterest(name="friction work", unit="J", text="work of friction"),
        QuantityOfInterest(
            name="path", unit="m", scale=clearance, text="path of the journal, error over the clearance"
        ),
        QuantityOfInterest(name="contact load", unit="N", text="load carried by contact, largest error of the run"),
    )
