"""Averages over time of velocity and pressure at the points of a grid."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from warpsph.frame import Frame
from warpsph.probes.grid import Grid, GridInterpolation
from warpsph.scene.recordings import FlowStatistics as FlowStatisticsSpec
from warpsph.scene.schema import Scene


class FlowStatistics:
    """Running means and covariances of (velocity, pressure) over the samples in which a point is in the fluid.

    They are updated sample by sample (Welford 1962), so that nothing is lost to cancellation in a long run.
    """

    needs: Mapping[str, tuple[str, ...]] = {
        "fluid": ("position", "velocity", "pressure", "density", "mass"),
        "boundary": ("position", "volume"),
        "structure": ("position", "volume"),
    }
    """Fields that a frame must carry, by kind of set."""

    def __init__(self, spec: FlowStatisticsSpec, scene: Scene) -> None:
        self.grid = Grid.between(spec.min, spec.max, spec.spacing or scene.spacing)
        self._start, self._dimension = spec.start, scene.dimension
        self._interpolation = GridInterpolation(self.grid, scene)
        columns, size = scene.dimension + 1, self.grid.size
        self._samples = np.zeros(size, dtype=np.int64)
        self._mean = np.zeros((size, columns))
        self._products = np.zeros((size, columns, columns))
        self._first, self._last = np.nan, np.nan

    def note(self, frame: Frame) -> None:
        """Take a sample, if its time has come."""
        if frame.time < self._start * (1.0 - 1e-9):
            return
        values = self._interpolation.evaluate(frame, ("velocity", "pressure"))
        wet = np.isfinite(values).all(axis=1)
        self._samples[wet] += 1
        before = values[wet] - self._mean[wet]
        self._mean[wet] += before / self._samples[wet, None]
        after = values[wet] - self._mean[wet]
        self._products[wet] += before[:, :, None] * after[:, None, :]
        self._first = frame.time if np.isnan(self._first) else self._first
        self._last = frame.time

    @property
    def times(self) -> tuple[float, float]:
        """Times of the first and of the last sample [s], not numbers without any."""
        return self._first, self._last

    def fields(self) -> dict[str, np.ndarray]:
        """Samples and averages in the shape of the grid, NaN where a point was never in the fluid.

        velocity_covariance are the Reynolds stresses over minus the density, <v_i' v_j'>.
        """
        dim, shape, wet = self._dimension, self.grid.shape, self._samples > 0
        mean = np.where(wet[:, None], self._mean, np.nan)
        covariance = self._products / np.maximum(self._samples, 1)[:, None, None]
        covariance[~wet] = np.nan
        return {
            "samples": self._samples.reshape(shape),
            "velocity": mean[:, :dim].reshape(*shape, dim),
            "pressure": mean[:, dim].reshape(shape),
            "velocity_covariance": covariance[:, :dim, :dim].reshape(*shape, dim, dim),
            "pressure_variance": covariance[:, dim, dim].reshape(shape),
        }

    def save(self) -> dict[str, Any]:
        """What a run needs to go on."""
        return {
            "samples": self._samples,
            "mean": self._mean,
            "products": self._products,
            "first": self._first,
            "last": self._last,
        }

    def load(self, saved: Mapping[str, Any]) -> None:
        """Go on from what `save` returned."""
        self._samples, self._mean, self._products = (
            np.array(saved[name]) for name in ("samples", "mean", "products")
        )
        self._first, self._last = float(saved["first"]), float(saved["last"])
