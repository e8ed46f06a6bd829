"""Two commands at once in one folder, studies and diagnoses: the second is refused in a line, the first ends well."""

import os
import shutil
import signal
import time

import pytest
from ledger import DONE
from likeness import files
from work import WORKS, start

pytestmark = pytest.mark.faults
# rules that both have something to do for
AGAIN = {"study": ("-R", "make_report"), "diagnosis": ("-R", "make_diagnosis_report")}


@pytest.fixture(scope="module")
def both(whole, tmp_path_factory):
    """A folder with a finished study and a finished diagnosis."""
    study, diagnosis = whole("study").checkout, whole("diagnosis").checkout
    checkout = diagnosis.copied(tmp_path_factory.mktemp("both") / "copy")
    for name in ("results", "reports", ".snakemake"):
        shutil.copytree(study.folder / name, checkout.folder / name, dirs_exist_ok=True)
    return checkout


@pytest.mark.parametrize("second", WORKS)
@pytest.mark.parametrize("first", WORKS)
def test_a_second_command_is_refused_and_the_first_ends(first, second, both):
    lock = both.folder / ".snakemake" / "command.lock"
    before = lock.read_text()
    results = {
        path: path.stat().st_mtime_ns for path in files(both.folder / "results", ".nc", ".json", ".csv")
    }
    running = start(both, first, *AGAIN[first])
    while lock.read_text() in (before, ""):
        assert running.poll() is None
        time.sleep(0.05)
    os.kill(running.pid, signal.SIGSTOP)  # it holds the folder until the second has come so far
    answer = both.snakemake(*WORKS[second], *AGAIN[second])
    os.kill(running.pid, signal.SIGCONT)
    said, _ = running.communicate()
    DONE[f"{second} begun in the folder of a running {first}"] += 1
    assert answer.returncode == 2
    lines = [line for line in (answer.stdout + answer.stderr).splitlines() if line.startswith("blockshake:")]
    assert len(lines) == 1
    assert "expected a folder in which no other study or diagnosis runs" in lines[0]
    assert running.returncode == 0, said
    assert {path: path.stat().st_mtime_ns for path in results} == results
