"""A record at rest comes out as published; one that drifts is named, and corrected with its pads."""

import os
import re
import sys
from functools import lru_cache
from pathlib import Path

import numpy as np
import pytest

from blockshake.dynamics.baseline import check_window, checked_baseline, fast_length, high_pass
from blockshake.dynamics.intensity import motion_figures
from blockshake.dynamics.load_motion import load_motion, provenance
from blockshake.dynamics.synthetic_motion import load_synthetic, synthesise
from blockshake.errors import InputError
from blockshake.files import shipped

sys.path.insert(0, str(Path(__file__).parent))
from made_records import SIZE, TIME, wavelet, write_at2

SHARED = Path(os.environ.get("BLOCKSHAKE_SHARED", Path(__file__).parents[3] / "shared"))
CASE = SHARED / "cases" / "record-corrected-twice"
PAD = 30.0  # s: 1.5 times the order, 2, over the corner of 0.1 Hz
DRIFTS = {
    "offset": np.full(len(TIME), 0.01),
    "slope": 0.02 * TIME / TIME[-1],
    "tilt": 0.01 * (TIME > 15.0),
    "hum": 0.01 * np.sin(2.0 * np.pi * TIME / 90.0),
}  # m/s2
EARLY, LATE = 0.1, 12.0  # s, where the wavelet starts


@lru_cache
def made_at_rest(seed):
    """Acceleration of 40 s at 0.005 s that ends at rest, like the shipped motion Alkion [m/s2]."""
    parameters = load_synthetic(shipped("motions", "alkion"))
    motion = synthesise(parameters.model_copy(update={"time_step": 0.005, "duration": 40.0, "seed": seed}))
    return motion.evaluate(motion.table.breaks, 2)[:, 0]


def as_published(path):
    """Whether a record comes out bit for bit."""
    read, raw = load_motion(path), load_motion(path, baseline="none")
    same = all(a.tobytes() == b.tobytes() for a, b in zip(read.table, raw.table, strict=True))
    assert same == read.attributes["baseline"].startswith("as published")
    assert ("record_start" in read.attributes) is not same
    return same


@pytest.mark.parametrize("start", [EARLY, LATE])
def test_record_at_rest_keeps_its_peaks(start, tmp_path):
    path = write_at2(tmp_path / "rest.AT2", wavelet(start)[1])
    assert as_published(path)
    figures = motion_figures(load_motion(path))
    assert figures["peak_displacement"] == pytest.approx(SIZE, rel=3e-3)  # a row may miss the peak
    assert figures["peak_acceleration"] == pytest.approx(np.abs(wavelet(start)[1]).max(), rel=1e-6)
    assert "within the rounding of its values" in load_motion(path).attributes["baseline"]


@pytest.mark.parametrize("cut", [False, True])
@pytest.mark.parametrize("fixed", [False, True])
@pytest.mark.parametrize("digits", [4, 5, 6, 7])
def test_rounding_of_a_print_calls_no_correction(digits, fixed, cut, tmp_path):
    """40 s at 0.005 s: the sums of rounding errors reach centimetres with few decimals, with 27 mm of motion."""
    path = write_at2(tmp_path / "p.AT2", made_at_rest(digits), 0.005, digits=digits, fixed=fixed, cut=cut)
    assert as_published(path)
    assert "within the rounding" in load_motion(path).attributes["baseline"]


@pytest.mark.parametrize("digits", [4, 5, 6, 7])
@pytest.mark.parametrize("fixed", [False, True])
def test_drift_beyond_rounding_is_no_rounding(digits, fixed, tmp_path):
    """An offset of three steps of the fourth digit, 0.0003 g: 88 mm/s and 1.3 m after 30 s."""
    offset = 0.003 / 1.02  # m/s2, not a whole number of steps
    path = write_at2(tmp_path / "d.AT2", wavelet(EARLY)[1] + offset, digits=digits, fixed=fixed)
    assert not as_published(path)


