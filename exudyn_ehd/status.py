"""Outcomes of a film evaluation, the package's errors, and the checks that scene descriptions share."""

from __future__ import annotations

import dataclasses
import difflib
import enum
import functools
import math
import re
import sys
import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from operator import ge, gt, le, lt
from typing import Any, ClassVar, TypeVar

import numpy as np

from exudyn_ehd.plausible import doubt, kind_of

Hinted = TypeVar("Hinted")
# Largest number of vertices of a film grid in one direction. The error of the load falls with its square, 0.05 % at 192
# (`FiniteLength`): 5e-8 at this limit, where the closures' tolerances dominate. A larger limit allows films that take
# minutes and gigabytes.
MOST_VERTICES = 20_000
# Shares of a whole that are nothing: of what was typed, read or found by an iteration, and of what is computed.
SMALL, ROUNDING = 1e-6, 1e-9


class Status(enum.IntEnum):
    """Outcome of one film evaluation: converged, or why not; ``advice`` says what to do about it.

    CONVERGED: evaluated. NOT_CONVERGED: the cavitation model did not converge. NO_FILM: the gap closed. NO_PRESSURE: no
    finite pressure carries the film with this viscosity-pressure law. OUTSIDE_MAP: outside an `ImpedanceMap`. NO_OIL: a
    steady `ElrodAdams` film has no source of oil. NOT_FINITE: the state is not finite.

    Examples
    --------
    After the example of `solve_film`:

    >>> film.status is ehd.Status.CONVERGED
    True
    >>> ehd.Status.OUTSIDE_MAP.advice.split(";")[0]
    'the journal left the domain of its impedance map'
    """

    CONVERGED = 0
    NOT_CONVERGED = 1
    NO_FILM = 2
    NOT_FINITE = 3
    NO_PRESSURE = 4
    OUTSIDE_MAP = 5
    NO_OIL = 6

    @property
    def advice(self) -> str:
        """One sentence for the user: what happened and what to try."""
        return _ADVICE[self]


_ADVICE = {
    Status.CONVERGED: "the film was evaluated.",
    Status.NOT_CONVERGED: "the cavitation model did not converge; refine the film grid (FiniteLength) or reduce the "
    "step size, and please report the state.",
    Status.NO_FILM: "the gap closed somewhere, where a film has no solution; give the bearing a contact, "
    "contact=RegularisedWall(onset=...), reduce the load, the eccentricity or the step size, or check the radial "
    "clearance.",
    Status.NO_PRESSURE: "the pressure runs away: with this viscosity-pressure law no finite pressure carries the film; "
    "name an elastic liner or bush, which spreads the load, or reduce the load.",
    Status.OUTSIDE_MAP: "the journal left the domain of its impedance map; give ImpedanceMap a larger "
    "largest_eccentricity_ratio, or use film=FiniteLength(...), with contact=RegularisedWall(onset=...) if surfaces "
    "may touch.",
    Status.NO_OIL: "a steady film with ElrodAdams needs oil from somewhere: where it goes round at the cavity "
    "pressure, time alone says how much there is; give the bearing a supply or end_pressures above the cavity "
    "pressure, or take ElrodAdams(cavity_pressure=-1e5) below ambient pressure.",
    Status.NOT_FINITE: "the state handed to the film is not finite; reduce the step size and check the masses and "
    "loads of the model.",
}


class EHDError(Exception):
    """Base class of all errors of this package.

    ``except ehd.EHDError`` catches `InputError`, `FilmError` and `RunError`.

    Examples
    --------
    >>> try:
    ...     ehd.Lubricant(viscosity=-0.02)
    ... except ehd.EHDError as error:
    ...     print(type(error).__name__)
    InputError
    """


class InputError(EHDError, ValueError):
    """An argument has an invalid value; raised before anything runs, with the allowed range.

    Examples
    --------
    >>> ehd.Lubricant(viscosity=-0.02)
    Traceback (most recent call last):
        ...
    exudyn_ehd.status.InputError: Lubricant.viscosity must be > 0 Pa s, got -0.02....
    """


class FilmError(EHDError, RuntimeError):
    """A film could not be evaluated; the message names the joint, the state and the remedy.

    Examples
    --------
    After the example of `JournalBearing`:

    >>> ehd.steady(bearing, speed=314.0, eccentricity_ratio=1.1)
    Traceback (most recent call last):
        ...
    exudyn_ehd.status.FilmError: steady: NO_FILM at x = 2.75e-05 m, y = 0 m, tilt = (0, 0), m...
    """


