"""Kernels that first films compile: few, of one signature each, and as the table has them."""

import collections

import pytest

from tests.benchmarks import first_films

# Kernels that a first model compiles
MOST_KERNELS = 72


@pytest.mark.slow
def test_the_table_is_what_first_films_compile():
    """If not: ``python -m tests.benchmarks.first_films`` writes it anew."""
    notes = {film: first_films.notes_of(film) for film in first_films.FILMS}
    # one signature of every kernel of the first model, literal types included
    counts = collections.Counter(name for name, _ in {*notes["bodies"]})
    assert not {name for name, n in counts.items() if n > 1}
    assert len(counts) <= MOST_KERNELS
    assert first_films.lines_of(notes) == first_films.TABLE.read_text(encoding="utf-8").splitlines()
