"""Make records anew: ``python -m tests.recorded KIND [FIRST [LAST]]``; draw bearings: ``... draw COUNT``."""

import sys

from tests.recorded import draw, record

kind, numbers = sys.argv[1], [int(text) for text in sys.argv[2:]]
(draw.main if kind == "draw" else lambda *places: record.main(kind, *places))(*numbers)
