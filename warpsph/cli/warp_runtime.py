"""Warp, started as the command line wants it: silent unless --verbose, on a device that exists."""

from __future__ import annotations

import contextlib
import os
import sys
from collections.abc import Iterator

from warpsph.cli.failures import BadInput


def start_warp(device: str | None = None, *, verbose: bool) -> None:
    """Initialise Warp; without `verbose` it says nothing, neither now nor while it compiles.

    Raises BadInput if there is no such device.
    """
    import warp as wp

    if verbose:
        wp.init()
    else:
        wp.config.quiet = True
        wp.config.log_level = getattr(wp, "LOG_ERROR", 40)
        with _silent_stderr():
            wp.init()
    known = [str(known) for known in wp.get_devices()]
    if device is not None and device not in known:
        raise BadInput(f"--device {device}: there is no such device; there are {', '.join(known)}")


@contextlib.contextmanager
def _silent_stderr() -> Iterator[None]:
    """Native code that finds no CUDA driver writes past `sys.stderr`, to the file descriptor itself."""
    sys.stderr.flush()
    kept = os.dup(2)
    with open(os.devnull, "w") as nowhere:
        os.dup2(nowhere.fileno(), 2)
    try:
        yield
    finally:
        os.dup2(kept, 2)
        os.close(kept)
