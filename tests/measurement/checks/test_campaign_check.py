"""Lines of `check` on a campaign; the good test is that of resting_stack.py, whose truth is known."""

import os
import re
from pathlib import Path

import numpy as np
import pytest
from resting_stack import MARKERS, MOTION, NOISE, PLACES, STRUCTURE, resting_stack, write_campaign
from scipy.spatial.transform import Rotation

from blockshake.dynamics.motion import ground_motion
from blockshake.dynamics.records.contract_csv import write_motion_csv
from blockshake.errors import InputError
from blockshake.files import file_digest
from blockshake.measurement.checks.campaign_check import campaign_lines, multiples

SHARED = Path(os.environ.get("BLOCKSHAKE_SHARED", Path(__file__).parents[4] / "shared"))
BLOCKS = [place for place, name in enumerate(MARKERS) if not name.startswith("slab")]


def _lines(folder, spoil=lambda test: None, **how):
    test = resting_stack()
    spoil(test)
    return campaign_lines(write_campaign(folder, test, **how))


def test_a_good_campaign_is_described_and_never_changed(tmp_path):
    folder = write_campaign(tmp_path, resting_stack())
    before = file_digest(folder / "t1.nc")
    lines = campaign_lines(folder)
    assert f"10 s at 200 Hz, {len(MARKERS)} markers on 4 bodies" in lines[1]
    assert "2 accelerometer channels at 512 Hz" in lines[1]
    assert "table moved by 100 % of the command" in lines[1]
    assert lines[-1] == "no inconsistency found"
    assert file_digest(folder / "t1.nc") == before


def test_noise_is_found_in_the_quiet_part(tmp_path):
    lines = _lines(tmp_path, noise=1e-3)
    found = float(re.search(r"marker noise ([\d.]+) mm", lines[1]).group(1))
    # 48 channels of 100 readings: a standard error of 1.2 % of what differences of neighbours give
    assert found == pytest.approx(1e3 * NOISE, rel=0.05)
    assert any("marker noise found" in line and "stated 1 mm" in line for line in lines)


def test_of_a_sealed_test_shape_and_noise_are_told_and_no_more(tmp_path):
    def answer(test):
        _turn_blocks(test)
        test["marker_displacement"][..., 0] *= 0.5

    lines = _lines(tmp_path, answer, role="sealed")
    assert f"{len(MARKERS)} markers" in lines[1]
    assert "table moved" not in lines[1]
    remark, sealed = lines[lines.index("remarks:") + 1 :]
    assert sealed == "  all tests are sealed: a diagnosis has none to read"
    assert "along x, y, z" in remark  # halved along x alone


@pytest.mark.parametrize("ratio", [0.5, 2.0, -3.0])
def test_a_column_that_is_a_multiple_of_another_is_remarked(ratio, tmp_path):
    def spoil(test):
        readings = test["marker_displacement"]
        readings[:, BLOCKS[-1], 1] = ratio * readings[:, BLOCKS[0], 1]

    name, other = MARKERS[BLOCKS[-1]], MARKERS[BLOCKS[0]]
    assert any(f"{name}.y is {other}.y times {ratio:g}" in line for line in _lines(tmp_path, spoil))


@pytest.mark.parametrize("ratio", [0.5, -3.0])
def test_a_channel_that_is_a_multiple_of_another_is_remarked(ratio, tmp_path):
    def spoil(test):
        noise = np.random.default_rng(1).normal(0.0, 0.02, test["accelerometer"].shape)
        test["accelerometer"][:] = test["accelerometer"] + noise
        test["accelerometer"][:, 1] = ratio * test["accelerometer"][:, 0]

    first, second = resting_stack()["channel"].values[:2]
    assert any(f"{second} is {first} times {ratio:g}" in line for line in _lines(tmp_path, spoil))


