"""The paper's run beside its estimate: finished parts alone, by the logs of their jobs."""

import sys
from pathlib import Path

import pytest

from blockshake.cost.part import Part

PARTS = (
    Part("samples of configuration-1, ls-dem", 20, 120.0),
    Part("samples of configuration-2, ls-dem", 20, 60.0),
    Part("mean friction of configuration-1", 200, 60.0),
    Part("jobs beside their runs", 30, 600.0),
)


@pytest.fixture
def paper_run(monkeypatch):
    monkeypatch.syspath_prepend(str(Path(__file__).parents[1] / "bench"))
    import paper_run

    monkeypatch.setattr(paper_run, "study_cost", lambda path: list(PARTS))
    yield paper_run
    sys.modules.pop("paper_run")


def _took(seconds):
    return f"python 3\nTook 100.0 s, {seconds} CPU s.\n"


def _write(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)


def test_finished_parts_stand_beside_their_estimate(paper_run, tmp_path):
    logs, results = tmp_path / "logs" / "paper", tmp_path / "results" / "paper"
    for place, seconds in enumerate((60.0, 90.0)):
        _write(logs / "simulate_batch" / "ls-dem" / "configuration-1" / f"{place}.log", _took(seconds))
    _write(logs / "calibrate_friction" / "configuration-1.log", _took(30.0))
    assert paper_run.paper_rows(tmp_path) == []
    _write(results / "samples" / "ls-dem" / "configuration-1.nc", "samples")
    _write(results / "friction" / "configuration-1.json", "{}")
    first, second, whole = paper_run.paper_rows(tmp_path)
    assert first[:5] == ("samples of configuration-1, ls-dem", 20, "2.0", "2.5", "1.25")
    assert second[:5] == ("mean friction of configuration-1", 200, "1.0", "0.5", "0.50")
    assert first[5] != second[5]
    assert whole == ("all of these", 220, "3.0", "3.0", "1.00", "")
    assert len(first) == len(paper_run.HEADER)
