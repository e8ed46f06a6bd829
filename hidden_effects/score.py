"""Score of verdicts against the truth: the answers that were right, how often, and how sure that is.

``python hidden_effects/score.py --results results/hidden-effects`` reads the truth of every case of the plan and the
verdict on it, prints the tables, and writes the track record, its page and the README's paragraph, of the sealed plan
alone. ``--verdicts DIR`` scores the verdicts of another program, ``DIR/NAME/verdict.json`` as of `answer_file`.
"""

import argparse
import datetime
import os
import subprocess
import sys
from pathlib import Path

from answer_file import load_answer
from answers import Scored
from case_files import PAGE, README, ROOT, SEEDS, TRACK_RECORD, failure_of, load_plan, truth_of, verdict_of
from make_case import LABORATORIES
from oracle_gain import gains_of, load_gains
from score_figures import figures
from scored_record import ScoredRecord, write_scored_record
from track_record_text import as_markdown, in_words, with_block

from blockshake.diagnosis.verdict.track_record import WHOLE, procedure_digest
from blockshake.files import load_json, write_text


def score_plan(plan, results, verdicts=None):
    """Every case of a plan with its truth, and its verdict and gains, or its verdict of another program.

    A case that could not be made or diagnosed, as its file of the failure has it, is left out.

    Raises
    ------
    InputError
        A case whose truth or verdict is missing.
    """
    if verdicts is not None:
        return [
            Scored(
                case.name, load_json(truth_of(results, case.name)), load_answer(verdicts / case.name / "verdict.json")
            )
            for case in plan.cases
        ]  # fmt: skip
    return [
        Scored(
            case.name, load_json(truth_of(results, case.name)), load_answer(verdict_of(results, case.name)),
            load_gains(gains_of(results, case.name)),
        )
        for case in plan.cases
        if verdict_of(results, case.name).is_file() or not failure_of(results, case.name).is_file()
    ]  # fmt: skip


def make_track_record(scored, plan):
    """Track record of the scored cases of a plan: of today and these sources."""
    commit = subprocess.run(
        ["git", "describe", "--always", "--dirty", "--abbrev=12"], cwd=ROOT, capture_output=True, text=True, check=False
    )  # fmt: skip
    return ScoredRecord(
        date=datetime.date.today().isoformat(),
        commit=commit.stdout.strip() or "not under version control",
        procedure=procedure_digest(),
        machine=f"{os.cpu_count()} cores",
        seeds=plan.digest,
        part=plan.part,
        failed=sorted({case.name for case in plan.cases} - {case.name for case in scored}),
        **figures(scored),
    )


def main(arguments):
    """Score a finished run of the plan, as the command line states."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--results", type=Path, required=True, help="folder of the cases and their verdicts")
    parser.add_argument("--seeds", type=Path, default=SEEDS, help="the plan")
    parser.add_argument("--share", default=WHOLE, help="part of the plan, such as 1/4; its strata are kept")
    parser.add_argument("--laboratory", choices=list(LABORATORIES), help="this one alone")
    parser.add_argument("--verdicts", type=Path, help="of another program, NAME/verdict.json by case")
    parser.add_argument("--track-record", type=Path, default=TRACK_RECORD)
    parser.add_argument("--page", type=Path, default=PAGE)
    parser.add_argument("--readme", type=Path, default=README)
    asked = parser.parse_args(arguments)
    plan = load_plan(asked.seeds).chosen(asked.share, asked.laboratory)
    record = make_track_record(score_plan(plan, asked.results, asked.verdicts), plan)
    text = as_markdown(record)
    sys.stdout.write(text + "\n")
    if asked.seeds == SEEDS and asked.verdicts is None and asked.laboratory is None:
        write_scored_record(asked.track_record, record)
        for path, block, words in ((asked.page, "figures", text), (asked.readme, "record", in_words(record))):
            write_text(path, with_block(path.read_text(encoding="utf-8"), block, words))


if __name__ == "__main__":
    main(sys.argv[1:])
