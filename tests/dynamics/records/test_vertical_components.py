"""A component that its file calls vertical does not become x or y."""

import os
from pathlib import Path

import numpy as np
import pytest

from blockshake.cli import main
from blockshake.dynamics.load_motion import load_motion
from blockshake.dynamics.records.record import Record
from blockshake.errors import InputError

CASES = Path(os.environ.get("BLOCKSHAKE_SHARED", Path(__file__).parents[4] / "shared")) / "cases"
UP = (
    "UP",
    "up",
    "DOWN",
    "Dwn",
    "U-D",
    "UD",
    "UD2",
    "Vert",
    "VERTICAL",
    "vert.",
    "HNZ",
    "BHZ",
    "V",
    "Z",
    "CHN 2: Up",
)
LEVEL = ("N-S", "E-W", "NS1", "HNE", "HN1", "90", "N90E", "H1", "X", "90 Deg", "TRAN", "360", "SETUP", "")


def record(**keys):
    return Record(np.array([0.0, 1.0, -1.0, 0.0]), 0.01, "made up", "nothing", **keys)


def moving(motion):
    """Axes along which a motion moves."""
    return np.flatnonzero(np.ptp(motion.evaluate(np.linspace(0.0, 0.03, 4))[:, :3], axis=0)).tolist()


@pytest.mark.parametrize("text", UP)
def test_vertical_names(text):
    assert record(channel=text).vertical() == text
    assert record(metadata={"stream": text}).vertical() == text
    assert record(metadata={"event": f"Somewhere, 10/15/79, Station 9, {text}"}).vertical() == text


@pytest.mark.parametrize("text", LEVEL)
def test_horizontal_names(text):
    assert record(channel=text).vertical() == ""
    assert record(metadata={"stream": text}).vertical() == ""
    assert record(metadata={"event": f"Somewhere, 10/15/79, Station 9, {text}"}).vertical() == ""


def test_the_name_of_an_event_is_no_direction():
    assert record(metadata={"event": "MADE UP"}).vertical() == ""


@pytest.mark.parametrize(("direction", "refused"), [("UP", True), ("090", False)])
def test_a_vertical_at2_file(direction, refused, tmp_path):
    head = f"PEER STRONG MOTION DATABASE RECORD\nSomewhere, 1/1/2000, Nowhere, {direction}\n"
    path = tmp_path / "a.at2"
    path.write_text(f"{head}ACCELERATION IN UNITS OF G\nNPTS= 4, DT= .010 SEC\n 0.0 0.1 -0.1 0.0\n")
    if not refused:
        assert moving(load_motion(path)) == [0]
        return
    for channels in (None, {"x": "1"}, {"y": "1"}):
        with pytest.raises(InputError, match=r"a\.at2: [xy]: expected a horizontal component, found 'UP'"):
            load_motion(path, channels=channels)
    assert moving(load_motion(path, channels={"z": "1"})) == [2]


@pytest.mark.skipif(not CASES.is_dir(), reason=f"no {CASES} (set BLOCKSHAKE_SHARED)")
def test_a_vertical_record_shakes_no_block_sideways(tmp_path, capsys):
    case, run = CASES / "vertical-record-as-x", tmp_path / "run.nc"
    command = ["simulate", "--structure", str(case / "block.yaml"), "--motion", str(case / "record.UD")]
    assert main([*command, "--model", "nscd-rigid", "--duration", "2", "--output", str(run)]) == 2
    assert main(["check", str(case / "record.UD")]) == 2
    assert "expected a horizontal component, found 'U-D'" in capsys.readouterr().err
    motion = tmp_path / "motion.csv"
    assert main(["convert-motion", str(case / "record.UD"), "--column", "z=1", "--output", str(motion)]) == 0
    assert motion.read_text().splitlines()[0].endswith("acceleration_z")