def test_a_wire_that_is_a_multiple_of_another_is_remarked_and_a_gap_and_a_copy_are_not():
    """Copies have a remark of their own; of a wire with gaps nothing is said."""
    wires = np.random.default_rng(2).normal(0.0, 1e-3, (500, 4))
    wires[:, 1], wires[:, 2], wires[5, 3] = 2.5 * wires[:, 0], wires[:, 0], np.nan
    assert multiples(["w1", "w2", "w3", "w4"], wires) == [
        "w2 is w1 times 2.5: one column mapped twice?",
        "w3 is w2 times 0.4: one column mapped twice?",
    ]


def test_a_marker_that_no_test_reads_and_a_weak_table_are_remarked(tmp_path):
    test = resting_stack()
    test["marker_displacement"][:] *= 0.6
    lines = campaign_lines(write_campaign(tmp_path, test.sel(marker=MARKERS[:-1])))
    assert any(f"marker {MARKERS[-1]} of the structure is in no test" in line for line in lines)
    assert any("table moved by 0.60 of what was commanded" in line for line in lines)


def _turn_blocks(test):
    values = test["marker_displacement"].to_numpy().copy()
    values[:, BLOCKS] = values[:, BLOCKS][..., [1, 0, 2]]
    test["marker_displacement"][:] = values


def _uplift_along_y(test):
    test["marker_displacement"][:, BLOCKS, 1] += 0.01 * np.sin(test["time"].to_numpy())[:, None] ** 2


def _noisy_marker(test):
    generator = np.random.default_rng(2)
    test["marker_displacement"][:, 5] += generator.normal(0.0, 5.0 * NOISE, (test.sizes["time"], 3))


def _noisy_accelerometer(test):
    test["accelerometer"][:, 1] += np.random.default_rng(2).normal(0.0, 1.0, test.sizes["time_acc"])


def _quiet_accelerometer(test):
    test["accelerometer"][:, 1] /= 9.81


def _slow_clock(test):
    test["time_acc"] = test["time_acc"].to_numpy() - 0.02


def _reversed_accelerometer(test):
    test["accelerometer"][:, 0] *= -1.0


def _exchanged_accelerometers(test):
    test["accelerometer"][:] *= 0.75


def _another_motion(test):
    test["marker_displacement"][:] = test["marker_displacement"].to_numpy()[::-1]
    test["marker_displacement"][:] -= test["marker_displacement"].to_numpy()[:5].mean(axis=0)


def _away(test):
    test["marker_displacement"][:, 5, 2] += 0.004


REMARKS = {
    "axes of the blocks": (_turn_blocks, r"block-1-face moves by -?0\.0\d, 1\.00, .*and 11 more markers likewise"),
    "y and z of the blocks": (_uplift_along_y, "are y and z swapped"),
    "a noisy marker": (_noisy_marker, r"marker noise of block-1-lower found 0\.5\d* mm, stated 0\.1 mm"),
    "a noisy accelerometer": (_noisy_accelerometer, r"accelerometer noise of block-1-acc-x found [\d.]+ m/s2, stated"),
    "a block's accelerometer in g": (_quiet_accelerometer, "accelerometer noise of block-1-acc-x found 0.00"),
    "a clock that is slow": (_slow_clock, r"add (20|19\.\d+|20\.\d+) ms to the accelerometers' times"),
    "a reversed accelerometer": (_reversed_accelerometer, r"slab's accelerometer along x reads -(0\.99|1)\d* of"),
    "accelerometers of another test": (_exchanged_accelerometers, r"slab's accelerometer along x reads 0\.7\d* of"),
    "another motion": (_another_motion, "does not follow the commanded motion"),
    "a start that is off": (_away, "block-1-lower starts 4.* mm off"),
}  # fmt: skip


@pytest.mark.parametrize("what", REMARKS)
def test_what_is_odd_but_usable_is_remarked(what, tmp_path):
    spoil, remark = REMARKS[what]
    lines = _lines(tmp_path, spoil)
    assert [line for line in lines if re.search(remark, line)], lines


