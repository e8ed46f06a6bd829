import os
import re
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from blockshake.dynamics.load_motion import load_motion
from blockshake.errors import InputError
from blockshake.files import file_digest
from blockshake.geometry.structure import load_structure
from blockshake.measurement.campaign import load_campaign, load_test
from blockshake.measurement.campaign_check import campaign_lines
from blockshake.measurement.markers import marker_position

SHARED = Path(os.environ.get("BLOCKSHAKE_SHARED", Path(__file__).parents[3] / "shared"))
NOISE = 1e-4
STRUCTURE = load_structure("configuration-1")
MARKERS = [marker.name for marker in STRUCTURE.file.markers]
PLACES = marker_position(STRUCTURE, STRUCTURE.position, STRUCTURE.orientation)
CAMPAIGN = """
name: mine
structure: configuration-1
sensors: {{marker_noise: {noise}, accelerometer_noise: 0.02}}
tests:
  - {{name: t1, file: {file}, motion: basso-tirreno, scale: 1.0, role: {role}}}
"""


@pytest.fixture
def readings():
    """Every marker follows the table, with noise and gaps: a synthetic test of a stack that never moves."""
    time = np.arange(2001) / 200.0
    motion = load_motion("basso-tirreno").evaluate(time)
    position = np.zeros((len(time), len(MARKERS), 3))
    position[..., 0] = (motion[:, 0] - motion[0, 0])[:, None]
    position += np.random.default_rng(1).normal(0.0, NOISE, position.shape)
    position[300:303, 2] = np.nan
    return xr.Dataset(
        {
            "marker_displacement": (("time", "marker", "axis"), position - position[0]),
            "marker_initial_position": (("marker", "axis"), PLACES.copy()),
            "accelerometer": (("time_acc", "channel"), np.zeros((5120, 1))),
        },
        {
            "time": time, "marker": MARKERS, "axis": ["x", "y", "z"], "time_acc": np.arange(5120) / 512.0,
            "channel": ["a-x"],
        },
    )  # fmt: skip


@pytest.fixture
def campaign(tmp_path):
    def write(test, file="t1.nc", role="fit", noise=NOISE):
        test.to_netcdf(tmp_path / file)
        (tmp_path / "campaign.yaml").write_text(CAMPAIGN.format(file=file, role=role, noise=noise))
        return tmp_path

    return write


def test_a_good_campaign_is_described_and_never_changed(readings, campaign):
    folder = campaign(readings)
    before = file_digest(folder / "t1.nc")
    lines = campaign_lines(folder)
    assert "10 s at 200 Hz, 12 markers on 4 bodies" in lines[1]
    assert "accelerometer channels at 512 Hz" in lines[1]
    assert "table reached 100 % of the commanded peak" in lines[1]
    assert lines[-1] == "no inconsistency found"
    assert file_digest(folder / "t1.nc") == before


def test_noise_is_found_in_the_quiet_part(readings, campaign):
    lines = campaign_lines(campaign(readings, noise=1e-3))
    found = float(re.search(r"marker noise ([\d.]+) mm", lines[1]).group(1))
    # 36 channels of 100 readings: a standard error of 1.2 %
    assert found == pytest.approx(1e3 * NOISE, rel=0.05)
    assert any("stated 1 mm" in line for line in lines)


def test_of_a_sealed_test_shape_and_noise_are_told_and_no_more(readings, campaign):
    lines = campaign_lines(campaign(readings, role="sealed"))
    assert "12 markers" in lines[1]
    assert "table reached" not in lines[1]


def test_a_marker_that_no_test_reads_and_a_weak_table_are_remarked(readings, campaign):
    readings["marker_displacement"][:] *= 0.5
    lines = campaign_lines(campaign(readings.sel(marker=MARKERS[:-1])))
    assert any(f"marker {MARKERS[-1]} of the structure is in no test" in line for line in lines)
    assert any("table's peak is 0.5" in line for line in lines)


def _swap(test):
    test["marker_displacement"][:] = test["marker_displacement"].to_numpy()[..., [1, 0, 2]]


def _swap_places(test):
    test["marker_initial_position"][:] = test["marker_initial_position"].to_numpy()[:, [1, 0, 2]]


def _millimetres(test):
    test["marker_displacement"][:] *= 1000.0


def _negative_step(test):
    time = test["time"].to_numpy().copy()
    time[100] = time[98]
    test["time"] = time


def _silent(test):
    test["marker_displacement"][:, 3, 1] = np.nan


def _unknown(test):
    test["marker"] = ["mystery", *MARKERS[1:]]


