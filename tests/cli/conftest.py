"""Fixtures of the command line's tests."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from fake_runs import SCENE, run_that
from typer.testing import CliRunner, Result

from warpsph.cli.app import app


@pytest.fixture
def scene_file(tmp_path: Path) -> Path:
    """A scene that runs in a moment."""
    path = tmp_path / "tank.yaml"
    path.write_text(SCENE)
    return path


@pytest.fixture
def warpsph() -> Callable[..., Result]:
    """Call `warpsph ARGUMENTS...` in this process."""

    def call(*arguments: Any) -> Result:
        return CliRunner().invoke(app, [str(argument) for argument in arguments], catch_exceptions=False)

    return call


@pytest.fixture
def ending(monkeypatch: pytest.MonkeyPatch) -> Callable[[Callable[[Path], dict[str, Any]]], None]:
    """Let every run end in a given way instead of running."""

    def replace(end: Callable[[Path], dict[str, Any]]) -> None:
        monkeypatch.setattr("warpsph.solver.run.run_scene", run_that(end))

    return replace
