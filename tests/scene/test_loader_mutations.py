"""Whatever is done to the text of a scene: the loader gives a Scene or a SceneError, never anything else."""

import string
from io import StringIO
from typing import Any

from hypothesis import given, settings
from hypothesis import strategies as st
from ruamel.yaml import YAML
from scene_texts import DAM_BREAK

from warpsph.scene import Scene, SceneError, scene_from_yaml
from warpsph.scene.document import decode

LINES = DAM_BREAK.splitlines(keepends=True)
DATA = YAML(typ="safe", pure=True).load(DAM_BREAK)

mutations = settings(max_examples=25)
scalars = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(),
    st.floats(),
    st.sampled_from(["auto", "none", "box", "water", "x", "1e3", "front.position[m]", "sin(x)", "y/0"]),
    st.text(string.printable, max_size=8),
)
values = st.recursive(
    scalars,
    lambda inner: st.one_of(
        st.lists(inner, max_size=4),
        st.dictionaries(st.sampled_from(["type", "min", "max", "shape", "at", "x", "!"]), inner, max_size=4),
    ),
    max_leaves=8,
)


def outcome(content: bytes, overrides: tuple[str, ...] = ()) -> None:
    """Load the bytes of a file; anything but a Scene or a SceneError with its reasons fails the test."""
    result: Scene | SceneError
    try:
        result = scene_from_yaml(decode(content, "mutated.yaml"), overrides=overrides)
    except SceneError as error:
        result = error
    reasons = [] if isinstance(result, Scene) else [problem.message for problem in result.problems]
    assert isinstance(result, Scene) or (reasons and all(reasons) and str(result))


def paths(data: Any, path: tuple[str | int, ...] = ()) -> list[tuple[str | int, ...]]:
    """Path of every value inside the data."""
    items = data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ()
    return [found for key, child in items for found in [(*path, key), *paths(child, (*path, key))]]


def replaced(data: Any, path: tuple[str | int, ...], value: Any) -> Any:
    """A copy of the data with another value at the path."""
    if not path:
        return value
    copied = data.copy()
    copied[path[0]] = replaced(data[path[0]], path[1:], value)
    return copied


def dumped(data: Any) -> str:
    """The data as YAML."""
    stream = StringIO()
    YAML(typ="safe", pure=True).dump(data, stream)
    return stream.getvalue()


PATHS = paths(DATA)


@mutations
@given(st.sets(st.integers(0, len(LINES) - 1), min_size=1, max_size=6))
def test_lines_are_deleted(deleted: set[int]) -> None:
    outcome("".join(line for index, line in enumerate(LINES) if index not in deleted).encode())


@mutations
@given(st.permutations(LINES))
def test_lines_are_shuffled(lines: list[str]) -> None:
    outcome("".join(lines).encode())


@mutations
@given(st.integers(0, len(DAM_BREAK)))
def test_the_text_is_truncated(length: int) -> None:
    outcome(DAM_BREAK.encode()[:length])


@mutations
@given(st.lists(st.tuples(st.integers(0, len(DAM_BREAK) - 1), st.integers(0, 255)), min_size=1, max_size=4))
def test_bytes_are_flipped(flips: list[tuple[int, int]]) -> None:
    content = bytearray(DAM_BREAK.encode())
    for position, byte in flips:
        content[position] = byte
    outcome(bytes(content))


@mutations
@given(st.integers(0, len(DAM_BREAK)), st.text("{}[]:,-#&*!|>'\"%@`?\n\t 0x", max_size=6))
def test_punctuation_is_inserted(position: int, inserted: str) -> None:
    outcome((DAM_BREAK[:position] + inserted + DAM_BREAK[position:]).encode())


@mutations
@given(st.sampled_from(PATHS), values)
def test_a_value_is_replaced_by_anything(path: tuple[str | int, ...], value: Any) -> None:
    outcome(dumped(replaced(DATA, path, value)).encode())


@mutations
@given(st.sampled_from(PATHS), st.text(string.printable, max_size=10))
def test_an_override_is_anything(path: tuple[str | int, ...], value: str) -> None:
    outcome(DAM_BREAK.encode(), (f"{'.'.join(map(str, path))}={value}",))


@mutations
@given(st.text(string.printable, max_size=20))
def test_an_override_has_any_key(override: str) -> None:
    outcome(DAM_BREAK.encode(), (override,))


@mutations
@given(st.binary(max_size=200))
def test_the_file_is_binary(content: bytes) -> None:
    outcome(content)
