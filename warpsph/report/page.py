"""The report as one HTML file that needs nothing else: no style sheets, scripts, fonts or pictures from elsewhere."""

from __future__ import annotations

import base64
from collections.abc import Iterator, Mapping, Sequence
from html import escape
from typing import Any

from warpsph.report.content import SceneReport
from warpsph.report.html import document, table, text_list, verdict
from warpsph.report.ledger import entries_of
from warpsph.report.words import (
    machine,
    number,
    order_in_words,
    percent,
    quantity_in_words,
    quoted_error,
    wall_time,
)
from warpsph.validation.halving import halving_cost
from warpsph.validation.options import as_mapping, options_in_words, without_effect
from warpsph.validation.runner import CaseResult
from warpsph.validation.study import Study

Pictures = Mapping[str, Mapping[str, bytes]]
"""PNGs by scene and by what they show."""

_ERRORS = (
    "spacing [m]",
    "particles",
    "quantity",
    "value",
    "reference",
    "error",
    "bound",
    "holds",
    "wall time",
    "particle-steps [million]",
)
_STUDIES = ("quantity", "observed order", "half the error takes")
_LEDGER = ("total", "unit", "start", "end", "change")


def page(reports: Sequence[SceneReport], pictures: Pictures, notice: str | None = None) -> str:
    """The whole page; `notice` says what is missing and why."""
    body = "\n".join(
        [
            "<h1>Validation report</h1>",
            f"<p class='quiet'>{escape(_provenance(reports))}</p>",
            *([f"<p class='no'>{escape(notice)}</p>"] if notice else []),
            table(("scene", "how good, for how much", "bounds kept"), map(_overview, reports)),
            *(_section(report, pictures.get(report.scene.name, {})) for report in reports),
        ]
    )
    return document("Validation report", body)


def _overview(report: SceneReport) -> list[str]:
    name = escape(report.scene.name)
    return [f"<a href='#{name}'>{name}</a>", escape(report.sentence), _kept(report)]


def _kept(report: SceneReport) -> str:
    """How many bounds of all runs hold; coarse runs may have none."""
    verdicts = [row["holds"] for row in report.rows if row["holds"] is not None]
    kind = "yes" if all(result.holds for result in report.results) else "no"
    text = f"{sum(verdicts)} of {len(verdicts)}" if verdicts else "there are none"
    return f"<span class='{kind}'>{text}</span>"


def _section(report: SceneReport, pictures: Mapping[str, bytes]) -> str:
    name = escape(report.scene.name)
    return "\n".join(
        [
            f"<h2 id='{name}'>{name}</h2>",
            f"<p class='sentence'>{escape(report.sentence)}</p>",
            f"<p>{escape(report.scene.description)}</p>",
            *_compared(report),
            *(_image(title, data) for title, data in pictures.items()),
            "<h3>Errors and their cost</h3>",
            _error_table(report),
            *_study_table(report),
            *_failures(report),
            *(part for result in _with_ledger(report.results) for part in _conservation(result)),
            *_warnings(report.results),
            "<h3>References</h3>",
            text_list(_sources(report)),
        ]
    )


def _compared(report: SceneReport) -> Iterator[str]:
    """The compared options by their full keys, and what is of no use to this scene."""
    values: dict[str, dict[str, None]] = {}
    for result in report.results:
        for key, value in as_mapping(result.case.options).items():
            values.setdefault(key, {})[value] = None
    for key, found in values.items():
        yield f"<p>Compared: {escape(key)} = {escape(', '.join(found))}.</p>"
    for key in without_effect(report.rows):
        yield f"<p class='no'>{escape(key)} makes no difference here: every figure is the same.</p>"


def _image(title: str, data: bytes) -> str:
    return f"<img alt='{escape(title)}' src='data:image/png;base64,{base64.b64encode(data).decode()}'>"


def _error_table(report: SceneReport) -> str:
    compared = ("options",) if report.compares_options else ()
    rows = ([*map(escape, _options(row, bool(compared))), *_error_cells(row)] for row in report.rows)
    return table((*compared, *_ERRORS), rows)


