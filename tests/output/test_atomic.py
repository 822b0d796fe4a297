"""A file is replaced whole or not at all."""

import pytest

from warpsph.output.atomic import replacing, write_atomically
from warpsph.output.errors import OutputError


def test_new_content_takes_the_place_of_the_old(tmp_path):
    path = tmp_path / "file.txt"
    for content in (b"old", b"new"):
        write_atomically(path, content, durable=True)
        assert path.read_bytes() == content
    assert list(tmp_path.iterdir()) == [path]


def test_interrupted_write_leaves_the_old_content_and_nothing_else(tmp_path):
    path = tmp_path / "file.txt"
    path.write_text("old")

    def interrupted():
        with replacing(path) as partial:
            partial.write_text("ne")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        interrupted()
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


def test_full_disk_names_path_and_reason_and_leaves_the_old_content(tmp_path, disk_full_beyond):
    path = tmp_path / "file.txt"
    path.write_text("old")
    with disk_full_beyond(1000), pytest.raises(OutputError, match=r"file\.txt: cannot write: File too large"):
        write_atomically(path, bytes(2000))
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]
