"""Records of the study: settings on a ladder, outcome of a run; protocol of a scene."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping
from typing import Any, Protocol

import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.status import require_integer, require_number


@dataclasses.dataclass(frozen=True, kw_only=True)
class Integration:
    """Time integration of a moving scene.

    Parameters
    ----------
    steps : int or None
        Steps over the whole run; None: the scene's own.
    spectral_radius : float
        Of generalised alpha, 0 to 1.
    newton_tolerance : float
        Newton's relative tolerance.
    modified_newton : bool
        Keep the Jacobian over several iterations.
    runge_kutta : bool
        Exudyn's explicit RK44 in place of generalised alpha.
    """

    steps: int | None = None
    spectral_radius: float = 0.8
    newton_tolerance: float = 1e-6
    modified_newton: bool = False
    runge_kutta: bool = False

    def __post_init__(self) -> None:
        if self.steps is not None:
            require_integer("Integration.steps", self.steps, at_least=1, hint="None takes the scene's own.")
        require_number("Integration.spectral_radius", self.spectral_radius, at_least=0.0)
        require_number("Integration.newton_tolerance", self.newton_tolerance, above=0.0)


@dataclasses.dataclass(frozen=True, kw_only=True)
class Setting:
    """One rung.

    Parameters
    ----------
    label : str
        In tables and pictures; unique on its ladder.
    family : str
        Rungs that differ by resolution only; one colour in pictures.
    model : str
        Which physical model this is: the reference of that name is what the rung converges to.
    options : mapping
        Fields of `JournalBearing` that replace the scene's.
    integration : Integration
        For scenes that move.
    """

    label: str
    family: str
    model: str
    options: Mapping[str, Any] = dataclasses.field(default_factory=dict)
    integration: Integration = Integration()

    def bearing(self, base: JournalBearing) -> JournalBearing:
        """The scene's bearing ``base`` with this rung's options."""
        return dataclasses.replace(base, **self.options)


@dataclasses.dataclass(frozen=True, kw_only=True)
class QuantityOfInterest:
    """Quantity whose error is measured.

    Parameters
    ----------
    name : str
    unit : str
        Of the value, for tables.
    scale : float or None
        Errors are divided by it; None: by the largest absolute value of the reference.
    text : str
        What exactly is meant, for tables and pictures.
    """

    name: str
    unit: str
    scale: float | None = None
    text: str = ""

    def scale_of(self, reference: np.ndarray) -> float:
        """Divisor of errors against ``reference``."""
        largest = float(np.max(np.abs(reference))) if self.scale is None else self.scale
        return largest if largest > 0.0 else 1.0

    def distance(self, value: np.ndarray, reference: np.ndarray) -> float:
        """Largest difference of two values (any equal shapes), divided by the scale."""
        return float(np.max(np.abs(np.asarray(value) - reference))) / self.scale_of(reference)


@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
class Outcome:
    """Results of one run.

    Attributes
    ----------
    values : mapping
        By quantity: a number or an array, of the same shape on every rung; what a model does not know is left out.
    seconds : float
        Processor time of the measured part.
    newton : float
        Newton iterations: of Exudyn per step, of a steady film per evaluation (linear solves; sweeps of `ClassicSOR`).
    films : float
        Film evaluations: per step, in a steady scene per position.
    """

    values: Mapping[str, np.ndarray]
    seconds: float
    newton: float
    films: float


class Scene(Protocol):
    """A bearing at work."""

    @property
    def name(self) -> str:
        """Name of the scene in files."""
        ...

    @property
    def title(self) -> str:
        """Title of the scene in tables and pictures."""
        ...

    @property
    def quantities(self) -> tuple[QuantityOfInterest, ...]:
        """Quantities whose errors can be measured."""
        ...

    @property
    def per(self) -> str:
        """Unit of work that `Outcome.seconds` refers to."""
        ...

    def prepare(self, setting: Setting) -> Callable[[], Outcome]:
        """Build what can be built ahead (mode shapes, maps, kernels) and return the run, which can be repeated."""
        ...
