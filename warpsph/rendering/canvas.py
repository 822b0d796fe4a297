"""A picture of particle surfaces, painted body by body with a depth buffer."""

from __future__ import annotations

import copy
from dataclasses import dataclass

import numpy as np
import warp as wp
from scipy.ndimage import gaussian_filter
from warpsph_kernels import surface_splatting as kernels

from warpsph.rendering.camera import Camera

SUPERSAMPLING = 2
BACKGROUND = 1.0

_KEY_LIGHT = (-0.45, 0.75, -0.50)
"""Over the left shoulder, in camera axes: right, up, forward."""

_SKY = (0.93, 0.96, 1.0)

_SMOOTHING_REACH = 1.8
_SMOOTHING_THRESHOLD = 1.5
"""Spacings across the view, and bend along it beyond which a neighbour belongs to another surface."""

_OCCLUSION_BLUR = 1.0 / 45.0
_OCCLUSION_STRENGTH = 0.35
_OCCLUSION_RANGE = 0.1
"""Blur as part of the picture's height, strongest darkening, and its depth as part of the picture's range."""


@dataclass(frozen=True)
class Material:
    """Colours (k, 3) in [0, 1] for values from low to high, and gloss: 0 for walls, 1 for water."""

    palette: np.ndarray
    low: float = 0.0
    high: float = 1.0
    gloss: float = 0.0


@dataclass(frozen=True)
class Spheres:
    """Particles to draw: centres (n, 3) and radii (n,) [m], and the spacing [m] over which bumps are smoothed."""

    centres: np.ndarray
    radii: np.ndarray
    spacing: float


class Canvas:
    """Paints on Warp's default device, at twice the size of the picture."""

    def __init__(self, camera: Camera) -> None:
        """The camera's size is that of the finished picture."""
        self._camera = camera.magnified(SUPERSAMPLING)
        self._shape = (self._camera.height, self._camera.width)
        self._view = _view(self._camera)
        self._lights = _lights()
        self._depth = wp.full(self._shape, np.inf, dtype=float)
        self._picture = wp.full(self._shape, wp.vec3(BACKGROUND), dtype=wp.vec3)

    def copy(self) -> Canvas:
        """The same picture, to paint on without changing this one."""
        other = copy.copy(self)
        other._depth, other._picture = wp.clone(self._depth), wp.clone(self._picture)
        return other

    def paint_front(self, spheres: Spheres, values: np.ndarray, material: Material) -> None:
        """Paint the nearest surface, coloured by the values (n,)."""
        centres, radii = _on_device(spheres)
        nearest = self._splatted_depth(centres, radii, side=1.0)
        sums = wp.zeros(self._shape, dtype=wp.vec3)
        carried = wp.array(values, dtype=float)
        inputs = [centres, radii, carried, spheres.spacing, self._view, nearest]
        wp.launch(kernels.splat_layer, len(radii), inputs, [sums])
        depth, value = wp.empty_like(nearest), wp.empty_like(nearest)
        wp.launch(kernels.resolve, self._shape, [sums], [depth, value])
        self._paint(self._smoothed(depth, spheres), value, material)

    def paint_back(self, spheres: Spheres, material: Material) -> None:
        """Paint the farthest surface: a container whose near walls must not hide what it holds."""
        negative = self._splatted_depth(*_on_device(spheres), side=-1.0)
        depth = wp.array(np.abs(negative.numpy()))
        self._paint(self._smoothed(depth, spheres), wp.zeros_like(depth), material)

    def image(self) -> np.ndarray:
        """The finished picture (height, width, 3) in [0, 1]; what lies behind its surroundings is darker."""
        height, width = (length // SUPERSAMPLING for length in self._shape)
        samples = self._picture.numpy().reshape(height, SUPERSAMPLING, width, SUPERSAMPLING, 3)
        depth = self._depth.numpy()[::SUPERSAMPLING, ::SUPERSAMPLING]
        shade = 1.0 - _OCCLUSION_STRENGTH * occlusion(depth)
        return np.clip(samples.mean(axis=(1, 3)) * shade[..., None], 0.0, 1.0)

    def _splatted_depth(self, centres: wp.array, radii: wp.array, *, side: float) -> wp.array:
        depth = wp.full(self._shape, np.inf, dtype=float)
        wp.launch(kernels.splat_depth, len(radii), [centres, radii, side, self._view], [depth])
        return depth

    def _smoothed(self, depth: wp.array, spheres: Spheres) -> wp.array:
        """Depth without the bumps of single particles."""
        distance = float(np.median(self._camera.project(spheres.centres)[:, 2]))
        reach = max(1, round(_SMOOTHING_REACH * self._camera.focal * spheres.spacing / distance))
        for along_rows in (1, 0):
            smoother = wp.empty_like(depth)
            inputs = [depth, along_rows, reach, _SMOOTHING_THRESHOLD * spheres.spacing]
            wp.launch(kernels.smooth, self._shape, inputs, [smoother])
            depth = smoother
        return depth

    def _paint(self, depth: wp.array, value: wp.array, material: Material) -> None:
        inputs = [depth, value, _paint(material), self._lights, self._view]
        wp.launch(kernels.paint_surface, self._shape, inputs, [self._depth, self._picture])


def occlusion(depth: np.ndarray) -> np.ndarray:
    """Part of the light that its surroundings take from each pixel (Luft, Colditz & Deussen 2006)."""
    covered = np.isfinite(depth)
    if not covered.any():
        return np.zeros_like(depth)
    blur = depth.shape[0] * _OCCLUSION_BLUR
    weight = gaussian_filter(covered.astype(np.float32), blur)
    finite = np.where(covered, depth, np.float32(0.0))
    surroundings = gaussian_filter(finite, blur) / np.maximum(weight, np.float32(1e-6))
    scale = _OCCLUSION_RANGE * float(np.ptp(depth[covered])) or 1.0
    return np.where(covered, np.clip((finite - surroundings) / scale, 0.0, 1.0), 0.0)


def _on_device(spheres: Spheres) -> tuple[wp.array, wp.array]:
    return wp.array(spheres.centres, dtype=wp.vec3), wp.array(spheres.radii, dtype=float)


def _view(camera: Camera) -> kernels.View:
    view = kernels.View()
    view.eye = wp.vec3(*camera.eye)
    view.right, view.up, view.forward = (wp.vec3(*axis) for axis in camera.axes)
    view.focal, view.width, view.height = camera.focal, camera.width, camera.height
    return view


def _lights() -> kernels.Lights:
    lights = kernels.Lights()
    lights.key = wp.normalize(wp.vec3(*_KEY_LIGHT))
    lights.sky = wp.vec3(*_SKY)
    return lights


def _paint(material: Material) -> kernels.Paint:
    paint = kernels.Paint()
    paint.palette = wp.array(material.palette, dtype=wp.vec3)
    paint.low, paint.high, paint.gloss = material.low, material.high, material.gloss
    return paint
