"""What a run says while it goes on."""

from __future__ import annotations

import io

import pytest
from fake_runs import Clock, Sim
from rich.console import Console

from warpsph.cli.progress import BarReporter, LineReporter, Pace, Reporter, duration, reporter_for


def log_console() -> tuple[Console, io.StringIO]:
    stream = io.StringIO()
    return Console(file=stream, width=160), stream


def run_reported(reporter: Reporter, clock: Clock, *, seconds_a_step: float, steps: int = 100) -> None:
    sim = Sim()
    with reporter:
        reporter.start(sim)
        for number in range(1, steps + 1):
            clock.now += seconds_a_step
            sim.step_count, sim.time = number, sim.end_time * number / steps
            reporter.progress(sim)
        reporter.finish({})


def test_slow_run_says_a_line_at_every_tenth() -> None:
    (console, stream), clock = log_console(), Clock()
    run_reported(LineReporter(console, clock), clock, seconds_a_step=2.0)
    first, *lines = stream.getvalue().splitlines()
    assert "compiling kernels" in first
    assert len(lines) in (9, 10)
    assert "0:03:00 left" in lines[0]
    assert "0.0005 M particle-steps/s" in lines[0]
    assert "dt = 1.50e-04 s (acoustic)" in lines[0]


def test_very_slow_run_is_never_silent_for_more_than_a_minute() -> None:
    (console, stream), clock = log_console(), Clock()
    run_reported(LineReporter(console, clock), clock, seconds_a_step=30.0)
    assert len(stream.getvalue().splitlines()) == 1 + 50


def test_quick_run_says_next_to_nothing() -> None:
    (console, stream), clock = log_console(), Clock()
    run_reported(LineReporter(console, clock), clock, seconds_a_step=0.01)
    assert len(stream.getvalue().splitlines()) == 1


def test_bar_shows_time_pace_step_and_limit() -> None:
    stream, clock = io.StringIO(), Clock()
    console = Console(file=stream, force_terminal=True, width=160)
    run_reported(BarReporter(console, clock), clock, seconds_a_step=1.0)
    shown = stream.getvalue()
    for part in ("t = 2 of 2 s", "0.001 M particle-steps/s", "dt = 1.50e-04 s (acoustic)", "100%"):
        assert part in shown


def test_pace_forgets_what_lies_far_back() -> None:
    clock, sim = Clock(), Sim(particle_count=1_000_000)
    pace = Pace(clock)
    pace.restart(sim)
    for _ in range(20):  # one step a second, then ten
        clock.now, sim.step_count = clock.now + 1.0, sim.step_count + 1
        pace.in_words(sim)
    for _ in range(20):
        clock.now, sim.step_count = clock.now + 1.0, sim.step_count + 10
        words = pace.in_words(sim)
    assert words == "10 M particle-steps/s"


@pytest.mark.parametrize(("seconds", "text"), [(0.4, "0:00:00"), (61.0, "0:01:01"), (7325.0, "2:02:05")])
def test_duration(seconds: float, text: str) -> None:
    assert duration(seconds) == text


def test_reporter_fits_the_console() -> None:
    terminal, (log, stream) = Console(file=io.StringIO(), force_terminal=True), log_console()
    assert isinstance(reporter_for(terminal, quiet=False), BarReporter)
    assert isinstance(reporter_for(log, quiet=False), LineReporter)
    run_reported(reporter_for(log, quiet=True), Clock(), seconds_a_step=1.0)
    assert stream.getvalue() == ""


@pytest.mark.parametrize("kind", [LineReporter, BarReporter])
def test_warnings_are_said_at_once(kind: type[LineReporter] | type[BarReporter]) -> None:
    console, stream = log_console()
    reporter = kind(console, Clock())
    with reporter:
        reporter.warn("fluid leaked")
    assert "warning: fluid leaked" in stream.getvalue()
