"""Joints that the sensors of a campaign show, told before anything is simulated."""

from dataclasses import replace

import pytest
import xarray as xr
from tiny_campaign import write_campaign

from blockshake.files import PACKAGE, write_dataset
from blockshake.forces.seen.sight import sight_lines
from blockshake.measurement.campaigns.campaign import load_campaign

STRUCTURE = PACKAGE.parents[1] / "hidden_effects" / "structures" / "two-blocks.yaml"


@pytest.fixture
def folder(tmp_path):
    write_campaign(tmp_path, STRUCTURE)
    return tmp_path


def test_levers_are_seen_with_an_error(folder):
    (line,) = sight_lines(load_campaign(folder))
    assert line.startswith("joint forces: lever seen of slab-block-1 to ")
    assert "block-1-block-2 to " in line


def test_more_noise_blurs_the_lever(folder):
    """The error goes with the noise of the sensors."""
    errors = []
    for noise in (1e-4, 1e-3):
        campaign = load_campaign(folder)
        sensors = campaign.sensors.model_copy(
            update={"marker_noise": noise, "accelerometer_noise": 20.0 * noise}
        )
        (line,) = sight_lines(replace(campaign, sensors=sensors))
        errors.append(float(line.split("slab-block-1 to ")[1].split(" mm")[0]))
    assert errors[1] / errors[0] == pytest.approx(10.0, rel=0.15)


def test_a_block_with_one_marker_gives_no_joint_forces(folder):
    test = xr.load_dataset(folder / "one-100.nc")
    names = [str(name) for name in test["marker"].values]
    kept = [name for name in names if not name.startswith("block-2")]
    kept.append(next(name for name in names if name.startswith("block-2")))
    write_dataset(folder / "one-100.nc", test.sel(marker=kept))
    (line,) = sight_lines(load_campaign(folder))
    assert line == "joint forces: none, the rotation of block-2 is not read"


def test_sensors_without_stated_noise_are_the_best_instruments(folder):
    campaign = load_campaign(folder)
    silent = campaign.sensors.model_copy(update={"marker_noise": 0.0, "accelerometer_noise": 0.0})
    (line,) = sight_lines(replace(campaign, sensors=silent))
    assert 0.0 < float(line.split("slab-block-1 to ")[1].split(" mm")[0]) < 0.5


def test_a_record_of_three_readings_gives_no_joint_forces(folder):
    test = xr.load_dataset(folder / "one-100.nc")
    write_dataset(folder / "one-100.nc", test.isel(time=slice(3)))
    (line,) = sight_lines(load_campaign(folder))
    assert line == "joint forces: none, the test is too short"


def test_a_frame_of_blocks_has_no_lever_of_a_single_joint(tmp_path):
    write_campaign(tmp_path, STRUCTURE.with_name("bridged-walls.yaml"))
    (line,) = sight_lines(load_campaign(tmp_path))
    assert line.startswith("joint forces: sums over the joints that turn")
