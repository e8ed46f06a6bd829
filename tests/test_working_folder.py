"""One command at a time works in a folder, a killed one holds nothing, and its jobs end with it."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from blockshake.errors import InputError
from blockshake.working_folder import COMMAND, hold

LIMIT = 60.0  # s; against a test that hangs
HOLDS = (
    "import sys, time; from blockshake.working_folder import hold; hold(sys.argv[1]); print(1, flush=True);"
)
# a shell stands between a command and its job, as under Snakemake
STARTS_A_JOB = """
import subprocess, sys
from blockshake.working_folder import start_jobs
start_jobs()
subprocess.run(["sh", "-c", '"$0" -c "$1"; true', sys.executable, sys.argv[1]])
"""
JOB = """
import os, time
from blockshake.working_folder import end_with_command
end_with_command()
print(os.getpid(), flush=True)
time.sleep(600)
"""


def _start(*arguments):
    return subprocess.Popen([sys.executable, "-c", *map(str, arguments)], stdout=subprocess.PIPE, text=True)


def test_a_second_command_is_refused_in_one_line_until_the_first_is_killed(tmp_path):
    first = _start(HOLDS + "time.sleep(600)", tmp_path)
    assert first.stdout.readline() == "1\n"
    with pytest.raises(
        InputError, match="expected a folder in which no other study or diagnosis runs"
    ) as error:
        hold(tmp_path)
    assert str(error.value).startswith(str(tmp_path))
    assert "\n" not in str(error.value)
    first.kill()
    first.communicate()
    os.close(hold(tmp_path))
    # let go of when it is closed
    os.close(hold(tmp_path))


@pytest.mark.parametrize("command", [HOLDS, HOLDS + "raise SystemExit(1)"])
def test_a_command_that_ends_lets_go(command, tmp_path):
    _start(command, tmp_path).communicate()
    os.close(hold(tmp_path))


def _is_there(process):
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    return True


def test_a_job_ends_with_its_killed_command():
    command = _start(STARTS_A_JOB, JOB)
    job = int(command.stdout.readline())
    assert _is_there(job)
    command.send_signal(signal.SIGKILL)
    command.wait()
    deadline = time.monotonic() + LIMIT
    while _is_there(job):
        assert time.monotonic() < deadline
        time.sleep(0.01)


BOOT = Path("/proc/sys/kernel/random/boot_id").read_text().strip()
GONE = 2**22 + 1  # no process has such a number


@pytest.mark.parametrize(
    ("command", "code"),
    [(f"elsewhere {GONE}", 0), (f"{BOOT} {GONE}", -signal.SIGKILL), (f"{BOOT} {os.getpid()}", 0), ("", 0)],
    ids=["on another machine", "killed before the job came so far", "alive", "none"],
)
def test_a_job_goes_on_but_without_its_command(command, code):
    job = subprocess.run(
        [sys.executable, "-c", JOB.replace("600", "0")], env={**os.environ, COMMAND: command}, check=False
    )
    assert job.returncode == code


QUEUED = """
import os, sys, time
from blockshake import working_folder
working_folder._PERIOD = 0.01
working_folder.end_with_folder(sys.argv[1])
assert working_folder.COMMAND not in os.environ  # a job of this job follows nobody
print(1, flush=True)
time.sleep(float(sys.argv[2]))
"""


def _queued(folder, command, seconds):
    return subprocess.Popen(
        [sys.executable, "-c", QUEUED, folder, str(seconds)],
        env={**os.environ, COMMAND: command}, stdout=subprocess.PIPE, text=True,
    )  # fmt: skip


@pytest.mark.parametrize("kept", [True, False], ids=["command alive", "command ended"])
def test_a_job_of_a_queue_goes_on_until_another_command_takes_the_folder(kept, tmp_path):
    held = hold(tmp_path)
    command = f"{BOOT} {os.getpid()}"
    if not kept:
        os.close(held)
    assert _queued(tmp_path, command, 0.2).wait(LIMIT) == 0
    job = _queued(tmp_path, command, 600)
    assert job.stdout.readline() == "1\n"
    if kept:
        os.close(held)
    next_command = _start(HOLDS + "time.sleep(600)", tmp_path)
    assert next_command.stdout.readline() == "1\n"
    assert job.wait(LIMIT) == -signal.SIGKILL
    # one that was still in the queue begins nothing
    late = _queued(tmp_path, command, 600)
    assert late.communicate(timeout=LIMIT) == ("", None)
    next_command.kill()
    next_command.communicate()
