"""Track record of the diagnosis: make every case of a plan, diagnose it as a user would, and score it.

``python hidden_effects/measure_track_record.py --output results/hidden-effects --cores 2`` goes on where it was cut
short. Every step is a line of ``log.jsonl`` in that folder. ``--make-only`` leaves the verdicts to others.
"""

import argparse
import json
import os
import subprocess
import sys
import time
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from multiprocessing import get_context
from pathlib import Path
from types import SimpleNamespace

import score
from case_files import ROOT, SEEDS, campaign_of, load_plan, truth_of, verdict_of
from make_case import made_by, make_case

from blockshake.diagnosis import steps
from blockshake.diagnosis.answer.decision import freeze, write_decision
from blockshake.diagnosis.verdict.verdict import write_verdict
from blockshake.files import write_json

ENVIRONMENT = {
    **os.environ,
    **dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1"),
    "PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}",
}


class Log:
    """Log of steps: one JSON object a line, kept from run to run, and one line on the terminal."""

    def __init__(self, path):
        self.path, self.start = Path(path), time.monotonic()
        self.path.parent.mkdir(parents=True, exist_ok=True)

    def __call__(self, step, **facts):
        """Write a step and its facts."""
        line = {"at": time.strftime("%Y-%m-%dT%H:%M:%S"), "step": step, **facts}
        with self.path.open("a", encoding="utf-8") as file:
            file.write(json.dumps(line) + "\n")
        words = " ".join(f"{key} {value}" for key, value in facts.items())
        sys.stdout.write(f"[{(time.monotonic() - self.start) / 60.0:5.1f} min] {step} {words}\n")
        sys.stdout.flush()


def make_cases(cases, results, cores, log):
    """Make the cases that are missing or that other sources made, in their order.

    Parameters
    ----------
    cases : sequence of PlannedCase
    results : Path
    cores : int
        Cases at a time.
    log : Log
    """
    maker = made_by()
    due = [case for case in cases if not _is_made(case, results, maker)]
    log("cases", due=len(due), ready=len(cases) - len(due), maker=maker)
    with ProcessPoolExecutor(cores, get_context("spawn")) as pool:
        for name, seconds in pool.map(partial(_make, results), due):
            log("made", case=name, cpu_seconds=round(seconds, 1))


def _make(results, case):
    """Name of a case made, and the CPU time it took [s]."""
    begin = time.process_time()
    make_case(
        case.seed, case.causes, case.size, campaign_of(results, case.name), truth_of(results, case.name).parent,
        case.gain is not None, case.structure, case.hollow, laboratory=case.laboratory, strength=case.strength,
    )  # fmt: skip
    return case.name, time.process_time() - begin


def _is_made(case, results, maker):
    """Whether the case is there whole; its README is written last."""
    truth = truth_of(results, case.name)
    if not truth.is_file() or not (campaign_of(results, case.name) / "README").is_file():
        return False
    true = json.loads(truth.read_text())
    names = tuple(cause["name"] for cause in true["causes"])
    wanted = {
        "made_by": maker, "seed": case.seed, "structure": case.structure, "size": case.size,
        "sealed": case.gain is not None, "hollow": case.hollow, "laboratory": case.laboratory,
        "strength": case.strength,
    }  # fmt: skip
    return names == case.causes and {key: true[key] for key in wanted} == wanted


def diagnose(cases, results, cores, log):
    """The verdict on every case that has none yet: without a simulation several at a time, with simulations in turn.

    Parameters
    ----------
    cases : sequence of PlannedCase
    results : Path
    cores : int
    log : Log
    """
    due = [case for case in cases if not verdict_of(results, case.name).is_file()]
    quick = [case for case in due if case.effort == "quick"]
    with ProcessPoolExecutor(cores, get_context("spawn")) as pool:
        for name, seconds in pool.map(partial(_diagnose_quickly, results), quick):
            log("diagnosed", case=name, effort="quick", seconds=round(seconds, 1))
    for case in due:
        if case.effort != "quick":
            begin = time.monotonic()
            command = [
                "blockshake", "diagnose", str(campaign_of(results, case.name)), "--output",
                str(verdict_of(results, case.name).parent), "--effort", case.effort, "--cores", str(cores),
            ]  # fmt: skip
            subprocess.run(command, cwd=ROOT, env=ENVIRONMENT, check=True)
            log("diagnosed", case=case.name, effort=case.effort, seconds=round(time.monotonic() - begin, 1))


def _diagnose_quickly(results, case):
    """Name of a case diagnosed by the steps of the rules, as at quick effort, and the time it took [s]."""
    begin, folder, out = (
        time.monotonic(),
        campaign_of(results, case.name),
        verdict_of(results, case.name).parent,
    )
    out.mkdir(parents=True, exist_ok=True)
    files = SimpleNamespace(
        parity=str(out / "parity.json"), decision=str(out / "decision.json"), frozen=str(out / "frozen.json"),
        ensembles=[], extended=[], gain=[],
    )  # fmt: skip
    found = steps.decide(str(folder), ())
    write_json(files.parity, found.parity.as_json())
    write_decision(files.decision, found.decision)
    freeze(files.frozen, files.decision, found.decision.tests)
    if case.gain is not None and (found.decision.parts or found.parity.findings):
        gained = steps.measure_gain(str(folder), "quick", files)
        files.gain = [str(out / "gain.json")]
        write_json(files.gain[0], gained.summary.model_dump(mode="json"))
    write_verdict(verdict_of(results, case.name), steps.conclude(str(folder), 0, files))
    return case.name, time.monotonic() - begin


def main(arguments):
    """Make, diagnose and score the plan, as the command line says."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--output", type=Path, default=ROOT / "results" / "hidden-effects")
    parser.add_argument("--seeds", type=Path, default=SEEDS, help="the plan")
    parser.add_argument("--make-only", action="store_true", help="neither diagnose nor score")
    parser.add_argument("--cores", type=int, default=os.cpu_count())
    asked = parser.parse_args(arguments)
    plan, log = load_plan(asked.seeds), Log(asked.output / "log.jsonl")
    log("started", cores=asked.cores, seeds=plan.digest)
    make_cases(plan.cases, asked.output, asked.cores, log)
    if asked.make_only:
        return
    diagnose(plan.cases, asked.output, asked.cores, log)
    score.main(["--results", str(asked.output), "--seeds", str(asked.seeds)])
    log("scored")


if __name__ == "__main__":
    os.environ.update(ENVIRONMENT)
    main(sys.argv[1:])
