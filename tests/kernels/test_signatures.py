"""The table of the first films' kernels: read, written, and as the films have it."""

import collections
import inspect

import pytest
from numba.core import types

from exudyn_ehd.film.reynolds.balance import FilmTerms
from exudyn_ehd.kernels import ahead
from exudyn_ehd.kernels.ahead import TABLE, find, read_types, table
from tests.benchmarks.first_films import write_type

# Kernels that a first model compiles
MOST_KERNELS = 63
f2, b2 = types.Array(types.float64, 2, "C"), types.Array(types.boolean, 2, "C")


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("f i u b -", (types.float64, types.int64, types.uint64, types.boolean, types.none)),
        ("f2 i1A", (f2, types.Array(types.int64, 1, "A"))),
        ("(f2 f2) (f i)", (types.UniTuple(f2, 2), types.Tuple((types.float64, types.int64)))),
        (
            f"film.reynolds.balance:FilmTerms({' '.join(['f2'] * 10)} b2)",
            (types.NamedTuple((*[f2] * 10, b2), FilmTerms),),
        ),
    ],
)
def test_types_as_text(text, expected):
    assert read_types(text) == expected
    assert " ".join(write_type(kind) for kind in expected) == text


@pytest.mark.parametrize("kind", [types.float32, types.unicode_type, types.Array(types.float64, 1, "C", readonly=True)])
def test_other_types_have_no_text(kind):
    with pytest.raises(ValueError, match="no text for"):
        write_type(kind)


def test_every_line_names_a_kernel_and_what_it_calls():
    names = {kernel.function for kernel in table()}
    for kernel in table():
        function = find(kernel.function).py_func
        arguments = read_types(kernel.arguments)
        assert len(arguments) == len(inspect.signature(function).parameters), kernel.function
        assert " ".join(write_type(kind) for kind in arguments) == kernel.arguments
        assert set(kernel.after) <= names - {kernel.function}
    # one kind of every kernel, but for parts that may be absent
    counts, absent = collections.Counter((k.function, k.group) for k in table()), {"part", "both"}
    assert {name for (name, _), n in counts.items() if n > 1} == {f"film.reynolds.balance:{name}" for name in absent}
    for group, probe in ahead.PROBES.items():
        assert [k.group for k in table() if k.function == probe] == [group]


@pytest.mark.slow
def test_the_table_is_what_first_films_compile():
    """If not: ``python -m tests.benchmarks.first_films`` writes it anew."""
    from tests.benchmarks import first_films

    def content(lines):
        return {tuple(part.strip() for part in line.split("|")[:3]) for line in lines}

    notes = {film: first_films.notes_of(film) for film in first_films.FILMS}
    # one signature of every kernel of the first model, literal types included
    counts = collections.Counter(note["function"] for note in notes["bodies"])
    assert not {name for name, n in counts.items() if n > 1}
    assert len(counts) <= MOST_KERNELS
    found = first_films.lines_of(notes)
    assert content(found) == content(TABLE.read_text(encoding="utf-8").splitlines())
