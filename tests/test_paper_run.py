"""The paper's run beside its estimate: finished parts alone and the whole, by the logs of the jobs."""

import os
import sys
from pathlib import Path

import pytest

TOLD = """\
part                                runs  CPU min
samples of configuration-1, ls-dem  20    2.0
samples of configuration-2, ls-dem  20    1.0
twin of configuration-1, ls-dem     2     0.2
calibration of configuration-1, nscd-rigid  200   1.0
jobs beside their runs              30    10.0
config/paper.yaml: about 14 CPU minutes on this machine, 7 min on 2 cores
"""


@pytest.fixture
def paper_run(monkeypatch):
    monkeypatch.syspath_prepend(str(Path(__file__).parents[1] / "bench"))
    import paper_run

    yield paper_run
    sys.modules.pop("paper_run")


@pytest.fixture
def study(tmp_path):
    """A study whose jobs have ended, without results."""
    logs = tmp_path / "logs" / "paper"
    _write(logs / "estimate.txt", TOLD)
    samples = logs / "simulate_batch" / "ls-dem" / "configuration-1"
    _log(samples / "000-009.log", cpu=60.0, begin=1000.0, end=1200.0)
    _log(samples / "010-019.log", cpu=90.0, begin=1100.0, end=1300.0)
    _log(samples / "half-step.log", cpu=24.0, begin=1320.0, end=1345.0)
    _log(
        logs / "compare_open_tests" / "nscd-rigid" / "configuration-1.log", cpu=30.0, begin=9000.0, end=9135.0
    )
    return tmp_path


def _log(path, *, cpu, begin, end):
    _write(path, f"python 3\nTook {end - begin:.2f} s, {cpu} CPU s.\n")
    os.utime(path, (end, end))


def _write(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)


def test_nothing_stands_there_before_a_part_is_finished(paper_run, study):
    assert paper_run.paper_rows(study) == []


def test_nothing_stands_there_without_an_estimate(paper_run, study):
    _write(study / "results" / "paper" / "samples" / "ls-dem" / "configuration-1.nc", "samples")
    (study / "logs" / "paper" / "estimate.txt").unlink()
    assert paper_run.paper_rows(study) == []


def test_finished_parts_stand_beside_their_estimate(paper_run, study):
    results = study / "results" / "paper"
    _write(results / "samples" / "ls-dem" / "configuration-1.nc", "samples")
    _write(results / "runs" / "ls-dem" / "configuration-1" / "half-step.nc", "twin")
    _write(results / "open-tests" / "nscd-rigid" / "configuration-1.nc", "open tests")
    samples, twin, calibration, whole = paper_run.paper_rows(study)
    assert samples[:5] == ("samples of configuration-1, ls-dem", "20", "2.0", "2.5", "1.25")
    # 0.2 min may be 0.15 or 0.25: no ratio
    assert twin[:5] == ("twin of configuration-1, ls-dem", "2", "0.2", "0.4", "")
    assert calibration[:5] == ("calibration of configuration-1, nscd-rigid", "200", "1.0", "0.5", "0.50")
    assert len({samples[5], twin[5], calibration[5]}) == 3
    assert whole == ("CPU time of all of these", 222, "3.2", "3.4", "1.06", "")
    assert len(samples) == len(paper_run.HEADER)


def test_whole_study_counts_the_time_in_which_jobs_ran(paper_run, study):
    _write(study / "reports" / "paper.pdf", "report")
    [whole] = paper_run.paper_rows(study)
    # 1000 to 1345 s with 20 s between two jobs; the hours until the command was typed again do not count
    assert whole[:5] == ("duration of the whole study on 2 cores", "", "7.0", "8.0", "1.14")
