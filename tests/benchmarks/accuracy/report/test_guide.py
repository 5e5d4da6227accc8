"""The guide says what the shipped tables say, and every marker is filled."""

import math
import re

import pytest

from exudyn_ehd.status import InputError
from tests.benchmarks.accuracy.report import guide
from tests.benchmarks.accuracy.table import DATA, Cost


def _marked(text, name):
    return re.search(rf"<!-- {name} -->\n\n(.*?)\n\n<!-- end -->", text, re.DOTALL).group(1)


@pytest.mark.parametrize("name", guide.BLOCKS)
def test_the_guides_say_what_the_tables_say(name):
    texts = [path.read_text(encoding="utf-8") for path in guide.READMES]
    (text,) = (text for text in texts if f"<!-- {name} -->" in text)
    assert _marked(text, name) == guide.BLOCKS[name](DATA)


@pytest.mark.slow
def test_guides_are_renewed_and_nothing_else_of_their_files(tmp_path):
    paths, picture = [tmp_path / "first.md", tmp_path / "second.md"], tmp_path / "picture.png"
    stale = [f"Before {name}.\n\n<!-- {name} -->\nstale numbers\n<!-- end -->\n\n" for name in guide.BLOCKS]
    for path, part in zip(paths, (stale[:3], stale[3:]), strict=True):
        path.write_text("# Title\n\n" + "".join(part) + "Text after.\n", encoding="utf-8")
    guide.renew(paths, DATA, picture)
    assert picture.stat().st_size > 10_000
    texts = [path.read_text(encoding="utf-8") for path in paths]
    for name, block in guide.guide_texts(DATA).items():
        assert f"Before {name}.\n\n<!-- {name} -->\n\n{block}\n\n<!-- end -->\n\n" in "".join(texts)
    for text in texts:
        assert "stale numbers" not in text and text.startswith("# Title\n\n") and text.endswith("Text after.\n")
    missing = texts[1].replace("<!-- growth -->", "")
    paths[1].write_text(missing, encoding="utf-8")
    with pytest.raises(InputError, match="must have the markers <!-- growth -->"):
        guide.renew(paths, DATA, picture)
    assert paths[1].read_text(encoding="utf-8") == missing


def test_the_machine_is_named_by_cores_and_clock_only():
    assert guide.machine_of(["a", "time per run; 2 cores at 2.6 GHz, one thread used; rest"]) == "2 cores at 2.6 GHz"
    assert guide.machine_of(["4 cores, x86_64, one thread used"]) == "4 cores"


def test_factors_read_well():
    def factor(value, spread):
        return guide._factor(
            Cost(what="", per="", base="b", factor=value, factor_low=value - spread, factor_high=value + spread)
        )

    assert factor(1.234, 0.02) == "1.23 ± 0.02"
    assert factor(62.06, 3.3) == "62 ± 3"
    assert factor(0.0194, 0.0) == "0.019 ± 0.001"
    assert guide._factor(Cost(what="", per="", failure="no film")) == "failed"
    assert guide._factor(Cost(what="", per="", factor=math.nan)) == "1"
