"""A base-isolated building on a shake table through the whole loop, and its part of docs/results/measured.md.

``python bench/measured_building.py SHARED`` makes the campaign of SHARED/measured/isolated-building by
``examples/measured_building.py``, diagnoses it as a user would, and writes its part of the page beside a regression of
the same readings.
"""

import datetime
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import pandas as pd
import yaml
from measured import ROOT, causes_in_words, made_by, put_section

import blockshake
from blockshake.diagnosis.answer.decision import load_decision
from blockshake.diagnosis.outside.registry import FORMS
from blockshake.effects.registry import EFFECTS, title_of
from blockshake.files import load_json
from blockshake.geometry.structure import load_structure

TITLES = {name: title_of(name) for name in EFFECTS} | {name: form.title for name, form in FORMS.items()}


def main(shared):
    """Write the part of the page."""
    with tempfile.TemporaryDirectory() as folder:
        campaign, output = Path(folder) / "isolated-building", Path(folder) / "output"
        program, source = (
            ROOT / "examples" / "measured_building.py",
            shared / "measured" / "isolated-building",
        )
        subprocess.run([sys.executable, str(program), str(source), str(campaign)], check=True)
        blockshake.diagnose(campaign, output, effort="quick")
        put_section("building", "\n\n".join([made_by(), *_part(campaign, output)]))


def _part(folder, output):
    verdict, decision = load_json(output / "verdict.json"), load_decision(output / "decision.json")
    yield f"### The building, {datetime.date.today().isoformat()}"
    yield f"The verdict: **{verdict['decision']}** ({verdict['word']})."
    yield "\n".join(f"- {line}" for line in causes_in_words(decision, TITLES)) or "- no cause is named"
    yield "\n".join(_table(folder, decision))
    gain = verdict["row_gain"]["recalibrated"]
    yield (
        f"Error of the forces of the sealed test that the cause removes, beyond the model recalibrated on the open "
        f"ones: {gain['estimate']:.0%} ({gain['lower']:.0%} to {gain['upper']:.0%})."
    )
    yield "\n".join(["Caveats of the diagnosis:", "", *(f"- {line}" for line in verdict["caveats"])])


def _table(folder, decision):
    """Rows by test: period of the stiffness that the diagnosis found, and of a regression of the readings."""
    columns = (
        "test",
        "role",
        "largest drift [mm]",
        "period [s]",
        "period, regression [s]",
        "damping ratio, regression",
    )
    yield f"| {' | '.join(columns)} |"
    yield f"|{' --- |' * len(columns)}"
    mass = load_structure(folder / "structure.yaml").mass[1]
    own = [one for one in decision.histories if one.parameter == "stiffness"]
    found = dict(zip(own[0].tests, own[0].sizes, strict=True)) if own else {}
    for test in yaml.safe_load((folder / "campaign.yaml").read_text())["tests"]:
        farthest, period, ratio = _regression(folder, test["name"])
        one, words = found.get(test["name"]), "not read"
        if one:
            middle, short, long = (
                2.0 * np.pi * np.sqrt(mass / k) for k in (one.estimate, one.upper, one.lower)
            )
            words = f"{middle:.2f} ({short:.2f} to {long:.2f})"
        yield f"| {test['name']} | {test['role']} | {1e3 * farthest:.0f} | {words} | {period:.2f} | {ratio:.2f} |"


def _regression(folder, name):
    """Largest drift [m], and period [s] and damping ratio by least squares of acceleration on drift and its rate."""
    markers, channels = pd.read_csv(folder / f"{name}.csv"), pd.read_csv(folder / f"{name}-acc.csv")
    drift = (markers["low.x"] - markers["table-face.x"]).to_numpy()
    rate = np.gradient(drift, markers["time_s"])
    stiffness, damping = np.linalg.lstsq(np.c_[drift, rate], -channels["building-acc-x"])[0]
    return np.abs(drift).max(), 2.0 * np.pi / np.sqrt(stiffness), 0.5 * damping / np.sqrt(stiffness)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
