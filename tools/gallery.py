"""Make the gallery of the shipped scenes: docs/gallery.md and its pictures.

warpsph validate --set output.usd=true --report
python tools/gallery.py out/validation

Errors and costs are those of the record docs/validation.jsonl. Pictures of particles and curves come from the report in
the directory, as far as it goes; scenes that are not in it keep theirs. Without a directory only the page and the
pictures of errors are made anew.
"""

from __future__ import annotations

import io
import json
import sys
from collections.abc import Iterable, Iterator, Mapping
from itertools import groupby
from pathlib import Path
from typing import Any

import pages
from PIL import Image

from warpsph.report.pictures import errors_picture
from warpsph.report.sentence import sentence_of
from warpsph.report.words import machine
from warpsph.scene import load_scene, shipped_scenes
from warpsph.validation.study import studies_of

ROOT = Path(__file__).resolve().parents[1]
RECORD, PAGE, PICTURES = (
    ROOT / "docs/validation.jsonl",
    ROOT / "docs/gallery.md",
    ROOT / "docs/images/gallery",
)
BEGIN, END = "<!-- gallery:begin -->", "<!-- gallery:end -->"
PARTICLES, CURVE, ERRORS = "particles", "curve", "errors"
PHOTO_SIZE, PHOTO_QUALITY, CHART_COLOURS = (720, 405), 82, 255
"""Pixels and quality of pictures of particles, and colours of charts: enough to see, little to keep."""

Row = Mapping[str, Any]


def block(rows: Iterable[Row], pictures: Path = PICTURES) -> str:
    """The generated part of the page: a table of all scenes, then each with its pictures."""
    scenes = {name: list(own) for name, own in groupby(rows, key=lambda row: row["scene"])}
    overview = ([f"[`{name}`](#{name})", sentence_of(own), _device(own)] for name, own in scenes.items())
    sections = (line for name, own in scenes.items() for line in _section(name, own, pictures))
    return "\n".join([*pages.table(("scene", "how good, for how much", "device"), overview), *sections])


def take(report: Path, pictures: Path = PICTURES) -> None:
    """Keep the particles and the first curve of every scene in the directory of a report."""
    for scene in json.loads((report / "report.json").read_text(encoding="utf-8"))["scenes"]:
        name, spacing = scene["scene"], min(run["resolution"] for run in scene["runs"])
        source, target = report / name, pictures / name
        target.mkdir(parents=True, exist_ok=True)
        if (source / "particles.png").is_file():
            _replace(target, PARTICLES, f"{PARTICLES}_{spacing:g}.jpg", _photo(source / "particles.png"))
        curves = sorted(source.glob("curve_*.png"), key=lambda path: _place(path, scene))
        if curves:
            _replace(target, CURVE, f"{CURVE}.png", _chart(curves[0].read_bytes()))


def draw_errors(rows: Iterable[Row], pictures: Path = PICTURES) -> None:
    """Draw errors against cost of every scene with more than one resolution."""
    for name, own in groupby(rows, key=lambda row: row["scene"]):
        picture = errors_picture(studies_of(own), "Errors over resolution and cost")
        if picture is not None:
            (pictures / name).mkdir(parents=True, exist_ok=True)
            _replace(pictures / name, ERRORS, f"{ERRORS}.png", _chart(picture))


def _section(name: str, rows: list[Row], pictures: Path) -> Iterator[str]:
    yield from ("", f"## {name}", "", _description(name), "", f"*{sentence_of(rows)}*")
    for kind in (PARTICLES, CURVE, ERRORS):
        for path in sorted((pictures / name).glob(f"{kind}*")):
            yield from ("", f"![{name}](images/gallery/{name}/{path.name})", "", _caption(path))


def _caption(path: Path) -> str:
    kind, _, spacing = path.stem.partition("_")
    match kind:
        case "particles":
            return f"The end of a run at spacing {spacing} m."
        case "curve":
            return "Runs over their reference."
        case _:
            return "Errors of the record."


def _description(name: str) -> str:
    path = shipped_scenes().get(name)
    return load_scene(path).description if path else ""


def _device(rows: Iterable[Row]) -> str:
    found = dict.fromkeys((row["device"], row["threads"]) for row in rows if row["device"])
    return "; ".join(f"{device}, {machine(device, threads)}" for device, threads in found)


def _place(picture: Path, scene: Mapping[str, Any]) -> int:
    """Place of the quantity of a curve among the references of its scene."""
    quantities = [row["quantity"] for row in scene["comparisons"]]
    return quantities.index(picture.stem.removeprefix("curve_"))


def _replace(folder: Path, kind: str, name: str, content: bytes) -> None:
    for old in folder.glob(f"{kind}*"):
        old.unlink()
    (folder / name).write_bytes(content)


def _photo(path: Path) -> bytes:
    buffer = io.BytesIO()
    with Image.open(path) as picture:
        small = picture.convert("RGB").resize(PHOTO_SIZE, Image.Resampling.LANCZOS)
        small.save(buffer, "JPEG", quality=PHOTO_QUALITY, optimize=True)
    return buffer.getvalue()


def _chart(content: bytes) -> bytes:
    buffer = io.BytesIO()
    with Image.open(io.BytesIO(content)) as picture:
        few = picture.convert("RGB").quantize(CHART_COLOURS, dither=Image.Dither.NONE)
        few.save(buffer, "PNG", optimize=True)
    return buffer.getvalue()


def main(report: Path | None) -> None:
    """Take the pictures of a report and write the page anew."""
    rows = pages.read_rows(RECORD)
    if report is not None:
        take(report)
    draw_errors(rows)
    pages.rewrite(PAGE, BEGIN, END, block(rows))


if __name__ == "__main__":
    if len(sys.argv) > 2:
        sys.exit(__doc__)
    main(Path(sys.argv[1]) if len(sys.argv) == 2 else None)
