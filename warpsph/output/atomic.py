"""Files that are either complete or not there, whatever kills the program."""

import contextlib
import os
from collections.abc import Iterator
from pathlib import Path

from warpsph.output.errors import OutputError, reason_of


@contextlib.contextmanager
def replacing(path: Path, *, durable: bool = False) -> Iterator[Path]:
    """A sibling of `path` to write to; it takes the place of `path` when the block ends without an error.

    After an error `path` is as it was and the sibling is gone. `durable` waits until the disk holds the file,
    so that it also survives a power cut. Raises OutputError where the operating system refuses.
    """
    partial = path.with_name(f".{path.stem}.partial{path.suffix}")
    try:
        yield partial
        if durable:
            _flush_to_disk(partial)
        os.replace(partial, path)
        if durable:
            _flush_to_disk(path.parent)
    except OSError as error:
        raise OutputError(path, f"cannot write: {reason_of(error)}") from error
    finally:
        with contextlib.suppress(OSError):
            partial.unlink()


def write_atomically(path: Path, content: bytes | memoryview, *, durable: bool = False) -> None:
    """Replace `path` by a file with this content, or leave it as it was and raise OutputError."""
    with replacing(path, durable=durable) as partial:
        partial.write_bytes(content)


def _flush_to_disk(path: Path) -> None:
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
