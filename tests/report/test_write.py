"""The files of a report: strict JSON, a page that needs nothing else, pictures; and a report without the extra."""

from __future__ import annotations

import base64
import json
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import fake_runs
import pytest
from typer.testing import CliRunner, Result

from warpsph.cli.app import app
from warpsph.report import write
from warpsph.report.content import scene_reports
from warpsph.report.ledger import entries_of
from warpsph.report.page import page
from warpsph.scene import scene_from_yaml
from warpsph.validation.runner import Case, CaseResult

PNG = b"\x89PNG\r\n\x1a\n"


@pytest.fixture
def scene_file(tmp_path: Path) -> Path:
    path = tmp_path / "tank.yaml"
    path.write_text(fake_runs.SCENE)
    return path


def validated(scene_file: Path, directory: Path, *options: str) -> Result:
    arguments = ["validate", str(scene_file), "--resolutions", "0.5,0.25", "--out", str(directory), *options]
    return CliRunner().invoke(app, arguments, catch_exceptions=False)


def sources(html: str) -> list[str]:
    return re.findall(r"(?:src|href)='([^']*)'", html)


def test_a_validation_leaves_record_page_and_pictures(scene_file: Path, tmp_path: Path) -> None:
    directory = tmp_path / "out"
    compare = "numerics.kernel=wendland_c2,cubic_spline"
    assert (
        validated(
            scene_file, directory, "--compare", compare, "--report", "--set", "output.usd=true"
        ).exit_code
        == 0
    )
    (scene,) = json.loads((directory / "report.json").read_text(), parse_constant=pytest.fail)["scenes"]
    assert [run["options"]["numerics.kernel"] for run in scene["runs"]] == [
        "wendland_c2",
        "wendland_c2",
        "cubic_spline",
        "cubic_spline",
    ]
    assert [len(study["points"]) for study in scene["studies"]] == [2, 2]
    assert {"device", "threads", "versions", "ledger"} <= scene["runs"][0].keys()
    html = (directory / "report.html").read_text()
    assert scene["sentence"] in html
    inline = [base64.b64decode(s.partition(",")[2]) for s in sources(html) if s.startswith("data:image/png")]
    pictures = {path.name: path.read_bytes() for path in (directory / "tank").glob("*.png")}
    assert pictures.keys() == {"particles.png", "errors_front.png", "curve_front.png"}
    assert sorted(inline) == sorted(pictures.values())
    assert all(picture.startswith(PNG) for picture in inline)


def test_the_page_fetches_nothing(scene_file: Path, tmp_path: Path) -> None:
    validated(scene_file, tmp_path / "out", "--report")
    html = (tmp_path / "out/report.html").read_text()
    assert all(source.startswith(("data:", "#")) for source in sources(html))
    assert not re.search(r"<script|<link|@import|url\(", html)


def test_without_being_asked_nothing_is_drawn(
    scene_file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(write, "write_page", pytest.fail)
    validated(scene_file, tmp_path / "out")
    assert (tmp_path / "out/report.json").is_file()


def test_without_the_extra_a_line_says_what_to_install(
    scene_file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("warpsph.rendering.extra.find_spec", lambda module: None)
    result = validated(scene_file, tmp_path / "out", "--report", "--quiet")
    assert result.exit_code == 0
    assert 'pip install "warpsph[render]"' in result.stderr
    html = (tmp_path / "out/report.html").read_text()
    assert "warpsph[render]" in html
    assert "<img" not in html
    assert not list((tmp_path / "out").rglob("*.png"))


def finished(**changes: Any) -> CaseResult:
    scene = scene_from_yaml(
        fake_runs.SCENE.replace("name: tank", "name: tank\ndescription: a < b & c"), Path()
    )
    summary: Mapping[str, Any] = fake_runs.summary() | changes
    return CaseResult(Case(scene), (), summary=summary)


def test_texts_of_a_scene_are_no_markup() -> None:
    row = {"scene": "tank", "resolution": 0.25, "steps": 1, "wall_seconds": 1.0, "threads": 1}
    rows = ({**fake_runs.REFERENCE_ROW, **row, "particles": 10, "device": "cpu", "uncertainty": 0.02},)
    result = CaseResult(finished().case, rows, summary=finished(warnings=["h > 2"]).summary)
    html = page(scene_reports([result]), {})
    assert "a &lt; b &amp; c" in html
    assert "h &gt; 2" in html
    assert "&lt;= 2 %" in html


def test_the_ledger_names_units_by_dimension() -> None:
    after = fake_runs.LEDGER | {"kinetic_energy": 5.0, "momentum": [1.0, -2.0], "energies": {"strain": 3.0}}
    before = fake_runs.LEDGER | {"energies": {"strain": 1.0}}
    entries = entries_of({"ledger": {"start": before, "end": after}})
    assert [(entry.name, entry.unit, entry.change) for entry in entries] == [
        ("mass", "kg/m", 0.0),
        ("kinetic energy", "J/m", 5.0),
        ("potential energy", "J/m", 0.0),
        ("strain energy", "J/m", 2.0),
        ("momentum x", "kg/s", 1.0),
        ("momentum y", "kg/s", -2.0),
    ]
    solid = before | {"momentum": [0.0, 0.0, 0.0]}
    assert {entry.unit for entry in entries_of({"ledger": {"start": solid, "end": None}})} == {
        "kg",
        "J",
        "kg m/s",
    }


def test_a_run_that_broke_off_has_no_end() -> None:
    entries = entries_of({"ledger": {"start": fake_runs.LEDGER, "end": None}})
    assert {entry.end for entry in entries} == {None}
    assert {entry.change for entry in entries} == {None}
