"""The pages and CI agree with the project: links, paths and commands, and the generated table."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pages
import pytest
import validation_tables

ROOT = Path(__file__).parents[2]
PAGES = sorted([*ROOT.glob("*.md"), *(ROOT / "docs").glob("*.md")])

ROW = {
    "scene": "still_tank",
    "resolution": 0.02,
    "particles": 12345,
    "quantity": "pressure",
    "value": 5.0,
    "reference": 4.0,
    "error": 0.25,
    "bound": 0.01,
    "holds": False,
    "steps": 300,
    "wall_seconds": 7.25,
    "device": "cpu",
    "threads": 2,
}


def headings(page: Path) -> set[str]:
    """The anchors of a page as GitHub makes them."""
    titles = re.findall(r"^#+ (.*)$", page.read_text(), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-") for title in titles}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_lead_somewhere(page: Path) -> None:
    for target in re.findall(r"\]\((?!https?:)([^)]+)\)", page.read_text()):
        file, _, anchor = target.partition("#")
        linked = (page.parent / file).resolve() if file else page
        assert linked.exists(), f"{page.name} links to {target}"
        assert not anchor or anchor in headings(linked), f"{page.name} links to {target}"


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_files_that_a_page_names_exist(page: Path) -> None:
    named = re.findall(r"`((?:warpsph|kernels|tests|tools|docs|scenes)/[\w./]+)`", page.read_text())
    assert [name for name in named if not (ROOT / name).exists()] == []


def test_ci_ends_with_the_test_command_of_the_readme() -> None:
    (command,) = re.findall(r"^python3 -m venv .*pytest$", (ROOT / "README.md").read_text(), re.MULTILINE)
    assert (ROOT / ".ci/run").read_text().splitlines()[-1] == command


def test_every_shipped_scene_is_in_the_changelog() -> None:
    changelog = (ROOT / "CHANGELOG.md").read_text()
    assert [s.stem for s in (ROOT / "scenes").glob("*.yaml") if f"`{s.stem}`" not in changelog] == []


def test_the_table_shows_cost_and_error_and_marks_what_fails() -> None:
    line = "| `still_tank` | 0.02 | 12345 | pressure | 5 | 4 | **25 %** | 1 % | 300 | 7.25 |"
    assert line in validation_tables.table([ROW])


def test_the_table_shows_what_a_failed_run_has_not() -> None:
    missing = dict.fromkeys(
        ("value", "reference", "error", "particles", "steps", "wall_seconds", "device", "threads")
    )
    assert "| - | pressure | - | - | **-** | 1 % | - | - |" in validation_tables.table([ROW | missing])


def test_the_summary_has_a_line_a_scene_with_its_finest_resolution() -> None:
    limit = ROW | {"quantity": "kinetic_energy", "error": 0.0, "error_unit": "J", "holds": True}
    coarse = ROW | {"resolution": 0.04}
    line = "| `still_tank` | 0.02 | 12345 | **pressure 25 % (1 %)**; within limits: kinetic energy | 7.25 |"
    assert line in validation_tables.summary([coarse, ROW, limit])
    assert "0.04" not in validation_tables.summary([coarse, ROW, limit])


def test_new_rows_replace_those_of_their_scene_and_resolution() -> None:
    other = ROW | {"scene": "dam"}
    newer = ROW | {"quantity": "level"}
    assert validation_tables.merged([ROW, other], [newer]) == [other, newer]


def test_only_the_marked_block_of_a_page_is_rewritten(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    begin, end = validation_tables.BEGIN, validation_tables.END
    results = tmp_path / "results.jsonl"
    results.write_text(f"{json.dumps(ROW)}\n")
    for name in ("RECORD", "PAGE", "README"):
        file = tmp_path / name
        file.write_text("" if name == "RECORD" else f"above\n{begin}\nold\n{end}\nbelow\n")
        monkeypatch.setattr(validation_tables, name, file)
    validation_tables.main(results)
    texts = [(tmp_path / name).read_text() for name in ("PAGE", "README")]
    tables = [validation_tables.table([ROW]), validation_tables.summary([ROW])]
    assert texts == [f"above\n{begin}\n{table}\n{end}\nbelow\n" for table in tables]
    assert json.loads((tmp_path / "RECORD").read_text()) == ROW


def test_a_page_without_marks_is_refused() -> None:
    with pytest.raises(ValueError, match="validation:begin"):
        pages.between("no marks", validation_tables.BEGIN, validation_tables.END, "table", "page.md")
