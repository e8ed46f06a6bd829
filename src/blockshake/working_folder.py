"""The folder that a workflow works in: one command at a time, whose jobs end with it, however it ends."""

import fcntl
import os
import select
import signal
import threading
from pathlib import Path

from blockshake.errors import InputError

COMMAND = (
    "BLOCKSHAKE_COMMAND"  # environment variable of jobs: machine and process of the command that started them
)
_BOOT = Path("/proc/sys/kernel/random/boot_id")  # of this machine since it was switched on


def hold(folder):
    """Keep other commands out of a folder until this process ends, or the descriptor that is returned is closed.

    The operating system lets go of the folder with the process, so that a killed command locks nobody out.

    Raises
    ------
    InputError
        Another command works in the folder.
    """
    path = Path(folder) / ".snakemake" / "command.lock"
    path.parent.mkdir(parents=True, exist_ok=True)
    held = os.open(path, os.O_RDWR | os.O_CREAT, 0o666)
    try:
        fcntl.flock(held, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        os.close(held)
        said = "expected a folder in which no other study or diagnosis runs; wait for its end, then type this again"
        raise InputError(Path(folder).resolve(), "", said) from None
    return held


def end_with_command():
    """Kill this process when the command that started it on this machine ends, as one that is killed does.

    A job that a queue starts, on this machine or another, goes on.
    """
    machine, _, command = os.environ.get(COMMAND, "").partition(" ")
    if machine != _BOOT.read_text().strip():
        return
    try:
        descriptor = os.pidfd_open(int(command))
    except ProcessLookupError:  # before this process came so far
        os.kill(os.getpid(), signal.SIGKILL)
    if int(command) in _ancestors():
        threading.Thread(target=_follow, args=[descriptor], daemon=True).start()


def this_command():
    """Environment variable of a process that ends with this one, see `end_with_command`: a dict of one entry."""
    return {COMMAND: f"{_BOOT.read_text().strip()} {os.getpid()}"}


def start_jobs():
    """Have the jobs that this process starts from now on end with it, see `end_with_command`."""
    os.environ.update(this_command())


def _ancestors():
    """Processes that this one descends from."""
    process = os.getppid()
    while process > 1:
        yield process
        process = int(Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[1])


def _follow(descriptor):
    waiting = select.poll()
    waiting.register(descriptor, select.POLLIN)
    waiting.poll()
    os.kill(os.getpid(), signal.SIGKILL)
