"""What drawing needs beyond the plain install, and whether it is there."""

from __future__ import annotations

from importlib.util import find_spec

MODULES = ("matplotlib", "imageio_ffmpeg")


def what_to_install() -> str | None:
    """What is missing and the command that installs it; None if nothing is."""
    missing = [module for module in MODULES if find_spec(module) is None]
    return f'{" and ".join(missing)}: pip install "warpsph[render]"' if missing else None
