"""Pair loops that take neighbours a few at a time, so that a CPU core computes them side by side.

A compiler makes vector instructions of a loop over lanes only if it finds the same component of all lanes side by side
in memory. Records lie the other way round, so a block of them is loaded and transposed in registers, which costs less
than the gather instructions of today's processors: sums become three to eight times as fast. On a GPU a block is one
neighbour, and the same code is the plain loop.

    n = int(first)
    while n < end:
        b = lanes.take(neighbours, i, n, end)
        record_b = lanes.records(array, b, 0)
        k = int(0)
        while k < lanes.count:
            weight = wp.where(n + k < end, ..., 0)   # the last block is filled up with a neighbour that does not count
            ... component d of neighbour k is record_b[k + lanes.count * d] ...
            sums[k + lanes.count * d] += ...
            k += 1
        n += lanes.count
    total = lanes.fold(sums)

The blocks are indexed in the kernel itself: a function that takes one copies it. The loops are `while` loops because
Warp unrolls a `for` over a few iterations, and what is unrolled is not vectorised. What a particle has of its own is
copied before the loop, `vector(shift[i])`: Warp would read `shift[i]` again wherever it is used, and a loop that does
is not vectorised either.
"""

from dataclasses import dataclass
from functools import cache
from typing import Any

import warp as wp

from warpsph_kernels.arithmetic import Arithmetic

ON_CPU = {2: 8, 3: 16}
"""Lanes by dimension: in 2D rows are so short that much of a longer block would be empty."""
C_TYPES = {"single": "float", "double": "double"}
REGISTER = 4
"""Components of a record in its register; those that it lacks are zero."""


@dataclass(frozen=True)
class Lanes:
    """A number of lanes with the functions of a blocked pair loop.

    take(neighbours, row, first, end): `count` indices of a row from `first` on, the last one again beyond `end`;
    records(array, index, offset), vectors and matrices: the components of the entries index - offset, lane after lane,
    those of matrices row by row; numbers(array, index): entries that are numbers; stretch(array, first): the vectors
    from `first` on, one after the other; append(neighbours, row, found, first, hits): writes first + k behind the
    `found` neighbours of a row for every lane k that is a hit, as far as there is room, and returns how many it has
    then; fold(sums): the vector that the lanes' vectors add up to, fold_scalar and fold_tensor the same of numbers and
    of matrices.
    """

    count: int
    sums: Any
    """Type of a vector for each lane, component after component."""
    scalars: Any
    """Type of a number for each lane."""
    tensors: Any
    """Type of a matrix for each lane, component after component."""
    take: Any
    records: Any
    vectors: Any
    matrices: Any
    numbers: Any
    stretch: Any
    hits: Any
    """Type of a whole number for each lane: 1 if it is to be kept, else 0."""
    append: Any
    fold: Any
    fold_scalar: Any
    fold_tensor: Any


@cache
def make_lanes(arithmetic: Arithmetic, count: int) -> Lanes:
    """Return the lanes of an arithmetic: so many at a time, a power of two from 8 on, or one."""
    dim, real, vector = arithmetic.dimension, arithmetic.real, arithmetic.vector
    sums, scalars = wp.types.vector(count * dim, real), wp.types.vector(count, real)
    matrix, tensors = arithmetic.matrix, wp.types.vector(count * dim * dim, real)

    @wp.func
    def fold(lanes: sums):
        total = vector()
        for d in range(wp.static(dim)):
            k = int(0)
            while k < wp.static(count):
                total[d] = total[d] + lanes[wp.static(count) * d + k]
                k += 1
        return total

    @wp.func
    def fold_scalar(lanes: scalars):
        total = real(0.0)
        k = int(0)
        while k < wp.static(count):
            total += lanes[k]
            k += 1
        return total

    @wp.func
    def fold_tensor(lanes: tensors):
        total = matrix()
        for d in range(wp.static(dim)):
            for e in range(wp.static(dim)):
                k = int(0)
                while k < wp.static(count):
                    total[d, e] = total[d, e] + lanes[wp.static(count) * (wp.static(dim) * d + e) + k]
                    k += 1
        return total

    return Lanes(
        count=count,
        sums=sums,
        scalars=scalars,
        tensors=tensors,
        take=_make_take(count),
        records=_make_gather(arithmetic, arithmetic.record, dim + 1, count),
        vectors=_make_gather(arithmetic, vector, dim, count),
        matrices=_make_gather(arithmetic, matrix, dim * dim, count),
        numbers=_make_pick(arithmetic, count),
        stretch=_make_stretch(arithmetic, count),
        hits=wp.types.vector(count, wp.int32),
        append=_make_append(count),
        fold=fold,
        fold_scalar=fold_scalar,
        fold_tensor=fold_tensor,
    )


