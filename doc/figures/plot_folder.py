"""Lets the scripts here import the modules of friction-plot."""

import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[2] / "common" / "plot"))
