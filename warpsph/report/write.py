"""Write a report into the directory of its runs."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from warpsph.output.atomic import write_atomically
from warpsph.output.summary import write_summary
from warpsph.rendering.extra import what_to_install
from warpsph.report.content import SceneReport
from warpsph.report.curves import charts_of
from warpsph.report.page import page

RECORD, PAGE = "report.json", "report.html"


def write_record(reports: Sequence[SceneReport], directory: Path) -> Path:
    """Write report.json and return its path. Raises OutputError."""
    path = directory / RECORD
    write_summary(path, {"scenes": [report.as_record() for report in reports]})
    return path


def write_page(reports: Sequence[SceneReport], directory: Path) -> tuple[Path, str | None]:
    """Write report.html and its pictures, from the runs below the directory.

    Returns its path, and what is missing in it where the extra `render` is not installed. Raises OutputError.
    """
    missing = what_to_install()
    notice = f"no pictures: they need {missing}" if missing else None
    pictures = {
        report.scene.name: {} if missing else dict(_pictures(report, directory)) for report in reports
    }
    path = directory / PAGE
    write_atomically(path, page(reports, pictures, notice).encode())
    return path, notice


def _pictures(report: SceneReport, directory: Path) -> Iterator[tuple[str, bytes]]:
    """Title and content of each picture of a scene, which is also written beside the runs of the scene."""
    for name, title, content in _drawn(report, directory):
        write_atomically(directory / report.scene.name / f"{name}.png", content)
        yield title, content


def _drawn(report: SceneReport, directory: Path) -> Iterator[tuple[str, str, bytes]]:
    """File name, title and content: the particles, the errors, and the curves.

    Where options are compared, each quantity has a picture of errors for itself.
    """
    from warpsph.report.pictures import chart_picture, errors_picture
    from warpsph.report.scene_picture import scene_picture
    from warpsph.report.words import quantity_in_words

    particles = scene_picture(report.results, directory)
    if particles is not None:
        yield "particles", "the particles at the end", particles
    every = [study for studies in report.studies.values() for study in studies]
    groups = report.studies if report.compares_options else {"": every}
    for quantity, studies in groups.items():
        words = f" of {quantity_in_words(quantity)}" if quantity else ""
        title = f"Errors{words} over resolution and cost"
        content = errors_picture(studies, title)
        if content is not None:
            yield "_".join(filter(None, ("errors", quantity))), title, content
    for chart in charts_of(report.results, directory):
        yield f"curve_{chart.name}", chart.title, chart_picture(chart)
