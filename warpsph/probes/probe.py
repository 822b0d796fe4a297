"""What every probe is: something that turns the state at one time into a few numbers."""

from abc import ABC, abstractmethod
from collections.abc import Mapping

from warpsph.frame import Frame


class Probe(ABC):
    """Evaluated on a `Frame` whose sets carry the fields that the probe needs, in any particle order."""

    def __init__(self, columns: tuple[str, ...], needs: Mapping[str, tuple[str, ...]]) -> None:
        """`columns` are named `probe.quantity[unit]`, in the order of the values.

        `needs` are the fields that a frame must carry, by kind of set ("fluid", "boundary").
        """
        self.columns = columns
        self.needs = needs

    def start(self, frame: Frame) -> None:  # noqa: B027 - most probes need to know nothing of the start
        """Take what the probe must know of the initial state.

        Called once with the state at time zero before the first evaluation, also where a run is resumed.
        Raises SceneError if the probe does not fit the particles.
        """

    @abstractmethod
    def evaluate(self, frame: Frame) -> tuple[float, ...]:
        """One value a column."""
