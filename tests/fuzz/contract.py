"""The contract of all readers of users' files: read, or refuse in one line; soon, in little memory, in one folder."""

import contextlib
import io
import os
import resource
import signal
import sys
import tempfile
import time
import warnings
from pathlib import Path

import matplotlib

from blockshake.caches import kernel_folder
from blockshake.cli import BAD_INPUT, NUMERICAL_FAILURE, main
from blockshake.errors import InputError

LIMIT = 5.0  # s of CPU time
MEMORY = 2 * 2**30  # bytes beyond those that the process has
_PROGRAMS = (
    "subprocess.Popen",
    "os.system",
    "os.exec",
    "os.posix_spawn",
    "os.fork",
    "socket.connect",
    "webbrowser.open",
)
_MOVES = (
    "os.rename",
    "os.remove",
    "os.rmdir",
    "os.mkdir",
    "os.symlink",
    "os.link",
    "os.chmod",
    "os.truncate",
)
_WRITES = os.O_WRONLY | os.O_RDWR | os.O_CREAT | os.O_TRUNC | os.O_APPEND


class TooLong(BaseException):
    """More CPU time than a refusal may take."""


# requested now: matplotlib makes the folder, which a watch would watch
_PICTURES = Path(matplotlib.get_cachedir()).resolve()


class _Watch:
    """Deeds that Python reports while a reader runs: writes outside of a folder, reads of secrets, programs."""

    def __init__(self):
        self.folder, self.secrets, self.seen = None, (), []
        sys.addaudithook(self)

    def __call__(self, event, arguments):
        if self.folder is None:
            return
        if event == "open" and isinstance(arguments[0], (str, bytes)):
            path = os.path.realpath(os.fsdecode(arguments[0]))
            mode, flags = arguments[1] or "", arguments[2] or 0
            if path in self.secrets:
                self.seen.append(f"reads {path}")
            if (set(mode) & set("wax+") or flags & _WRITES) and not self._own(path):
                self.seen.append(f"writes {path}")
        elif event in _MOVES and isinstance(arguments[0], (str, bytes)):
            named = arguments[:2] if event == "os.rename" else arguments[:1]
            self.seen += [
                f"{event} {path}" for path in named if not self._own(os.path.realpath(os.fsdecode(path)))
            ]
        elif event in _PROGRAMS:
            self.seen.append(f"{event} {arguments}")

    def _own(self, path):
        kept = self.folder, kernel_folder("").resolve(), "/dev", _PICTURES
        return "__pycache__" in path or any(Path(path).is_relative_to(own) for own in kept)


_WATCH = _Watch()


@contextlib.contextmanager
def watched(folder, secrets=()):
    """Let a reader run: no write outside of a folder, no secret read, no program started, limits of time and memory."""
    folder = Path(folder).resolve()
    pages = int(Path("/proc/self/statm").read_text().split()[0])
    before = resource.getrlimit(resource.RLIMIT_AS)
    resource.setrlimit(resource.RLIMIT_AS, (pages * resource.getpagesize() + MEMORY, before[1]))
    old = signal.signal(signal.SIGPROF, _too_long)
    signal.setitimer(signal.ITIMER_PROF, LIMIT)
    _WATCH.folder, _WATCH.secrets, _WATCH.seen = (
        str(folder),
        {str(Path(one).resolve()) for one in secrets},
        [],
    )
    begin = time.process_time()
    try:
        yield
        assert _WATCH.seen == []
        assert time.process_time() - begin < LIMIT
    finally:
        _WATCH.folder = None
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        signal.signal(signal.SIGPROF, old)
        resource.setrlimit(resource.RLIMIT_AS, before)


def _too_long(*_):
    raise TooLong


def run_command(arguments, folder, secrets=(), codes=(0, BAD_INPUT)):
    """Exit code of a command in a folder, and its words; a refusal is one line and no warning."""
    said, complained = io.StringIO(), io.StringIO()
    with (
        contextlib.chdir(folder),
        contextlib.redirect_stdout(said),
        contextlib.redirect_stderr(complained),
        warnings.catch_warnings(record=True) as warned,
        watched(folder, secrets),
    ):
        warnings.simplefilter("always")
        code = main([str(one) for one in arguments])
    assert code in codes, complained.getvalue()
    said.getvalue().encode()
    if code == BAD_INPUT:
        is_one_line(complained.getvalue().removesuffix("\n").removeprefix("blockshake: "))
        assert [str(one.message) for one in warned] == []
    return code, said.getvalue(), complained.getvalue()


def is_one_line(words):
    """Refusals are one line that a person can read."""
    assert words.isprintable(), words
    assert 0 < len(words) <= 1000, words[:2000]


def read_or_refused(load, folder, secrets=()):
    """Whether a reader took its input, or refused it with `InputError`; anything else fails."""
    with warnings.catch_warnings(record=True) as warned, watched(folder, secrets):
        warnings.simplefilter("always")
        try:
            load()
        except InputError as error:
            is_one_line(str(error))
            assert [str(one.message) for one in warned] == []
            return False
    return True


def scratch():
    """A new folder for one mutation."""
    return tempfile.TemporaryDirectory(prefix="blockshake-fuzz-")


__all__ = [
    "BAD_INPUT", "NUMERICAL_FAILURE", "TooLong", "is_one_line", "read_or_refused", "run_command", "scratch", "watched",
]  # fmt: skip
