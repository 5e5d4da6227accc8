"""Every public name shows how it is used, in at most six lines, and what its docstring shows is true."""

import doctest
import inspect
import re
import warnings

import exudyn as exu
import matplotlib.pyplot as plt
import numpy as np
import pytest

import exudyn_ehd as ehd

# An audit tries every effect, a flexible bush takes the kernels of the solid: long to compile. Recommendations solve
# many films, rows of bores and modes too.
SLOW = {"Audit", "Finding", "CreateFlexibleBush", "FlexibleBush", "add_bore_modes", "BoreModesReport"}
SLOW |= {"Recommendation", "recommend", "StepRecommendation", "recommend_steps", "ElasticJournal", "ReplaceReducedBody"}
LINES = 6
FLAGS = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE


def before(name):
    """Names whose examples run first, in their order."""
    found = re.search(
        r"^ *After the examples? of (.*?):$", inspect.getdoc(getattr(ehd, name)), re.MULTILINE | re.DOTALL
    )
    direct = re.findall(r"`(\w+)`", found.group(1)) if found else []
    return list(dict.fromkeys(k for first in direct for k in (*before(first), first)))


def examples(name):
    """The doctest of a public name, without those of its methods."""
    return doctest.DocTestParser().get_doctest(inspect.getdoc(getattr(ehd, name)), {}, name, None, None)


@pytest.mark.parametrize("name", [pytest.param(n, marks=[pytest.mark.slow] * (n in SLOW)) for n in ehd.__all__])
def test_the_example_of_a_docstring_is_true(name, tmp_path, monkeypatch, request):
    monkeypatch.chdir(tmp_path)
    request.addfinalizer(lambda: plt.close("all"))
    own = examples(name)
    assert own.examples, f"{name} has no example"
    assert sum(len(e.source.splitlines()) for e in own.examples) <= LINES
    known = {"np": np, "exu": exu, "ehd": ehd}
    with warnings.catch_warnings():
        for test in (*map(examples, before(name)), own):
            test.globs = known
            said = []
            result = doctest.DocTestRunner(optionflags=FLAGS).run(test, out=said.append, clear_globs=False)
            assert not result.failed, "".join(said)
