import sys
from pathlib import Path

import numpy as np
import pytest

from blockshake.dynamics.load_motion import load_motion
from blockshake.dynamics.records.contract_csv import write_motion_csv
from blockshake.errors import InputError

sys.path.insert(0, str(Path(__file__).parent / "records"))
from record_files import STEP, at2, cosmos, dyna, series


def accelerations(motion):
    return 2.0 * motion.table.coefficients[:, 0, 2]


@pytest.mark.parametrize(
    ("file_name", "text", "unit", "format_name"),
    [
        ("a.asc", dyna(series()), 0.01, "ESM/ITACA DYNA 1.2"),
        ("b.AT2", at2(series() / 1000.0), 9.80665e-3, "PEER NGA AT2"),
        ("c.v2", cosmos(series()), 0.01, "COSMOS V2"),
        ("d.txt", dyna(series()), 0.01, "ESM/ITACA DYNA 1.2"),
    ],
)
def test_content_tells_the_format_and_values_are_si(tmp_path, file_name, text, unit, format_name):
    (tmp_path / file_name).write_text(text)
    raw = load_motion(tmp_path / file_name, baseline="none")
    np.testing.assert_allclose(accelerations(raw), unit * series()[:-1], atol=1e-8)  # the files' last digits
    assert raw.duration == pytest.approx(STEP * 499)
    assert raw.attributes["format"] == format_name
    assert raw.attributes["baseline"].startswith("none, as requested; the record ends with ")
    assert raw.attributes["synthetic"] is False
    assert raw.name == Path(file_name).stem


@pytest.mark.parametrize("file_name", ["a.asc", "b.AT2", "c.v2"])
def test_a_record_of_any_format_is_corrected_where_it_drifts(file_name, tmp_path):
    make, unit = {"a.asc": (dyna, 1.0), "b.AT2": (at2, 980.665), "c.v2": (cosmos, 1.0)}[file_name]
    ends = {}
    for offset in (0.0, 5.0):  # 0.05 m/s2, 0.6 m after 5 s
        (tmp_path / file_name).write_text(make((series() + offset) / unit))
        raw = load_motion(tmp_path / file_name, baseline="none")
        read = load_motion(tmp_path / file_name)
        ends[offset] = [motion.evaluate(motion.table.breaks[-1:])[0, 0] for motion in (raw, read)]
        assert read.attributes["baseline"].startswith("corrected" if offset else "as published")
        assert read.attributes["format"] == raw.attributes["format"]
    assert ends[0.0][0] == ends[0.0][1]
    assert ends[5.0][0] > 0.5
    assert abs(ends[5.0][1]) < 1e-6
    assert "0.1 Hz" in read.attributes["baseline"]


def test_converted_record_moves_as_the_record(tmp_path):
    (tmp_path / "a.asc").write_text(dyna(series()))
    motion = load_motion(tmp_path / "a.asc")
    write_motion_csv(motion, tmp_path / "a.csv")
    again = load_motion(tmp_path / "a.csv")
    times = np.linspace(0.0, 4.99, 777)
    np.testing.assert_allclose(again.evaluate(times), motion.evaluate(times), rtol=0, atol=1e-14)


def test_csv_is_not_corrected_and_time_starts_at_zero(tmp_path):
    (tmp_path / "m.csv").write_text("time_s,velocity_x\n2.0,1.0\n3.0,1.0\n")
    motion = load_motion(tmp_path / "m.csv", scale=2.0)
    assert motion.table.breaks[0] == 0.0
    assert motion.attributes["first_time"] == 2.0
    assert motion.attributes["baseline"] == "none"
    np.testing.assert_allclose(motion.evaluate(np.array([0.5]))[0, 0], 1.0)
    assert motion.attributes["scale"] == 2.0


def test_shipped_names_load_and_own_parameters_too(tmp_path):
    motion = load_motion("alkion", scale=0.5)
    assert np.abs(accelerations(motion)).max() == pytest.approx(0.588, rel=1e-12)
    own = tmp_path / "own.yaml"
    shipped_file = Path(__file__).parents[2] / "config" / "motions" / "alkion.yaml"
    own.write_text(shipped_file.read_text().replace("peak_acceleration: 1.176", "peak_acceleration: 2.0"))
    assert np.abs(accelerations(load_motion(own))).max() == pytest.approx(2.0, rel=1e-12)


@pytest.mark.parametrize(
    ("file_name", "text", "message"),
    [
        ("missing.csv", None, "missing.csv: expected a readable file"),
        ("note.txt", "hello\n", "note.txt: expected a motion CSV"),
        ("short.AT2", "hello\n", "short.AT2: expected four header lines"),
        ("short.asc", "hello\n", "short.asc: SAMPLING_INTERVAL_S"),
        ("short.V2C", "hello\n", "short.V2C: expected an acceleration series"),
        ("bad.csv", "a,b\n", "bad.csv: time_s"),
    ],
)
def test_wrong_files_are_named_in_one_line(tmp_path, file_name, text, message):
    if text is not None:
        (tmp_path / file_name).write_text(text)
    with pytest.raises(InputError, match=message) as caught:
        load_motion(tmp_path / file_name)
    assert "\n" not in str(caught.value)


def test_unknown_name_lists_the_shipped_ones():
    with pytest.raises(InputError, match="alkion, basso-tirreno"):
        load_motion("alkyon")


def test_scale_must_be_a_number():
    with pytest.raises(InputError, match="scale: expected a finite number"):
        load_motion("alkion", scale=np.nan)
