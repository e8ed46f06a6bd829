"""Tables of any columns and units become motions, and are never guessed at."""

import numpy as np
import pytest

from blockshake.cli import main
from blockshake.dynamics.load_motion import load_motion

TIME = np.arange(2001) / 200.0
WAVE = np.sin(2.0 * np.pi * TIME) * np.sin(np.pi * TIME / TIME[-1]) ** 2


def _convert(tmp_path, values, *options, time=TIME):
    rows = [f"{at:.3f};{value:.9f}".replace(".", ",") for at, value in zip(time, values, strict=True)]
    (tmp_path / "in.csv").write_text("Zeit;EW\n" + "\n".join(rows) + "\n")
    call = [
        "convert-motion",
        str(tmp_path / "in.csv"),
        "--decimal",
        ",",
        "--time",
        "Zeit",
        "--column",
        "x=EW",
    ]
    return main([*call, *options, "--output", str(tmp_path / "out.csv")])


@pytest.mark.parametrize(
    ("unit", "size", "derivative"),
    [
        ("g", 9.80665, 2),
        ("m/s2", 1.0, 2),
        ("cm/s2", 0.01, 2),
        ("cm/s", 0.01, 1),
        ("m", 1.0, 0),
        ("mm", 1e-3, 0),
    ],
)
def test_a_unit_is_taken_at_its_word(unit, size, derivative, tmp_path):
    assert _convert(tmp_path, WAVE, "--unit", unit) == 0
    motion = load_motion(tmp_path / "out.csv")
    assert motion.kind == ("displacement", "velocity", "acceleration")[derivative]
    # nine digits after the comma were written
    np.testing.assert_allclose(
        motion.evaluate(TIME, derivative)[1:-1, 0], size * WAVE[1:-1], atol=2e-9 * size
    )


def test_a_correction_is_made_where_it_is_asked_for(tmp_path):
    """An offset of 0.01 m/s2 carries the ground 0.5 m in 10 s; the corrected one ends at rest."""
    ends = {}
    for baseline in ("auto", "none", "0.1"):
        assert _convert(tmp_path, WAVE + 0.01, "--unit", "m/s2", "--baseline", baseline) == 0
        motion = load_motion(tmp_path / "out.csv")
        ends[baseline] = motion.evaluate(motion.table.breaks[-1:])[0, 0]
    assert ends["none"] == pytest.approx(0.5, abs=0.05)
    assert ends["auto"] == ends["none"]
    assert abs(ends["0.1"]) < 1e-6


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ([], "--unit: expected for a table; the unit and the columns are never guessed"),
        (["--unit", "furlong"], "--unit: furlong: expected a unit of acceleration"),
        (["--unit", "g", "--column", "u=EW"], "--column: u: expected x, y, z"),
        (["--unit", "g", "--column", "y=NS"], "column 'NS': expected this column once; there are Zeit, EW"),
        (["--unit", "g", "--column", "x=NS"], "--column: x=NS: expected x once"),
        (["--unit", "g", "--column", "y=EW"], "--column: EW, EW: expected every column once"),
        (
            ["--unit", "g", "--column", "y=Zeit"],
            "--column: EW, Zeit: expected every column once, and not that of",
        ),
        (["--unit", "g", "--column", "x"], "--column: x: expected READING=COLUMN"),
        (["--unit", "mm", "--baseline", "0.1"], "baseline: expected accelerations at even times"),
        (
            ["--unit", "g", "--baseline", "correct"],
            "baseline: expected auto, none or a corner frequency above 0 Hz",
        ),
        (["--unit", "g", "--time-unit", "h"], "--time-unit: h: expected a unit of time"),
    ],
)
def test_faults_get_one_line(options, message, tmp_path, capsys):
    assert _convert(tmp_path, WAVE, *options) == 2
    assert message in capsys.readouterr().err
    assert not (tmp_path / "out.csv").exists()


def test_times_that_go_back_are_refused(tmp_path, capsys):
    time = TIME.copy()
    time[7] = time[5]
    assert _convert(tmp_path, WAVE, "--unit", "g", time=time) == 2
    assert "in.csv: line 9, Zeit: expected times that increase" in capsys.readouterr().err
