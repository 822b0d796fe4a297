"""A pass gives the same bits however its range is cut, and a failing chunk is not lost."""

import numpy as np
import pytest
import warp as wp

from warpsph.particles import launch
from warpsph.particles.launch import Launcher


@wp.kernel(module="test_launch", enable_backward=False)
def mark(offset: int, out: wp.array(dtype=wp.float32)):
    i = offset + wp.tid()
    out[i] = wp.sin(float(i)) + 1.0


def test_chunks_cover_every_index_once(monkeypatch):
    monkeypatch.setattr(launch, "WORTH_SPLITTING", 0.0)
    results = []
    for threads in (1, 2, 3):
        out = wp.zeros(1003, dtype=wp.float32, device="cpu")
        bound = Launcher("cpu", threads).bind("mark", mark, out)
        for _ in range(3 * launch.TRIAL_RUNS):
            out.zero_()
            bound.run(1003)
            assert np.all(out.numpy() != 0.0)
        results.append(out.numpy().copy())
    assert np.array_equal(results[0], results[1])
    assert np.array_equal(results[0], results[2])


def test_the_range_may_change_between_runs():
    out = wp.zeros(10, dtype=wp.float32, device="cpu")
    bound = Launcher("cpu", 2).bind("mark", mark, out)
    bound.run(4)
    assert np.count_nonzero(out.numpy()) == 4
    bound.run(10)
    assert np.count_nonzero(out.numpy()) == 10
    out.zero_()
    bound.run(0)
    assert np.count_nonzero(out.numpy()) == 0


def test_an_error_in_a_worker_reaches_the_caller():
    class Fails:
        def launch(self):
            raise RuntimeError("broken chunk")

    class Works:
        def launch(self):
            pass

    with pytest.raises(RuntimeError, match="broken chunk"):
        Launcher("cpu", 2).run_parallel([Works(), Fails(), Works()])


def test_stages_are_timed():
    launcher = Launcher("cpu", 1)
    out = wp.zeros(10, dtype=wp.float32, device="cpu")
    launcher.bind("some stage", mark, out).run(10)
    assert launcher.seconds["some stage"] > 0.0


@wp.kernel(module="test_launch_replay", enable_backward=False)
def grow(offset: int, out: wp.array(dtype=wp.float64)):
    i = offset + wp.tid()
    out[i] = wp.float64(2.0) * out[i] + wp.float64(1.0)


@pytest.mark.parametrize("rounds", [1, 2, 5, 32])
def test_a_replayed_sequence_is_the_same_as_round_by_round(rounds):
    launcher, ends = Launcher("cpu", 1), []
    for replayed in (False, True):
        out = wp.zeros(10, dtype=wp.float64, device="cpu")
        bound = launcher.bind("grow", grow, out)
        bound.run(10)
        if replayed:
            launch.Replay(launcher, "growth", lambda bound=bound: bound.run(10)).run(rounds)
        else:
            for _ in range(rounds):
                bound.run(10)
        ends.append(out.numpy().copy())
    assert np.array_equal(ends[0], ends[1])
    assert ends[0][0] == 2.0 ** (rounds + 1) - 1.0
    assert launcher.seconds["growth"] > 0.0
