"""The mass that passes patches of open boundaries, from the particles around them."""

from functools import cache
from typing import Any, NamedTuple

import warp as wp

from warpsph_kernels.arithmetic import make_packing, make_separation
from warpsph_kernels.cells import make_cell_functions, make_grid_struct
from warpsph_kernels.options import FluidOptions
from warpsph_kernels.pair_terms import make_constants_struct
from warpsph_kernels.patch import make_across, make_nearest_station, make_on_patch, make_patch_struct


class PatchFluxKernels(NamedTuple):
    """Kernels of the flux, in the order of a step."""

    gather_flux: Any
    tally_flux: Any


@cache
def make_patch_flux_kernels(options: FluidOptions) -> PatchFluxKernels:
    """Return the kernels of the flux specialised for the options.

    With d the depth of a particle inside a patch of normal n, the flux is sum_b m_b (v_b . n) w(d_b), where w is a hat
    of half width `reach` and integral one: the mean of the flux through planes up to that far from the patch. Particles
    that move across with their mass carry just that; values at stations, a spacing apart, would be off by 1 / (2 n^2)
    of the flow of a parabola over n stations.
    """
    arithmetic = options.arithmetic
    dim, real, vector, record = (
        arithmetic.dimension,
        arithmetic.real,
        arithmetic.vector,
        arithmetic.record,
    )
    patch_type = make_patch_struct(options)
    constants_type, grid_type = make_constants_struct(arithmetic), make_grid_struct(arithmetic)
    _, unpack = make_packing(arithmetic)
    separation = make_separation(arithmetic, options.periodic)
    wrap, cell_of, row_base = make_cell_functions(arithmetic)
    across, on_patch = make_across(options), make_on_patch(options)
    nearest_station = make_nearest_station(options)
    rows = 3 ** (dim - 1)
    module = options.module_of("patch_flux")

    @wp.kernel(module=module, enable_backward=False)
    def gather_flux(
        offset: int,
        c: constants_type,
        reach: real,
        margin: real,
        grid: grid_type,
        start: wp.array(dtype=wp.int32),
        patches: wp.array(dtype=patch_type),
        patch_of: wp.array(dtype=wp.int32),
        place: wp.array(dtype=vector),
        position_pressure: wp.array(dtype=record),
        velocity_volume: wp.array(dtype=record),
        share: wp.array(dtype=wp.float64),
    ):
        """One station at its `place` on the patch: the flux [kg/s] of the particles to which no other is nearer, within
        `reach` [m] before and behind the patch, less than a cell is wide, and `margin` [m] beside it."""
        i = offset + wp.tid()
        patch = patches[patch_of[i]]
        total = wp.float64(0.0)
        cell = cell_of(place[i], grid)
        for row in range(wp.static(rows)):
            base = row_base(cell, row, grid)
            for r in range(3):
                bucket = base + wrap(cell[0] - 1 + r, grid.cells[0])
                for b in range(start[bucket], start[bucket + 1]):
                    away = separation(unpack(position_pressure[b]), patch.center, c.period)
                    d = wp.abs(wp.dot(away, patch.normal))
                    s = across(patch, away)
                    if d < reach and on_patch(patch, s, margin) and nearest_station(patch, s) == i:
                        u = wp.dot(unpack(velocity_volume[b]), patch.normal)
                        total += wp.float64(c.mass * u * (reach - d) / (reach * reach))
        share[i] = total

    @wp.kernel(module=module, enable_backward=False)
    def tally_flux(
        offset: int,
        clock: wp.array(dtype=wp.float64),
        patches: wp.array(dtype=patch_type),
        share: wp.array(dtype=wp.float64),
        flux: wp.array(dtype=wp.float64),
        mass: wp.array(dtype=wp.float64),
    ):
        """One patch: mass that enters a second [kg/s], the sum over its stations, and its integral [kg]."""
        k = offset + wp.tid()
        patch = patches[k]
        total = wp.float64(0.0)
        for j in range(patch.counts[0] * patch.counts[1]):
            total += share[patch.first_station + j]
        flux[k] = total
        mass[k] = mass[k] + clock[0] * total

    return PatchFluxKernels(gather_flux, tally_flux)
