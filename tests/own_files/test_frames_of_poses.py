"""Poses from another frame: places and quaternions turn together, or the map is refused."""

import itertools
import os
from pathlib import Path

import numpy as np
import pytest
import yaml
from scipy.spatial.transform import Rotation

from blockshake.cli import main
from blockshake.measurement.campaigns.campaign import load_campaign, load_test

CASES = Path(os.environ.get("BLOCKSHAKE_SHARED", Path(__file__).parents[3] / "shared")) / "cases"
AXES, TIME = "xyz", np.arange(300) / 100
PITCH = 0.02 * np.sin(2.0 * np.pi * TIME) * (TIME > 1.0)  # rad about +y
# rows: x, y, z here; columns: the file's axes
FRAMES = {
    "z up": np.eye(3),
    "y up": np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]]),
    "z down": np.array([[1, 0, 0], [0, -1, 0], [0, 0, -1]]),
    "x up": np.array([[0, 1, 0], [0, 0, 1], [1, 0, 0]]),
    "shaken along -z, y up": np.array([[0, 0, -1], [-1, 0, 0], [0, 1, 0]]),
}
STRUCTURE = """\
name: column
materials: {c: {density: 2400, youngs_modulus: 3.0e10, poisson_ratio: 0.2}}
shapes: {b: {box: [0.4, 0.4, 1.2]}, s: {box: [3, 1, 0.2]}}
bodies:
  - {name: table, shape: s, material: c, position: [0, 0, -0.1], driven: true}
  - {name: column, shape: b, material: c, position: [0, 0, 0.6]}
friction: [{pair: [c, c], coefficient: 0.6}]
markers:
  - {name: s1, body: table, position: [0, -0.5, 0]}
  - {name: top, body: column, position: [0, 0, 0.6]}
  - {name: side, body: column, position: [0.2, 0, 0]}
"""


def campaign(folder, frame, letters="XYZ"):
    """Poses of a table and of a column that rocks about its base's middle, in a file's frame; and their true map."""
    (folder / "column.yaml").write_text(STRUCTURE)
    moved = 0.01 * np.sin(3.0 * np.pi * TIME) * (TIME > 1.0)
    rows = [f"{t},{x:.8f}" for t, x in zip(TIME, moved, strict=True)]
    (folder / "command.csv").write_text("\n".join(["time_s,displacement_x", *rows]) + "\n")
    noise = np.random.default_rng(1).normal(0.0, 1e-4, (2, len(TIME), 3))
    base = np.column_stack([moved, 0 * TIME, 0 * TIME])
    turned = Rotation.from_rotvec(np.outer(PITCH, [0, 1, 0]))
    bodies = {
        "T": (base + [0, 0, -0.1] + noise[0], Rotation.from_rotvec(np.zeros((len(TIME), 3)))),
        "C": (base + turned.apply([0, 0, 0.6]) + noise[1], turned),
    }
    columns, mapped = {"t": TIME}, {}
    for short, name in (("T", "table"), ("C", "column")):
        place, turn = bodies[short]
        quaternion = turn.as_quat(scalar_first=True)
        columns |= dict(zip([f"{short}{one}" for one in letters], (place @ frame).T, strict=True))
        columns[f"{short}QW"] = quaternion[:, 0]
        columns |= dict(
            zip([f"{short}Q{one}" for one in letters], (quaternion[:, 1:] @ frame).T, strict=True)
        )
        mapped[f"{name}.qw"] = f"{short}QW"
        for row, axis in zip(frame, AXES, strict=True):
            (at,) = np.flatnonzero(row)
            for part, head in (("", short), ("q", f"{short}Q")):
                mapped[f"{name}.{part}{axis}"] = {
                    "column": f"{head}{letters[at]}",
                    "reversed": bool(row[at] < 0),
                }
    np.savetxt(
        folder / "take.csv",
        np.column_stack([*columns.values()]),
        "%.9f",
        ",",
        header=",".join(columns),
        comments="",
    )
    return mapped


def imported(folder, mapped):
    settings = {
        "name": "take", "structure": "column.yaml", "time": "t", "displacement_unit": "m", "columns": mapped,
        "tests": [{"name": "t1", "file": "take.csv", "motion": "command.csv", "scale": 1.0, "role": "fit"}],
    }  # fmt: skip
    (folder / "map.yaml").write_text(yaml.safe_dump(settings))
    return main(["import-campaign", str(folder / "map.yaml"), "--output", str(folder / "made")])


@pytest.mark.parametrize("frame", FRAMES.values(), ids=FRAMES)
def test_poses_of_any_right_handed_frame_have_the_true_pitch(frame, tmp_path):
    assert imported(tmp_path, campaign(tmp_path, frame)) == 0
    test = load_test(load_campaign(tmp_path / "made"), "t1")["marker_displacement"]
    np.testing.assert_allclose(test.sel(marker="side", axis="z"), -0.2 * np.sin(PITCH), atol=8e-4)


@pytest.mark.parametrize("frame", FRAMES.values(), ids=FRAMES)
@pytest.mark.parametrize(
    "key", [f"column.{part}{axis}" for part, axis in itertools.product(("", "q"), AXES)] + ["column.qw"]
)
def test_one_sign_too_many_is_refused(frame, key, tmp_path, capsys):
    mapped = campaign(tmp_path, frame)
    entry = mapped[key] if isinstance(mapped[key], dict) else {"column": mapped[key], "reversed": False}
    mapped[key] = entry | {"reversed": not entry["reversed"]}
    assert imported(tmp_path, mapped) == 2
    assert "columns.column." in capsys.readouterr().err
    assert not (tmp_path / "made").exists()


@pytest.mark.parametrize("letters", ["XYZ", ["1st", "2nd", "3rd"]])
def test_a_part_of_a_quaternion_that_is_not_reversed_as_its_place_is_refused(letters, tmp_path):
    mapped = campaign(tmp_path, FRAMES["y up"], letters)
    mapped["column.qy"] = mapped["column.qy"] | {"reversed": False}
    assert imported(tmp_path, mapped) == 2


def test_two_axes_exchanged_without_a_sign_are_refused(tmp_path, capsys):
    mapped = campaign(tmp_path, FRAMES["y up"])
    mapped = {key: one if isinstance(one, str) else one | {"reversed": False} for key, one in mapped.items()}
    assert imported(tmp_path, mapped) == 2
    assert "the map mirrors" in capsys.readouterr().err


@pytest.mark.parametrize(("name", "code"), [("right", 0), ("axes-exchanged", 2), ("place-reversed", 2)])
@pytest.mark.skipif(not CASES.is_dir(), reason=f"no {CASES} (set BLOCKSHAKE_SHARED)")
def test_a_take_with_y_up(name, code, tmp_path):
    case = CASES / "filmed-y-up"
    assert main(["import-campaign", str(case / f"{name}.yaml"), "--output", str(tmp_path / "made")]) == code
    if code:
        return
    read = load_test(load_campaign(tmp_path / "made"), "t1")["marker_displacement"].sel(axis="z")
    found = -(read.sel(marker="c1") - read.sel(marker="c3")) / 0.6
    truth = np.genfromtxt(case / "truth.csv", delimiter=",", names=True)
    pitch = np.interp(found["time"], truth["time_s"], truth["pitch_rad"])
    assert np.corrcoef(found, pitch)[0, 1] > 0.99
