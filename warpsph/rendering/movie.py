"""From a run to pictures: a PNG a frame and one MP4."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import imageio_ffmpeg
import numpy as np
from matplotlib import image

from warpsph.output.errors import OutputError, reason_of
from warpsph.rendering.cache import ParticleCache
from warpsph.rendering.colour import scale_of
from warpsph.rendering.errors import RenderError
from warpsph.rendering.extent import extent_of
from warpsph.rendering.pathlines import PATH_FILE, Pathline, read_pathlines
from warpsph.rendering.plane import PlaneView
from warpsph.rendering.space import SpaceView

SMALLEST, LARGEST = 64, 8192
SLOWEST, FASTEST = 1.0, 60.0
"""Frames a second of a movie when none are asked for."""


@dataclass(frozen=True)
class Pictures:
    """The files that were made."""

    images: tuple[Path, ...]
    movie: Path | None


def render(
    source: Path,
    *,
    field: str = "velocity",
    size: tuple[int, int] = (1280, 720),
    frames: str = ":",
    fps: float | None = None,
    streamlines: bool = False,
    paths: bool = False,
    progress: Callable[[int, int], None] = lambda done, total: None,
) -> Pictures:
    """Draw frames of a run directory or USD file into a directory `render` beside the USD file.

    Args:
        field: to colour by; a vector field by its magnitude.
        size: width and height in pixels, both even.
        frames: which to draw, as a Python slice such as `10:50:2`, or one number; negative ones count from the
            end. One picture alone makes no movie.
        fps: frames a second of the movie; by default real time, 60 at most.
        streamlines: draw those of the fluid at each moment; in two dimensions.
        paths: draw the paths of particles that the run has recorded, up to the time of each picture.
        progress: called with the number of pictures made and the total.

    Raises:
        RenderError: if the request cannot be met.
        OutputError: if a picture cannot be written.
    """
    _check_size(size)
    cache = ParticleCache(source)
    if field not in cache.fields:
        raise RenderError(f"there is no field {field!r} in {cache.path}; there are {', '.join(cache.fields)}")
    if streamlines and not cache.is_plane:
        raise RenderError(f"streamlines are drawn in two dimensions, and {cache.path} has three")
    indices = chosen_frames(frames, len(cache.codes))
    directory = cache.path.parent / "render"
    files = tuple(directory / f"{field}_{index:04d}.png" for index in indices)
    movie = directory / f"{field}.mp4" if len(indices) > 1 else None
    lines = read_pathlines(cache.path.parent / PATH_FILE) if paths else ()
    drawn = _drawn(cache, field, size, indices, streamlines, lines)
    try:
        directory.mkdir(exist_ok=True)
        with _movie_writer(movie, size, fps or _real_time_rate(cache, indices)) as append:
            for count, (path, picture) in enumerate(zip(files, drawn, strict=True), start=1):
                image.imsave(path, picture)
                append(picture)
                progress(count, len(files))
    except OSError as error:
        raise OutputError(directory, f"cannot write: {reason_of(error)}") from error
    return Pictures(files, movie)


def chosen_frames(text: str, count: int) -> tuple[int, ...]:
    """Indices of `count` frames that a slice or a number chooses. Raises RenderError if it chooses none."""
    chosen: tuple[int, ...]
    try:
        parts = [int(part) if part.strip() else None for part in text.split(":")]
        chosen = tuple(range(count)[slice(*parts)]) if len(parts) > 1 else (range(count)[int(text)],)
    except (ValueError, TypeError):
        raise RenderError(f"frames {text!r}: give one number or a slice such as 10:50 or ::5") from None
    except IndexError:
        chosen = ()
    if not chosen:
        raise RenderError(f"frames {text!r}: none of the {count} frames, numbered from 0 to {count - 1}")
    return chosen


def _check_size(size: tuple[int, int]) -> None:
    if any(length % 2 or not SMALLEST <= length <= LARGEST for length in size):
        width, height = size
        raise RenderError(f"size {width}x{height}: both must be even, from {SMALLEST} to {LARGEST} pixels")


def _drawn(
    cache: ParticleCache,
    field: str,
    size: tuple[int, int],
    indices: Sequence[int],
    streamlines: bool,
    pathlines: Sequence[Pathline],
) -> Iterator[np.ndarray]:
    scale, extent = scale_of(cache, field), extent_of(cache, field)
    view: PlaneView | SpaceView
    if cache.is_plane:
        view = PlaneView(scale, extent, size, streamlines=streamlines, pathlines=pathlines)
    else:
        view = SpaceView(scale, extent, size, cache.up_axis, pathlines=pathlines)
    for index in indices:
        yield view.draw(cache.frame(index, field, velocities=streamlines))


def _real_time_rate(cache: ParticleCache, indices: Sequence[int]) -> float:
    codes = cache.codes[indices[-1]] - cache.codes[indices[0]]
    rate = cache.frame_rate * (len(indices) - 1) / abs(codes) if codes else cache.frame_rate
    return float(np.clip(rate, SLOWEST, FASTEST))


@contextlib.contextmanager
def _movie_writer(
    path: Path | None, size: tuple[int, int], fps: float
) -> Iterator[Callable[[np.ndarray], None]]:
    """Something to append pictures to: H.264 that every player shows."""
    if path is None:
        yield lambda picture: None
        return
    writer = imageio_ffmpeg.write_frames(
        str(path), size, fps=fps, codec="libx264", quality=8, macro_block_size=2, ffmpeg_log_level="error"
    )
    writer.send(None)
    try:
        yield lambda picture: writer.send(np.ascontiguousarray(picture))
    finally:
        writer.close()