def _turned(angle, swapped):
    """Blocks that turn by an angle [rad] over 2 s, about z, or about y with y and z of their markers exchanged."""

    def spoil(test):
        moved, time = test["marker_displacement"], test["time"].to_numpy()
        swell = angle * np.sin(0.5 * np.pi * np.clip((time - 4.0) / 2.0, 0.0, 1.0)) ** 2
        turns = Rotation.from_rotvec(
            swell[:, None] * np.array([0.0, 1.0, 0.0] if swapped else [0.0, 0.0, 1.0])
        )
        for body in ("block-1", "block-2", "block-3"):
            mine = [place for place in BLOCKS if MARKERS[place].startswith(f"{body}-")]
            for place in mine:
                arm = PLACES[place] - STRUCTURE.centroid[STRUCTURE.body_names.index(body)]
                turned = turns.apply(arm) - arm
                moved[:, place] += turned[:, [0, 2, 1]] if swapped else turned

    return spoil


@pytest.mark.parametrize(("swapped", "count"), [(False, 0), (True, 1)])
def test_blocks_that_turn_about_z_are_not_taken_for_swapped_axes(swapped, count, tmp_path):
    """A turn by 5 degrees moves markers 0.4 m from the centre by 35 mm along y; z is noise alone."""
    lines = _lines(tmp_path, _turned(np.deg2rad(5.0), swapped))
    assert sum("are y and z swapped?" in line for line in lines) == count, lines


def test_rounded_readings_that_stand_at_rest_have_the_noise_of_their_rounding(tmp_path):
    """Readings to 0.1 mm of a table without noise: rounding has 0.1 mm / sqrt(12) = 0.0289 mm."""

    def rounded(test):
        values = test["marker_displacement"].to_numpy()
        values[..., 0] = MOTION.evaluate(test["time"].to_numpy())[:, :1]
        values[..., 1:] = 0.02 * values[..., :1]
        test["marker_displacement"][:] = np.round(values - values[0], 4)

    assert "marker noise 0.0289 mm in the quiet" in _lines(tmp_path, rounded)[1]


@pytest.mark.parametrize("role", ["fit", "sealed"])
@pytest.mark.parametrize(
    ("factor", "said"),
    [
        (0.001, "1000 times as large: is the unit m, not mm, or mm, not um?"),
        (0.01, "100 times as large: is the unit m, not cm?"),
        (10.0, "0.1 times as large: is the unit mm, not cm?"),
        (0.103, "10 times as large: is the unit cm, not mm?"),
        (0.11, None),  # 10 % off
    ],
)
def test_another_unit_is_named_where_the_table_would_follow_its_command_in_it(factor, said, role, tmp_path):
    """Noise as in the wrong unit; the table follows the command within 1 %."""
    test = resting_stack().drop_vars("accelerometer").drop_dims("time_acc")
    _scaled(factor)(test)
    lines = campaign_lines(write_campaign(tmp_path, test, role=role))
    found = [line for line in lines if "would follow" in line]
    assert found == ([f"  t1: the table would follow its command with readings {said}"] if said else [])


def test_a_record_without_the_strong_part_is_remarked(tmp_path):
    test = resting_stack().isel(time=slice(0, 400), time_acc=slice(0, 1000))
    lines = campaign_lines(write_campaign(tmp_path, test))
    assert any("ends before the strongest shaking" in line for line in lines)


def test_rows_that_are_missing_are_remarked_with_time_and_length(tmp_path):
    test = resting_stack()
    rows = np.r_[0:800, 1000 : test.sizes["time"]]
    lines = campaign_lines(write_campaign(tmp_path, test.isel(time=rows)))
    for name in ("marker of a slab", "marker of a block"):
        remark = rf"  t1: no {name} reads anything for 1 s after 3.99\d? s, the longest such gap"
        assert any(re.fullmatch(remark, line) for line in lines), lines
    (tmp_path / "t1.nc").unlink()
    test = resting_stack().isel(time_acc=np.r_[0:512, 1024 : test.sizes["time_acc"]])
    lines = campaign_lines(write_campaign(tmp_path, test))
    assert any("  t1: no accelerometer reads anything for 1 s after 0.99" in line for line in lines), lines