@cache
def _make_take(count: int) -> Any:
    indices = wp.types.vector(count, wp.int32)

    @wp.func
    def take_one(neighbours: wp.array2d(dtype=wp.int32), row: int, first: int, end: int):
        return indices(neighbours[row, first])

    if count == 1:
        return take_one
    snippet = f"""
    wp::vec_t<{count}, int> out;
    const int* from = &wp::index(neighbours, row, first);
    if (first + {count} <= end) {{
        __builtin_memcpy(&out, from, {4 * count});
    }} else {{
        for (int k = 0; k < {count}; ++k) out.c[k] = from[first + k < end ? k : end - 1 - first];
    }}
    return out;
    """

    @wp.func_native(snippet)
    def take(neighbours: wp.array2d(dtype=wp.int32), row: int, first: int, end: int) -> indices: ...

    return take


@cache
def _make_gather(arithmetic: Arithmetic, entry: Any, width: int, count: int) -> Any:
    """The function that loads `count` entries of `width` components, transposed."""
    dim = arithmetic.dimension
    indices = wp.types.vector(count, wp.int32)
    block = wp.types.vector(count * width, arithmetic.real)

    @wp.func
    def gather_one(array: wp.array(dtype=entry), index: indices, offset: int):
        loaded = array[index[0] - offset]
        out = block()
        for d in range(wp.static(width)):
            out[d] = loaded[d]
        return out

    @wp.func
    def gather_one_matrix(array: wp.array(dtype=entry), index: indices, offset: int):
        loaded = array[index[0] - offset]
        out = block()
        for d in range(wp.static(dim)):
            for e in range(wp.static(dim)):
                out[wp.static(dim) * d + e] = loaded[d, e]
        return out

    if count == 1:
        return gather_one_matrix if entry is arithmetic.matrix else gather_one
    snippet = _transposing_loads(C_TYPES[arithmetic.precision], width, count)

    @wp.func_native(snippet)
    def gather(array: wp.array(dtype=entry), index: indices, offset: int) -> block: ...

    return gather


@cache
def _make_pick(arithmetic: Arithmetic, count: int) -> Any:
    """The function that loads `count` numbers."""
    real, indices = arithmetic.real, wp.types.vector(count, wp.int32)
    block = wp.types.vector(count, real)

    @wp.func
    def pick(array: wp.array(dtype=real), index: indices):
        out = block()
        for k in range(wp.static(count)):
            out[k] = array[index[k]]
        return out

    return pick


@cache
def _make_stretch(arithmetic: Arithmetic, count: int) -> Any:
    """The function that loads `count` vectors that follow each other; the array has to have so many."""
    dim, vector = arithmetic.dimension, arithmetic.vector
    block = wp.types.vector(count * dim, arithmetic.real)

    @wp.func
    def stretch_of_one(array: wp.array(dtype=vector), first: int):
        return array[first]

    if count == 1:
        return stretch_of_one
    snippet = f"""
    wp::vec_t<{count * dim}, {C_TYPES[arithmetic.precision]}> out;
    __builtin_memcpy(&out, array.data + first, sizeof(out));
    return out;
    """

    @wp.func_native(snippet)
    def stretch(array: wp.array(dtype=vector), first: int) -> block: ...

    return stretch


