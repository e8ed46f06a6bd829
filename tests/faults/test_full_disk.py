"""A disk that is full, or that takes no writing: one line, nothing lost, and the same command ends once there is room.

The results are on a file system in memory of their own, which needs the right to mount one.
"""

import shutil
import subprocess
import sys

import pytest
from ledger import DONE
from likeness import unlike
from work import WORKS, checkout_with_campaign

pytestmark = pytest.mark.faults


@pytest.fixture
def small_disk(tmp_path):
    """A checkout whose results are on a file system of their own, and a function that changes its options."""
    checkout = checkout_with_campaign(tmp_path / "small-disk")
    results = checkout.folder / "results"
    results.mkdir()
    if not sys.platform.startswith("linux") or _mount("-t", "tmpfs", "-o", "size=1m", "none", results):
        pytest.skip("no right to mount a file system")
    yield checkout, lambda options: _mount("-o", f"remount,{options}", results)
    subprocess.run([shutil.which("umount"), results], check=True)


def _mount(*arguments):
    return subprocess.run([shutil.which("mount"), *arguments], capture_output=True, check=False).returncode


def _lines(answer):
    return [line for line in (answer.stdout + answer.stderr).splitlines() if line.startswith("blockshake:")]


@pytest.mark.parametrize(
    ("fault", "mended", "words"),
    [
        ("size=1m", "size=200m", "expected room to write to; the disk is full"),
        ("ro", "rw,size=200m", "expected a folder to write to"),
    ],
)
def test_results_that_cannot_be_written(fault, mended, words, small_disk, whole):
    checkout, remount = small_disk
    assert remount(fault) == 0
    answer = checkout.snakemake(*WORKS["study"])
    DONE[f"study: results on a disk with {fault}"] += 1
    assert answer.returncode in (1, 2)
    assert _lines(answer), answer.stdout + answer.stderr
    assert all(words in line for line in _lines(answer)), _lines(answer)
    # jobs that are interrupted with the one that failed may show where they were
    assert "Traceback" not in answer.stderr.rpartition("Not finished.")[2]
    assert remount(mended) == 0
    answer = checkout.snakemake(*WORKS["study"])
    assert answer.returncode == 0, answer.stdout + answer.stderr
    assert unlike(whole("study").checkout.folder, checkout.folder) == []
