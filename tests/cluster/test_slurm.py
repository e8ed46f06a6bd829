"""A study through SLURM, by its profile: jobs killed, a node drained, a command killed; results as on one machine."""

import os
import signal
import subprocess
import time

import one_node
import pytest
from checkout import LIMIT, Checkout
from likeness import unlike

pytestmark = pytest.mark.cluster
TARGET = "configuration-1"  # the study but for its report: minutes less
BATCH = "rule_simulate_batch"
DURATION = 1.0  # s; of motion, so that a batch can be met at work


@pytest.fixture(scope="module")
def slurm(tmp_path_factory):
    if lacking := one_node.missing():
        pytest.skip(f"not installed: {', '.join(lacking)} (Debian: slurmctld, slurmd, slurm-client, munge)")
    pytest.importorskip("snakemake_executor_plugin_slurm", reason="not installed: blockshake[cluster]")
    with one_node.running(tmp_path_factory.mktemp("slurm")) as node:
        yield node


def _checkout(folder):
    checkout = Checkout(folder)
    checkout.config["cases"][0]["duration"] = DURATION
    checkout.config["samples_per_job"] = 2  # as by the profile
    checkout.write_config(checkout.config)
    return checkout


@pytest.fixture(scope="module")
def local(tmp_path_factory):
    checkout = _checkout(tmp_path_factory.mktemp("local"))
    answer = checkout.snakemake(TARGET)
    assert answer.returncode == 0, answer.stdout + answer.stderr
    return checkout


def _start(checkout, slurm):
    """Start the study by the profile; its output goes to a file."""
    quick = ("--slurm-init-seconds-before-status-checks", "2", "--latency-wait", "5")
    command = checkout.command(TARGET, *quick, engine=("--profile", "profiles/slurm"))
    with open(checkout.folder / "said.txt", "ab") as said:
        return subprocess.Popen(
            command, cwd=checkout.folder, env=slurm.environment, stdout=said, stderr=said, start_new_session=True
        )  # fmt: skip


def _said(checkout):
    return (checkout.folder / "said.txt").read_text()


def _until(met, study, checkout):
    """Wait for what the study is to do; its value."""
    deadline = time.monotonic() + LIMIT
    while not (value := met()):
        assert study.poll() is None, _said(checkout)
        assert time.monotonic() < deadline, _said(checkout)
        time.sleep(0.1)
    return value


def _batch_at_work(slurm, checkout):
    """Number of a running job that simulates a batch, once a sample is in the store."""
    if not list((checkout.folder / "results" / "store").glob("[!.]*.nc")):
        return None
    return next((job for job, comment in slurm.jobs("RUNNING").items() if comment.startswith(BATCH)), None)


def _end(study, checkout):
    assert study.wait(LIMIT) == 0, _said(checkout)


def test_study_with_a_killed_job_and_a_drained_node_is_the_local_one(slurm, local, tmp_path):
    checkout = _checkout(tmp_path)
    study = _start(checkout, slurm)
    killed = _until(lambda: _batch_at_work(slurm, checkout), study, checkout)
    slurm.ask("scancel", "--signal=KILL", killed)
    _until(lambda: killed in slurm.jobs("FAILED,NODE_FAIL,CANCELLED"), study, checkout)
    slurm.set_node("drain")
    _until(lambda: slurm.jobs("PENDING") and not slurm.jobs("RUNNING,COMPLETING"), study, checkout)
    slurm.set_node("resume")
    _end(study, checkout)
    assert list(slurm.jobs("FAILED,NODE_FAIL,CANCELLED")) == [killed]
    # the killed batch went on from its finished samples
    logs = (checkout.folder / "logs" / "small" / "simulate_batch").rglob("*.log")
    assert any(", kept:" in path.read_text() for path in logs)
    assert unlike(local.folder, checkout.folder) == []


def test_jobs_of_a_killed_command_go_on_until_the_next_one_takes_the_folder(slurm, local, tmp_path):
    checkout = _checkout(tmp_path)
    first = _start(checkout, slurm)
    _until(lambda: _batch_at_work(slurm, checkout), first, checkout)
    os.kill(first.pid, signal.SIGKILL)
    first.wait()
    before = slurm.jobs("RUNNING,PENDING")
    assert before
    second = _start(checkout, slurm)
    _end(second, checkout)
    assert not before.keys() & slurm.jobs("RUNNING,PENDING,COMPLETING").keys()
    assert unlike(local.folder, checkout.folder) == []
