"""Fixtures that the tests of all writers share."""

import contextlib
import resource
from collections.abc import Callable, Iterator

import pytest
from sample_frames import tank_scene

from warpsph.scene.schema import Scene


@pytest.fixture(params=[2, 3])
def scene(request: pytest.FixtureRequest) -> Scene:
    """The tank in the plane and in space."""
    return tank_scene(request.param)


@pytest.fixture
def disk_full_beyond() -> Callable[[int], contextlib.AbstractContextManager[None]]:
    """No file may grow beyond so many bytes: the system refuses the write, as on a full disk."""

    @contextlib.contextmanager
    def limit(size: int) -> Iterator[None]:
        soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, hard))
        try:
            yield
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))

    return limit
