"""The cost of a job in its log: its own time and that of the programs it starts, to the end."""

import subprocess
import sys
import time

import pytest

from blockshake.errors import InputError
from blockshake.log import logging_to, read_cost

BUSY = "import time\nwhile time.process_time() < 0.6: pass"


def test_a_job_and_the_programs_that_it_starts_are_counted(tmp_path):
    started = time.process_time()
    with logging_to(tmp_path / "job.log") as say:
        say("a line")
        while time.process_time() - started < 0.5:
            pass
        subprocess.run([sys.executable, "-c", BUSY], check=True)
    cost = read_cost(tmp_path / "job.log")
    assert 1.05 <= cost.cpu_time < 3.0
    assert cost.wall_time > 0.9


def test_a_job_that_fails_has_its_cost_and_one_that_was_killed_has_none(tmp_path):
    with pytest.raises(SystemExit), logging_to(tmp_path / "job.log"):
        raise InputError("a.yaml", "", "expected more")
    assert read_cost(tmp_path / "job.log").cpu_time >= 0.0
    (tmp_path / "killed.log").write_text("a line\n")
    assert read_cost(tmp_path / "killed.log") is None
    assert read_cost(tmp_path / "none.log") is None
