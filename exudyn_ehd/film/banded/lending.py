"""Arrays that kernels hand on without counting who holds them.

Numba counts the holders of an array one by one, safely for all threads: every kernel that unpacks a tuple or flattens
an array counts up and down again. On small films that takes a seventh of the time.
"""

from __future__ import annotations

from collections.abc import Sequence

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core.base import BaseContext
from numba.core.typing.templates import Signature
from numba.extending import intrinsic


def _lent(context: BaseContext, builder: ir.IRBuilder, kind: types.Type, value: ir.Value) -> ir.Value:
    """The same arrays without their counters, those in tuples, too."""
    if isinstance(kind, types.BaseTuple):
        parts = cgutils.unpack_tuple(builder, value)
        lent = [_lent(context, builder, own, part) for own, part in zip(kind.types, parts, strict=True)]
        return context.make_tuple(builder, kind, lent)
    if not isinstance(kind, types.Array):
        return value
    array = context.make_array(kind)(context, builder, value)
    for name in ("meminfo", "parent"):
        setattr(array, name, cgutils.get_null_value(getattr(array, name).type))
    return array._getvalue()


def _generate(
    context: BaseContext, builder: ir.IRBuilder, signature: Signature, arguments: Sequence[ir.Value]
) -> ir.Value:
    return _lent(context, builder, signature.args[0], arguments[0])


@intrinsic
def lend(typingctx, what):
    """The same array, or tuple of arrays and numbers, for kernels that end before its owner does.

    Only of a kernel's own arguments: what the kernel makes itself is gone behind its last use by its own name.
    """
    return what(what), _generate
