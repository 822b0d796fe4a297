"""The table of hard cases follows its record."""

from __future__ import annotations

import hard_cases
import pages

from warpsph.validation.hard.suite import HARD_CASES


def row(case: str, holds: bool = True) -> dict[str, object]:
    return {
        "case": case,
        "about": f"What {case} does.",
        "seconds": 2.0,
        "device": "cpu",
        "threads": 1,
        "figure": "leaks",
        "value": 0.0,
        "bound": 0.0,
        "unit": "1",
        "at_least": False,
        "holds": holds,
        "failure": None,
    }


def test_new_rows_replace_those_of_the_same_case_in_the_order_of_the_suite():
    old, new = [row("b"), row("gone"), row("a")], [row("b", holds=False)]
    assert hard_cases.merged(old, new, ["a", "b"]) == [row("a"), row("b", holds=False)]


def test_what_fails_is_named_first():
    text = hard_cases.block([row("falls_over", holds=False), row("stands")])
    assert text.startswith("1 of 2 cases keep their bounds; these do not: falls over.")
    assert "| falls over | leaks | 0 | at most 0 | **NO** | 2 |" in text


def test_the_page_has_every_case_and_follows_the_record():
    rows = pages.read_rows(hard_cases.RECORD)
    assert list(dict.fromkeys(r["case"] for r in rows)) == [case.name for case in HARD_CASES]
    text = hard_cases.PAGE.read_text()
    assert pages.between(text, hard_cases.BEGIN, hard_cases.END, hard_cases.block(rows), "page") == text
