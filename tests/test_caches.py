"""Where compiled kernels and libraries' caches go: named folder, user's cache, a temporary folder, nowhere."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from blockshake import caches
from blockshake.caches import kernel_folder, set_cache_home

NONE = "/proc/none"  # a folder that nobody can make, root included
ASK = """
import numpy as np
from blockshake.dynamics.free_motion import drift_into
from blockshake.jit import kernel
position, orientation, spin = np.zeros(3), np.array([1.0, 0.0, 0.0, 0.0]), np.zeros(3)
drift = kernel(drift_into)
drift(np.eye(3), spin, np.array([0.0, 0.0, np.pi]), spin.copy(), 1.0, position, orientation)
print(orientation[3], sum(drift.stats.cache_hits.values()))
"""


@pytest.fixture
def place(monkeypatch, tmp_path):
    """A user without any folder but a temporary one."""
    for name in ("XDG_CACHE_HOME", "BLOCKSHAKE_CACHE", "MPLCONFIGDIR"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("HOME", NONE)
    monkeypatch.setattr(caches.tempfile, "tempdir", str(tmp_path))
    return tmp_path


def test_the_named_folder_is_first_then_the_users_cache(place, monkeypatch):
    monkeypatch.setenv("HOME", str(place / "home"))
    assert kernel_folder("d") == place / "home" / ".cache" / "blockshake" / "d"
    monkeypatch.setenv("XDG_CACHE_HOME", str(place / "xdg"))
    assert kernel_folder("d") == place / "xdg" / "blockshake" / "d"
    for ignored in ("", "relative"):
        monkeypatch.setenv("XDG_CACHE_HOME", ignored)
        assert kernel_folder("d") == place / "home" / ".cache" / "blockshake" / "d"
    monkeypatch.setenv("BLOCKSHAKE_CACHE", str(place / "named"))
    assert kernel_folder("d") == place / "named" / "d"
    monkeypatch.setenv("BLOCKSHAKE_CACHE", "")
    assert kernel_folder("d").is_relative_to(place / "home")


def test_a_named_folder_that_takes_nothing_is_passed_over_unless_it_holds_the_kernels(
    place, monkeypatch, caplog
):
    monkeypatch.setenv("XDG_CACHE_HOME", str(place))
    monkeypatch.setenv("BLOCKSHAKE_CACHE", NONE)
    assert kernel_folder("d") == place / "blockshake" / "d"
    assert f"BLOCKSHAKE_CACHE: {NONE} cannot be written to" in caplog.text
    # a folder of /proc stands for a read-only one
    monkeypatch.setenv("BLOCKSHAKE_CACHE", "/proc")
    assert kernel_folder("self") == Path("/proc/self")


def test_without_a_home_a_temporary_folder_of_the_user_alone_is_taken_with_a_remark(place, caplog):
    set_cache_home()
    folder = place / f"blockshake-{os.getuid()}"
    assert os.environ["XDG_CACHE_HOME"] == str(folder)
    assert os.environ["MPLCONFIGDIR"] == str(folder / "matplotlib")
    assert folder.stat().st_mode & 0o777 == 0o700
    assert caplog.text.count("no cache of the user can be written to") == 1
    # it is the user's cache from now on, for the processes that this one starts too
    set_cache_home()
    assert caplog.text.count("no cache of the user can be written to") == 1
    assert kernel_folder("d") == folder / "blockshake" / "d"


@pytest.mark.parametrize("trap", ["open to others", "a link"])
def test_a_folder_that_others_can_write_to_is_not_taken(place, trap):
    """Kernels are code: a folder laid out by another user in the temporary ones would run it."""
    laid = place / f"blockshake-{os.getuid()}"
    if trap == "a link":
        (place / "elsewhere").mkdir(mode=0o700)
        laid.symlink_to(place / "elsewhere")
    else:
        laid.mkdir()
        laid.chmod(0o777)
    set_cache_home()
    assert Path(os.environ["XDG_CACHE_HOME"]).parent == place
    assert os.environ["XDG_CACHE_HOME"] != str(laid)


def test_a_user_that_the_system_does_not_know(place, monkeypatch):
    """As in a container with a number for a user: without HOME, Python finds no home at all."""

    def homeless():
        raise RuntimeError("Could not determine home directory.")

    monkeypatch.delenv("HOME")
    monkeypatch.setattr(Path, "home", homeless)
    set_cache_home()
    assert Path(os.environ["XDG_CACHE_HOME"]).parent == place


def test_where_nothing_can_be_written_nothing_is_set(place, monkeypatch):
    monkeypatch.setattr(caches.tempfile, "tempdir", NONE)
    set_cache_home()
    assert "XDG_CACHE_HOME" not in os.environ
    assert kernel_folder("d") == Path(NONE) / ".cache" / "blockshake" / "d"


def _python(arguments, folder, **environment):
    """A process without a home: whether it ended well, and what it said and complained of."""
    kept = {key: value for key, value in os.environ.items() if key not in ("XDG_CACHE_HOME", "MPLCONFIGDIR")}
    return subprocess.run(
        [sys.executable, *arguments], cwd=folder, env={**kept, "HOME": NONE, **environment}, check=False,
        capture_output=True, text=True, timeout=300,
    )  # fmt: skip


def test_kernels_that_cannot_be_kept_are_compiled_in_every_process(tmp_path):
    done = _python(["-c", ASK], tmp_path, BLOCKSHAKE_CACHE="/proc/none", XDG_CACHE_HOME=str(tmp_path))
    assert done.stdout.split() == ["1.0", "0"], done.stderr
    assert "/proc/none cannot be written to" in done.stderr
    full = _python(
        ["-c", ASK], tmp_path, BLOCKSHAKE_CACHE="", XDG_CACHE_HOME="/proc/none", TMPDIR=str(tmp_path)
    )
    assert full.stdout.split() == ["1.0", "0"], full.stderr
    again = _python(["-c", ASK], tmp_path, BLOCKSHAKE_CACHE="", TMPDIR=str(tmp_path))
    assert again.stdout.split() == ["1.0", "1"], again.stderr


def test_a_cache_on_a_full_disk_or_without_permission_keeps_nothing(tmp_path):
    """The folder of the sources is there, and cannot be written to."""
    ask = "import blockshake.caches as c\nfrom pathlib import Path\nc.kernel_folder = lambda d: Path('/proc/self')\n"
    done = _python(["-c", ask + ASK], tmp_path, TMPDIR=str(tmp_path))
    assert done.stdout.split() == ["1.0", "0"], done.stderr
    assert done.stderr.count("compiled kernels are not kept in /proc") == 1


@pytest.mark.parametrize(
    "command",
    [
        ["parameters"],
        ["simulate", "--structure", "configuration-1", "--motion", "alkion", "--duration", "0.05",
         "--model", "nscd-rigid", "--output", "r.nc"],
        ["plot", "RUN", "--output", "a.png"],
    ],
    ids=lambda command: command[0],
)  # fmt: skip
def test_commands_run_without_a_home(command, tmp_path, leaning_file):
    """With nothing of a cache, with Numba's and with Matplotlib's; the kernels are there, and none is compiled."""
    command = [str(leaning_file) if word == "RUN" else word for word in command]
    done = _python(
        ["-m", "blockshake", *command],
        tmp_path,
        BLOCKSHAKE_CACHE=str(kernel_folder("")),
        TMPDIR=str(tmp_path),
    )
    assert done.returncode == 0, done.stderr
    assert "Traceback" not in done.stderr
    assert done.stderr.splitlines()[0].startswith("no cache of the user can be written to; ")
    assert "atplotlib" not in done.stderr