BAD = {
    "swapped axes": (_swap, "axis: expected the table to move along x"),
    "swapped places": (
        _swap_places,
        "axis: expected x, y, z; the markers start where the structure has them",
    ),
    "millimetres": (_millimetres, "marker_displacement: expected metres"),
    "negative step": (_negative_step, "time: expected times that increase; 0.49 s follows 0.495 s"),
    "silent channel": (_silent, f"{MARKERS[3]}.y: expected readings; all are missing"),
    "unknown marker": (_unknown, "mystery: expected markers of the structure"),
}


@pytest.mark.parametrize("what", BAD)
def test_bad_files_get_one_clear_line(what, readings, campaign):
    spoil, message = BAD[what]
    spoil(readings)
    folder = campaign(readings)
    with pytest.raises(InputError) as error:
        campaign_lines(folder)
    assert str(error.value).startswith(f"{folder / 't1.nc'}: {message}")
    assert "\n" not in str(error.value)


def test_a_missing_slab_marker_is_named(readings, campaign):
    driven = {body.name for body in STRUCTURE.file.bodies if body.driven}
    slab = [marker.name for marker in STRUCTURE.file.markers if marker.body in driven]
    folder = campaign(readings.drop_sel(marker=slab))
    with pytest.raises(InputError, match=f"marker of the driven body, which is the input: {slab[0]}"):
        campaign_lines(folder)


def test_a_truncated_file_is_one_line(readings, campaign):
    folder = campaign(readings)
    content = (folder / "t1.nc").read_bytes()
    (folder / "t1.nc").write_bytes(content[: len(content) // 2])
    with pytest.raises(InputError, match=r"t1.nc: expected a netCDF file") as error:
        campaign_lines(folder)
    assert "\n" not in str(error.value)


def test_a_spreadsheet_of_readings_goes_in(readings, campaign, tmp_path):
    """The same test as two CSV tables gives the same readings."""
    folder = campaign(readings)
    expected = load_test(load_campaign(folder), "t1")
    displacement = readings["marker_displacement"]
    names = [f"{marker}.{axis}" for marker in MARKERS for axis in "xyz"]
    table = displacement.to_numpy().reshape(displacement.sizes["time"], -1)
    rows = [
        f"{time!r}," + ",".join("" if np.isnan(cell) else repr(float(cell)) for cell in row)
        for time, row in zip(displacement["time"].values.tolist(), table, strict=True)
    ]
    (tmp_path / "t1.csv").write_text(f"time_s,{','.join(names)}\n" + "\n".join(rows) + "\n")
    acceleration = readings["accelerometer"].to_numpy()[:, 0]
    times = readings["time_acc"].values.tolist()
    (tmp_path / "t1-acc.csv").write_text(
        "time_s,a-x\n"
        + "\n".join(f"{t!r},{v!r}" for t, v in zip(times, acceleration.tolist(), strict=True))
        + "\n"
    )
    (folder / "campaign.yaml").write_text(CAMPAIGN.format(file="t1.csv", role="fit", noise=NOISE))
    read = load_test(load_campaign(folder), "t1")
    for name in ("marker_displacement", "accelerometer", "time", "time_acc", "marker"):
        xr.testing.assert_equal(read[name].drop_attrs(), expected[name].drop_attrs())
    assert "12 markers" in campaign_lines(folder)[1]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("a,b\n1,2\n", "time_s: expected a header with time_s"),
        (
            "time_s,slab-face.x\n0,0\n0.1,far\n",
            "line 3, slab-face.x: expected a number or nothing, not 'far'",
        ),
        ("time_s,slab-face.x\n0,0\n0.1\n", "line 3: expected 2 cells, not 1"),
        ("time_s,slab-face\n0,0\n0.1,0\n", "slab-face: expected columns MARKER.x"),
    ],
)
def test_bad_tables_get_one_clear_line(text, message, tmp_path):
    (tmp_path / "t1.csv").write_text(text)
    (tmp_path / "campaign.yaml").write_text(CAMPAIGN.format(file="t1.csv", role="fit", noise=NOISE))
    with pytest.raises(InputError) as error:
        campaign_lines(tmp_path)
    assert str(error.value).startswith(f"{tmp_path / 't1.csv'}: {message}")


@pytest.mark.parametrize("name", ["example-clean", "example-pitch"])
def test_the_example_campaigns_pass(name):
    folder = SHARED / "campaigns" / name
    if not folder.is_dir():
        pytest.skip(f"{folder} is not here")
    lines = campaign_lines(folder)
    assert len(lines) == 7
    assert lines[-1] == "no inconsistency found"
