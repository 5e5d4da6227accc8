"""Any value in any field of a public description builds, or raises the documented error that names the argument."""

from __future__ import annotations

import dataclasses
import math
import types
import warnings

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import exudyn_ehd as ehd
from tests.descriptions import by_itself, specs

OIL = ehd.Lubricant(viscosity=0.02)
MESH = ehd.HollowCylinder(inner_radius=0.02, thickness=0.01, length=0.02, axial=2, radial=1, circumferential=8)
STEEL = ehd.SaintVenantKirchhoff(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7800.0)
# Made of a mesh's own surfaces and lines.
OF_A_MESH = {"DeadPressure", "FollowerPressure", "LineLoad", "SurfaceLoad", "Support", "ProfileTable"}
# One good example of every public description that needs more than numbers of any size.
GOOD = [
    ehd.JournalBearing(journal_radius=0.02, length=0.02, radial_clearance=2e-5, lubricant=OIL),
    ehd.TiltingPads(journal_radius=0.02, length=0.02, radial_clearance=2e-5, lubricant=OIL, pad_thickness=0.01),
    ehd.Lubricant(viscosity=0.02, temperature=310.0),
    ehd.RegularisedWall(onset=1e-6),
    ehd.GreenwoodTripp(composite_roughness=4e-7, composite_modulus=1e11),
    ehd.PatirCheng(composite_roughness=4e-7),
    ehd.ArchardWear(wear_rate=1e-16),
    ehd.AxialGroove(angle=0.3, width_angle=0.5),
    ehd.CircumferentialGroove(width=2e-3),
    ehd.Hole(angle=0.3, diameter=3e-3),
    ehd.Pocket(angle=0.3, width_angle=0.5, length=5e-3),
    ehd.LumpedThermal(supply_temperature=313.0),
    ehd.FilmEnergy(supply_temperature=313.0),
    ehd.ElasticLiner(thickness=1e-3, youngs_modulus=1e9),
    ehd.BarusPressure(coefficient=2e-8),
    ehd.RoelandsPressure(coefficient=2e-8),
    ehd.CarreauShear(relaxation_time=1e-6, exponent=0.6, residual=0.2),
    ehd.OutOfRound(amplitude=1e-6, order=2),
    ehd.Crown(drop=1e-6),
    ehd.EdgeRelief(drop=1e-6, relief_length=2e-3),
    ehd.AxialProfile(positions=(-0.01, 0.01), depths=(0.0, 1e-6)),
    ehd.VogelTemperature(first=(313.0, 0.04), second=(373.0, 0.006)),
    ehd.TableViscosity(temperatures=(293.0, 313.0, 373.0), viscosities=(0.1, 0.04, 0.006)),
    ehd.WaltherTemperature(first=(313.0, 0.04), second=(373.0, 0.006)),
    ehd.ReynoldsTemperature(point=(313.0, 0.04), coefficient=0.03),
    ehd.HollowCylinder(inner_radius=0.02, thickness=0.01, length=0.02, axial=2, radial=1, circumferential=8),
    STEEL,
    ehd.NeoHooke(youngs_modulus=5e6, poisson_ratio=0.45, density=1100.0),
    ehd.OnCylinder(radius=0.03),
    ehd.OnPlane(point=(0.0, 0.0, 0.01), normal=(0.0, 0.0, 1.0)),
    ehd.Gravity(acceleration=(0.0, -9.81, 0.0)),
    ehd.ModalBush(mesh=MESH, material=STEEL),
    ehd.ANCFBush(mesh=MESH, material=STEEL),
    ehd.FEBore(fem=types.SimpleNamespace(elements=[])),
    ehd.FEJournal(fem=types.SimpleNamespace(elements=[])),
    ehd.File(path="main.rows"),
    ehd.Every(steps=20),
    ehd.TaperLand(pads=6, depth=2e-5),
    ehd.StepLand(pads=6, depth=2e-5),
    ehd.ThrustFaces(inner_radius=0.02, outer_radius=0.03, clearance=2e-5),
    ehd.TiltingThrustPads(
        inner_radius=0.05,
        outer_radius=0.1,
        pads=8,
        extent=0.65,
        pivot_radius=0.077,
        pivot_angle=0.39,
        clearance=6e-5,
        lubricant=OIL,
        pad_mass=0.3,
        pad_inertia=(6e-5, 6e-5),
    ),
    ehd.SphericalBearing(ball_radius=0.015, radial_clearance=3e-5, lubricant=OIL),
    ehd.HeldBands(bands=((-0.03, -0.015), (0.015, 0.03))),
    ehd.ElasticJournal(material=STEEL, span=(-0.03, 0.03), held=ehd.HeldEnds()),
]
_OTHERS = [c for c in specs() if c.__name__ not in OF_A_MESH | {type(good).__name__ for good in GOOD}]
GOOD += [good for good in map(by_itself, _OTHERS) if good is not None]
SPECIAL = [0, -1, 1, 1e-300, 1e300, math.inf, -math.inf, math.nan, 5e-324, np.float64(0.5), np.int64(3), 10**400]
OBJECTS = [OIL, ehd.SwiftStieber, ehd.SwiftStieber(), object(), {}, np.zeros(2), np.zeros((2, 2)), 1j, b"x"]
NUMBERS = st.one_of(st.floats(), st.sampled_from(SPECIAL), st.integers(-5, 2000))
ANYTHING = st.one_of(
    NUMBERS,
    st.none(),
    st.booleans(),
    st.text(max_size=5),
    st.tuples(NUMBERS, NUMBERS),
    st.lists(NUMBERS, max_size=3),
    st.sampled_from(OBJECTS),
)
SETTINGS = {"deadline": None, "suppress_health_check": list(HealthCheck), "derandomize": True, "database": None}