class RunError(EHDError, RuntimeError):
    """A solver of Exudyn failed although every film could be evaluated; the message tells the state of every joint.

    Raised by the package's own solver calls such as `SolveDynamic`.

    Examples
    --------
    >>> issubclass(ehd.RunError, ehd.EHDError)
    True
    """


class MemoryWarning(UserWarning):
    """A run starts at a new state, but the film of a joint keeps oil content, wear and heat of its last run.

    Call ``joint.forget()`` before a run whose film is to start anew.

    Examples
    --------
    >>> import warnings
    >>> warnings.simplefilter("error", ehd.MemoryWarning)  # ends a run where it would warn
    """


class RingingWarning(UserWarning):
    """Time steps are too large: forces of a joint alternate, or its mesh turns too far in one step.

    Forces and pressures of such a run come from the time integration: take more steps or a smaller spectral radius. It
    also warns of a spectral radius above 0.9, with which alternating velocities hardly fade.

    Examples
    --------
    >>> import warnings
    >>> warnings.simplefilter("error", ehd.RingingWarning)  # ends a run where it would warn
    """


class StarvationWarning(UserWarning):
    """A film gets less oil than it loses: that of a joint runs dry, or a supply area is not full.

    In `steady` and `equilibrium`, if a film takes more oil from a supply area than comes through its restrictor. In a
    joint with `ElrodAdams`, if neither a supply nor an end is above the cavity pressure: give one of them a pressure,
    or take `SwiftStieber` for a bearing that stays flooded.

    Examples
    --------
    >>> import warnings
    >>> warnings.simplefilter("error", ehd.StarvationWarning)  # ends a run where it would warn
    """


class ThinFilmWarning(UserWarning):
    """The film of a joint is thinner than good surfaces are rough, and the bearing models no contact.

    The limit is 0.2 um, or 5 % of the radial clearance if that is less. Give the bearing a contact (`GreenwoodTripp`,
    `RegularisedWall`), or check load, clearance and viscosity.

    Examples
    --------
    >>> import warnings
    >>> warnings.simplefilter("error", ehd.ThinFilmWarning)  # ends a run where it would warn
    """


class GridWarning(UserWarning):
    """The grid of a film does not resolve its pressure peak.

    The peak pressure may be wrong by more than some 5 %; the message names a grid that resolves it.

    Examples
    --------
    >>> import warnings
    >>> warnings.simplefilter("error", ehd.GridWarning)  # ends a run where it would warn
    """


class OverloadWarning(UserWarning):
    """A film has a pressure that neither oil nor steel bears; most likely a step of the time integration was wrong.

    The limits are a peak pressure of 3 GPa, and 1 GPa for the force of film and contact on the projected area 2 R L. In
    `steady` the eccentricity is too large, or a unit is wrong.

    Examples
    --------
    >>> import warnings
    >>> warnings.simplefilter("error", ehd.OverloadWarning)  # ends a run where it would warn
    """


class HotFilmWarning(UserWarning):
    """A film is hotter than mineral oils bear for long.

    Above 150 degrees Celsius. Above 700 K it is a `FilmError`: no oil is a liquid there.

    Examples
    --------
    >>> import warnings
    >>> warnings.simplefilter("error", ehd.HotFilmWarning)  # ends a run where it would warn
    """


class StrainWarning(UserWarning):
    """A `ModalBush`, which is linear, strains by more than 1 %.

    Its displacement is wrong by one to two times the strain: take an `ANCFBush`, with `NeoHooke` for large strain.

    Examples
    --------
    >>> import warnings
    >>> warnings.simplefilter("error", ehd.StrainWarning)  # `steady` raises where it would warn
    """


class PlausibilityWarning(UserWarning):
    """An argument has a size that bearings do not have; most likely it is in another unit.

    The message gives the usual range. The run continues with the value as given.

    Examples
    --------
    >>> import warnings
    >>> warnings.simplefilter("error", ehd.PlausibilityWarning)
    >>> ehd.Lubricant(viscosity=50.0)
    Traceback (most recent call last):
        ...
    exudyn_ehd.status.PlausibilityWarning: Lubricant.viscosity: 50.0 Pa s is unusual, bearings have 0.0...
    """


def warn_user(text: str, kind: type[Warning]) -> None:
    """Warn at the line of the caller's scene, however deep inside this package and Exudyn this is called."""
    frame, level = sys._getframe(1), 3
    own = __name__.partition(".")[0], "dataclasses", "exudyn"
    while frame.f_back is not None and frame.f_back.f_globals.get("__name__", "").partition(".")[0] in own:
        frame, level = frame.f_back, level + 1
    warnings.warn(text, kind, stacklevel=level)