def test_constant_record_drifts_though_its_values_have_one_digit(tmp_path):
    assert not as_published(
        write_at2(tmp_path / "c.AT2", np.full(len(TIME), 0.01 * 9.80665), digits=2, fixed=True)
    )


@pytest.mark.parametrize("start", [EARLY, LATE])
@pytest.mark.parametrize("drift", DRIFTS)
def test_drifting_record_is_named_and_comes_to_rest(drift, start, tmp_path):
    displacement, acceleration = wavelet(start)
    path = write_at2(tmp_path / "d.AT2", acceleration + DRIFTS[drift])
    raw, read = load_motion(path, baseline="none"), load_motion(path)
    assert motion_figures(raw)["peak_displacement"] > 1.0
    # the words hold the drift and the peaks before and after
    words = read.attributes["baseline"]
    changes = words.partition("; least")[0].replace("m/s2", "")
    numbers = [float(text) for text in re.findall(r"[-+]?\d+\.?\d*(?:e[-+]?\d+)?", changes)]
    before, after = motion_figures(raw), motion_figures(read)
    expected = [raw.evaluate(raw.table.breaks[-1:], 1)[0, 0], 1e3 * before["end_displacement"]]
    for key, unit in (("peak_acceleration", 1.0), ("peak_velocity", 1.0), ("peak_displacement", 1e3)):
        expected += [unit * before[key], unit * after[key]]
    np.testing.assert_allclose(numbers, expected, rtol=5e-3)
    # the pads are kept, and the record lies between them
    assert read.duration == pytest.approx(TIME[-1] + 2.0 * PAD)
    assert read.attributes["record_start"] == pytest.approx(PAD)
    ends = read.table.breaks[[0, -1]]
    # exp(-pi sqrt(2) corner PAD) of a tilt's 25 mm, step / (2 pi corner)^2
    np.testing.assert_allclose(read.evaluate(ends)[:, 0], 0.0, atol=1e-6)
    np.testing.assert_allclose(read.evaluate(ends, 1)[:, 0], 0.0, atol=1e-6)
    # peaks of the wavelet, of which the filter takes the part below its corner: area 15 mm s times some 0.2 Hz
    moved = read.evaluate(PAD + TIME)[:, 0]
    assert np.abs(moved - displacement).max() < 0.006
    outside = np.concatenate(
        [read.evaluate(np.arange(0.0, PAD, 0.1))[:, 0], read.evaluate(PAD + 30.0 + TIME)[:, 0]]
    )
    assert np.abs(outside).max() < 0.006
    assert after["peak_acceleration"] == pytest.approx(np.abs(acceleration).max(), rel=5e-3)
    assert after["peak_velocity"] == pytest.approx(0.2534, rel=1e-2)


def test_permanent_displacement_is_no_drift(tmp_path):
    """A step of 0.3 m within 4 s, published with it: the ground is at rest elsewhere, and stays so."""
    x = np.clip((TIME - 5.0) / 4.0, 0.0, 1.0)
    acceleration = (
        0.3 / 16.0 * 2.0 * np.pi * np.sin(2.0 * np.pi * x)
    )  # second derivative of x - sin(2 pi x) / 2 pi
    path = write_at2(tmp_path / "fling.AT2", acceleration)
    assert as_published(path)
    assert "permanent displacement" in load_motion(path).attributes["baseline"]
    # the same without a mean: velocity ends at zero, but not before
    drifting = wavelet(EARLY)[1] + 0.02 * (1.0 - 2.0 * TIME / TIME[-1])
    path = write_at2(tmp_path / "mean.AT2", drifting)
    raw = load_motion(path, baseline="none")
    assert abs(raw.evaluate(raw.table.breaks[-1:], 1)[0, 0]) < 1e-6
    assert not as_published(path)


def test_small_drift_is_named_and_stays(tmp_path):
    """0.6 mm/s and 9 mm at the end, of 253 mm/s and 50 mm: a correction would change more."""
    path = write_at2(tmp_path / "s.AT2", wavelet(LATE)[1] + 2e-5)
    assert as_published(path)
    words = load_motion(path).attributes["baseline"]
    assert "0.0006 m/s at 9 mm" in words
    assert "less than 5% of its peak velocity and 20% of its peak displacement" in words


