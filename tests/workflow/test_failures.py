"""A workflow that cannot succeed any more ends at once; its last lines are the reason, the job and the log."""

import os
import re
import signal
import subprocess
import sys
import time

import pytest
from checkout import LIMIT, Checkout, heed_interrupts

RUNS = "results/small/runs/nscd-rigid/configuration-1/000-004.nc"
NOT_FINISHED = "Not finished. All that is finished is kept, and the same command goes on."
REFUSED = 'raise InputError("{0}.csv", "key", "expected another {0}")'
# two jobs without inputs, that wait for each other's start; and a simulation that keeps its state when interrupted
BOTH = """
import time
from pathlib import Path
while len(list(Path("logs").rglob("*.log"))) < 2:
    time.sleep(0.01)
"""
LONG = """
def simulate_samples(*_, **__):
    import time
    from pathlib import Path
    try:
        Path("simulates").touch()
        time.sleep(1e5)
    except KeyboardInterrupt:
        Path("kept").touch()
        raise
"""


def broken(checkout, module, function, body):
    """Put a function with another body in the place of one of the package."""
    lines = "".join(f"\n    {line}" for line in body.strip().splitlines())
    checkout.append(f"{module}.py", f"\n\ndef {function}(*_, **__):{lines}\n")


def describe_fails(checkout, body):
    broken(checkout, "dynamics/describe_motion", "describe_motion", body)


def drawing_fails(checkout, body):
    broken(checkout, "study/sampling/sample_table", "write_design", body)


IMPORT = "from blockshake.errors import InputError\n"


def last_lines(answer, count):
    return answer.stderr.splitlines()[-count:]


def test_bad_input_of_the_first_job_ends_a_study_at_once(tmp_path):
    checkout = Checkout(tmp_path)
    broken(checkout, "simulation/simulate", "compile_kernels", IMPORT + REFUSED.format("kernels"))
    answer = checkout.snakemake(RUNS)
    assert answer.returncode == 2
    ended, reason, job, log = last_lines(answer, 4)
    assert (ended, reason) == (NOT_FINISHED, "blockshake: kernels.csv: key: expected another kernels")
    made = re.fullmatch(
        r"  job: compile_kernels, which makes results/kernels/(nscd-rigid-[0-9a-f]{12})\.json", job
    )
    assert log == f"  log: logs/compile_kernels/{made[1]}.log"
    assert not (tmp_path / "results" / "store").exists()
    assert "Ended with exit code 2" in (tmp_path / "logs" / "compile_kernels" / f"{made[1]}.log").read_text()


@pytest.mark.faults
@pytest.mark.short_faults
def test_a_bug_ends_a_study_at_once_with_exit_1(tmp_path):
    checkout = Checkout(tmp_path)
    drawing_fails(checkout, "return {}['a\\nb']")
    answer = checkout.snakemake("results/small/design.csv")
    assert answer.returncode == 1
    assert last_lines(answer, 3)[0] == r"blockshake: KeyError: 'a\nb'"
    assert last_lines(answer, 1) == ["  log: logs/small/draw_samples.log"]


@pytest.mark.faults
@pytest.mark.short_faults
def test_a_job_that_is_killed_ends_a_study_too(tmp_path):
    checkout = Checkout(tmp_path)
    drawing_fails(checkout, "import os\nos.kill(os.getpid(), 9)")
    answer = checkout.snakemake("results/small/design.csv")
    assert answer.returncode == 1
    assert "the job ended without a word, as one does that is killed" in last_lines(answer, 3)[0]


@pytest.mark.faults
@pytest.mark.short_faults
@pytest.mark.parametrize("engine", [(), ("--keep-going",)])
def test_two_jobs_fail(tmp_path, engine):
    checkout = Checkout(tmp_path)
    drawing_fails(checkout, BOTH + IMPORT + REFUSED.format("design"))
    describe_fails(checkout, BOTH + IMPORT + REFUSED.format("motion"))
    answer = checkout.snakemake("results/small/design.csv", "results/small/motions/basso-tirreno.nc", *engine)
    assert answer.returncode == 2
    ends = answer.stderr[answer.stderr.rindex(NOT_FINISHED) :].splitlines()
    assert ends[-1].startswith("  log: logs/small/")
    reasons = {f"blockshake: {name}.csv: key: expected another {name}" for name in ("design", "motion")}
    assert set(ends) & reasons
    if engine:
        assert reasons <= set(ends)


