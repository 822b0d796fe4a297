"""The times on which a run lands: frames, probe samples and checkpoints."""

from __future__ import annotations

import math
from dataclasses import dataclass

from warpsph.scene.schema import Scene

CHECKPOINTS_A_RUN = 10
SAME_TIME = 1e-9
"""Two times closer than this part of the shorter interval are one."""


@dataclass(frozen=True)
class Stop:
    """A time [s] on which a step lands exactly; `frame` is the number of the frame to write, if any."""

    time: float
    frame: int | None
    probes: bool
    checkpoint: bool


def frame_times(scene: Scene) -> list[float]:
    """Return the times of all frames [s], the start and the end included."""
    return _regular_times(scene.time.frame_rate, scene.time.end)


def schedule(scene: Scene) -> list[Stop]:
    """Return all stops of a scene in order, the first at time zero."""
    frames = frame_times(scene)
    samples = _regular_times(scene.output.probe_rate or scene.time.frame_rate, scene.time.end)
    every = scene.output.checkpoint_every or math.ceil(len(frames) / CHECKPOINTS_A_RUN)
    shortest = min(1.0 / scene.time.frame_rate, 1.0 / (scene.output.probe_rate or scene.time.frame_rate))
    tick = SAME_TIME * shortest
    numbers = {round(time / tick): number for number, time in enumerate(frames)}
    times = {round(time / tick): time for time in (*samples, *frames)}
    sampled = {round(time / tick) for time in samples}
    last = len(frames) - 1
    return [
        Stop(
            time=times[key],
            frame=numbers.get(key),
            probes=key in sampled,
            checkpoint=key in numbers and (numbers[key] == last or numbers[key] % every == 0),
        )
        for key in sorted(times)
    ]


def _regular_times(rate: float, end: float) -> list[float]:
    times = [k / rate for k in range(math.floor(end * rate * (1.0 + SAME_TIME)) + 1)]
    if end - times[-1] > SAME_TIME / rate:
        times.append(end)
    return times