def require_plausible(where: str, value: object, size: float | np.ndarray | None = None) -> None:
    """Warn of a size that bearings do not have, and raise `InputError` beyond all reason; see `plausible`.

    Parameters
    ----------
    where : str
        ``Class.argument``, as in the table.
    value : object
        Value given by the user.
    size : float or array, optional
        Size to be judged in place of ``value``, which then is only named; of arrays the largest number.
    """
    judged = np.abs(np.asarray(value if size is None else size, dtype=float))
    largest = float(judged.max(initial=0.0))
    said = doubt(where, value if size is not None or judged.size < 4 else f"up to {largest:g}", largest)
    if said is not None and said[1]:
        raise InputError(said[0])
    if said is not None:
        warn_user(said[0], PlausibilityWarning)


def require_number(
    where: str,
    value: float,
    unit: str = "",
    *,
    above: float | None = None,
    at_least: float | None = None,
    below: float | None = None,
    at_most: float | None = None,
    hint: str = "",
) -> float:
    """Return ``value`` as a finite float, or raise `InputError` naming argument, received and expected value.

    Parameters
    ----------
    where : str
        ``Class.argument`` for the message.
    value : float
        Value given by the user.
    unit : str
        SI unit for the message; left out, that of the argument in `exudyn_ehd.plausible`.
    above, at_least, below, at_most : float, optional
        Exclusive and inclusive bounds.
    hint : str
        Next step, appended to the message.
    """
    known = ((">", above, gt), (">=", at_least, ge), ("below", below, lt), ("at most", at_most, le))
    bounds = [(f"{sign} {bound:g}", bound, holds) for sign, bound, holds in known if bound is not None]
    # a lower bound is named by itself, an upper one as the end of a range
    if len(bounds) == 2:
        bounds[1] = (f"between {bounds[0][1]:g} and {bounds[1][1]:g}", *bounds[1][1:])
    kind = kind_of(where)
    if not unit and kind is not None:
        unit = kind.unit
    unit = f" {unit}" if unit else ""
    finite = f"a finite number in{unit}" if unit else "a finite number"
    expected = f"{bounds[0][0]}{unit}" if bounds else ""
    tail = f"; {hint}" if hint else "."
    if isinstance(value, bool) or not isinstance(value, (int, float, np.integer, np.floating)):
        raise InputError(f"{where} must be {f'a number {expected}' if bounds else finite}, got {value!r}{tail}")
    try:
        number = float(value)
    except OverflowError:
        number = math.inf
    broken = [text for text, bound, holds in bounds if not holds(number, bound)]
    if broken or not math.isfinite(number):
        expected = f"{broken[0]}{unit}" if broken else expected or finite
        raise InputError(f"{where} must be {expected}, got {value!r}{tail}")
    require_plausible(where, value, number)
    return number


def require_integer(where: str, value: int, *, at_least: int, at_most: int | None = None, hint: str = "") -> int:
    """Return ``value`` as an int within bounds, or raise `InputError`."""
    tail = f"; {hint}" if hint else "."
    if isinstance(value, bool) or not isinstance(value, (int, np.integer)) or value < at_least:
        raise InputError(f"{where} must be an integer >= {at_least}, got {value!r}{tail}")
    if at_most is not None and value > at_most:
        raise InputError(f"{where} must be between {at_least} and {at_most}, got {value!r}{tail}")
    return int(value)


require_count = functools.partial(require_integer, at_most=MOST_VERTICES, hint="it is of a film grid.")
"""Check of a number of vertices or intervals of a film grid in one direction."""


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """The nearest of the known names; empty if none is near."""
    near = {other.lower(): other for other in known}
    found = difflib.get_close_matches(name.lower(), near, n=1)
    return near[found[0]] if found else ""


_BUSHES_WITH_MASS = (
    "take ANCFBush(...), whose elements have mass, or an ObjectFFRFreducedOrder as housing with FEBore(fem=...)"
)
# Public names and arguments that are not supported any more, with what takes their place.
GONE = {
    "ModalBush.body_forces": _BUSHES_WITH_MASS,
    "ModalBush.dynamics": _BUSHES_WITH_MASS,
    "JournalLeakage": "give ThrustFaces(inner_pressures=...) the pressures at the inner edges",
    "ThrustFaces.feed": "give inner_pressures=... the pressures at the inner edges",
}


def require_supported(name: str) -> None:
    """Raise `InputError` with the substitute of a name or an argument that is not supported any more."""
    if name in GONE:
        raise InputError(f"{name} is not supported any more; {GONE[name]}.")


