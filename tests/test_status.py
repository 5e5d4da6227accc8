"""Hints of the public descriptions on arguments that they do not have."""

import dataclasses
import inspect
import pickle

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.status import InputError, hint_arguments, require_number


def _descriptions():
    for name in ehd.__all__:
        item = getattr(ehd, name)
        if dataclasses.is_dataclass(item):
            yield item, [field.name for field in dataclasses.fields(item) if field.init]


def test_every_description_names_the_argument_that_was_meant():
    """By a letter that is missing, doubled or another one, of names that are long enough to be meant."""
    rng = np.random.default_rng(4)
    count = 0
    for item, names in _descriptions():
        for name in (name for name in names if len(name) > 6):
            k = int(rng.integers(1, len(name)))
            wrong = (name[:k] + name[k + 1 :], name[:k] + name[k - 1 :], name[:k] + "q" + name[k + 1 :])[count % 3]
            if wrong in names:
                continue
            with pytest.raises(ehd.InputError, match=rf"{item.__name__} has no argument '{wrong}'; did you mean") as e:
                item(**{wrong: 1.0})
            # of similar names the nearest
            assert f"did you mean {name}" in str(e.value) or sum(n[:3] == name[:3] for n in names) > 1
            count += 1
    assert count > 200


def test_the_hint_says_what_the_argument_means():
    size = {"journal_radius": 0.02, "length": 0.02, "lubricant": ehd.Lubricant(viscosity=0.02)}
    with pytest.raises(
        ehd.InputError, match=r"no argument 'clearance'; did you mean radial_clearance \(.*, half the diametral clear"
    ):
        ehd.JournalBearing(**size, clearance=20e-6)
    with pytest.raises(ehd.InputError, match=r"^Lubricant has no argument 'mu'. It takes viscosity, density"):
        ehd.Lubricant(mu=0.02)
    bearing = ehd.JournalBearing(**size, radial_clearance=20e-6)
    with pytest.raises(ehd.InputError, match="did you mean radial_clearance"):
        dataclasses.replace(bearing, radial_clearence=30e-6)


def test_descriptions_stay_what_they_were():
    """Signatures, pickling and equality; what is missing is Python's to say; a second call changes nothing."""
    hole = ehd.Hole(angle=1.0, diameter=0.004)
    assert pickle.loads(pickle.dumps(hole)) == hole == ehd.Hole(angle=1.0, diameter=0.004)
    assert list(inspect.signature(ehd.Hole).parameters) == [
        "angle",
        "z",
        "diameter",
        "pressure",
        "supply",
        "depth",
        "rotating",
    ]
    with pytest.raises(TypeError, match="missing 1 required keyword-only argument: 'diameter'"):
        ehd.Hole(angle=1.0)
    before = ehd.Hole.__init__
    assert hint_arguments(ehd.Hole).__init__ is before and hint_arguments(ehd.steady) is ehd.steady


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (
            lambda: ehd.ModalBush(mesh=None, material=None, dynamics=True),
            r"ModalBush\.dynamics is not supported any more; take ANCFBush",
        ),
        (lambda: ehd.JournalLeakage, r"JournalLeakage is not supported any more; give ThrustFaces\(inner_pressures"),
        (
            lambda: ehd.ThrustFaces(inner_radius=0.02, outer_radius=0.04, clearance=2e-5, feed=None),
            r"ThrustFaces.feed is not supported any more; give inner_pressures",
        ),
    ],
)
def test_what_is_gone_names_its_substitute(call, message):
    with pytest.raises(ehd.InputError, match=message):
        call()


@pytest.mark.parametrize(
    ("unit", "bounds", "value", "text"),
    [
        ("rad/s", {}, "fast", "must be a finite number in rad/s, got 'fast'."),
        ("rad/s", {}, np.inf, "must be a finite number in rad/s, got inf."),
        ("", {}, "fast", "must be a finite number, got 'fast'."),
        ("m", {"above": 0.0}, "wide", "must be a number > 0 m, got 'wide'."),
        ("m", {"above": 0.0}, -1.0, "must be > 0 m, got -1.0."),
        ("m", {"above": 0.0}, np.inf, "must be > 0 m, got inf."),
        ("m", {"at_least": 0.0, "below": 2.0}, 3.0, "must be between 0 and 2 m, got 3.0."),
    ],
)
def test_what_a_number_must_be(unit, bounds, value, text):
    with pytest.raises(InputError) as told:
        require_number("Thing.size", value, unit, **bounds)
    assert str(told.value) == f"Thing.size {text}"
