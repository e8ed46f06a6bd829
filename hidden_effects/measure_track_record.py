"""Track record of the diagnosis: make every case of a plan, diagnose it as a user would, and score it.

``python hidden_effects/measure_track_record.py --output results/hidden-effects --cores 2`` goes on where it was cut
short. Every step is a line of ``log.jsonl`` in that folder. ``--share 1/4`` takes a fourth of the cases, ``2-2/4`` the
second of each four, ``--laboratory mujoco`` those of one laboratory, and ``--make-only`` leaves the verdicts to others.
"""

import argparse
import json
import os
import shutil
import sys
import time
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from multiprocessing import get_context
from pathlib import Path
from types import SimpleNamespace

import mujoco_case
import score
from answer_file import load_answer
from case_files import ROOT, SEEDS, campaign_of, failure_of, load_plan, truth_of, verdict_of
from make_case import LABORATORIES, made_by, make_case
from oracle_gain import gains_of, response_gains, write_gains

from blockshake.diagnosis import steps
from blockshake.diagnosis.answer.decision import freeze, write_decision
from blockshake.diagnosis.nominal.nominal_model import MODELS
from blockshake.diagnosis.nominal.plan import plan_diagnosis
from blockshake.diagnosis.verdict.track_record import WHOLE
from blockshake.diagnosis.verdict.verdict import load_verdict, write_verdict
from blockshake.files import load_json, write_json
from blockshake.parity.parity import load_parity
from blockshake.store import Store

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


def cpu_time():
    """CPU time of this process and of those that it waited for [s]."""
    return sum(os.times()[:4])


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
    _each(_make, "made", due, results, cores, log)


def _each(step, word, cases, results, cores, log):
    """A step of several cases at a time; a case in which it fails is logged with the reason and holds up no other."""
    with ProcessPoolExecutor(cores, get_context("spawn")) as pool:
        for case, seconds, fault in pool.map(partial(_attempt, step, results), cases):
            said = {"case": case, "cpu_seconds": round(seconds, 1)}
            if fault:
                write_json(failure_of(results, case), {"step": step.__name__, "reason": fault})
                log("failed", **said, reason=fault)
            else:
                log(word, **said)


def _attempt(step, results, case):
    """Name of a case, CPU time of a step of it [s], and the reason for which it failed, or None."""
    begin, fault = cpu_time(), None
    try:
        step(results, case)
    except Exception as error:
        fault = f"{type(error).__name__}: {error}"
    return case.name, cpu_time() - begin, fault


def _make(results, case):
    make_case(
        case.seed, case.causes, case.size, campaign_of(results, case.name), truth_of(results, case.name).parent,
        case.gain is not None, case.structure, case.hollow, laboratory=case.laboratory, strength=case.strength,
    )  # fmt: skip


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
    """The verdict on every case that has none yet.

    Parameters
    ----------
    cases : sequence of PlannedCase
    results : Path
    cores : int
        Cases at a time.
    log : Log
    """
    due = [
        case
        for case in cases
        if not verdict_of(results, case.name).is_file() and not failure_of(results, case.name).is_file()
    ]
    _each(_diagnose, "diagnosed", due, results, cores, log)


def measure_gains(cases, results, cores, log):
    """Gains on the responses of the cases that ask for them and in which something is named or described."""
    due = [
        case
        for case in cases
        if case.gain == "responses"
        and verdict_of(results, case.name).is_file()
        and load_answer(verdict_of(results, case.name)).decision != "none"
        and not gains_of(results, case.name).is_file()
    ]
    _each(_measure_gains, "gains", due, results, cores, log)


def _measure_gains(results, case):
    out = verdict_of(results, case.name).parent
    findings = load_parity(out / "parity.json").findings
    gains = response_gains(
        campaign_of(results, case.name), load_json(truth_of(results, case.name)),
        load_verdict(verdict_of(results, case.name)), findings, out / "runs",
    )  # fmt: skip
    write_gains(gains_of(results, case.name), gains)
    shutil.rmtree(out / "runs")


def _diagnose(results, case):
    """Diagnose a case by the steps of the rules, as at quick effort."""
    folder, out = campaign_of(results, case.name), verdict_of(results, case.name).parent
    out.mkdir(parents=True, exist_ok=True)
    files = SimpleNamespace(
        parity=str(out / "parity.json"), decision=str(out / "decision.json"), frozen=str(out / "frozen.json"),
        ensembles=[], extended=[], gain=[], outcomes=[], clean=[],
    )  # fmt: skip
    store = Store(out / "runs", "", lambda line: None)
    for solver in MODELS if plan_diagnosis(folder, "quick").clean else ():
        files.clean.append(str(out / f"clean-{solver}.json"))
        write_json(files.clean[-1], steps.simulate_clean(str(folder), "quick", solver, store))
    found = steps.decide(str(folder), (), files)
    write_json(files.parity, found.parity.as_json())
    write_decision(files.decision, found.decision)
    freeze(files.frozen, files.decision, found.decision.tests)
    if case.gain is not None and (found.decision.parts or found.parity.findings):
        gained = steps.measure_gain(str(folder), "quick", files)
        files.gain = [str(out / "gain.json")]
        write_json(files.gain[0], gained.summary.model_dump(mode="json"))
    write_verdict(verdict_of(results, case.name), steps.conclude(str(folder), 0, files))


def main(arguments):
    """Make, diagnose and score the plan, as the command line states."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--output", type=Path, default=ROOT / "results" / "hidden-effects")
    parser.add_argument("--seeds", type=Path, default=SEEDS, help="the plan")
    parser.add_argument("--share", default=WHOLE, help="part of the plan, such as 1/4; its strata are kept")
    parser.add_argument("--laboratory", choices=list(LABORATORIES), help="this one alone")
    parser.add_argument("--make-only", action="store_true", help="neither diagnose nor score")
    parser.add_argument("--cores", type=int, default=os.cpu_count())
    asked = parser.parse_args(arguments)
    plan = load_plan(asked.seeds).chosen(asked.share, asked.laboratory)
    if any(case.laboratory == "mujoco" for case in plan.cases) and not mujoco_case.is_there():
        parser.error(
            "no mujoco in the environment of the peers: `make peers` sets it up; or --laboratory home"
        )
    log = Log(asked.output / "log.jsonl")
    log("started", cores=asked.cores, seeds=plan.digest, part=plan.part, cases=len(plan.cases))
    for case in plan.cases:
        failure_of(asked.output, case.name).unlink(missing_ok=True)
    make_cases(plan.cases, asked.output, asked.cores, log)
    if asked.make_only:
        return
    diagnose(plan.cases, asked.output, asked.cores, log)
    measure_gains(plan.cases, asked.output, asked.cores, log)
    one = ["--laboratory", asked.laboratory] if asked.laboratory else []
    score.main(["--results", str(asked.output), "--seeds", str(asked.seeds), "--share", asked.share, *one])
    log("scored")


if __name__ == "__main__":
    os.environ.update(ENVIRONMENT)
    main(sys.argv[1:])
