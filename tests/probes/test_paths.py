"""Paths are where the particles nearest to the seeds have been."""

import numpy as np
from particles import fluid, frame_of, lattice

from warpsph.probes.paths import PathRecorder
from warpsph.scene.recordings import Paths

START = lattice([0.0, 0.0], [1.0, 1.0])


def frame_at(time: float, order: np.ndarray | None = None, ids: np.ndarray | None = None):
    """Water that moves along x at 1 m/s, its particles in any order."""
    ids = np.arange(len(START)) if ids is None else ids
    order = np.arange(len(ids)) if order is None else order
    frame = frame_of(fluid(START[ids[order]] + [time, 0.0], id=ids[order]))
    object.__setattr__(frame, "time", time)
    return frame


def test_the_nearest_particle_is_followed_through_every_order():
    recorder = PathRecorder(Paths(seeds=((0.33, 0.36), (0.95, 0.95)), at=0.05))
    random = np.random.default_rng(1)
    for k in range(5):
        recorder.note(frame_at(0.1 * k, random.permutation(len(START))))
    np.testing.assert_allclose(recorder.times, [0.1, 0.2, 0.3, 0.4])
    chosen = START[recorder.ids] + [0.1, 0.0]
    np.testing.assert_allclose(chosen, [[0.35, 0.35], [0.95, 0.95]])
    expected = START[recorder.ids] + recorder.times[:, None, None] * [1.0, 0.0]
    np.testing.assert_allclose(recorder.positions, expected)


def test_particles_that_leave_have_no_place_from_then_on():
    recorder = PathRecorder(Paths(seeds=((0.05, 0.05),)))
    recorder.note(frame_at(0.0))
    recorder.note(frame_at(0.1, ids=np.arange(1, 100)))
    assert recorder.ids[0] == 0
    assert np.isnan(recorder.positions[1]).all()
    assert np.isfinite(recorder.positions[0]).all()


def test_a_seed_that_chooses_again_follows_one_more_particle_each_time():
    """The flow passes a spacing in 0.1 s: a seed that chooses every 0.2 s takes each second particle of a row."""
    recorder = PathRecorder(Paths(seeds=((0.75, 0.55),), every=0.2))
    for k in range(6):
        recorder.note(frame_at(0.1 * k))
    np.testing.assert_allclose(START[recorder.ids], [[0.75, 0.55], [0.55, 0.55], [0.35, 0.55]])
    assert np.isnan(recorder.positions[:2, 1]).all()
    assert np.isfinite(recorder.positions[2:, 1]).all()


def test_paths_go_on_from_what_was_saved():
    spec = Paths(seeds=((0.75, 0.55),), every=0.2)
    whole, first, second = (PathRecorder(spec) for _ in range(3))
    frames = [frame_at(0.1 * k) for k in range(6)]
    for frame in frames:
        whole.note(frame)
    for frame in frames[:3]:
        first.note(frame)
    second.load(first.save())
    for frame in frames[3:]:
        second.note(frame)
    np.testing.assert_array_equal(second.positions, whole.positions)
    np.testing.assert_array_equal(second.ids, whole.ids)