def _options(row: Mapping[str, Any], compared: bool) -> list[str]:
    return [options_in_words(row.get("options"))] if compared else []


def _error_cells(row: Mapping[str, Any]) -> list[str]:
    steps, particles, seconds = row["steps"], row["particles"], row["wall_seconds"]
    bound = None if row.get("error_unit") else row["bound"]
    return [
        number(row["resolution"]),
        number(particles, 8),
        escape(quantity_in_words(row["quantity"])) + _remark(row),
        number(row["value"]),
        number(row["reference"]),
        escape(quoted_error(row)),
        "-" if bound is None else percent(bound),
        verdict(row["holds"]),
        "-" if seconds is None else wall_time(seconds),
        "-" if steps is None or particles is None else number(steps * particles / 1e6, 3),
    ]


def _remark(row: Mapping[str, Any]) -> str:
    """The fitted lag of a row and what is doubtful about it."""
    lag = f"after a lag of {number(row['lag'], 3)} s" if row.get("lag") else None
    told = "; ".join(filter(None, (lag, row.get("note"))))
    return f" <span class='quiet'>({escape(told)})</span>" if told else ""


def _study_table(report: SceneReport) -> list[str]:
    studies = [study for own in report.studies.values() for study in own if study.order is not None]
    if not studies:
        return []
    compared = ("options",) if report.compares_options else ()
    rows = ([*([escape(study.label)] if compared else []), *_study_cells(study)] for study in studies)
    return ["<h3>Convergence</h3>", table((*compared, *_STUDIES), rows)]


def _study_cells(study: Study) -> list[str]:
    order, halving = study.order, halving_cost(study)
    factor = "-" if halving is None else f"{number(halving.factor, 2)} times the work"
    between = "" if halving is None or halving.range is None else f" ({_range(halving.range)})"
    name = escape(quantity_in_words(study.quantity))
    return [name, "-" if order is None else order_in_words(order), factor + between]


def _range(ends: tuple[float, float]) -> str:
    return " to ".join(number(end, 2) for end in ends)


def _with_ledger(results: Sequence[CaseResult]) -> list[CaseResult]:
    """The finest finished run of each choice of options."""
    finished = {result.case.options: result for result in results if result.summary is not None}
    return list(finished.values())


def _conservation(result: CaseResult) -> Iterator[str]:
    assert result.summary is not None
    run = ", ".join([f"spacing {result.case.scene.spacing:g} m", *result.case.options])
    yield f"<h3>Conservation, {escape(run)}</h3>"
    yield table(
        _LEDGER,
        (
            [entry.name, entry.unit, *(number(value, 5) for value in (entry.start, entry.end, entry.change))]
            for entry in entries_of(result.summary)
        ),
    )


def _failures(report: SceneReport) -> Iterator[str]:
    for result in report.results:
        if result.failure:
            yield f"<p class='no'>{escape(str(result.case.directory))}: {escape(result.failure)}</p>"


def _warnings(results: Sequence[CaseResult]) -> list[str]:
    warnings = dict.fromkeys(
        f"{result.case.directory}: {warning}"
        for result in results
        for warning in (result.summary or {}).get("warnings", ())
    )
    return ["<h3>Warnings</h3>", text_list(warnings)] if warnings else []


def _sources(report: SceneReport) -> Iterator[str]:
    for name, reference in report.scene.references.items():
        uncertainty = getattr(reference, "uncertainty", 0.0)
        known = f", known within {percent(uncertainty)}" if uncertainty else ""
        yield f"{quantity_in_words(name)}: {reference.source}{known}"


def _provenance(reports: Sequence[SceneReport]) -> str:
    """Devices, threads and versions of all runs, each once."""
    summaries = [r.summary for report in reports for r in report.results if r.summary is not None]
    machines = dict.fromkeys(f"{s['device']}, {machine(s['device'], s['threads'])}" for s in summaries)
    versions = dict.fromkeys(f"{k} {v}" for s in summaries for k, v in s["versions"].items())
    return f"Computed on {'; '.join(machines) or 'nothing'}. Versions: {', '.join(versions) or 'unknown'}."
