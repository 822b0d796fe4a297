"""Parts of the package that need more than the plain install."""

from __future__ import annotations

from importlib.util import find_spec

from warpsph.cli.failures import BadInput

RENDER_MODULES = ("matplotlib", "imageio_ffmpeg")


def require_render_extra() -> None:
    """Raise BadInput with the command that installs what drawing needs, if it is not there."""
    missing = [module for module in RENDER_MODULES if find_spec(module) is None]
    if missing:
        raise BadInput(f'drawing needs {" and ".join(missing)}: pip install "warpsph[render]"')
