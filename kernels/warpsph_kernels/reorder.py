"""Physical reordering of particle arrays, whatever their type."""

import warp as wp

MODULE = "warpsph_reorder"


@wp.kernel(module=MODULE, enable_backward=False)
def gather_words(
    offset: int,
    order: wp.array(dtype=wp.int32),
    source: wp.array2d(dtype=wp.uint32),
    target: wp.array2d(dtype=wp.uint32),
):
    """One particle: copy all 4-byte words of the record at its old place to its new one."""
    i = offset + wp.tid()
    old = order[i]
    for k in range(source.shape[1]):
        target[i, k] = source[old, k]