def _largest_rocking(motion):
    """Largest tilt of a block of 1.6 x 9.6 m over its slenderness, after Housner (1963); infinite if it falls."""
    slenderness, radius = np.arctan2(0.8, 4.8), np.hypot(0.8, 4.8)
    frequency2, kept = 3.0 * 9.81 / (4.0 * radius), 1.0 - 1.5 * np.sin(slenderness) ** 2
    step, time = 1e-3, np.arange(0.0, motion.duration, 1e-3)
    tilt, speed, largest = 0.0, 0.0, 0.0
    for push in motion.evaluate(time, 2)[:, 0] / 9.81:
        if tilt == 0.0 and abs(push) <= np.tan(slenderness):
            continue  # rests until the ground pushes it over an edge
        side = np.sign(tilt) if tilt else -np.sign(push)
        lever = side * slenderness - tilt
        speed -= step * frequency2 * (np.sin(lever) + push * np.cos(lever))
        before, tilt = tilt, tilt + step * speed
        if before * tilt < 0.0:
            speed *= kept
            tilt = 0.0 if abs(speed) < 1e-3 else tilt
        largest = max(largest, abs(tilt))
        if largest > 2.0 * slenderness:
            return np.inf
    return largest / slenderness


def test_block_that_stands_as_provided_stands_by_default(tmp_path):
    """Two seconds of strong motion at the start of two minutes, of which a taper of 2 % would cut the first half."""
    time = 0.02 * np.arange(6001)
    x, h = (time - EARLY) / 2.0, 1e-4

    def shape(x):
        return np.where((x > 0.0) & (x < 1.0), np.sin(2.0 * np.pi * x) * np.sin(np.pi * x) ** 3, 0.0)

    acceleration = shape(x + h) - 2.0 * shape(x) + shape(x - h)
    acceleration *= 3.5 / np.abs(acceleration).max()
    rest = write_at2(tmp_path / "rest.AT2", acceleration)
    drift = write_at2(tmp_path / "drift.AT2", acceleration + 0.005)
    provided = _largest_rocking(load_motion(rest, baseline="none"))
    assert provided == pytest.approx(0.37, abs=0.01)
    assert _largest_rocking(load_motion(rest)) == provided
    assert _largest_rocking(load_motion(drift)) == pytest.approx(provided, rel=0.05)


def test_frequency_corrects_whatever_ends_at_rest(tmp_path):
    path = write_at2(tmp_path / "r.AT2", wavelet(LATE)[1])
    read = load_motion(path, scale=2.0, baseline=0.5)
    assert read.attributes["record_start"] == pytest.approx(6.0)  # 1.5 times 2 over 0.5 Hz
    assert "as requested" in read.attributes["baseline"]
    assert "0.5 Hz" in read.attributes["baseline"]
    assert read.attributes["scale"] == 2.0
    with pytest.raises(InputError, match="duration: expected more than 6 s"):
        check_window(read, 6.0, "study.yaml", "duration")
    check_window(read, 6.1, "study.yaml", "duration")


def test_tables_of_the_project_are_corrected_with_a_frequency_alone(tmp_path):
    path = tmp_path / "m.csv"
    values = wavelet(LATE)[1] + 0.01
    rows = "\n".join(f"{time:.2f},{value:.7f},{-value:.7f}" for time, value in zip(TIME, values, strict=True))
    path.write_text("time_s,acceleration_x,acceleration_z\n" + rows + "\n")
    assert load_motion(path).attributes["baseline"] == "none"
    read = load_motion(path, baseline=0.1)
    moved = read.evaluate(read.table.breaks)
    np.testing.assert_allclose(moved[:, 2], -moved[:, 0], atol=1e-12)
    assert abs(moved[-1, 0]) < 1e-6
    assert "along z it ends with -0.3 m/s at -4500 mm" in read.attributes["baseline"]


