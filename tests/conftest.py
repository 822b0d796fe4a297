"""Quiet Warp, the tests' own modules on the path, and no deadlines: a loaded machine is slow, not wrong."""

import sys
from pathlib import Path

import warp as wp
from hypothesis import settings

sys.path.insert(0, str(Path(__file__).parent))
wp.config.quiet = True
settings.register_profile("steady", deadline=None)
settings.load_profile("steady")
