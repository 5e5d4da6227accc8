"""Fixtures for all tests: examples as modules, no screen."""

import importlib.util
import os
import pathlib
import sys

os.environ.setdefault("MPLBACKEND", "Agg")

import pytest

ROOT = pathlib.Path(__file__).resolve().parent.parent


def load_module(path):
    """Import a file by its path, once."""
    name = f"loaded_{path.stem}"
    if name not in sys.modules:
        spec = importlib.util.spec_from_file_location(name, path)
        module = importlib.util.module_from_spec(spec)
        sys.modules[name] = module
        spec.loader.exec_module(module)
    return sys.modules[name]


@pytest.fixture(scope="session")
def example():
    """Function that imports an example by its name."""
    return lambda name: load_module(ROOT / "examples" / f"{name}.py")
