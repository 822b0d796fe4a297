"""Several runs of a validation at once, each in a process of its own."""

from __future__ import annotations

import multiprocessing
import os
import threading
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor

from warpsph.validation.runner import Case, CaseResult

RunCase = Callable[[Case], CaseResult]


def side_by_side(
    cases: Sequence[Case], run: RunCase, jobs: int, begin: Callable[[], None]
) -> Iterator[CaseResult]:
    """Yield the results of all cases in their order, `jobs` of which run at the same time.

    `run` and `begin`, which every process calls first, have to be picklable.
    """
    # Not forked: Warp and its threads do not survive that.
    context = multiprocessing.get_context("spawn")
    pool = ProcessPoolExecutor(jobs, mp_context=context, initializer=_begin, initargs=(begin,))
    try:
        yield from (future.result() for future in [pool.submit(run, case) for case in cases])
    finally:
        pool.shutdown(wait=True, cancel_futures=True)


def _begin(begin: Callable[[], None]) -> None:
    threading.Thread(target=_end_with_parent, daemon=True).start()
    begin()


def _end_with_parent() -> None:
    """End this process with the one that started it: killed, that could not tell, and runs would go on for hours."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)
