"""Track record of the diagnosis: make every case of the plan, diagnose it by the ordinary rules, and score it.

``python hidden_effects/measure_track_record.py --output results/hidden-effects --cores 2`` goes on where it was cut
short. Every step is a line of ``log.jsonl`` in that folder.
"""

import argparse
import json
import os
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from case_files import ROOT, campaign_of, load_plan, truth_of, verdict_of
from make_case import made_by

HERE = Path(__file__).parent
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


def make_cases(plan, results, cores, log):
    """Make the cases that are missing or that other sources made, each in a process of its own.

    Parameters
    ----------
    plan : Plan
    results : Path
    cores : int
        Cases at a time.
    log : Log

    Raises
    ------
    subprocess.CalledProcessError
        A maker failed.
    """
    maker = made_by()
    due = [case for case in plan.cases if not _is_made(case, results, maker)]
    log("cases", due=len(due), ready=len(plan.cases) - len(due), maker=maker)

    def make(case):
        begin = time.monotonic()
        size = [] if case.size is None else ["--size", case.size]
        sealed = [] if case.sealed else ["--no-sealed"]
        command = [
            sys.executable, str(HERE / "make_case.py"), "--seed", str(case.seed), "--case", case.truth, *size, *sealed,
            "--structure", case.structure, "--output", str(campaign_of(results, case.name)),
            "--truth", str(truth_of(results, case.name)),
        ]  # fmt: skip
        subprocess.run(command, env=ENVIRONMENT, check=True)
        log("made", case=case.name, seconds=round(time.monotonic() - begin, 1))

    with ThreadPoolExecutor(cores) as pool:
        list(pool.map(make, due))


def _is_made(case, results, maker):
    """Whether the case is there whole; its README is written last."""
    truth = truth_of(results, case.name) / "truth.json"
    if not truth.is_file() or not (campaign_of(results, case.name) / "README").is_file():
        return False
    told = json.loads(truth.read_text())
    made = told["made_by"], told["seed"], told["structure"], told["truth"], told["size_class"]
    return made == (maker, case.seed, case.structure, case.truth, case.size)


def diagnose(names, results, effort, cores, without, log, target="verdicts"):
    """Verdicts on campaigns by the ordinary rules, in one workflow; what an earlier one finished is kept.

    Parameters
    ----------
    names : list of str
        Of cases.
    results : Path
    effort : str
    cores : int
    without : str or None
        Effect that is not among the candidates.
    log : Log
    target : str
        Of the workflow: ``verdicts``, or ``diagnose`` for the reports too.

    Raises
    ------
    subprocess.CalledProcessError
        The workflow failed; it goes on where it stopped when it is started again.
    """
    campaigns = ",".join(f"'{campaign_of(results, name).resolve()}'" for name in names)
    left_out = [] if without is None else [f"without=['{without}']"]
    begin = time.monotonic()
    command = [
        "snakemake", "--cores", str(cores), "--keep-going", "--rerun-incomplete", target,
        "--config", f"campaigns=[{campaigns}]", f"effort={effort}", *left_out,
    ]  # fmt: skip
    log("diagnosing", cases=len(names), without=without, effort=effort)
    subprocess.run(command, cwd=ROOT, env=ENVIRONMENT, check=True)
    log(
        "diagnosed", cases=len(names), without=without, seconds=round(time.monotonic() - begin, 1),
        verdicts=sum(verdict_of(results, name, without).is_file() for name in names),
    )  # fmt: skip


def main(arguments):
    """Make, diagnose and score the plan, as the command line says."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--output", type=Path, default=ROOT / "results" / "hidden-effects")
    parser.add_argument("--cores", type=int, default=os.cpu_count())
    asked = parser.parse_args(arguments)
    plan, log = load_plan(), Log(asked.output / "log.jsonl")
    log("started", cores=asked.cores, seeds=plan.digest)
    make_cases(plan, asked.output, asked.cores, log)
    for structure, effort in plan.efforts.items():
        names = [case.name for case in plan.cases if case.structure == structure]
        diagnose(names, asked.output, effort, asked.cores, None, log)
    cases = {case.name: case for case in plan.cases}
    for name in plan.removed:
        effort = plan.efforts[cases[name].structure]
        diagnose([name], asked.output, effort, asked.cores, cases[name].truth, log)
    subprocess.run(
        [sys.executable, str(HERE / "score.py"), "--results", str(asked.output)], env=ENVIRONMENT, check=True
    )
    log("scored")


if __name__ == "__main__":
    main(sys.argv[1:])
