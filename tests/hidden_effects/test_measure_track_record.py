"""The record's runner: a case that fails holds up no other, and is tried again by the next run."""

import json

import measure_track_record
from case_files import PlannedCase, failure_of
from measure_track_record import Log

CASES = [PlannedCase(name=f"case-{number}", seed=number) for number in (1, 2)]


def half(results, case):
    """A step that fails in the first case alone."""
    if case.seed == 1:
        raise ValueError("it is the first")


def test_a_case_that_fails_holds_up_no_other(tmp_path):
    log = Log(tmp_path / "log.jsonl")
    measure_track_record._each(half, "done", CASES, tmp_path, 1, log)
    lines = [json.loads(line) for line in (tmp_path / "log.jsonl").read_text().splitlines()]
    assert [(line["step"], line["case"]) for line in lines] == [("failed", "case-1"), ("done", "case-2")]
    assert json.loads(failure_of(tmp_path, "case-1").read_text())["reason"] == "ValueError: it is the first"
    assert not failure_of(tmp_path, "case-2").exists()