def hint_arguments(item: Hinted) -> Hinted:
    """Let a description name the argument that was meant by one that it does not have; return any other item as it is.

    The meaning is the first sentence about the argument in the description's docstring.
    """
    if not (isinstance(item, type) and dataclasses.is_dataclass(item)) or hasattr(item.__init__, "__wrapped__"):
        return item
    own, names = item.__init__, [field.name for field in dataclasses.fields(item) if field.init]

    @functools.wraps(own)
    def init(self: object, *args: object, **given: object) -> None:
        if args and dataclasses.fields(item)[0].kw_only:
            raise InputError(
                f"{item.__name__} takes its arguments by name, {names[0]}=..., got {args[0]!r} without one."
            )
        for name in given.keys() - names:
            require_supported(f"{item.__name__}.{name}")
            meant = did_you_mean(name, names)
            about = re.search(rf"\n +{meant or '-'} : .*\n +([^.]*)\.", item.__doc__ or "")
            raise InputError(
                f"{item.__name__} has no argument {name!r}"
                + (f"; did you mean {meant}" if meant else "")
                + (f" ({' '.join(about[1].split())})" if about else "")
                + ("? " if meant else ". ")
                + f"It takes {', '.join(names)}."
            )
        own(self, *args, **given)

    item.__init__ = init  # type: ignore[method-assign]
    return item


def require_type(where: str, value: object, *types: type, hint: str = "") -> None:
    """Raise `InputError` for an object of none of these types, and for a class.

    ``type(None)`` stands for None. An object is of a protocol if it has all of its attributes. Without a ``hint`` the
    message says that options are objects, or that an object of this package is of another kind.
    """
    if isinstance(value, type) or not isinstance(value, types):
        called, own = {True: "a {} of your own", False: "{}(...)"}, type(value).__module__.startswith("exudyn_ehd.")
        names = " or ".join(
            "None" if t is type(None) else called[getattr(t, "_is_protocol", False)].format(t.__name__) for t in types
        )
        raise InputError(
            f"{where} must be {names}, got {f'{type(value).__name__}(...)' if own else repr(value)}; "
            + (
                hint
                or f"{'that is an object of another kind' if own else 'options are objects, not strings or classes'}."
            )
        )


def require_bool(where: str, value: object) -> bool:
    """Return ``value`` as a bool; 0 and 1 count as such."""
    if not isinstance(value, (bool, np.bool_, int, np.integer)) or value not in (0, 1):
        raise InputError(f"{where} must be True or False, got {value!r}.")
    return bool(value)


# Checks of single arguments for the tables of `Checked`.
POSITIVE = functools.partial(require_number, above=0.0)
NOT_NEGATIVE = functools.partial(require_number, at_least=0.0)
KELVIN = functools.partial(POSITIVE, hint="0 degrees Celsius are 273.15 K.")
SHARE = functools.partial(POSITIVE, at_most=1.0)


class Checked:
    """Base of descriptions whose arguments are checked one by one.

    Attributes
    ----------
    checks : mapping
        By argument: a function of ``Class.argument`` and value, such as a partial `require_number`, or the types of
        which the value must be. An argument that is None by default may stay so.
    """

    checks: ClassVar[Mapping[str, Callable[[str, Any], object] | tuple[type, ...]]] = {}

    def __post_init__(self) -> None:
        for field in dataclasses.fields(self):  # type: ignore[arg-type]
            value, check = getattr(self, field.name), self.checks.get(field.name, ())
            where = f"{type(self).__name__}.{field.name}"
            if check == () or (value is None and field.default is None):
                continue
            if isinstance(check, tuple):
                require_type(where, value, *check)
            else:
                check(where, value)


def require_vector(where: str, value: Sequence[float] | np.ndarray, size: int, unit: str = "") -> np.ndarray:
    """Return ``value`` as a finite float64 vector of ``size``, or raise `InputError`."""
    expected = f"must be {size} finite numbers" + (f" in {unit}" if unit else "")
    try:
        vector = np.array(value, dtype=float)
        # numpy reads numbers out of strings, arithmetic does not
        if np.asarray(value).dtype.kind in "SU":
            raise TypeError
    except (TypeError, ValueError, OverflowError):
        raise InputError(f"{where} {expected}, got {value!r}.") from None
    if vector.shape != (size,) or not np.all(np.isfinite(vector)):
        raise InputError(f"{where} {expected}, got {value!r}.")
    require_plausible(where, value, vector)
    return vector


def require_size(where: str, value: float | np.ndarray, unit: str, largest: float) -> None:
    """Raise `InputError` if a size is neither 0 nor within limits beyond which numbers overflow or vanish."""
    size, smallest = float(np.max(np.abs(value))), 1e-30
    if size != 0.0 and not smallest <= size <= largest:
        raise InputError(
            f"{where} must be 0 or between {smallest:g} and {largest:g} {unit} in size, got {value!r}; check its unit."
        )
