"""What all writers of a run have in common."""

from abc import ABC, abstractmethod


class Writer(ABC):
    """A file that grows with a run: opened once, written to often by its `write`, closed at the end."""

    @abstractmethod
    def open(self, resume_time: float | None = None) -> None:
        """Start anew, deleting an older file; or continue it after `resume_time` [s], the checkpoint's.

        Raises OutputError if the file cannot be written, or the older one cannot be continued.
        """

    @abstractmethod
    def close(self) -> None:
        """Finish the file; after an error too, so that what was written stays readable."""
