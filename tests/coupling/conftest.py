"""Film models, bodies and scenes for the tests of the coupling."""

import sys
from pathlib import Path

# scenes that tests share are plain modules next to their packages; importlib mode puts no test folder on the path
sys.path.insert(0, str(Path(__file__).parent))
