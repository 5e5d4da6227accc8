"""The guide says what the shipped tables say, and every marker is filled."""

import math
import pathlib
import re

import pytest

from exudyn_ehd.status import InputError
from tests.benchmarks.accuracy.__main__ import main
from tests.benchmarks.accuracy.report import guide
from tests.benchmarks.accuracy.table import DATA, Cost

README = pathlib.Path(__file__).parents[4] / "README.md"


def _marked(text, name):
    return re.search(rf"<!-- {name} -->\n\n(.*?)\n\n<!-- end -->", text, re.DOTALL).group(1)


@pytest.mark.parametrize("name", guide.BLOCKS)
def test_the_guide_says_what_the_tables_say(name):
    assert _marked(README.read_text(encoding="utf-8"), name) == guide.BLOCKS[name](DATA)


def test_the_guide_is_renewed_and_nothing_else_of_its_file(tmp_path):
    path = tmp_path / "guide.md"
    empty = "".join(f"Before {name}.\n\n<!-- {name} -->\nstale numbers\n<!-- end -->\n\n" for name in guide.BLOCKS)
    path.write_text("# Title\n\n" + empty + "Text after.\n", encoding="utf-8")
    main(["--guide", str(path)])
    text = path.read_text(encoding="utf-8")
    assert "stale numbers" not in text
    for name, block in guide.guide_texts(DATA).items():
        assert f"Before {name}.\n\n<!-- {name} -->\n\n{block}\n\n<!-- end -->\n\n" in text
    assert text.startswith("# Title\n\n") and text.endswith("Text after.\n")
    path.write_text(empty.replace("<!-- growth -->", ""), encoding="utf-8")
    with pytest.raises(InputError, match="must have the markers <!-- growth -->"):
        main(["--guide", str(path)])
    assert path.read_text(encoding="utf-8") == empty.replace("<!-- growth -->", "")


def test_the_picture_of_the_guide_is_renewed(tmp_path):
    path, picture = tmp_path / "guide.md", tmp_path / guide.PICTURE
    path.write_text("".join(f"<!-- {name} -->\n<!-- end -->\n" for name in guide.BLOCKS), encoding="utf-8")
    picture.parent.mkdir(parents=True)
    picture.write_bytes(b"")
    main(["--guide", str(path)])
    assert picture.stat().st_size > 10_000


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
