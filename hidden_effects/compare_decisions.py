"""Two decisions beside each other: the shares of right and wrong answers that each gives on the same cases.

``python hidden_effects/compare_decisions.py --results results/hidden-effects --verdicts old=FOLDER new=FOLDER`` reads
``FOLDER/NAME/verdict.json`` of every case of the plan, of any version of the verdict, and prints the table.
"""

import argparse
import sys
from pathlib import Path

from answers import Scored
from case_files import SEEDS, load_plan, truth_of
from score_figures import figures

from blockshake.diagnosis.verdict.verdict import Verdict
from blockshake.files import load_json

SHARES = (
    "false_alarms", "confidently_wrong", "truth_in_set", "exact_large_alone", "outside_unknown", "outside_named",
    "pairs_one", "pairs_both",
)  # fmt: skip


def table(scored):
    """Markdown of the shares by decision; ``scored``: lists of `Scored` by the name of the decision."""
    shares = {name: figures(cases)["shares"] for name, cases in scored.items()}
    lines = [f"| figure | {' | '.join(scored)} |", f"| --- |{' ---: |' * len(scored)}"]
    for key in SHARES:
        cells = [f"{own[key].hits} of {own[key].n}" for own in shares.values()]
        lines.append(f"| {next(iter(shares.values()))[key].meaning} | {' | '.join(cells)} |")
    return "\n".join(lines)


def read_verdict(path):
    """Decision and causes of a verdict of any version, without what only the newest states."""
    file = load_json(path)
    return Verdict.model_construct(decision=file["decision"], causes=tuple(file["causes"]))


def main(arguments):
    """Print the table, as the command line says."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--results", type=Path, required=True, help="folder of the cases")
    parser.add_argument("--seeds", type=Path, default=SEEDS, help="the plan")
    parser.add_argument("--verdicts", nargs="+", metavar="NAME=FOLDER", required=True)
    asked = parser.parse_args(arguments)
    truths = {
        case.name: load_json(truth_of(asked.results, case.name)) for case in load_plan(asked.seeds).cases
    }
    scored = {}
    for given in asked.verdicts:
        name, _, folder = given.partition("=")
        scored[name] = [
            Scored(case, truth, read_verdict(Path(folder) / case / "verdict.json"))
            for case, truth in truths.items()
        ]
    sys.stdout.write(table(scored) + "\n")


if __name__ == "__main__":
    main(sys.argv[1:])
