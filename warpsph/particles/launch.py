"""Launches that use the whole device: recorded once, split over the cores of a CPU, timed by stage.

Warp runs a launch on its CPU device on one core, but without holding the interpreter lock. A pass therefore cuts
its range into chunks that a few threads take from a queue. A chunk's first kernel argument is its offset, and a
kernel writes only what belongs to its own index, so that the result has the same bits for any number of threads.
"""

from __future__ import annotations

import os
import threading
import time
from collections import defaultdict
from collections.abc import Callable
from itertools import pairwise
from queue import SimpleQueue
from typing import Any

import warp as wp
from warpsph_kernels.lanes import ON_CPU

WORTH_SPLITTING = 3.0e-4
"""Seconds on one thread from which handing chunks to other threads pays for itself (a hand-over costs about 0.1 ms)."""
CHUNKS_PER_THREAD = 4
TRIAL_RUNS = 5


def available_cores() -> int:
    """Return the number of cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def lanes_on(device: Any, dimension: int) -> int:
    """Neighbours that a pair loop takes at a time on a device."""
    return ON_CPU[dimension] if device.is_cpu else 1


class _Workers:
    """Threads that run recorded launches from a queue."""

    def __init__(self, count: int) -> None:
        self._tasks: SimpleQueue[Any] = SimpleQueue()
        self._finished: SimpleQueue[BaseException | None] = SimpleQueue()
        for _ in range(count):
            threading.Thread(target=self._work, daemon=True).start()

    def _work(self) -> None:
        while True:
            command = self._tasks.get()
            try:
                command.launch()
            except BaseException as error:  # handed to the caller of run(), who raises it
                self._finished.put(error)
            else:
                self._finished.put(None)

    def run(self, commands: list[Any]) -> None:
        """Run all commands, the first on the calling thread, and return when the last has ended."""
        for command in commands[1:]:
            self._tasks.put(command)
        commands[0].launch()
        errors = [self._finished.get() for _ in commands[1:]]
        for error in errors:
            if error is not None:
                raise error


class Launcher:
    """Runs kernels on one device; on a CPU with as many threads as asked for.

    Args:
        device: Warp device name such as `cpu` or `cuda:0`.
        threads: CPU threads, all available cores by default; ignored on CUDA.
    """

    def __init__(self, device: str, threads: int | None = None) -> None:
        self.device = wp.get_device(device)
        self.threads = 1 if self.device.is_cuda else (threads or available_cores())
        self.seconds: dict[str, float] = defaultdict(float)
        self.capturing = False
        self._workers = _Workers(self.threads - 1) if self.threads > 1 else None

    def bind(self, stage: str, kernel: Any, *arguments: Any) -> Pass:
        """Return the pass that launches `kernel(offset, *arguments)`; its time counts under `stage`."""
        return Pass(self, stage, kernel, arguments)

    def run_parallel(self, commands: list[Any]) -> None:
        assert self._workers is not None
        self._workers.run(commands)


class Pass:
    """A kernel with its arguments, ready to run over any number of particles.

    The first runs measure whether splitting pays: whole launches first, and if they are long enough chunks; the
    faster way stays. The shortest of a few runs decides, because another program may disturb any one of them.
    """

    def __init__(self, launcher: Launcher, stage: str, kernel: Any, arguments: tuple[Any, ...]) -> None:
        self.stage = stage
        self.kernel = kernel
        self._launcher = launcher
        self._arguments = arguments
        self._count = -1
        self._whole: Any = None
        self._chunks: list[Any] = []
        self._trial = _Trial() if launcher.threads > 1 else None
        self._split = False

    def run(self, count: int) -> None:
        """Launch over the indices 0 .. count - 1."""
        if count == 0:
            return
        if count != self._count:
            self._record(count)
        if self._launcher.capturing:
            self._whole.launch()
            return
        start = time.perf_counter()
        if self._split:
            self._launcher.run_parallel(self._chunks)
        else:
            self._whole.launch()
        elapsed = time.perf_counter() - start
        self._launcher.seconds[self.stage] += elapsed
        if self._trial:
            self._judge(self._trial, elapsed)

    def _judge(self, trial: _Trial, elapsed: float) -> None:
        verdict = trial.note(elapsed, self._split)
        if verdict is None:
            return
        self._split, ended = verdict
        if self._split and not self._chunks:
            self._chunks = self._record_chunks()
        if ended:
            self._trial = None

    def _record(self, count: int) -> None:
        self._count = count
        self._whole = self._command(0, count)
        self._chunks = self._record_chunks() if self._split else []

    def _record_chunks(self) -> list[Any]:
        pieces = min(CHUNKS_PER_THREAD * self._launcher.threads, self._count)
        edges = [self._count * k // pieces for k in range(pieces + 1)]
        return [self._command(a, b - a) for a, b in pairwise(edges)]

    def _command(self, offset: int, count: int) -> Any:
        inputs = [offset, *self._arguments]
        return wp.launch(self.kernel, dim=count, inputs=inputs, device=self._launcher.device, record_cmd=True)


class Replay:
    """A sequence of passes that is made many times, recorded as graphs of 1, 2, 4 ... rounds of it.

    A launch out of a graph costs a tenth of one by one, which is what counts where passes take microseconds. Only on a
    CPU, and every pass on one thread.

    Args:
        stage: under which the time counts, in place of those of the passes.
        sequence: makes one round; has made one before, so that nothing is left to compile.
    """

    def __init__(self, launcher: Launcher, stage: str, sequence: Callable[[], None]) -> None:
        self._launcher, self._stage, self._sequence = launcher, stage, sequence
        self._graphs: list[Any] = []

    def run(self, rounds: int) -> None:
        """Make so many rounds."""
        while len(self._graphs) < rounds.bit_length():
            self._graphs.append(self._capture(2 ** len(self._graphs)))
        start = time.perf_counter()
        for k, graph in enumerate(self._graphs):
            if rounds >> k & 1:
                wp.capture_launch(graph)
        self._launcher.seconds[self._stage] += time.perf_counter() - start

    def _capture(self, rounds: int) -> Any:
        self._launcher.capturing = True
        try:
            with wp.ScopedCapture(device=self._launcher.device) as capture:
                for _ in range(rounds):
                    self._sequence()
        finally:
            self._launcher.capturing = False
        return capture.graph


class _Trial:
    """Shortest times of a pass as a whole and in chunks."""

    def __init__(self) -> None:
        self._shortest = {False: float("inf"), True: float("inf")}
        self._runs = {False: 0, True: 0}

    def note(self, elapsed: float, split: bool) -> tuple[bool, bool] | None:
        """Note a run; return (whether to split from now on, whether that is final), or None to go on as it is."""
        self._runs[split] += 1
        self._shortest[split] = min(self._shortest[split], elapsed)
        if self._runs[split] < TRIAL_RUNS:
            return None
        if not split:
            worth = self._shortest[False] > WORTH_SPLITTING
            return worth, not worth
        return self._shortest[True] < self._shortest[False], True