def attempt(make):
    """Call; any error must be the documented one. Returns what was built, or None."""
    with warnings.catch_warnings():
        # clearances outside the usual range warn
        warnings.simplefilter("ignore", UserWarning)
        try:
            return make()
        except ehd.InputError as error:
            return error


def check_replaced(good, name, value):
    built = attempt(lambda: dataclasses.replace(good, **{name: value}))
    if isinstance(built, ehd.InputError):
        text = str(built)
        # the message names class or argument, or the other one that it clashes with, and says more than that
        assert type(good).__name__ in text or name in text, text
        assert len(text) > 30
    else:
        # what was accepted can be written down, compared and changed again
        assert repr(built)
        for field in dataclasses.fields(built):
            got = getattr(built, field.name)
            if isinstance(got, float):
                assert math.isfinite(got) or got == getattr(good, field.name), (field.name, got)


def _fields():
    for good in GOOD:
        for field in dataclasses.fields(good):
            yield pytest.param(good, field.name, id=f"{type(good).__name__}.{field.name}")


FIELDS = list(_fields())


@pytest.mark.parametrize(("good", "name"), FIELDS)
@settings(max_examples=6, **SETTINGS)
@given(value=ANYTHING)
def test_any_value_in_any_field(good, name, value):
    check_replaced(good, name, value)


@pytest.mark.slow
@pytest.mark.parametrize(("good", "name"), FIELDS)
@settings(max_examples=60, **SETTINGS)
@given(value=ANYTHING)
def test_many_values_in_any_field(good, name, value):
    check_replaced(good, name, value)


@pytest.mark.slow
@pytest.mark.parametrize("good", GOOD, ids=lambda good: type(good).__name__)
def test_special_values_in_any_field(good):
    """Every special number, alone and in pairs, and every object in every field: some that draws would miss."""
    values = [*SPECIAL, *((x, 1.0) for x in SPECIAL), *((1.0, x) for x in SPECIAL), *OBJECTS, None, True, False, "", []]
    for field in dataclasses.fields(good):
        for value in values:
            check_replaced(good, field.name, value)


def test_every_public_description_takes_part():
    missing = set(specs()) - {type(good) for good in GOOD}
    assert {c.__name__ for c in missing} <= OF_A_MESH
