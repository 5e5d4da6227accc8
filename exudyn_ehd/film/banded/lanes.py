"""Four neighbouring numbers at once, written out as vectors.

The rows of a film's bands are some ten numbers long: too short for the compiler's vector loops, and numba does not let
it join single numbers into vectors. On processors without such vectors LLVM makes smaller ones of them.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from llvmlite import ir
from numba import types
from numba.core.base import BaseContext
from numba.core.errors import TypingError
from numba.core.typing.templates import Signature
from numba.extending import intrinsic

LANES = 4
_int32 = ir.IntType(32)
_vector = ir.VectorType(ir.DoubleType(), LANES)


def _require_contiguous(*arrays: types.Array) -> None:
    """Refuse arrays, when a kernel is compiled, whose neighbours do not lie side by side."""
    if any(array.layout != "C" for array in arrays):
        raise TypingError(f"vectors are read from and written to contiguous arrays, got {arrays}")


def _place(context: BaseContext, builder: ir.IRBuilder, kind: types.Array, array: ir.Value, at: ir.Value) -> ir.Value:
    """Pointer to the vector that begins at a flat index."""
    data = context.make_array(kind)(context, builder, array).data
    return builder.bitcast(builder.gep(data, [at]), _vector.as_pointer())


def _subtract(count: int) -> Callable:
    """Code that subtracts ``count`` vectors, each times its factor."""

    def generate(
        context: BaseContext, builder: ir.IRBuilder, signature: Signature, arguments: Sequence[ir.Value]
    ) -> ir.Value:
        target, at, source, *rest = arguments
        goal = _place(context, builder, signature.args[0], target, at)
        total = builder.load(goal, align=8)
        for place, factor in zip(rest[:count], rest[count:], strict=True):
            known = builder.load(_place(context, builder, signature.args[2], source, place), align=8)
            lane = builder.insert_element(ir.Constant(_vector, ir.Undefined), factor, _int32(0))
            mask = ir.Constant(ir.VectorType(_int32, LANES), None)
            spread = builder.shuffle_vector(lane, ir.Constant(_vector, ir.Undefined), mask)
            product = builder.fmul(spread, known, flags=("contract", "nsz"))
            total = builder.fsub(total, product, flags=("contract", "nsz"))
        builder.store(total, goal, align=8)
        return context.get_dummy_value()

    return generate


def _signature(target: types.Array, source: types.Array, count: int) -> Signature:
    _require_contiguous(target, source)
    return types.void(target, types.uint64, source, *count * (types.uint64,), *count * (types.float64,))


@intrinsic
def subtract_lanes(typingctx, target, at, source, p, f):
    """target[at : at + 4] -= f source[p : p + 4], flat arrays and unsigned places."""
    return _signature(target, source, 1), _subtract(1)


@intrinsic
def subtract_four_lanes(typingctx, target, at, source, p0, p1, p2, p3, f0, f1, f2, f3):
    """target[at : at + 4] -= f0 source[p0 : p0 + 4] + f1 source[p1 : p1 + 4] + ..., flat arrays, unsigned places."""
    return _signature(target, source, 4), _subtract(4)
