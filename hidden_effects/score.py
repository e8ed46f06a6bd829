"""Score of verdicts against the truth: the answers that were right, how often, and how sure that is.

``python hidden_effects/score.py --results results/hidden-effects`` reads the truth of every
case of the plan and the verdict on it, writes the track record and the tables of its page, and prints them. Nothing
else opens a truth.
"""

import argparse
import datetime
import json
import os
import subprocess
import sys
from pathlib import Path

from case_files import PAGE, ROOT, TRACK_RECORD, load_plan, truth_of, verdict_of
from score_figures import Scored, figures
from track_record_text import as_markdown, with_block

from blockshake.diagnosis.verdict.track_record import TrackRecord, procedure_digest, write_track_record
from blockshake.diagnosis.verdict.verdict import load_verdict
from blockshake.errors import InputError
from blockshake.files import write_text


def score_plan(plan, results):
    """Every case of a plan with its verdict.

    Raises
    ------
    InputError
        A case whose truth or verdict is missing.
    """
    scored = [_scored(results, entry.name, None) for entry in plan.cases]
    return scored + [_scored(results, name, _truth(results, name)["truth"]) for name in plan.removed]


def _scored(results, name, without):
    verdict = load_verdict(verdict_of(results, name, without))
    return Scored(name, _truth(results, name), verdict, without is not None)


def _truth(results, name):
    path = truth_of(results, name) / "truth.json"
    if not path.is_file():
        raise InputError(path, "", "expected the truth of a case that is in the plan")
    return json.loads(path.read_text())


def make_track_record(scored, efforts, seeds):
    """Track record of scored cases, of today, this machine and these sources."""
    commit = subprocess.run(
        ["git", "describe", "--always", "--dirty", "--abbrev=12"],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    return TrackRecord(
        date=datetime.date.today().isoformat(),
        commit=commit.stdout.strip() or "not under version control",
        procedure=procedure_digest(),
        machine=f"{os.cpu_count()} cores",
        efforts=efforts,
        seeds=seeds,
        **figures(scored),
    )


def main(arguments):
    """Score a finished run of the plan, as the command line says."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--results", type=Path, required=True, help="folder of the cases and their verdicts")
    parser.add_argument("--track-record", type=Path, default=TRACK_RECORD)
    parser.add_argument("--page", type=Path, default=PAGE)
    asked = parser.parse_args(arguments)
    plan = load_plan()
    record = make_track_record(score_plan(plan, asked.results), plan.efforts, plan.digest)
    write_track_record(asked.track_record, record)
    write_text(asked.page, with_block(asked.page.read_text(encoding="utf-8"), "figures", as_markdown(record)))
    sys.stdout.write(as_markdown(record) + "\n")


if __name__ == "__main__":
    main(sys.argv[1:])
