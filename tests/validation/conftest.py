"""Reading of the tables next to these tests."""

from __future__ import annotations

import csv
from collections.abc import Callable
from pathlib import Path

import pytest

DATA = Path(__file__).parent / "data"


def _number(text: str) -> float | str:
    try:
        return float(text)
    except ValueError:
        return text


@pytest.fixture(scope="session")
def table() -> Callable[[str], list[dict]]:
    """Rows of ``data/<name>.csv`` as dictionaries; numbers as floats, empty cells as ''."""

    def read(name: str) -> list[dict]:
        with open(DATA / f"{name}.csv", newline="", encoding="utf-8") as file:
            return [{key: _number(value) for key, value in row.items()} for row in csv.DictReader(file)]

    return read
