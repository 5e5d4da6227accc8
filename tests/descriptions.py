"""Public descriptions found by themselves, so that contracts hold for a new one without naming it."""

from __future__ import annotations

import dataclasses
import inspect
import math

import exudyn_ehd as ehd
from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.film.lubricant import lubricant
from exudyn_ehd.plausible import ARGUMENTS, KINDS

LAWS = {name: lubricant.LAWS[name][:-1] for name in ("pressure_law", "shear_law", "density_law")}

# without the protocol of those that users write
OPTIONS = {name: types for name, types in JournalBearing.checks.items() if isinstance(types, tuple)}
CAVITATION = OPTIONS["cavitation"][:-1]


def specs():
    """Classes of all public descriptions that check what they are given."""
    public = [getattr(ehd, name) for name in ehd.__all__]
    return [
        c
        for c in public
        if inspect.isclass(c)
        and dataclasses.is_dataclass(c)
        and c.__dataclass_params__.frozen
        and hasattr(c, "__post_init__")
    ]


def usual(argument):
    """A size in the middle of an argument's plausible range."""
    kind = KINDS.get(ARGUMENTS.get(argument))
    return 0.5 if kind is None else math.sqrt(kind.low * kind.high) or 0.1 * kind.high


def by_itself(spec):
    """An example with the middle of its plausible range for everything that must be given; None if not enough.

    Numbers without a dimension get 0.5.
    """
    fields = dataclasses.fields(spec)
    needed = [f.name for f in fields if f.default is f.default_factory is dataclasses.MISSING]
    try:
        return spec(**{name: usual(f"{spec.__name__}.{name}") for name in needed})
    except (ehd.InputError, TypeError):
        return None


def options_of(module):
    """Options of a bearing (those of its lubricant under their own names) that a module defines, each by itself."""
    for option in (by_itself(spec) for spec in specs() if spec.__module__ == f"exudyn_ehd.{module}"):
        for name, types in (OPTIONS | LAWS).items():
            if isinstance(option, types):
                yield name, option
