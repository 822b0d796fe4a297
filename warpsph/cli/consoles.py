"""Consoles that print text as it is: brackets hold units here, not markup."""

from __future__ import annotations

from rich.console import Console

WIDTH_OF_LOGS = 160


def plain_console(*, stderr: bool = False, quiet: bool = False) -> Console:
    """A console without markup; where it is no terminal, wide enough for a table."""
    console = Console(stderr=stderr, quiet=quiet, markup=False, highlight=False, emoji=False)
    if not console.is_terminal:
        console.width = max(console.width, WIDTH_OF_LOGS)
    return console
