"""The table of kernels that the first films compile, with the types of their arguments as text.

A line has a group, a kernel as ``module:function``, its arguments, and the kernels of the table that it calls. Types
are f, i, u, b for 64-bit floats, integers, unsigned integers and bool; f2 for a contiguous array of two dimensions, f2A
for one with any strides; - for None; (f1 f1) for a tuple and ``module:Name(f1 f1)`` for a NamedTuple. Modules are those
of the package.
"""

from __future__ import annotations

import importlib
import pathlib
import re
from typing import Any, NamedTuple

from numba.core import types
from numba.core.types.containers import BaseTuple

TABLE = pathlib.Path(__file__).parent / "first_films.txt"
PACKAGE = __name__.split(".")[0]
SCALARS = {"f": types.float64, "i": types.int64, "u": types.uint64, "b": types.boolean, "-": types.none}
_TOKEN = re.compile(r"[()]|[\w.]+:\w+|[fiub]\d?A?|-")


class Kernel(NamedTuple):
    """One line of the table.

    Attributes
    ----------
    group : str
        Films that need it.
    function : str
        ``module:function``, modules without the package's name.
    arguments : str
        Types, see this module.
    after : tuple of str
        Kernels of the table that it calls, each ``module:function``.
    """

    group: str
    function: str
    arguments: str
    after: tuple[str, ...]

    def compile(self) -> bool:
        """Compile the kernel, or read it from numba's cache; returns whether it was there."""
        dispatcher = find(self.function)
        before = sum(dispatcher.stats.cache_hits.values())
        known = len(dispatcher.signatures)
        dispatcher.compile(read_types(self.arguments))
        return len(dispatcher.signatures) == known or sum(dispatcher.stats.cache_hits.values()) > before


def find(name: str) -> Any:
    """Return the object of the package with the path ``module:name``."""
    module, function = name.split(":")
    return getattr(importlib.import_module(f"{PACKAGE}.{module}"), function)


def table() -> tuple[Kernel, ...]:
    """All lines, the first to be compiled first."""
    lines = (f"{line} ".split("|") for line in TABLE.read_text(encoding="utf-8").splitlines())
    return tuple(Kernel(g.strip(), f.strip(), a.strip(), tuple(after.split())) for g, f, a, after in lines)


def read_types(text: str) -> tuple[types.Type, ...]:
    """Types of the arguments of a kernel from their text."""
    stack: list[list[types.Type]] = [[]]
    makers: list[str] = []
    named = ""
    for token in _TOKEN.findall(text):
        if token == "(":
            stack.append([])
            makers.append(named)
            named = ""
        elif token == ")":
            items, maker = stack.pop(), makers.pop()
            stack[-1].append(BaseTuple.from_types(items, find(maker) if maker else None))
        elif ":" in token:
            named = token
        elif len(token) == 1:
            stack[-1].append(SCALARS[token])
        else:
            stack[-1].append(types.Array(SCALARS[token[0]], int(token[1]), "A" if token.endswith("A") else "C"))
    return tuple(stack[0])