@cache
def _make_append(count: int) -> Any:
    """The function that appends the hits of a block to a row.

    Where a processor moves the marked entries of a register together, they are written at once. Else those of a block
    with any hit are written one by one, each behind the last one and over it unless that was a hit: no branch on what
    cannot be foreseen.
    """
    hits_type = wp.types.vector(count, wp.int32)

    @wp.func
    def append_one(neighbours: wp.array2d(dtype=wp.int32), row: int, found: int, first: int, hits: hits_type):
        if hits[0] > 0 and found < neighbours.shape[1]:
            neighbours[row, found] = first
        return found + hits[0]

    if count == 1:
        return append_one
    feature = "__AVX512F__" if count == 16 else "__AVX512VL__"
    order = ", ".join(map(str, range(count)))
    snippet = f"""
    const int places = neighbours.shape[1];
    int* to = &wp::index(neighbours, row, 0);
#if defined({feature})
    if (found + {count} <= places) {{
        typedef int block_t __attribute__((ext_vector_type({count})));
        typedef bool marks_t __attribute__((ext_vector_type({count})));
        block_t marks;
        __builtin_memcpy(&marks, &hits, sizeof(marks));
        const marks_t chosen = __builtin_convertvector(marks, marks_t);
        unsigned {"short" if count == 16 else "char"} mask;
        __builtin_memcpy(&mask, &chosen, sizeof(mask));
        const block_t block = block_t{{{order}}} + first;
        const block_t kept = __builtin_ia32_compresssi{32 * count}_mask(block, block, mask);
        __builtin_memcpy(to + found, &kept, sizeof(kept));
        return found + __builtin_popcount(mask);
    }}
#endif
    int any = 0;
    for (int k = 0; k < {count}; ++k) any |= hits.c[k];
    if (!any) return found;
    for (int k = 0; k < {count}; ++k) {{
        to[found < places ? found : places - 1] = first + k;
        found += hits.c[k];
    }}
    return found;
    """

    @wp.func_native(snippet)
    def append(
        neighbours: wp.array2d(dtype=wp.int32), row: int, found: int, first: int, hits: hits_type
    ) -> int: ...

    return append


def _transposing_loads(c_type: str, width: int, count: int) -> str:
    """C++ that loads entries and transposes them, four components at a time."""
    size = 4 if c_type == "float" else 8
    lines = [
        f"typedef {c_type} entry_t __attribute__((vector_size({REGISTER * size})));",
        f"const {c_type}* base = (const {c_type}*)array.data;",
        f"wp::vec_t<{count * width}, {c_type}> out;",
    ]
    for first in range(0, width, REGISTER):
        lines += ["{", *_transposed_register(first, min(REGISTER, width - first), width, size, count), "}"]
    return "\n".join([*lines, "return out;"])


def _transposed_register(first: int, components: int, width: int, size: int, count: int) -> list[str]:
    """C++ that loads components from `first` on into registers of four, joins every fourth of them, and interleaves the
    four joined ones twice; then each holds one component of all lanes."""
    groups = count // REGISTER
    lines = []
    for lane in range(count):
        place = f"base + {width} * (long long)(index.c[{lane}] - offset) + {first}"
        if components == REGISTER:
            lines.append(f"entry_t r{lane}; __builtin_memcpy(&r{lane}, {place}, {REGISTER * size});")
        else:  # a copy of fewer components would go through memory
            parts = ", ".join(f"({place})[{d}]" for d in range(components))
            lines.append(f"entry_t r{lane} = {{{parts}}};")
    for q in range(REGISTER):
        joined = _joined([f"r{q + REGISTER * g}" for g in range(groups)])
        lines.append(f"auto a{q} = {joined};")
    low, high = (0, 4, 1, 5), (2, 6, 3, 7)
    for name, one, other, pattern in (
        ("t0", "a0", "a1", low),
        ("t1", "a0", "a1", high),
        ("t2", "a2", "a3", low),
        ("t3", "a2", "a3", high),
        ("c0", "t0", "t2", (0, 1, 4, 5)),
        ("c1", "t0", "t2", (2, 3, 6, 7)),
        ("c2", "t1", "t3", (0, 1, 4, 5)),
        ("c3", "t1", "t3", (2, 3, 6, 7)),
    ):
        lines.append(f"auto {name} = {_shuffled(one, other, pattern, groups)};")
    lines += [
        f"__builtin_memcpy(&out.c[{count * (first + d)}], &c{d}, {count * size});" for d in range(components)
    ]
    return lines


def _joined(names: list[str], width: int = REGISTER) -> str:
    """Registers one behind the other."""
    if len(names) == 1:
        return names[0]
    order = ", ".join(map(str, range(2 * width)))
    pairs = zip(names[::2], names[1::2], strict=True)
    return _joined([f"__builtin_shufflevector({a}, {b}, {order})" for a, b in pairs], 2 * width)


def _shuffled(first: str, second: str, pattern: tuple[int, ...], groups: int) -> str:
    """In every group of four the same choice from two registers; 4 and above choose from the second."""
    total = REGISTER * groups
    order = [
        REGISTER * g + p if p < REGISTER else total + REGISTER * g + p - REGISTER
        for g in range(groups)
        for p in pattern
    ]
    return f"__builtin_shufflevector({first}, {second}, {', '.join(map(str, order))})"
