"""Clean campaigns whose blocks have hollow faces, each depth by itself; the null hypothesis draws hollows of its own.

``python hidden_effects/judge_hollow_faces.py --cores 2`` makes the campaigns by LS-DEM, diagnoses them by the ordinary
rules with the effort ``quick``, and writes the decisions to the page. The seeds are of this program alone.
"""

import argparse
import os
import sys
from pathlib import Path

from case_files import PAGE, ROOT, campaign_of, truth_of, verdict_of
from case_truth import NONE, true_numerics
from make_case import made_by, make_case
from measure_track_record import Log, diagnose
from track_record_text import with_block

from blockshake.diagnosis.verdict.verdict import load_verdict
from blockshake.files import load_json, write_text

DEPTHS = (1e-4, 3e-4, 1e-3, 3e-3)  # m; flat faces to what DIN 18202 allows on a metre
EACH = 6
FIRST_SEED = 91_000
EFFORT = "quick"


def planned():
    """Name, seed and depth [m] of each case; nonsmooth contact has no faces that could be hollow."""
    seeds = (seed for seed in range(FIRST_SEED, FIRST_SEED + 1000) if true_numerics(seed)[0] == "ls-dem")
    return [
        (f"hollow-{1e6 * depth:04.0f}um-{place}", next(seeds), depth)
        for depth in DEPTHS
        for place in range(EACH)
    ]


def table(verdicts):
    """Markdown of the decisions by depth; ``verdicts``: lists of `Verdict` by depth [m]."""
    rows = ["| hollow [mm] | campaigns | no effect | called |", "| --- | ---: | ---: | --- |"]
    for depth, judged in verdicts.items():
        called = [one for one in judged if one.decision != "none"]
        words = [", ".join(one.causes) or one.decision for one in called]
        rows.append(
            f"| {1e3 * depth:g} | {len(judged)} | {len(judged) - len(called)} | {'; '.join(words) or 'nothing'} |"
        )
    return "\n".join(rows)


def _is_made(folder, truth_folder, seed, depth):
    """Whether a case is there whole and of today's sources."""
    truth = truth_folder / "truth.json"
    if not truth.is_file() or not (folder / "README").is_file():
        return False
    told = load_json(truth)
    return (told["made_by"], told["seed"], told.get("hollow")) == (made_by(), seed, depth)


def main(arguments):
    """Make, diagnose and tabulate the cases."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--output", type=Path, default=ROOT / "results" / "hidden-effects")
    parser.add_argument("--cores", type=int, default=os.cpu_count())
    asked = parser.parse_args(arguments)
    cases, log = planned(), Log(asked.output / "log.jsonl")
    for name, seed, depth in cases:
        places = campaign_of(asked.output, name), truth_of(asked.output, name)
        if not _is_made(*places, seed, depth):
            make_case(seed, NONE, "large", *places, sealed=False, hollow=depth)
            log("made", case=name)
    diagnose([name for name, *_ in cases], asked.output, EFFORT, asked.cores, None, log)
    verdicts = {depth: [] for depth in DEPTHS}
    for name, _, depth in cases:
        verdicts[depth].append(load_verdict(verdict_of(asked.output, name)))
    write_text(PAGE, with_block(PAGE.read_text(encoding="utf-8"), "hollow", table(verdicts)))


if __name__ == "__main__":
    main(sys.argv[1:])
