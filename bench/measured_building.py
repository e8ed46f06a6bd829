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
from blockshake.diagnosis.answer.history import FRICTION
from blockshake.diagnosis.outside.registry import FORMS
from blockshake.effects.registry import EFFECTS, title_of
from blockshake.files import load_json
from blockshake.geometry.structure import load_structure

TITLES = {name: title_of(name) for name in EFFECTS} | {name: form.title for name, form in FORMS.items()}


def main(shared):
    """Write the part of the page."""
    with tempfile.TemporaryDirectory() as folder:
        campaign, output = Path(folder) / "isolated-building", Path(folder) / "output"
        program = ROOT / "examples" / "measured_building.py"
        source = shared / "measured" / "isolated-building"
        subprocess.run([sys.executable, str(program), str(source), str(campaign)], check=True)
        blockshake.diagnose(campaign, output, effort="quick")
        put_section("building", "\n\n".join([made_by(), *_part(campaign, output)]))


def _part(folder, output):
    verdict, decision = load_json(output / "verdict.json"), load_decision(output / "decision.json")
    yield f"### The building, {datetime.date.today().isoformat()}"
    yield f"The verdict: **{verdict['decision']}** ({verdict['word']})."
    yield "\n".join(f"- {line}" for line in causes_in_words(decision, TITLES)) or "- no cause is named"
    structure = load_structure(folder / "structure.yaml")
    yield "\n".join(_table(folder, structure.mass[1], decision))
    yield from _missed(folder, structure, decision)
    gain = verdict["row_gain"]["recalibrated"]
    yield (
        f"On the forces of the sealed test the cause removes {gain['estimate']:.0%} ({gain['lower']:.0%} to "
        f"{gain['upper']:.0%}, an interval of 90 %) of the error of the model recalibrated on the open tests."
    )
    yield "\n".join(["Caveats of the diagnosis:", "", *(f"- {line}" for line in verdict["caveats"])])


def _table(folder, mass, decision):
    """Rows by test: period of the stiffness that the diagnosis found, and of a regression of the readings."""
    columns = (
        "test", "role", "largest drift [mm]", "period [s]", "period, regression [s]", "damping ratio, regression",
    )  # fmt: skip
    yield f"| {' | '.join(columns)} |"
    yield f"|{' --- |' * len(columns)}"
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


def _missed(folder, structure, decision):
    """Sentences on what the regression shows and the answer does not say."""
    periods = {name: _regression(folder, name)[1] for name in decision.tests}
    short, long = min(periods, key=periods.get), max(periods, key=periods.get)
    softer = 1.0 - (periods[short] / periods[long]) ** 2
    if not any("damping" in cause.parameters for cause in decision.causes):
        guess = structure.file.friction[0].coefficient
        changes = [one.sizes for one in decision.histories if one.quantity == FRICTION]
        left = [guess * (1.0 + size.estimate) for sizes in changes for size in sizes]
        yield (
            f"The damping is missing in the answer, which has a friction of {min(left):.3f} to {max(left):.3f} of the "
            f"weight in its place, {guess:g} being the guess; a second size has to add a twentieth to the first."
        )
    if not any(one.changes for one in decision.histories if one.parameter == "stiffness"):
        yield (
            f"The answer has one stiffness for all tests. By the regression the stiffness in {long} is {softer:.0%} "
            f"lower than in {short}, a fall within the scatter that the diagnosis allows from test to test."
        )


def _regression(folder, name):
    """Largest drift [m], and period [s] and damping ratio by least squares of acceleration on drift and its rate."""
    markers, channels = pd.read_csv(folder / f"{name}.csv"), pd.read_csv(folder / f"{name}-acc.csv")
    drift = (markers["low.x"] - markers["table-face.x"]).to_numpy()
    rate = np.gradient(drift, markers["time_s"])
    stiffness, damping = np.linalg.lstsq(np.c_[drift, rate], -channels["building-acc-x"])[0]
    return np.abs(drift).max(), 2.0 * np.pi / np.sqrt(stiffness), 0.5 * damping / np.sqrt(stiffness)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
