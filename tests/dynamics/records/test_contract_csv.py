import numpy as np
import pytest

from blockshake.dynamics.load_motion import load_motion
from blockshake.dynamics.motion import ground_motion
from blockshake.dynamics.records.contract_csv import read_motion_csv, write_motion_csv
from blockshake.errors import InputError


def test_columns_kind_and_blank_lines():
    text = "time_s, acceleration_x,acceleration_z,pitch_y\n0,1,2,0.1\n\n0.5,3,4,0.2\n1.5,5,6,0.3\n\n"
    time, columns, kind = read_motion_csv(text, "motion.csv")
    np.testing.assert_array_equal(time, [0.0, 0.5, 1.5])
    assert kind == "acceleration"
    assert list(columns) == ["x", "z", "pitch_y"]
    np.testing.assert_array_equal(columns["z"], [2.0, 4.0, 6.0])
    np.testing.assert_array_equal(columns["pitch_y"], [0.1, 0.2, 0.3])


def test_pitch_alone_is_a_motion():
    assert read_motion_csv("time_s,pitch_y\n0,0\n1,0.1\n", "m")[2] == "displacement"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "time_s: expected this column"),
        ("t,acceleration_x\n0,0\n1,1\n", "time_s: expected this column"),
        ("time_s\n0\n1\n", "at least one column of motion"),
        ("time_s,acceleration_q\n0,0\n1,1\n", "column 'acceleration_q': expected one of"),
        ("time_s,acceleration_x,velocity_x\n0,0,0\n1,1,1\n", "one kind, found acceleration and velocity"),
        ("time_s,velocity_x,velocity_x\n0,0,0\n1,1,1\n", "column 'velocity_x': expected once"),
        ("time_s,velocity_x\n0,0\n", "at least two rows of numbers, found 1"),
        ("time_s,velocity_x\n0,0\n1,nan\n", "line 3, velocity_x: expected a finite number, found 'nan'"),
        ("time_s,velocity_x\n0,0\n1,\n", "line 3, velocity_x: expected a finite number"),
        ("time_s,velocity_x\n0,0\n\n1,2,3\n", "line 4: expected 2 cells, found 3"),
        ("time_s,velocity_x\n0,0\n1,1\n1,2\n", "line 4, time_s: expected times that increase"),
    ],
)
def test_wrong_files_are_named(text, message):
    with pytest.raises(InputError, match=message) as caught:
        read_motion_csv(text, "motion.csv")
    assert str(caught.value).startswith("motion.csv: ")
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("kind", ["acceleration", "velocity", "displacement"])
def test_round_trip_gives_the_same_displacement(tmp_path, kind):
    rng = np.random.default_rng(4)
    time = np.concatenate([[0.0], np.cumsum(rng.uniform(0.004, 0.02, 300))])
    columns = {"x": rng.normal(size=301), "pitch_y": 0.01 * rng.normal(size=301)}
    motion = ground_motion("m", time, columns, kind).scaled(1.5)
    write_motion_csv(motion, tmp_path / "m.csv")
    again = load_motion(tmp_path / "m.csv")
    assert again.kind == kind
    between = np.linspace(0.0, time[-1], 1000)
    # the table is rebuilt from values that agree to the last bit but for the last row
    np.testing.assert_allclose(again.evaluate(between), motion.evaluate(between), rtol=0, atol=1e-12)


def test_a_motion_at_rest_keeps_its_x_column(tmp_path):
    write_motion_csv(ground_motion("rest", [0.0, 1.0], {"y": [0.0, 0.0]}, "velocity"), tmp_path / "rest.csv")
    assert (tmp_path / "rest.csv").read_text() == "time_s,velocity_x\n0.0,0.0\n1.0,0.0\n"
