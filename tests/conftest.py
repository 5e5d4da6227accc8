"""Fixtures that all tests share."""

from __future__ import annotations

from collections.abc import Callable

import pytest

import exudyn_ehd as ehd

RADIUS = 0.025
CLEARANCE = 25e-6
VISCOSITY = 0.02


@pytest.fixture(scope="session")
def make_bearing() -> Callable[..., ehd.JournalBearing]:
    """A bearing of R = 25 mm, psi = 0.001, mu = 0.02 Pa s; everything can be replaced."""

    def make(length_to_diameter: float = 1.0, **options: object) -> ehd.JournalBearing:
        values = {
            "journal_radius": RADIUS,
            "radial_clearance": CLEARANCE,
            "lubricant": ehd.Lubricant(viscosity=VISCOSITY),
        } | options
        values.setdefault("length", 2.0 * length_to_diameter * values["journal_radius"])
        return ehd.JournalBearing(**values)

    return make


@pytest.fixture
def measured() -> Callable[[str, float, float], None]:
    """Assert that a measured error is below its limit, and print both (shown by ``pytest -rP``)."""

    def check(what: str, value: float, limit: float) -> None:
        print(f"{what}: {value:.3g} (limit {limit:g})")
        assert value <= limit, f"{what}: {value:.4g} exceeds {limit:g}"

    return check
