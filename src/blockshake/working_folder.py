"""The folder that a workflow works in: one command at a time, whose jobs end with it, however it ends.

Jobs that a queue starts outlive their command, so that hours of work are not lost with a session. They end when the
next command takes the folder, which starts them anew.
"""

import contextlib
import fcntl
import os
import select
import signal
import threading
import time
from pathlib import Path

from blockshake.errors import InputError

# environment variable of jobs: machine and process of the command that started them
COMMAND = "BLOCKSHAKE_COMMAND"
_BOOT = Path("/proc/sys/kernel/random/boot_id")  # of this machine since it was switched on
_LOCK = Path(".snakemake") / "command.lock"  # holds the name of the command that took the folder last
_WRITTEN = ("results", "reports", "logs")  # folders of a workflow in it
_PERIOD = 10.0  # s; between two looks at the lock from another machine


def hold(folder):
    """Keep other commands out of a folder until this process ends, or the descriptor that is returned is closed.

    The operating system lets go of the folder with the process, so that a killed command locks nobody out.

    Raises
    ------
    InputError
        Another command works in the folder, or what a workflow writes to cannot be written to.
    """
    for name in ("", *_WRITTEN):
        path = Path(folder, name)
        if path.exists() and not os.access(path, os.W_OK):
            raise InputError(path.resolve(), "", "expected a folder to write to; permission denied")
    path = Path(folder) / _LOCK
    path.parent.mkdir(parents=True, exist_ok=True)
    held = os.open(path, os.O_RDWR | os.O_CREAT, 0o666)
    try:
        fcntl.flock(held, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        os.close(held)
        wrong = "expected a folder in which no other study or diagnosis runs; wait for its end, or use another folder"
        raise InputError(Path(folder).resolve(), "", wrong) from None
    os.ftruncate(held, 0)
    os.write(held, this_command()[COMMAND].encode())
    return held


def end_with_command():
    """Kill this process when the command that started it on this machine ends, as one that is killed does.

    A job that a queue starts goes on, see `end_with_folder`.
    """
    machine, _, command = os.environ.get(COMMAND, "").partition(" ")
    if machine != _BOOT.read_text().strip():
        return
    try:
        descriptor = os.pidfd_open(int(command))
    except ProcessLookupError:  # before this process came so far
        os.kill(os.getpid(), signal.SIGKILL)
    if int(command) in _ancestors(os.getpid()):
        threading.Thread(target=_follow, args=[descriptor], daemon=True).start()


def end_with_folder(folder):
    """Kill this process, which a queue started, when another command than its own takes the folder.

    On this machine or another: the processes that it starts are the queue's to end with it, and no longer know the
    command.
    """
    command = os.environ.pop(COMMAND, None)
    if command is None:  # a job of a job: that one looks after the folder
        return
    _check_holder(Path(folder) / _LOCK, command)
    threading.Thread(target=_watch, args=[Path(folder) / _LOCK, command], daemon=True).start()


def this_command():
    """Environment variable of a process that ends with this one, see `end_with_command`: a dict of one entry."""
    return {COMMAND: f"{_BOOT.read_text().strip()} {os.getpid()}"}


def start_jobs():
    """Have the jobs that this process starts from now on end with it, see `end_with_command`."""
    os.environ.update(this_command())


def interrupt_jobs():
    """Interrupt all processes that descend from this one, as Ctrl-C does: long runs keep their checkpoints."""
    for folder in Path("/proc").glob("[0-9]*"):
        with contextlib.suppress(OSError):  # it ended this moment
            if os.getpid() in _ancestors(int(folder.name)):
                os.kill(int(folder.name), signal.SIGINT)


def _ancestors(process):
    """Processes that one descends from."""
    while process > 1:
        process = int(Path(f"/proc/{process}/stat").read_bytes().rpartition(b")")[2].split()[1])
        yield process


def _follow(descriptor):
    waiting = select.poll()
    waiting.register(descriptor, select.POLLIN)
    waiting.poll()
    os.kill(os.getpid(), signal.SIGKILL)


def _watch(lock, command):
    while True:
        time.sleep(_PERIOD)
        _check_holder(lock, command)


def _check_holder(lock, command):
    with contextlib.suppress(OSError):  # of a shared folder that is away for a moment
        if lock.read_text() != command:
            os.kill(os.getpid(), signal.SIGKILL)
