"""The plan of a campaign as its command: files, matrix, ranked additions, and one line for bad input."""

import json

import pytest

from blockshake.cli import main
from blockshake.diagnosis.planning import plan
from blockshake.diagnosis.planning.nominal_tests import load_planned
from blockshake.errors import InputError
from blockshake.files import PACKAGE, write_text

STRUCTURE = str(PACKAGE.parents[1] / "hidden_effects" / "structures" / "single-block.yaml")
SENSORS = """
sensors: {marker_noise: 2.0e-4, accelerometer_noise: 0.05}
markers:
  - {name: a, body: slab, position: [0.0, -1.5, 0.0]}
  - {name: b, body: BODY, position: [0.0, -1.2, 0.4]}
  - {name: c, body: BODY, position: [0.3, -1.2, -0.4]}
"""


def test_the_command_writes_a_plan(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(plan, "CAMPAIGNS", 1)
    monkeypatch.setattr(plan, "OF_ADDITIONS", 1)
    planned = [
        "plan-campaign",
        STRUCTURE,
        "--motions",
        "alkion@5.5",
        "--duration",
        "5",
        "--output",
        str(tmp_path),
    ]
    assert main(planned) == 0
    written = json.loads((tmp_path / "plan.json").read_text())
    assert written["tests"] == ["alkion@5.5"]
    limits = written["effects"]["eccentricity"]["limits"]
    assert 0.0 < limits["block-1"] < 0.15
    # nothing is distinguished before it is seen
    for one in written["effects"].values():
        seen = one["limits"][one["place"]]
        assert all(size is None or abs(size) >= 0.999 * abs(seen) for size in one["told_apart"].values())
    worth = [one["pairs"] for one in written["additions"]]
    assert worth == sorted(worth, reverse=True)
    words = [one["words"] for one in written["additions"]]
    assert {
        "alkion@5.5 times 1.25",
        "one more accelerometer on block-1",
        "weigh block-1 on two supports",
    } <= set(words)
    printed = capsys.readouterr().out
    assert "distinguished from" in printed
    assert "SYNTHETIC" in (tmp_path / "plan.html").read_text()


def test_sensors_of_a_file_are_the_chosen_ones_and_their_noise_counts(tmp_path):
    write_text(tmp_path / "sensors.yaml", SENSORS.replace("BODY", "block-1"))
    planned = load_planned(STRUCTURE, ["alkion"], str(tmp_path / "sensors.yaml"))
    assert planned.chosen == {"a", "b", "c"}
    assert planned.sensors.marker_noise == 2e-4
    assert set(planned.motions) == {"alkion@1"}


@pytest.mark.parametrize(
    ("motions", "sensors", "words"),
    [
        (["alkion@x"], None, "expected NAME or NAME@SCALE"),
        (["alkion", "alkion@1.0"], None, "once"),
        (["no-such-motion"], None, "no-such-motion"),
        (["alkion"], SENSORS.replace("BODY", "block-9"), "block-9"),
        (["alkion"], "markers: [{name: b, body: block-1, position: [0, 0, 0]}]", "on a driven body"),
        (["alkion"], "marker: []", "unknown key"),
    ],
)
def test_bad_input_is_one_line(tmp_path, motions, sensors, words):
    file = None
    if sensors:
        file = str(tmp_path / "sensors.yaml")
        write_text(file, sensors)
    with pytest.raises(InputError, match=words) as error:
        load_planned(STRUCTURE, motions, file)
    assert "\n" not in str(error.value)


def test_no_measurement_more_takes_chances_away():
    """Another draw of the noise may tell a pair less surely: the measurement then adds nothing to it."""
    before = {("a", "b"): 0.6, ("a", None): 0.9}
    after = {("a", "b"): 0.4, ("a", None): 0.95, ("c", None): 0.2}
    assert plan.gained_chances(before, after) == {
        ("a", "b"): 0.0, ("a", None): pytest.approx(0.05), ("c", None): 0.2,
    }  # fmt: skip
