"""Four neighbouring numbers at once, written out as vectors.

The rows of a film's bands are some ten numbers long: too short for the compiler's vector loops, and numba does not let
it join single numbers into vectors. On processors without such vectors LLVM makes smaller ones of them.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from llvmlite import ir
from numba import types
from numba.core import cgutils
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


def _dots(context: BaseContext, builder: ir.IRBuilder, signature: Signature, arguments: Sequence[ir.Value]) -> ir.Value:
    """Code of `dot_four_lanes`."""
    source, *places, x, at, size = arguments
    sums = [cgutils.alloca_once_value(builder, ir.Constant(_vector, [0.0] * LANES)) for _ in places]
    with cgutils.for_range_slice(builder, size.type(0), size, size.type(LANES), size.type) as (step, _):
        known = builder.load(_place(context, builder, signature.args[5], x, builder.add(at, step)), align=8)
        for total, place in zip(sums, places, strict=True):
            row = _place(context, builder, signature.args[0], source, builder.add(place, step))
            product = builder.fmul(builder.load(row, align=8), known, flags=("contract", "nsz"))
            builder.store(builder.fadd(builder.load(total), product, flags=("contract", "nsz")), total)
    found = []
    for total in map(builder.load, sums):
        a, b, c, d = (builder.extract_element(total, _int32(lane)) for lane in range(LANES))
        found.append(builder.fadd(builder.fadd(a, b), builder.fadd(c, d)))
    return context.make_tuple(builder, signature.return_type, found)


@intrinsic
def dot_four_lanes(typingctx, source, p0, p1, p2, p3, x, at, size):
    """Products of x[at : at + size] with source[p : p + size] for four places p, flat arrays and unsigned places; the
    size counts in whole fours."""
    _require_contiguous(source, x)
    four = types.UniTuple(types.float64, 4)
    return four(source, *4 * (types.uint64,), x, types.uint64, types.uint64), _dots


def _join(context: BaseContext, builder: ir.IRBuilder, signature: Signature, arguments: Sequence[ir.Value]) -> ir.Value:
    """Code of `put_four_lanes`."""
    target, at, *values = arguments
    vector: ir.Value = ir.Constant(_vector, ir.Undefined)
    for lane, value in enumerate(values):
        vector = builder.insert_element(vector, value, _int32(lane))
    builder.store(vector, _place(context, builder, signature.args[0], target, at), align=8)
    return context.get_dummy_value()


@intrinsic
def put_four_lanes(typingctx, target, at, s0, s1, s2, s3):
    """target[at : at + 4] = s0, s1, s2, s3 in one piece, as a vector that is read next waits for several."""
    _require_contiguous(target)
    return types.void(target, types.uint64, *4 * (types.float64,)), _join