def test_times_of_remarks_count_from_the_first_reading(tmp_path):
    """The command begins 1.5 s after it, the clock shows 100 s; gap and lost marker begin 4 s after the first one."""
    test = resting_stack()
    values = test["marker_displacement"].to_numpy()
    values[300:, :, 0] += np.roll(values[..., 0], 300, axis=0)[300:] - values[300:, :, 0]
    values[:300, :, 0] = np.random.default_rng(8).normal(0.0, NOISE, (300, len(MARKERS)))
    values[800:820, 3] = 0.5
    values[1000:1030] = np.nan
    test = test.drop_vars("accelerometer").drop_dims("time_acc")
    lines = campaign_lines(write_campaign(tmp_path, test.assign_coords(time=test["time"] + 100.0)))
    assert "1 test; stated noise of markers 0.1 mm" in lines[0]
    assert f"  t1: lost by the cameras at 4 s, 20 readings, taken as gaps: {MARKERS[3]}" in lines
    assert any(
        re.match(r"  t1: no marker of a slab reads anything for 0\.155 s after 4\.99\d s", line)
        for line in lines
    )


def _swap(test):
    test["marker_displacement"][:] = test["marker_displacement"].to_numpy()[..., [1, 0, 2]]


def _reverse(test):
    test["marker_displacement"][..., 0] *= -1.0


def _scaled(factor):
    def spoil(test):
        test["marker_displacement"][:] *= factor

    return spoil


def _one_in_millimetres(test):
    _rest(test)
    test["marker_displacement"][:, 7] *= 1000.0


def _rest(test):
    """Nothing but noise, which betrays the unit where nothing moves or the command is not at hand."""
    test["marker_displacement"][..., 0] -= test["marker_displacement"][..., 0].mean("marker")


def _resting_millimetres(test):
    _rest(test)
    _scaled(1000.0)(test)


def _in_g(test):
    test["accelerometer"][:] /= 9.81


LATER = {"motion": "of-the-laboratory"}
REFUSED = {
    "swapped axes": (_swap, {}, "axis: expected the table to move along x; what was commanded is along y"),
    "swapped axes, sealed": (_swap, {"role": "sealed"}, "axis: expected the table to move along x"),
    "x reversed": (_reverse, {}, "axis: expected the table to move along x as commanded; it moves by -1.00"),
    "x reversed, sealed": (_reverse, {"role": "sealed"}, "axis: expected the table to move along x as"),
    "millimetres": (_scaled(1000.0), {}, "marker_displacement: expected metres; a displacement of"),
    "centimetres": (
        _scaled(100.0), {}, "marker_displacement: expected metres; the table moves by 100 times what was commanded; "
        "the table would follow its command with readings 0.01 times as large: is the unit cm, not m",
    ),
    "centimetres, sealed": (_scaled(100.0), {"role": "sealed"}, "marker_displacement: expected metres; the table"),
    "millimetres, no command": (_resting_millimetres, LATER, r"\S+: expected metres; its noise at rest, 0\.\d+, is"),
    "one marker in millimetres": (_one_in_millimetres, LATER, f"{MARKERS[7]}: expected metres; its noise"),
    "accelerometers in g": (_in_g, {}, r"accelerometer: expected m/s2; the slab's reads 0\.1\d* of"),
}  # fmt: skip


@pytest.mark.parametrize("what", REFUSED)
def test_another_unit_or_axis_is_refused_in_one_line(what, tmp_path):
    spoil, how, message = REFUSED[what]
    test = resting_stack()
    spoil(test)
    folder = write_campaign(tmp_path, test.drop_vars("marker_initial_position"), **how)
    with pytest.raises(InputError) as error:
        campaign_lines(folder)
    assert re.match(f"{re.escape(str(folder / 't1.nc'))}: ({message})", str(error.value)), error.value
    assert "\n" not in str(error.value)