@pytest.mark.faults
@pytest.mark.short_faults
def test_jobs_that_need_no_failed_one_go_on_where_that_is_asked_for(tmp_path):
    checkout = Checkout(tmp_path)
    describe_fails(checkout, IMPORT + REFUSED.format("motion"))
    answer = checkout.snakemake(
        "results/small/motions/basso-tirreno.nc", "results/small/design.csv", "--keep-going", "--cores", "1"
    )
    assert answer.returncode == 2
    assert (tmp_path / "results" / "small" / "design.csv").exists()


@pytest.mark.faults
@pytest.mark.short_faults
def test_a_failure_ends_a_simulation_that_runs(tmp_path):
    checkout = Checkout(tmp_path)
    wait = (
        'import time\nfrom pathlib import Path\nwhile not Path("simulates").exists():\n    time.sleep(0.01)\n'
    )
    describe_fails(checkout, wait + IMPORT + REFUSED.format("motion"))
    checkout.append("study/ensembles/batch.py", LONG)
    answer = checkout.snakemake(RUNS, "results/small/motions/basso-tirreno.nc")
    assert (tmp_path / "simulates").exists()
    assert answer.returncode == 2
    assert last_lines(answer, 3)[0] == "blockshake: motion.csv: key: expected another motion"
    assert (tmp_path / "kept").exists()
    assert not (tmp_path / RUNS).exists()


@pytest.mark.faults
@pytest.mark.short_faults
def test_an_interrupted_study_says_so_last(tmp_path):
    checkout = Checkout(tmp_path)
    checkout.append("study/ensembles/batch.py", LONG)
    running = subprocess.Popen(
        checkout.command(RUNS), cwd=tmp_path,
        stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, start_new_session=True,
        preexec_fn=heed_interrupts,
    )  # fmt: skip
    deadline = time.monotonic() + LIMIT
    while not (tmp_path / "simulates").exists():
        assert time.monotonic() < deadline
        assert running.poll() is None
        time.sleep(0.05)
    os.killpg(running.pid, signal.SIGINT)
    _, said = running.communicate(timeout=LIMIT)
    assert running.returncode == 130
    assert said.splitlines()[-2:] == [NOT_FINISHED, "blockshake: interrupted"]
    assert (tmp_path / "kept").exists()


@pytest.mark.parametrize(
    ("body", "code", "reason"),
    [
        (IMPORT + REFUSED.format("readings"), 2, "readings.csv: key: expected another readings"),
        pytest.param(
            "return 1 / 0",
            1,
            "ZeroDivisionError: division by zero",
            marks=[pytest.mark.faults, pytest.mark.short_faults],
        ),
    ],
)
def test_a_diagnosis_ends_with_its_first_step(tmp_path, body, code, reason):
    checkout = Checkout(tmp_path)
    broken(checkout, "diagnosis/steps", "decide", body)
    answer = subprocess.run(
        [sys.executable, "-m", "blockshake", "diagnose", "data/virtual-campaign/configuration-1",
         "--output", "new/output", "--effort", "quick", "--cores", "2"],
        cwd=tmp_path, env={**os.environ, "PYTHONPATH": str(tmp_path / "src")}, capture_output=True, text=True,
        timeout=LIMIT, check=False,
    )  # fmt: skip
    assert answer.returncode == code
    said, job, log = last_lines(answer, 3)
    assert said == f"blockshake: {reason}"
    assert job.startswith("  job: decide, which makes results/diagnosis/")
    assert log.startswith("  log: logs/")
    assert not (tmp_path / "new").exists()
    assert not list(tmp_path.glob("results/diagnosis/*/ensembles/*.nc"))
