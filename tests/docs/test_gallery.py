"""The gallery: made from the record of validations and from the pictures of a report."""

from __future__ import annotations

import json
from pathlib import Path

import gallery
from PIL import Image
from report_rows import row


def report(directory: Path, *names: str) -> Path:
    """A report of one scene with pictures of these names."""
    comparisons = [{"quantity": "second"}, {"quantity": "first"}]
    scene = {"scene": "tank", "runs": [{"resolution": 0.2}, {"resolution": 0.1}], "comparisons": comparisons}
    (directory / "tank").mkdir(parents=True, exist_ok=True)
    (directory / "report.json").write_text(json.dumps({"scenes": [scene]}))
    for name in names:
        Image.new("RGB", (960, 540), "white").save(directory / "tank" / f"{name}.png")
    return directory


def test_particles_and_the_curve_of_the_first_reference_are_taken(tmp_path: Path) -> None:
    pictures = tmp_path / "pictures"
    gallery.take(report(tmp_path / "out", "particles", "curve_first", "curve_second", "errors"), pictures)
    assert {path.name for path in (pictures / "tank").iterdir()} == {"particles_0.1.jpg", "curve.png"}


def test_what_a_report_lacks_is_kept(tmp_path: Path) -> None:
    pictures = tmp_path / "pictures"
    gallery.take(report(tmp_path / "first", "particles", "curve_first"), pictures)
    gallery.take(report(tmp_path / "second"), pictures)
    assert len(list((pictures / "tank").iterdir())) == 2


def test_the_page_states_error_cost_and_device_and_shows_the_pictures(tmp_path: Path) -> None:
    rows = [row(0.2, 0.052, 5.0), row(0.1, 0.013, 40.0)]
    gallery.draw_errors(rows, tmp_path)
    text = gallery.block(rows, tmp_path)
    told = "Front within 1.3 % for 40 s on one thread; halving the error takes 2.8 times the work."
    assert f"| [`tank`](#tank) | {told} | cpu, one thread |" in text
    assert "![tank](images/gallery/tank/errors.png)" in text
    assert "curve" not in text


def test_one_resolution_has_no_picture_of_errors(tmp_path: Path) -> None:
    gallery.draw_errors([row(0.1, 0.01)], tmp_path)
    assert not list(tmp_path.iterdir())
