"""Progress of a run: a bar on a terminal, occasional lines elsewhere, nothing if asked for.

A reporter has `start(sim)`, `progress(sim)` after every step, `warn(text)`, and `finish(summary)`; it is entered before
the particles are sampled.
"""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Mapping
from types import TracebackType
from typing import Any, Protocol, Self

from rich.console import Console
from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeRemainingColumn

PREPARING = "sampling particles, compiling kernels ..."
COMPILING = "compiling kernels ..."

Clock = Callable[[], float]


class StepState(Protocol):
    """A step as reported: its size [s] and the limit that rules it."""

    @property
    def dt(self) -> float: ...

    @property
    def limit(self) -> str: ...


class RunState(Protocol):
    """What a reporter reads from a simulation."""

    @property
    def time(self) -> float: ...

    @property
    def end_time(self) -> float: ...

    @property
    def step_count(self) -> int: ...

    @property
    def particle_count(self) -> int: ...

    @property
    def last_step(self) -> StepState: ...


class Reporter:
    """Says nothing; remembers how far the run has come."""

    def __init__(self) -> None:
        self.time: float | None = None

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        return None

    def start(self, sim: RunState) -> None:
        """The simulation stands; no step has been made."""

    def progress(self, sim: RunState) -> None:
        """A step has been made."""
        self.time = sim.time

    def warn(self, text: str) -> None:
        """Something looks wrong while the run goes on."""

    def finish(self, summary: Mapping[str, Any]) -> None:
        """The run is over."""


class BarReporter(Reporter):
    """A bar over simulated time, on a terminal."""

    REFRESH_SECONDS = 0.1

    def __init__(self, console: Console, clock: Clock = time.perf_counter) -> None:
        super().__init__()
        self._bar = Progress(
            TextColumn("{task.description}"),
            BarColumn(bar_width=None),
            TaskProgressColumn(),
            TimeRemainingColumn(),
            TextColumn("{task.fields[pace]}"),
            console=console,
            expand=True,
        )
        self._task = self._bar.add_task(PREPARING, total=None, pace="")
        self._pace = Pace(clock)
        self._clock = clock
        self._shown_at = -float("inf")

    def __enter__(self) -> Self:
        self._bar.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._bar.stop()

    def start(self, sim: RunState) -> None:
        """Show the bar; the first step compiles what is not in the cache."""
        self._bar.update(self._task, description=COMPILING, total=sim.end_time, completed=sim.time)
        self._pace.restart(sim)

    def progress(self, sim: RunState) -> None:
        """Refresh the bar, a few times a second at most."""
        super().progress(sim)
        if self._clock() - self._shown_at < self.REFRESH_SECONDS:
            return
        self._shown_at = self._clock()
        description = f"t = {sim.time:.4g} of {sim.end_time:.4g} s"
        pace = f"{self._pace.in_words(sim)}, {step_in_words(sim.last_step)}"
        self._bar.update(self._task, description=description, completed=sim.time, pace=pace)

    def warn(self, text: str) -> None:
        """Say it above the bar."""
        self._bar.console.print(f"warning: {text}", style="yellow", highlight=False, soft_wrap=True)

    def finish(self, summary: Mapping[str, Any]) -> None:
        """Fill the bar."""
        self._bar.update(self._task, completed=self.time, refresh=True)


class LineReporter(Reporter):
    """A line now and then, for logs: at every tenth of the run, from five seconds to a minute apart."""

    SHORTEST_SILENCE, LONGEST_SILENCE = 5.0, 60.0
    FRACTION_A_LINE = 0.1

    def __init__(self, console: Console, clock: Clock = time.perf_counter) -> None:
        super().__init__()
        self._console = console
        self._clock = clock
        self._pace = Pace(clock)
        self._said_at = self._said_fraction = self._started_fraction = 0.0
        self._started_at = 0.0

    def __enter__(self) -> Self:
        self._say(PREPARING)
        return self

    def start(self, sim: RunState) -> None:
        """Begin to measure."""
        self._pace.restart(sim)
        self._started_at = self._said_at = self._clock()
        self._started_fraction = self._said_fraction = sim.time / sim.end_time

    def progress(self, sim: RunState) -> None:
        """Say where the run stands, if it is time to."""
        super().progress(sim)
        now, fraction = self._clock(), sim.time / sim.end_time
        silence = now - self._said_at
        has_moved_on = fraction - self._said_fraction >= self.FRACTION_A_LINE
        if silence < (self.SHORTEST_SILENCE if has_moved_on else self.LONGEST_SILENCE):
            return
        self._said_at, self._said_fraction = now, fraction
        done = fraction - self._started_fraction
        left = (now - self._started_at) * (1.0 - fraction) / done if done > 0.0 else 0.0
        self._say(
            f"t = {sim.time:.4g} of {sim.end_time:.4g} s ({fraction:.0%}), {duration(left)} left, "
            f"{self._pace.in_words(sim)}, {step_in_words(sim.last_step)}"
        )

    def warn(self, text: str) -> None:
        """Say it at once."""
        self._say(f"warning: {text}")

    def _say(self, text: str) -> None:
        self._console.print(text, highlight=False, soft_wrap=True)


class Pace:
    """Particle-steps a second over the last few seconds."""

    WINDOW_SECONDS = 5.0

    def __init__(self, clock: Clock) -> None:
        self._clock = clock
        self._marks: deque[tuple[float, int]] = deque()

    def restart(self, sim: RunState) -> None:
        """Forget what was; count from now."""
        self._marks = deque([(self._clock(), sim.step_count)])

    def in_words(self, sim: RunState) -> str:
        """The pace with its unit."""
        now = self._clock()
        while len(self._marks) > 1 and now - self._marks[1][0] > self.WINDOW_SECONDS:
            self._marks.popleft()
        began, steps = self._marks[0]
        self._marks.append((now, sim.step_count))
        per_second = (sim.step_count - steps) / (now - began) if now > began else 0.0
        return rate_in_words(per_second * sim.particle_count)


def rate_in_words(particle_steps_per_second: float) -> str:
    """A pace in millions: the unit in which codes are compared."""
    return f"{particle_steps_per_second / 1e6:.3g} M particle-steps/s"


def step_in_words(step: StepState) -> str:
    """The step's size and the limit that rules it."""
    return f"dt = {step.dt:.2e} s ({step.limit})"


def duration(seconds: float) -> str:
    """Seconds as h:mm:ss."""
    minutes, whole_seconds = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02d}:{whole_seconds:02d}"


def reporter_for(console: Console, *, quiet: bool) -> Reporter:
    """The reporter that fits where the console writes to."""
    if quiet:
        return Reporter()
    return BarReporter(console) if console.is_terminal else LineReporter(console)
