"""Makes the scenes of this folder available as fixtures."""

import importlib.util
import pathlib

import pytest


@pytest.fixture(scope="session")
def planar_rotor():
    """The class `PlanarRotor` of planar.py."""
    path = pathlib.Path(__file__).with_name("planar.py")
    spec = importlib.util.spec_from_file_location("planar_rotor_scene", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.PlanarRotor
