"""Score of verdicts against the truth: the answers that were right, how often, and how sure that is.

``python hidden_effects/score.py --results results/hidden-effects`` reads the truth of every case of the plan and the
verdict on it, prints the tables, and writes the track record and its page, of the sealed plan alone. Nothing else
opens a truth.
"""

import argparse
import datetime
import os
import subprocess
import sys
from pathlib import Path

from answers import Scored
from case_files import PAGE, ROOT, SEEDS, TRACK_RECORD, load_plan, truth_of, verdict_of
from score_figures import figures
from scored_record import ScoredRecord, write_scored_record
from track_record_text import as_markdown, with_block

from blockshake.diagnosis.verdict.track_record import procedure_digest
from blockshake.diagnosis.verdict.verdict import load_verdict
from blockshake.files import load_json, write_text


def score_plan(plan, results):
    """Every case of a plan with its truth and verdict.

    Raises
    ------
    InputError
        A case whose truth or verdict is missing.
    """
    names = [case.name for case in plan.cases]
    return [
        Scored(name, load_json(truth_of(results, name)), load_verdict(verdict_of(results, name)))
        for name in names
    ]


def make_track_record(scored, efforts, seeds):
    """Track record of scored cases, with efforts by structure and the plan's digest: of today and these sources."""
    commit = subprocess.run(
        ["git", "describe", "--always", "--dirty", "--abbrev=12"], cwd=ROOT, capture_output=True, text=True, check=False
    )  # fmt: skip
    return ScoredRecord(
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
    parser.add_argument("--seeds", type=Path, default=SEEDS, help="the plan")
    parser.add_argument("--track-record", type=Path, default=TRACK_RECORD)
    parser.add_argument("--page", type=Path, default=PAGE)
    asked = parser.parse_args(arguments)
    plan = load_plan(asked.seeds)
    record = make_track_record(score_plan(plan, asked.results), plan.efforts, plan.digest)
    text = as_markdown(record)
    sys.stdout.write(text + "\n")
    if asked.seeds == SEEDS:
        write_scored_record(asked.track_record, record)
        write_text(asked.page, with_block(asked.page.read_text(encoding="utf-8"), "figures", text))


if __name__ == "__main__":
    main(sys.argv[1:])
