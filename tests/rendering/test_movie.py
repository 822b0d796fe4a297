"""From a run directory to pictures and a movie."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import imageio_ffmpeg
import pytest
from matplotlib.image import imread

from warpsph.rendering.errors import RenderError
from warpsph.rendering.movie import chosen_frames, render


@pytest.mark.parametrize("dimension", [2, 3])
def test_every_frame_becomes_a_picture_and_all_of_them_a_movie(
    write_run: Callable[..., Path], dimension: int
) -> None:
    run = write_run(dimension)
    steps: list[tuple[int, int]] = []
    pictures = render(run, size=(320, 180), progress=lambda done, total: steps.append((done, total)))
    assert [path.name for path in pictures.images] == [f"velocity_{index:04d}.png" for index in range(3)]
    assert all(imread(path).shape[:2] == (180, 320) for path in pictures.images)
    assert steps == [(1, 3), (2, 3), (3, 3)]
    assert pictures.movie == run / "render" / "velocity.mp4"
    count, seconds = imageio_ffmpeg.count_frames_and_secs(str(pictures.movie))
    assert count == 3
    assert seconds == pytest.approx(0.3, abs=0.05)  # real time at ten frames a second


def test_one_picture_makes_no_movie(write_run: Callable[..., Path]) -> None:
    run = write_run(2)
    pictures = render(run / "particles.usdc", field="pressure", size=(320, 180), frames="-1")
    assert [path.name for path in pictures.images] == ["pressure_0002.png"]
    assert pictures.movie is None
    assert not list(run.glob("render/*.mp4"))


def test_unknown_field_names_those_there_are(write_run: Callable[..., Path]) -> None:
    with pytest.raises(RenderError, match=r"no field 'wetness'.*velocity, density, pressure"):
        render(write_run(2), field="wetness")


@pytest.mark.parametrize("size", [(641, 360), (10, 10), (100_000, 720)])
def test_sizes_that_no_movie_can_have_are_refused(
    write_run: Callable[..., Path], size: tuple[int, int]
) -> None:
    with pytest.raises(RenderError, match="both must be even"):
        render(write_run(2), size=size)


@pytest.mark.parametrize(
    ("text", "chosen"),
    [
        (":", (0, 1, 2, 3, 4)),
        ("2", (2,)),
        ("0", (0,)),
        ("-1", (4,)),
        ("1:3", (1, 2)),
        ("::2", (0, 2, 4)),
        ("-2:", (3, 4)),
    ],
)
def test_frames_are_chosen_as_in_python(text: str, chosen: tuple[int, ...]) -> None:
    assert chosen_frames(text, 5) == chosen


@pytest.mark.parametrize("text", ["", "first", "1,2", "7", "3:3", "1:2:3:4", "-", "::0"])
def test_choice_of_no_frame_is_refused(text: str) -> None:
    with pytest.raises(RenderError, match="frames"):
        chosen_frames(text, 5)
