"""Every hard case, one test each; the physics is asserted where the case is told, the counts here."""

import hard_registry
import pytest

CASES = hard_registry.load_cases()


@pytest.mark.parametrize(
    "case", [pytest.param(case, id=case.name, marks=pytest.mark.slow if case.slow else ()) for case in CASES]
)
def test_hard_case(case):
    outcome = hard_registry.perform(case)
    print(f"{outcome.rejected} rejected, {outcome.newton:.2f} iterations a step, {1e6 * outcome.minimum_gap:.4g} um")


def test_the_set_is_whole():
    assert len(CASES) >= 40
    assert all(len(case.story) > 40 for case in CASES)
