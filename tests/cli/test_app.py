"""The command as a whole: what it offers, and how quickly it answers."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Callable

import pytest
from typer.testing import Result

from warpsph import __version__
from warpsph.scene import shipped_scenes

Command = Callable[..., Result]


def test_help_names_every_command(warpsph: Command) -> None:
    result = warpsph("--help")
    assert result.exit_code == 0
    for command in ("run", "info", "scenes", "validate", "schema", "render"):
        assert f" {command} " in result.output


def test_version(warpsph: Command) -> None:
    result = warpsph("--version")
    assert (result.exit_code, result.stdout) == (0, f"warpsph {__version__}\n")


def test_unknown_command_is_bad_input(warpsph: Command) -> None:
    assert warpsph("walk").exit_code == 2


def test_command_line_answers_without_heavy_imports() -> None:
    """Help and usage errors must not wait for Warp, SciPy, USD or Matplotlib."""
    heavy = ("warp", "scipy", "pxr", "matplotlib", "pydantic", "numpy")
    code = f"import sys, warpsph.cli.app; print([m for m in {heavy!r} if m in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_schema_is_json_schema_of_a_scene(warpsph: Command) -> None:
    schema = json.loads(warpsph("schema").stdout)
    assert schema["$schema"].startswith("https://json-schema.org/")
    assert {"spacing", "fluids", "references"} <= schema["properties"].keys()


def test_scenes_lists_every_shipped_scene(warpsph: Command) -> None:
    listed = warpsph("scenes").stdout
    assert shipped_scenes()
    for name in shipped_scenes():
        assert name in listed


@pytest.mark.parametrize("command", ["run", "info", "validate"])
def test_scene_that_is_not_there_is_named_without_traceback(warpsph: Command, command: str) -> None:
    result = warpsph(command, "no_such_scene.yaml")
    assert result.exit_code == 2
    assert "no_such_scene.yaml" in result.stderr
    assert "Traceback" not in result.stderr
