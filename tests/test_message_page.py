"""`exudyn_ehd/MESSAGES.md` is what `tests/message_page.py` makes: each of its lines of code raises its message."""

import itertools
import re

import pytest

from tests import message_page

# Messages that no example raises. A new message needs an example in `tests/message_examples.py`; the number only falls.
MOST_WITHOUT_EXAMPLE = 7


# Words of examples that take long (meshes, runs, audits, searches for positions) or go on from the state of others.
LONG = ("Bush(", "Elastic", "SolveDynamic", "audit", "axial_load", "equilibrium(", "fem", "force = np", "housing")
LONG += ("mesh", "state()")


def test_quick_code_of_the_page_raises_its_messages(tmp_path, monkeypatch):
    """More than half of the examples, each with its message in one line of the page."""
    monkeypatch.chdir(tmp_path)
    lines, count = message_page.PAGE.read_text(encoding="utf-8").splitlines(), 0
    for group in message_page.GROUPS:
        for code in message_page.examples(group):
            if any(word in code for word in LONG):
                continue
            told, cell = message_page.raised(code, group.setup), message_page.shown_code(code)
            assert told is not None and told.sites, code
            expected = f"| **{told.kind}** {message_page.escaped(told.text)} | {cell} |"
            assert any(message_page.is_same(line, expected) for line in lines if line.endswith(f"{cell} |")), expected
            count += 1
    assert count > 252


@pytest.mark.slow
def test_code_of_the_page_raises_its_messages():
    """All in one test: examples take seconds, and parallel workers share no results."""
    # which reads the mesh files of some examples
    pytest.importorskip("meshio")
    silent, missing = message_page.silent(), message_page.without_example()
    assert not silent, "these examples tell nothing:\n\n" + "\n\n".join(silent)
    lines = [f"{site.path}:{site.first} {site.text}" for site in missing]
    assert len(missing) <= MOST_WITHOUT_EXAMPLE, "messages without an example:\n" + "\n".join(lines)
    stored, made = message_page.PAGE.read_text(encoding="utf-8").splitlines(), message_page.page().splitlines()
    pairs = itertools.zip_longest(stored, made, fillvalue="")
    changed = [f"- {old}\n+ {new}" for old, new in pairs if not message_page.is_same(old, new)]
    assert not changed, f"renew it: {message_page.COMMAND}\n" + "\n".join(changed[:20])


def test_examples_are_short_and_different():
    codes = [(group.setup, code) for group in message_page.GROUPS for code in message_page.examples(group)]
    assert len(set(codes)) == len(codes)
    for _, code in codes:
        assert len(code.splitlines()) <= 3, code
        compile(code, "example", "exec")


@pytest.mark.parametrize(
    ("line", "other", "same"),
    [
        ("got 0.02 m", "got 0.02 m", True),
        ("peak 1.681e+04 MPa", "peak 1.682e+04 MPa", True),
        ("peak 1.681e+04 MPa", "peak 1.9e+04 MPa", False),
        ("tilt = (2e-14, 0)", "tilt = (-3e-15, 0)", True),
        ("got 1 m", "got 1 2 m", False),
        ("got 1 m", "has 1 m", False),
    ],
)
def test_lines_may_differ_by_round_off(line, other, same):
    assert message_page.is_same(line, other) == same


def test_sites_are_found():
    """Errors that are raised or returned, warnings and the log, each where its words stand."""
    texts = {(site.path, site.text) for site in message_page.sites()}
    for path, text in (
        ("film/lubricant/lubricant.py", "Lubricant.at needs a temperature_law, which says how the viscosity changes"),
        ("status.py", "... must be True or False, got ...."),
        (
            "coupling/record/rows.py",
            "CreateLubricatedJoint.record: '...' holds something else than a record and is ",
        ),
        ("coupling/element/failures.py", "LubricatedJoint '...': the modes of its ... have no mass, which explicit "),
        ("coupling/api.py", "....bodyNumbers is now called itemNumbers."),
    ):
        assert any(place == path and said.startswith(text) for place, said in texts), text
    assert any(site.path == "coupling/element/accepted_steps.py" for site in message_page.sites())


def test_the_page_is_packaged():
    project = (message_page.PACKAGE.parent / "pyproject.toml").read_text(encoding="utf-8")
    (data,) = re.findall(r"^exudyn_ehd = \[(.*)\]$", project, re.MULTILINE)
    assert f'"{message_page.PAGE.name}"' in data
