"""Processes of a validation end with the one that started them, even if that is killed."""

import os
import subprocess
import sys
import time
from pathlib import Path

import pytest

MODULE = """
import os, time
from warpsph.validation.side_by_side import side_by_side

def begin():
    with open(os.environ["STARTED"], "a") as file:
        file.write(f"{os.getpid()}\\n")

def run(case):
    time.sleep(60.0)

def main():
    list(side_by_side([1, 2], run, 2, begin))
"""


@pytest.mark.skipif(not Path("/proc/self").exists(), reason="looks for processes in /proc")
def test_runs_end_with_a_validation_that_is_killed(tmp_path: Path) -> None:
    (tmp_path / "slow_runs.py").write_text(MODULE)
    started = tmp_path / "started"
    path = os.pathsep.join([str(tmp_path), *(entry for entry in sys.path if entry)])
    parent = subprocess.Popen(
        [sys.executable, "-c", "import slow_runs; slow_runs.main()"],
        env=os.environ | {"PYTHONPATH": path, "STARTED": str(started)},
    )

    def runs() -> list[str]:
        return started.read_text().split() if started.exists() else []

    try:
        _wait_until(lambda: len(runs()) == 2)
    finally:
        parent.kill()
        parent.wait()
    _wait_until(lambda: not any(_alive(run) for run in runs()))


def _alive(process: str) -> bool:
    """Whether a process is there and not only waits for its parent to take note of its end."""
    try:
        return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except FileNotFoundError:
        return False


def _wait_until(condition, seconds: float = 60.0) -> None:
    """Wait for a condition; fail after so many seconds."""
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.1)
