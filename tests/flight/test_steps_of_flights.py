"""The steps of a diagnosis without base motion, from the files of a campaign to its report."""

from types import SimpleNamespace

import numpy as np
import pandas as pd
import yaml
from made_flights import campaign, mapping
from scipy.spatial.transform import Rotation

from blockshake.diagnosis import steps
from blockshake.diagnosis.answer.decision import freeze, write_decision
from blockshake.diagnosis.report.report import make_diagnosis_report
from blockshake.diagnosis.verdict.verdict import write_verdict
from blockshake.files import write_dataset, write_json

ROLES = ("fit", "select", "sealed")


def written(folder):
    """Folder of a campaign of three tosses of a box whose mass centre lies off its middle."""
    tracked = campaign(range(len(ROLES)), {"body": {"mass_offset": [0.006, -0.004, 0.005]}})
    for test in tracked.tests:
        turned = Rotation.from_matrix(test.rotation).as_quat(scalar_first=True)
        columns = {f"box.{axis}": column for axis, column in zip("xyz", test.position.T, strict=True)}
        columns |= {f"box.q{part}": column for part, column in zip("wxyz", turned.T, strict=True)}
        pd.DataFrame({"time_s": test.time, **columns}).to_csv(folder / f"{test.name}.csv", index=False)
    (folder / "structure.yaml").write_text(yaml.safe_dump(mapping()))
    tests = [
        {"name": test.name, "file": f"{test.name}.csv", "role": role}
        for test, role in zip(tracked.tests, ROLES, strict=True)
    ]
    text = yaml.safe_dump({"name": "tosses", "structure": "structure.yaml", "tests": tests})
    (folder / "campaign.yaml").write_text(text)
    return str(folder)


def test_a_campaign_of_flights_is_diagnosed_from_its_files_to_its_report(tmp_path):
    folder, results = written(tmp_path), tmp_path / "results"
    results.mkdir()
    files = SimpleNamespace(
        parity=results / "parity.json", decision=results / "decision.json", frozen=results / "frozen.json"
    )
    decided = steps.decide(folder, ())
    assert [cause.name for cause in decided.decision.causes] == ["eccentricity"]
    assert decided.decision.tests == ("toss-0", "toss-1")
    write_json(files.parity, decided.parity.as_json())
    write_dataset(results / "evidence.nc", decided.evidence)
    write_decision(files.decision, decided.decision)
    freeze(files.frozen, files.decision, decided.decision.tests)
    gained = steps.measure_gain(folder, "quick", files)
    assert gained.scores["test"].values.tolist() == ["toss-2"]
    assert np.isfinite(gained.scores["place"]).all()
    write_dataset(results / "gain.nc", gained.scores)
    files.gain = [results / "gain.json"]
    write_json(files.gain[0], gained.summary.model_dump(mode="json"))
    write_verdict(results / "verdict.json", steps.conclude(folder, 0, files))
    html, pdf = tmp_path / "report.html", tmp_path / "report.pdf"
    make_diagnosis_report(folder, str(results), "quick", "no-record.json", html, pdf)
    assert "mass centre off the middle, box" in html.read_text()
    assert pdf.stat().st_size > 0
