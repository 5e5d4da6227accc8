"""Film models, bodies and scenes for the tests of the coupling."""

import sys
from pathlib import Path

HERE = Path(__file__).parent
# scenes that tests share are plain modules beside them; importlib mode puts no test folder on the path
sys.path[:0] = [str(HERE), str(HERE / "items"), str(HERE / "record")]
