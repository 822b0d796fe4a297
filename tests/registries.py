"""Leaves no trace of the formulas that a test registers."""

from collections.abc import Iterator
from contextlib import contextmanager

from warpsph_kernels.pair_terms import VISCOSITIES
from warpsph_kernels.smoothing import SMOOTHING_KERNELS
from warpsph_kernels.state import STATES

from warpsph.laws.smoothing import SMOOTHING_LAWS
from warpsph.laws.states import STATE_LAWS
from warpsph.laws.viscosities import VISCOSITY_LAWS

REGISTRIES = (SMOOTHING_KERNELS, SMOOTHING_LAWS, STATES, STATE_LAWS, VISCOSITIES, VISCOSITY_LAWS)


@contextmanager
def restored_registries() -> Iterator[None]:
    """Take away what has been registered inside of the block."""
    before = [dict(registry) for registry in REGISTRIES]
    try:
        yield
    finally:
        for registry, old in zip(REGISTRIES, before, strict=True):
            for name in set(registry) - set(old):
                del registry[name]
