"""The first use says that it compiles, and only then."""

import time

from exudyn_ehd.joint.model.compile import MESSAGE, announced


def test_slow_blocks_are_announced(capsys):
    with announced(patience=0.01):
        time.sleep(0.2)
    assert capsys.readouterr().err.strip() == MESSAGE


def test_quick_blocks_are_silent(capsys):
    with announced(patience=30.0):
        pass
    assert capsys.readouterr().err == ""
