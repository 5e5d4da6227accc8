"""Compilations: one line for the user, the garbage collector at rest, kernels ahead by ``python -m exudyn_ehd``."""

import gc
import types

import pytest
from numba.core import event

from exudyn_ehd import __main__ as ahead_of_time
from exudyn_ehd import compilation
from exudyn_ehd.compilation import MESSAGE, Compilations
from exudyn_ehd.progress import show_progress


@pytest.fixture
def listener():
    found = Compilations()
    event.register("numba:compile", found)
    yield found
    event.unregister("numba:compile", found)


def _event(module):
    function = types.FunctionType(compile("0", "", "eval"), {"__name__": module})
    return {"dispatcher": types.SimpleNamespace(py_func=function, targetoptions={})}


def test_one_line_for_all_kernels_of_the_package(listener, capsys):
    for module in ("elsewhere", "exudyn_ehd.film.loads", "exudyn_ehd.film.loads", "exudyn_ehd_of_another"):
        with event.trigger_event("numba:compile", _event(module)):
            assert gc.isenabled() == (module != "exudyn_ehd.film.loads")
            with event.trigger_event("numba:compile", _event(module)):
                pass
            assert gc.isenabled() == (module != "exudyn_ehd.film.loads")
    assert gc.isenabled() and listener.count == 4
    # stderr is a pipe here; the package's own listener may have told its line before
    assert capsys.readouterr().err.count(MESSAGE) in (1, 2)


def test_who_wants_no_progress_gets_no_line(listener, capsys):
    show_progress(False)
    try:
        with event.trigger_event("numba:compile", _event("exudyn_ehd.film.loads")):
            pass
    finally:
        show_progress(None)
    assert listener.count == 1 and MESSAGE not in capsys.readouterr().err


def test_a_failed_compilation_wakes_the_collector(listener):
    with pytest.raises(KeyError), event.trigger_event("numba:compile", _event("exudyn_ehd.film.loads")):
        raise KeyError
    assert gc.isenabled()


def test_groups_by_name(monkeypatch, capsys):
    asked = []

    def run(group):
        asked.append(group)
        monkeypatch.setattr(compilation.COMPILATIONS, "count", compilation.COMPILATIONS.count + (group == "elrod"))

    monkeypatch.setattr(ahead_of_time, "run", run)
    ahead_of_time.main(["film", "elrod"])
    assert asked == ["film", "elrod"]
    assert capsys.readouterr().out == "film: all kernels are in the cache\nelrod: 1 kernels compiled in 0 s\n"
    for arguments in ([], ["all"]):
        asked.clear()
        ahead_of_time.main(arguments)
        assert asked == ["film", "elrod", "bush"]
    with pytest.raises(SystemExit, match=r"no group 'tracks'; give film, elrod, bush or all\."):
        ahead_of_time.main(["film", "tracks"])