def test_a_small_sine_is_no_weak_or_strong_table(tmp_path):
    """0.3 mm read with 0.1 mm the peak would be a third too large; the regression is not.

    Its standard error is noise / (rms of the sine x root of the readings x markers) = 0.1 / (0.18 x 57) = 1 %.
    """
    time = np.arange(4001) / 1000.0
    omega, swell = 10.0 * np.pi, np.clip(np.minimum(time, 4.0 - time) / 0.8, 0.0, 1.0)
    moved = -0.3 / omega**2 * np.sin(omega * time) * swell**2 * (3.0 - 2.0 * swell)
    motion = ground_motion("sine", time, {"x": moved}, "displacement")
    write_motion_csv(motion, tmp_path / "sine.csv")
    test = resting_stack().isel(time=slice(0, 801)).drop_vars("accelerometer").drop_dims("time_acc")
    read = np.zeros(test["marker_displacement"].shape)
    read[..., 0] = motion.evaluate(test["time"].to_numpy())[:, :1]
    read += np.random.default_rng(3).normal(0.0, NOISE, read.shape)
    test["marker_displacement"][:] = read - read[0]
    lines = campaign_lines(write_campaign(tmp_path, test, motion="sine.csv"))
    assert lines[-1] == "no inconsistency found", lines
    assert float(re.search(r"table moved by ([\d.]+) %", lines[1]).group(1)) == pytest.approx(100.0, abs=4.0)


def test_a_motion_that_is_not_at_hand_is_remarked_and_a_broken_one_refused(tmp_path):
    lines = _lines(tmp_path, motion="of-the-laboratory")
    assert any("the commanded motion of-the-laboratory is not at hand" in line for line in lines)
    (tmp_path / "own.csv").write_text("time_s,acceleration_x\n0,0\n0.1,far\n")
    with pytest.raises(InputError, match=r"own\.csv: .*far"):
        _lines(tmp_path, motion="own.csv")


@pytest.mark.parametrize(
    ("scale", "message"),
    [(".nan", "finite number"), (".inf", "finite number"), ("0", "other than 0"), ('"1"', "valid number")],
)
def test_a_scale_is_a_finite_number_other_than_zero(scale, message, tmp_path):
    with pytest.raises(InputError, match=rf"campaign\.yaml: tests\.t1\.scale: .*{message}") as error:
        _lines(tmp_path, scale=scale)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize("name", ["example-clean", "example-pitch"])
def test_the_example_campaigns_pass(name):
    folder = SHARED / "campaigns" / name
    if not folder.is_dir():
        pytest.skip(f"{folder} is not here")
    lines = campaign_lines(folder)
    assert len(lines) == 8
    # a fifth of their noise is slow, which they do not state
    assert lines[-1].count("20 % of its variance slow (0.1 s)") == 2


def test_a_sensor_that_one_test_lacks_is_remarked(tmp_path):
    folder = write_campaign(tmp_path, resting_stack())
    test = resting_stack()
    test["marker_displacement"].values[:, 5] = 0.5  # named by its fault
    test.sel(marker=MARKERS[:-1]).isel(channel=[0]).to_netcdf(folder / "t2.nc")
    campaign = folder / "campaign.yaml"
    listed = campaign.read_text().rstrip().splitlines()[-1]
    campaign.write_text(f"{campaign.read_text().rstrip()}\n{listed.replace('t1', 't2')}\n")
    lines = campaign_lines(folder)
    assert f"  t2: no readings of {MARKERS[-1]}, block-1-acc-x, which other tests have" in lines
    assert sum("no readings of" in line for line in lines) == 1


def test_a_test_that_is_there_twice_is_remarked(tmp_path):
    folder = write_campaign(tmp_path, resting_stack())
    campaign = folder / "campaign.yaml"
    listed = campaign.read_text().rstrip().splitlines()[-1]
    campaign.write_text(f"{campaign.read_text().rstrip()}\n{listed.replace('t1', 't2')}\n")
    (folder / "t2.nc").write_bytes((folder / "t1.nc").read_bytes())
    assert "  t2: has the readings of t1" in campaign_lines(folder)
