"""Probe samples survive a crash, and a resumed run writes the file of an uninterrupted one."""

import math

import pytest

from warpsph.output.errors import OutputError
from warpsph.output.probes_csv import ProbesCsv, read_probes

COLUMNS = ("front.position[m]", "load.force_x[N/m]")


def write_samples(path, steps, resume_time=None):
    writer = ProbesCsv(path, COLUMNS)
    writer.open(resume_time)
    for step in steps:
        writer.write(step / 3, (math.sqrt(step), -1e-300 * step))
    writer.close()


def test_time_comes_first_and_numbers_come_back_exactly(tmp_path):
    write_samples(tmp_path / "probes.csv", range(5))
    columns = read_probes(tmp_path / "probes.csv")
    assert list(columns) == ["time[s]", *COLUMNS]
    assert columns["time[s]"] == [step / 3 for step in range(5)]
    assert columns[COLUMNS[0]] == [math.sqrt(step) for step in range(5)]
    assert columns[COLUMNS[1]] == [-1e-300 * step for step in range(5)]


def test_every_row_is_on_disk_at_once(tmp_path):
    writer = ProbesCsv(tmp_path / "probes.csv", COLUMNS)
    writer.open()
    writer.write(0.5, (1.0, math.nan))
    assert (tmp_path / "probes.csv").read_text().splitlines()[1] == "0.5,1.0,nan"


@pytest.mark.parametrize("tail", ["", "2.66", "2.666,1.0,-1"], ids=["whole", "cut in the time", "cut later"])
def test_resumed_file_has_the_bytes_of_the_uninterrupted_one(tmp_path, tail):
    """Rows after the checkpoint are dropped, and a row that the crash cut short."""
    whole, resumed = tmp_path / "whole.csv", tmp_path / "resumed.csv"
    write_samples(whole, range(12))
    write_samples(resumed, range(8))
    with resumed.open("a") as file:
        file.write(tail)
    write_samples(resumed, range(6, 12), resume_time=5 / 3)
    assert resumed.read_bytes() == whole.read_bytes()


def test_other_columns_cannot_be_continued(tmp_path):
    write_samples(tmp_path / "probes.csv", range(3))
    with pytest.raises(OutputError, match=r"probes\.csv: cannot continue: its columns are .*force_x"):
        ProbesCsv(tmp_path / "probes.csv", ["other.level[m]"]).open(resume_time=1.0)


def test_full_disk_is_an_error_and_keeps_the_rows_so_far(tmp_path, disk_full_beyond):
    path = tmp_path / "probes.csv"
    writer = ProbesCsv(path, COLUMNS)
    writer.open()
    writer.write(0.0, (0.0, 0.0))
    with disk_full_beyond(path.stat().st_size):
        with pytest.raises(OutputError, match="File too large"):
            writer.write(1.0, (0.0, 0.0))
        writer.close()
    assert read_probes(path)["time[s]"] == [0.0]
