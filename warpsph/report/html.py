"""Pieces of a page of HTML that needs nothing else."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape

STYLE = """
body { font: 15px/1.5 system-ui, sans-serif; color: #2b2f36; max-width: 1100px; margin: 2em auto; padding: 0 1em; }
h1, h2, h3 { font-weight: 600; line-height: 1.2; }
h2 { margin-top: 2.5em; border-top: 1px solid #b9bec6; padding-top: 1em; }
h3 { margin: 1.6em 0 0.4em; font-size: 1em; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; font-size: 13px; font-variant-numeric: tabular-nums; }
th, td { text-align: left; padding: 0.25em 1.2em 0.25em 0; vertical-align: top; border-bottom: 1px solid #e6e8eb; }
th { font-weight: 600; border-bottom-color: #b9bec6; }
img { max-width: 100%; height: auto; display: block; margin: 0.8em 0; }
.sentence { font-size: 1.1em; }
.no { color: #b3261e; font-weight: 600; }
.yes { color: #1b7f4b; }
.quiet { color: #5f6670; }
"""

_VERDICTS = {True: ("yes", "yes"), False: ("no", "NO"), None: ("quiet", "-")}


def document(title: str, body: str) -> str:
    """The whole page around its body."""
    head = f"<meta charset='utf-8'><title>{escape(title)}</title><style>{STYLE}</style>"
    return f"<!DOCTYPE html>\n<html lang='en'><head>{head}</head>\n<body>\n{body}\n</body></html>\n"


def verdict(holds: bool | None) -> str:
    """Whether a bound holds, a dash where there is none."""
    kind, word = _VERDICTS[holds]
    return f"<span class='{kind}'>{word}</span>"


def text_list(items: Iterable[str]) -> str:
    """A list of plain texts."""
    return f"<ul>{''.join(f'<li>{escape(item)}</li>' for item in items)}</ul>"


def table(header: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A table of cells that are HTML already."""
    head = "".join(f"<th>{escape(cell)}</th>" for cell in header)
    body = "\n".join(f"<tr>{''.join(f'<td>{cell}</td>' for cell in row)}</tr>" for row in rows)
    return f"<div class='scroll'><table><thead><tr>{head}</tr></thead>\n<tbody>{body}</tbody></table></div>"