@pytest.mark.parametrize("value", ["correct", "", None, True, 0, -0.1, np.nan, np.inf, "0", "1_0", [0.1]])
def test_another_baseline_is_refused(value, tmp_path):
    with pytest.raises(ValueError, match="expected auto, none or a corner frequency"):
        checked_baseline(value)
    path = write_at2(tmp_path / "r.AT2", wavelet(LATE)[1])
    with pytest.raises(InputError, match=r"r\.AT2: baseline: expected auto, none"):
        load_motion(path, baseline=value)


def test_a_corner_lies_below_the_nyquist_frequency_and_above_1_hz_is_remarked(tmp_path):
    path = write_at2(tmp_path / "r.AT2", wavelet(LATE)[1])
    nyquist = 0.5 / (TIME[1] - TIME[0])
    with pytest.raises(
        InputError, match=f"baseline: expected below the Nyquist frequency, {nyquist:g} Hz, not"
    ):
        load_motion(path, baseline=nyquist)
    remark = "a corner above 1 Hz takes ground motion away"
    for corner in (1.0, 1.1, 0.99 * nyquist):
        assert (remark in load_motion(path, baseline=corner).attributes["baseline"]) == (corner > 1.0)


@pytest.mark.parametrize(
    "text",
    [
        "time_s,velocity_x\n0,0\n1,1\n2,0\n",
        "time_s,acceleration_x\n0,0\n1,1\n3,0\n",
        "time_s,acceleration_x,pitch_y\n0,0,0\n1,1,0.1\n2,0,0\n",
    ],
)
def test_other_than_even_accelerations_cannot_be_corrected(text, tmp_path):
    (tmp_path / "m.csv").write_text(text)
    with pytest.raises(InputError, match="baseline: expected accelerations at even times"):
        load_motion(tmp_path / "m.csv", baseline=0.1)


def test_a_synthetic_motion_has_nothing_to_correct():
    with pytest.raises(InputError, match="baseline: expected auto or none of a synthetic motion"):
        load_motion("alkion", baseline=0.1)


def test_pads_longer_than_a_computer_holds_are_refused(tmp_path):
    path = write_at2(tmp_path / "r.AT2", wavelet(LATE)[1])
    with pytest.raises(InputError, match="expected at most 2e\\+07 samples"):
        load_motion(path, baseline=1e-6)


@pytest.mark.parametrize("ratio", [0.5, 1.0, 2.0])
def test_filter_has_the_amplitude_of_butterworth_twice(ratio):
    # a long sine seen in its middle, away from the ends: |H|^2 = r^8 / (1 + r^8), no phase shift
    time = 0.01 * np.arange(40000)
    sine = np.sin(2.0 * np.pi * 0.1 * ratio * time)
    middle = slice(18000, 22000)
    expected = ratio**8 / (1.0 + ratio**8)
    filtered = high_pass(sine, 0.01, 0.1, 4, fast_length(60000))
    np.testing.assert_allclose(filtered[middle], expected * sine[middle], atol=2e-3)


def test_provenance_says_format_assumption_and_baseline(tmp_path):
    read = load_motion(write_at2(tmp_path / "r.AT2", wavelet(LATE)[1]))
    words = provenance({**read.attributes, "assumed": "step from the header"})
    assert words.startswith("r.AT2 (PEER NGA AT2); assumed: step from the header; baseline: as published")
    assert provenance({"source": "somewhere"}) == "somewhere"


@pytest.mark.skipif(not CASE.is_dir(), reason=f"no {CASE} (set BLOCKSHAKE_SHARED)")
@pytest.mark.parametrize("name", ["wavelet", "control"])
def test_wavelet_of_the_case(name):
    """Peaks of the exact wavelet, early and late in the file: they were 2.847, 0.3453 and 0.260 where it is early."""
    figures = motion_figures(load_motion(CASE / f"{name}.AT2"))
    peaks = [figures[f"peak_{quantity}"] for quantity in ("acceleration", "velocity", "displacement")]
    np.testing.assert_allclose(peaks, [3.084, 0.2534, 0.0499], rtol=2e-3)
