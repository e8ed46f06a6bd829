"""The program behind ``make bench-scale``: the largest works on one machine, their memory and their CPU time.

Ten thousand samples of configuration 1 by rigid blocks, from the design to the report; an hour of motion in one run
file; 2,000 blocks in one run; an ensemble of 10,000 draws. Of the samples one batch is simulated, its file is copied
under the numbers of all others: what follows reads 10,000 samples, and most of the machine's time is saved.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

import accepted
import numpy as np
import walls
from measuring import seconds_between
from nscd_step import TIME_STEP, nscd_run

from blockshake.dynamics.load_motion import load_motion
from blockshake.files import HOME, load_json, shipped, write_dataset, write_json, write_text
from blockshake.geometry.structure import load_structure
from blockshake.store import load_made
from blockshake.study.ensembles.ensemble import DECIMALS
from blockshake.study.sampling.sample_table import load_design

_CHILDREN = Path(__file__).with_name("scale_children.py")
_MOST_MEMORY, _MOST_OVERHEAD, _MOST_HTML = 2048.0, 0.1, 20.0  # MiB, CPU s a sample, MB: targets
_SIZES = {"samples": (10_000, 250), "hours": (1.0,), "blocks": (2000,), "draws": (10_000,)}
_QUICK = {"samples": (40, 20), "hours": (0.01,), "blocks": (10,), "draws": (200,)}
_DURATION = 1.0  # s, of a sample
_TARGETS = {
    "make_envelope": "results/scale/envelopes/nscd-rigid/stack.nc",
    "measure_sensitivity": "results/scale/sensitivities/nscd-rigid/stack.nc",
    "compare_models": "results/scale/differences/stack.nc",
    "make_report": "reports/scale.html",
}
_CONFIG = """\
name: scale
description: many samples of configuration 1
samples_per_job: {batch}
models: {{nscd-rigid: {{time_step: 1.0e-3}}}}
cases: [{{structure: stack.yaml, motion: basso-tirreno, scale: 2.0, duration: {duration}}}]
ensemble: {{size: {samples}, seed: 1}}
"""


class Cost(NamedTuple):
    """CPU time [s], peak memory [MiB] and standard output of a process and of those that it started."""

    cpu: float
    memory: float
    output: str


def main(arguments=None):
    """Measure, print the table, and put it on the page."""
    parser = argparse.ArgumentParser(prog="scale", description=__doc__.partition("\n")[0])
    parser.add_argument("--only", choices=_SIZES, action="append", help="measure this part; may be repeated")
    parser.add_argument("--quick", action="store_true", help="smallest works, to see that the program works")
    parser.add_argument("--accept", action="store_true", help="keep the table in docs/results/bench.md")
    parser.add_argument("--output", type=Path, default=Path("results/scale.json"))
    options = parser.parse_args(arguments)
    sizes = _QUICK if options.quick else _SIZES
    before = load_json(options.output) if options.only and options.output.exists() else {}
    found = {**before, **{part: measure(part, sizes[part]) for part in options.only or _SIZES}}
    write_json(options.output, found)
    table = as_table([row for part in _SIZES for row in found.get(part, [])])
    sys.stdout.write(table)
    if options.accept:
        accepted.put("make bench-scale", table)


def measure(part, sizes):
    """Rows of the table: work, its measure, figure, target or None."""
    with tempfile.TemporaryDirectory(prefix="blockshake-scale-") as folder:
        return _PARTS[part](Path(folder), *sizes)


def as_table(rows):
    """Markdown."""
    lines = ["| work | measure | figure | target |", "| --- | --- | --- | --- |"]
    for what, name, figure, target in rows:
        shown = f"{figure:,.0f}" if figure >= 100.0 else f"{figure:.3g}"
        lines.append(f"| {what} | {name} | {shown} | {'' if target is None else f'{target:,g}'} |")
    return "\n".join(lines) + "\n"


def _samples(folder, samples, batch):
    write_text(folder / "stack.yaml", shipped("structures", "configuration-1").read_text(encoding="utf-8"))
    config = _CONFIG.format(samples=samples, batch=batch, duration=_DURATION)
    write_text(folder / "scale.yaml", config)
    jobs = _snakemake(folder, "-n", "reports/scale.html", "--config", "samples_per_job=10")
    spent = {"draw_samples": _snakemake(folder, "results/scale/design.csv")}
    runs = Path("results/scale/runs/nscd-rigid/stack")
    _snakemake(folder, "results/scale/runs/nscd-rigid/stack/half-step.nc")  # compiles the model
    spent["simulate_batch"] = _snakemake(folder, str(runs / f"000-{batch - 1:03d}.nc"))
    _copy_batches(folder / runs, load_design(folder / "results/scale/design.csv"), batch)
    for rule, target in _TARGETS.items():
        spent[rule] = _snakemake(folder, target, "--rerun-triggers", "mtime")
    study = f"{samples:,} samples"
    overhead = (spent["simulate_batch"].cpu - jobs.cpu) / batch - _simulation()
    after = sum(cost.cpu - jobs.cpu for rule, cost in spent.items() if rule != "simulate_batch")
    return [
        (study, "1,000 jobs planned, CPU s" if samples == 10_000 else "jobs planned, CPU s", jobs.cpu, None),
        (study, "jobs planned, MiB", jobs.memory, _MOST_MEMORY),
        (study, "next to the simulation, CPU s a sample", overhead, _MOST_OVERHEAD),
        (study, "all other rules, CPU s a sample", after / samples, _MOST_OVERHEAD),
        *((study, f"`{rule}`, MiB", cost.memory, _MOST_MEMORY) for rule, cost in spent.items()),
        (study, "HTML, MB", (folder / "reports/scale.html").stat().st_size / 1e6, _MOST_HTML),
    ]


def _simulation():
    """CPU time that the time steps of one sample take [s]."""
    run = nscd_run(load_structure("configuration-1"), load_motion("basso-tirreno", 2.0))
    run(1)
    return float(np.median(seconds_between(run, 1, round(_DURATION / TIME_STEP), 5)))


def _copy_batches(runs, design, batch):
    """Put the file of the first batch in place of all others, with their numbers and values."""
    first = load_made(runs / f"000-{batch - 1:03d}.nc")
    names = first["parameter"].values.tolist()
    for begin in range(batch, len(design), batch):
        rows = design.iloc[begin : begin + batch]
        values = first["parameter_value"].copy(data=rows[names].to_numpy())
        copy = first.assign_coords(sample=rows.index.to_numpy(), parameter_value=values.variable)
        write_dataset(runs / f"{begin:03d}-{begin + batch - 1:03d}.nc", copy, DECIMALS)


def _hours(folder, hours):
    cost = _run(_CHILDREN, "hours", folder / "run.nc", hours)
    work = f"{hours:g} h of motion"
    return [
        (work, "CPU s", cost.cpu, None),
        (work, "MiB", cost.memory, _MOST_MEMORY),
        (work, "run file, MB", (folder / "run.nc").stat().st_size / 1e6, None),
    ]


def _blocks(_, blocks):
    cost = _run(walls.__file__, blocks, 1)
    step = json.loads(cost.output)["us_per_step_and_block"]["median"]
    return [
        (f"{blocks:,} blocks", "LS-DEM, us a step and block", step, None),
        (f"{blocks:,} blocks", "LS-DEM, MiB", cost.memory, _MOST_MEMORY),
    ]


def _draws(_, draws):
    cost = _run(_CHILDREN, "draws", draws, 10.0)
    gathered, read = map(float, cost.output.split())
    work = f"ensemble of {draws:,} draws of 10 s"
    return [
        (work, "gathered and written, CPU s a draw", gathered / draws, _MOST_OVERHEAD),
        (work, "read, CPU s", read, None),
        (work, "MiB", cost.memory, _MOST_MEMORY),
    ]


def _snakemake(folder, *arguments):
    command = [Path(sys.executable).with_name("snakemake"), "--cores", "1", "--snakefile", HOME / "Snakefile"]
    return _process([*command, *arguments, "--configfile", "scale.yaml"], folder)


def _run(*arguments):
    return _process([sys.executable, *arguments])


def _process(command, folder=None):
    """`Cost` of a command."""
    with tempfile.TemporaryFile("w+") as output:
        process = subprocess.Popen(list(map(str, command)), cwd=folder, stdout=output)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode:
            raise subprocess.CalledProcessError(process.returncode, command)
        output.seek(0)
        return Cost(usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024.0, output.read())


_PARTS = {"samples": _samples, "hours": _hours, "blocks": _blocks, "draws": _draws}


if __name__ == "__main__":
    main()
