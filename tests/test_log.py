"""The cost of a job in its log: its own time and that of the programs it starts, to the end."""

import re
import subprocess
import sys
import time

import pytest

from blockshake.errors import InputError
from blockshake.log import logging_to

BUSY = "import time\nwhile time.process_time() < 0.6: pass"


def _cost(log):
    """Time and CPU time [s] in the last line of a log."""
    return tuple(
        map(float, re.findall(r"^Took ([\d.]+) s, ([\d.]+) CPU s\.$", log.read_text(), re.MULTILINE)[-1])
    )


def test_a_job_and_the_programs_that_it_starts_are_counted(tmp_path):
    started = time.process_time()
    with logging_to(tmp_path / "job.log") as say:
        say("a line")
        while time.process_time() - started < 0.5:
            pass
        subprocess.run([sys.executable, "-c", BUSY], check=True)
    wall_time, cpu_time = _cost(tmp_path / "job.log")
    assert 1.05 <= cpu_time < 3.0
    assert wall_time > 0.9


def test_a_job_that_fails_has_its_cost(tmp_path):
    with pytest.raises(SystemExit), logging_to(tmp_path / "job.log"):
        raise InputError("a.yaml", "", "expected more")
    assert _cost(tmp_path / "job.log")[1] >= 0.0
