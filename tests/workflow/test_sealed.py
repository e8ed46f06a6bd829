"""What sealed tests measured is read by the gain's rule alone."""

import re
import subprocess
import sys

from blockshake.files import PACKAGE
from blockshake.measurement.campaign import load_campaign

ROOT = PACKAGE.parents[1]
CAMPAIGN = ROOT / "data" / "virtual-campaign" / "configuration-2"


def _inputs(text):
    """Input files by rule, of the jobs that a dry run prints."""
    found = {}
    for rule, files in re.findall(r"^(?:local)?rule (\w+):\n    input: (.+)$", text, re.MULTILINE):
        found.setdefault(rule, set()).update(files.split(", "))
    return found


def test_no_rule_but_the_gains_has_a_sealed_file_as_input():
    run = subprocess.run(
        [
            sys.executable, "-m", "snakemake", "-n", "--forceall", "--workflow-profile", "none",
            "results/diagnosis/configuration-2/verdict.json", "results/diagnosis/configuration-2/gain.json",
            "--config", f"campaign={CAMPAIGN}", "--directory", str(ROOT), "--nolock", "--cores", "1",
        ],
        cwd=ROOT, capture_output=True, text=True, check=True,
    )  # fmt: skip
    inputs = _inputs(run.stdout)
    tests = load_campaign(CAMPAIGN).tests.values()
    sealed = {str(CAMPAIGN / test.file) for test in tests if test.role == "sealed"}
    opened = {str(CAMPAIGN / test.file) for test in tests if test.role != "sealed"}
    assert {"read_measured", "decide", "extend_model", "measure_gain", "conclude"} <= set(inputs)
    assert sealed <= inputs["measure_gain"]
    assert {rule for rule, files in inputs.items() if files & sealed} == {"measure_gain"}
    # the test can fail: open files are found among the inputs
    assert {rule for rule, files in inputs.items() if files & opened} == {"read_measured"}
