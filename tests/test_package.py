"""The structure of the packages: imports point downwards, and texts hold nothing of one machine."""

from __future__ import annotations

import ast
import re
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path

import pytest

import warpsph

ROOT = Path(__file__).parents[1]

LAYERS: tuple[tuple[str, ...], ...] = (
    ("warpsph.laws", "warpsph.geometry"),
    ("warpsph.scene", "warpsph.frame"),
    ("warpsph.sampling", "warpsph.output", "warpsph.particles"),
    ("warpsph.probes",),
    ("warpsph.physics", "warpsph.comparison"),
    ("warpsph.solver", "warpsph.rendering"),
    ("warpsph.validation", "warpsph.benchmark"),
    ("warpsph.report",),
    ("warpsph.cli",),
)
"""From the bottom to the top; a module belongs to the longest name that it begins with."""

RANKS = {name: rank for rank, layer in enumerate(LAYERS) for name in layer}
TEXTS = {".py", ".md", ".toml", ".yaml", ".yml", ".csv", ".cfg", ".txt", ""}


def package_of(module: str) -> str | None:
    """The layered package of a module, None for other modules."""
    fitting = [name for name in RANKS if module == name or module.startswith(f"{name}.")]
    return max(fitting, key=len, default=None)


def imports_of(path: Path) -> Iterator[str]:
    """Names of all modules that a file imports, at its top or inside functions."""
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}: imports are absolute"
            yield from (f"{node.module}.{alias.name}" for alias in node.names)


def is_upward(module: str, imported: str) -> bool:
    """Whether an import leaves its package for another one that does not lie below."""
    own, other = package_of(module), package_of(imported)
    return bool(own and other and own != other and RANKS[other] >= RANKS[own])


def module_name(path: Path) -> str:
    return ".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__")


def host_modules() -> list[Path]:
    return [path for path in sorted((ROOT / "warpsph").rglob("*.py")) if path.parent != ROOT / "warpsph"]


def project_texts() -> list[Path]:
    folders = ("warpsph", "kernels", "scenes", "tests", "tools", "docs", ".ci")
    files = [*ROOT.glob("*"), *(path for folder in folders for path in (ROOT / folder).rglob("*"))]
    return [p for p in files if p.is_file() and p.suffix in TEXTS and "__pycache__" not in p.parts]


def test_every_module_has_a_layer() -> None:
    assert [module_name(path) for path in host_modules() if package_of(module_name(path)) is None] == []


def test_imports_point_downwards() -> None:
    upward = [
        f"{module} imports {imported}"
        for path in host_modules()
        for imported in imports_of(path)
        if is_upward(module := module_name(path), imported)
    ]
    assert upward == []


def test_device_code_imports_warp_and_itself() -> None:
    allowed = {"warp", "warpsph_kernels"} | sys.stdlib_module_names
    foreign = [
        f"{path.name} imports {imported}"
        for path in (ROOT / "kernels").rglob("*.py")
        for imported in imports_of(path)
        if imported.partition(".")[0] not in allowed
    ]
    assert foreign == []


@pytest.mark.parametrize("package", ["laws", "scene", "sampling", "probes", "output"])
def test_host_packages_know_no_device(package: str) -> None:
    imported = {name for path in (ROOT / "warpsph" / package).rglob("*.py") for name in imports_of(path)}
    assert {name for name in imported if name.partition(".")[0] in {"warp", "warpsph_kernels"}} == set()


def test_texts_name_no_place_of_one_machine() -> None:
    place = re.compile(r"(?<![\w.])/(?:home|root|tmp|work|mnt|Users)/\w")
    assert [str(path) for path in project_texts() if place.search(path.read_text(errors="ignore"))] == []


def test_files_hold_one_concept_each() -> None:
    """Beyond 400 lines a module holds a second concept."""
    modules = [*(ROOT / "warpsph").rglob("*.py"), *(ROOT / "kernels").rglob("*.py")]
    assert {str(path): n for path in modules if (n := len(path.read_text().splitlines())) > 400} == {}


def test_versions_agree() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    assert project["version"] == warpsph.__version__
    assert f"[{warpsph.__version__}]" in (ROOT / "CHANGELOG.md").read_text()
