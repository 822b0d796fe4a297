"""`warpsph render`: what it needs and what it refuses."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from typer.testing import Result

Command = Callable[..., Result]


def test_run_is_drawn(warpsph: Command, scene_file: Path, tmp_path: Path) -> None:
    out = tmp_path / "run"
    assert warpsph("run", scene_file, "--out", out, "--quiet", "--set", "time.end=0.01").exit_code == 0
    result = warpsph("render", out, "--size", "320x180", "--field", "pressure")
    assert result.exit_code == 0
    assert "2 pictures in" in result.stdout
    assert {path.name for path in (out / "render").iterdir()} == {
        "pressure_0000.png",
        "pressure_0001.png",
        "pressure.mp4",
    }


def test_missing_extra_is_named_with_the_command_that_installs_it(
    warpsph: Command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("warpsph.rendering.extra.find_spec", lambda module: None)
    result = warpsph("render", tmp_path)
    assert result.exit_code == 2
    assert 'pip install "warpsph[render]"' in result.stderr


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ([], "particles.usdc: there is no such file"),
        (["--size", "large"], "as in 1280x720"),
        (["--fps", "0"], "0.1"),
    ],
)
def test_bad_request_is_explained(warpsph: Command, tmp_path: Path, arguments: list[str], said: str) -> None:
    result = warpsph("render", tmp_path, *arguments)
    assert result.exit_code == 2
    assert said in result.stderr
