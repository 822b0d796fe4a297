"""What goes wrong when results are written."""

import os
from pathlib import Path


class OutputError(RuntimeError):
    """A result that could not be written or continued; names the path and the reason."""

    def __init__(self, path: Path, reason: str) -> None:
        self.path = path
        self.reason = reason
        super().__init__(f"{path}: {reason}")

    def __reduce__(self) -> tuple[type["OutputError"], tuple[Path, str]]:
        """What another process makes the same error of."""
        return type(self), (self.path, self.reason)


def reason_of(error: OSError) -> str:
    """What the operating system says, without number and path."""
    return os.strerror(error.errno) if error.errno else str(error)
