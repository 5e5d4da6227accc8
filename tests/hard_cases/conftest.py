"""The hard cases are plain modules next to their tests, so that one command can run them too."""

import sys
from pathlib import Path

# importlib mode puts no test folder on the path
sys.path.insert(0, str(Path(__file__).parent))
