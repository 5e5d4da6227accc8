"""Rules of the package's structure that no other tool checks."""

import ast
import dataclasses
import importlib
import inspect
import pathlib
import pkgutil
import subprocess
import sys

import pytest

import exudyn_ehd

ROOT = pathlib.Path(__file__).resolve().parent.parent
PACKAGE = ROOT / "exudyn_ehd"
MODULES = [m.name for m in pkgutil.walk_packages(exudyn_ehd.__path__, "exudyn_ehd.")]


def _sources():
    return sorted(PACKAGE.rglob("*.py"))


def test_only_coupling_and_studies_import_exudyn():
    for path in _sources():
        if path.is_relative_to(PACKAGE / "coupling") or path.is_relative_to(PACKAGE / "studies"):
            continue
        for node in ast.walk(ast.parse(path.read_text())):
            names = []
            if isinstance(node, ast.Import):
                names = [a.name for a in node.names]
            elif isinstance(node, ast.ImportFrom):
                names = [node.module or ""]
            assert not any(n.split(".")[0] == "exudyn" for n in names), path


def test_film_studies_do_not_load_exudyn():
    """`steady` and its like run without Exudyn being imported."""
    code = (
        "import sys, exudyn_ehd as ehd;"
        "b = ehd.JournalBearing(journal_radius=.01, length=.02, radial_clearance=2e-5, lubricant=ehd.Lubricant(viscosity=.04));"
        "ehd.steady(b, speed=100., eccentricity_ratio=.5);"
        "assert 'exudyn' not in sys.modules"
    )
    subprocess.run([sys.executable, "-c", code], check=True, cwd=ROOT)


@pytest.mark.parametrize("name", MODULES)
def test_every_module_and_public_object_has_a_docstring(name):
    module = importlib.import_module(name)
    assert module.__doc__, name
    for label, item in vars(module).items():
        if label.startswith("_") or getattr(item, "__module__", None) != name:
            continue
        if inspect.isclass(item) or inspect.isfunction(item) or hasattr(item, "py_func"):
            doc = getattr(item, "py_func", item).__doc__
            assert doc, f"{name}.{label}"


def test_public_names_exist_and_are_sorted():
    assert list(exudyn_ehd.__all__) == sorted(exudyn_ehd.__all__)
    for name in exudyn_ehd.__all__:
        assert getattr(exudyn_ehd, name) is not None


@pytest.mark.parametrize("name", exudyn_ehd.__all__)
def test_docstrings_name_every_parameter(name):
    """Every argument of a public call and every field of a public description stands in its docstring."""
    item = getattr(exudyn_ehd, name)
    if dataclasses.is_dataclass(item):
        names = [f.name for f in dataclasses.fields(item)]
    elif inspect.isfunction(item):
        names = list(inspect.signature(item).parameters)
    else:
        return
    for argument in names:
        assert argument in item.__doc__, f"{name}: {argument} is not documented"


def test_options_are_frozen_and_keyword_only():
    for name in exudyn_ehd.__all__:
        item = getattr(exudyn_ehd, name)
        if dataclasses.is_dataclass(item) and not name.endswith("Result"):
            assert item.__dataclass_params__.frozen, name
            assert all(f.kw_only for f in dataclasses.fields(item)), name
