"""Film models and bodies for the tests of the coupling."""

import sys
from pathlib import Path

# the toy film is a plain module beside the tests; importlib mode puts no test folder on the path
sys.path.insert(0, str(Path(__file__).parent))
