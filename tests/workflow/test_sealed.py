"""Sealed tests are opened after the decision: places of their blocks for simulation, readings for the skill score."""

import re
import subprocess
import sys

from blockshake.files import PACKAGE
from blockshake.measurement.campaigns.campaign import load_campaign

ROOT = PACKAGE.parents[1]
CAMPAIGN = ROOT / "data" / "virtual-campaign" / "configuration-2"


def _inputs(text):
    """Input files by rule, of the jobs that a dry run prints."""
    found = {}
    for rule, files in re.findall(r"^(?:rule|checkpoint) (\w+):\n    input: (.+)$", text, re.MULTILINE):
        found.setdefault(rule, set()).update(files.split(", "))
    return found


def test_nothing_up_to_the_decision_has_a_sealed_file_as_input():
    run = subprocess.run(
        [
            sys.executable, "-m", "snakemake", "-n", "--forceall", "--workflow-profile", "none",
            "results/diagnosis/configuration-2/verdict.json",
            "--config", f"campaign={CAMPAIGN}", "--directory", str(ROOT), "--nolock", "--cores", "1",
        ],
        cwd=ROOT, capture_output=True, text=True, check=True,
    )  # fmt: skip
    inputs = _inputs(run.stdout)
    tests = load_campaign(CAMPAIGN).tests.values()
    sealed = {str(CAMPAIGN / test.file) for test in tests if test.role == "sealed"}
    opened = {str(CAMPAIGN / test.file) for test in tests if test.role != "sealed"}
    assert {"decide", "conclude"} <= set(inputs)
    assert not any(files & sealed for files in inputs.values())
    # the test can fail: open files are found among the inputs
    assert {rule for rule, files in inputs.items() if files & opened} == {
        "simulate_clean",
        "decide",
        "conclude",
    }


def test_two_rules_ask_for_sealed_files():
    """Rules after the decision depend on it, and so show in no dry run."""
    text = (ROOT / "workflow" / "rules" / "diagnosis.smk").read_text()
    parts = re.split(r"^(?:rule|checkpoint) (\w+):", text, flags=re.MULTILINE)[1:]
    asking = [rule for rule, body in zip(parts[::2], parts[1::2], strict=True) if '"sealed"' in body]
    # the former reads the survey alone: tests/measurement/campaigns/test_starting_places.py
    assert asking == ["extend_model", "measure_gain"]
    others = [path for path in (ROOT / "workflow" / "rules").glob("*.smk") if path.name != "diagnosis.smk"]
    uses = [path.name for path in others if ".sealed" in path.read_text()]
    # the function that lists them, for whoever asks
    assert uses == ["diagnosed.smk"]
