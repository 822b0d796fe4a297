"""Parts of the package that need more than the plain install."""

from __future__ import annotations

from warpsph.cli.failures import BadInput


def require_render_extra() -> None:
    """Raise BadInput with the command that installs what drawing needs, if it is not there."""
    from warpsph.rendering.extra import what_to_install

    missing = what_to_install()
    if missing:
        raise BadInput(f"drawing needs {missing}")
