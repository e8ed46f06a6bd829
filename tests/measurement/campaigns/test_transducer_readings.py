"""Displacement transducers from the virtual table through files, checks and an import: the same, or one clear line."""

import re

import numpy as np
import pytest
import xarray as xr
import yaml

from blockshake.cli import main
from blockshake.errors import InputError
from blockshake.geometry.structure import load_structure
from blockshake.measurement.campaigns.campaign import load_campaign, load_test
from blockshake.measurement.checks.campaign_check import campaign_lines
from blockshake.virtual import generate
from blockshake.virtual.settings import VirtualCampaign

WIRE = {
    "name": "wire-1", "body": "block-1", "position": [-0.4, 0.0, 0.7],
    "reference": "slab", "reference_position": [-1.4, 0.0, 1.6],
}  # fmt: skip
ROD = {
    "name": "rod-2", "body": "block-2", "position": [0.4, 0.0, -0.7], "reference": "block-1",
    "reference_position": [0.6, 0.0, 0.9], "axis": "-x",
}  # fmt: skip
NOISE = 2e-4  # m
TEST = "alkion-200"


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A virtual campaign of one test on configuration 1 with a wire and a rod."""
    place = tmp_path_factory.mktemp("transducers")
    mapping = load_structure("configuration-1").file.model_dump(mode="json")
    mapping["displacement_transducers"] = [WIRE, ROD]
    (place / "wall.yaml").write_text(yaml.safe_dump(mapping))
    settings = VirtualCampaign(
        name="wired", seed=3, model="nscd-rigid", duration=6.0, motions=("alkion",),
        intensities={"first": 2.0, "increment": 1.0, "highest": 2.0}, hidden={"effect": "none"},
        instruments={"transducer_noise": NOISE},
    )  # fmt: skip
    with pytest.MonkeyPatch.context() as patch:
        # the true stiffness does not matter to NSCD: no wave is simulated here
        patch.setattr("blockshake.virtual.truth.calibrate_stiffness", lambda *_: dict.fromkeys(
            ("normal_stiffness", "shear_stiffness"), 2e10
        ))  # fmt: skip
        generate.generate_campaign(
            settings, str(place / "wall.yaml"), place / "c", place / "truth", "one", lambda line: None
        )
    return place / "c"


def _spoilt(folder, tmp_path, spoil):
    """The campaign with its test spoilt."""
    test = xr.load_dataset(folder / f"{TEST}.nc", decode_times=False).drop_encoding()
    spoil(test).to_netcdf(tmp_path / f"{TEST}.nc")
    for name in ("campaign.yaml", "structure.yaml"):
        (tmp_path / name).write_text((folder / name).read_text())
    return tmp_path


def test_the_virtual_table_reads_them_with_noise_and_check_tells_it(folder):
    campaign = load_campaign(folder)
    assert campaign.sensors.transducer_noise == NOISE
    test = load_test(campaign, TEST)
    read = test["transducer_displacement"]
    assert read["transducer"].values.tolist() == ["wire-1", "rod-2"]
    assert read.sizes["time_acc"] == 6 * 512 + 1
    quiet = read.to_numpy()[test["time_acc"].to_numpy() < 0.5]
    # 512 differences of neighbours in all: a standard error of 4 % with the rounding to 0.01 mm
    assert np.sqrt(np.mean(np.diff(quiet, axis=0) ** 2) / 2.0) == pytest.approx(NOISE, rel=0.15)
    lines = campaign_lines(folder)
    assert lines[0].endswith("of displacement transducers 0.2 mm")
    assert "2 displacement transducers at 512 Hz with 0 % gaps" in lines[1]
    assert lines[-1] == "no inconsistency found"


def test_csv_and_netcdf_and_an_import_in_millimetres_read_the_same(folder, tmp_path):
    test = load_test(load_campaign(folder), TEST)
    moved = test["marker_displacement"].sel(axis="x")
    markers = ["slab-face", "block-1-face"]
    channels, wires = ["slab-acc-x"], ["wire-1", "rod-2"]
    felt, pulled = test["accelerometer"].sel(channel=channels), test["transducer_displacement"]
    for name, size in (("c", 1.0), ("import", 1e3)):
        (tmp_path / name).mkdir()
        rows = np.column_stack([test["time"], size * moved.sel(marker=markers)])
        head = ",".join(["time_s", *(f"{marker}.x" for marker in markers)])
        np.savetxt(tmp_path / name / "t1.csv", rows, "%.17g", ",", header=head, comments="")
        rows = np.column_stack([test["time_acc"], felt, size * pulled])
        head = ",".join(["time_s", *channels, *wires])
        np.savetxt(tmp_path / name / "t1-acc.csv", rows, "%.17g", ",", header=head, comments="")
        (tmp_path / name / "structure.yaml").write_text((folder / "structure.yaml").read_text())
    entry = {"name": "t1", "file": "t1.csv", "motion": "alkion", "scale": 2.0, "role": "fit"}
    campaign = {"name": "c", "structure": "structure.yaml", "tests": [entry]}
    (tmp_path / "c" / "campaign.yaml").write_text(yaml.safe_dump(campaign))
    columns = {f"{marker}.x": f"{marker}.x" for marker in markers} | {name: name for name in channels}
    columns |= {"wire-1": "wire-1", "rod-2": {"column": "rod-2", "reversed": True}}
    mapping = campaign | {
        "time": "time_s", "displacement_unit": "mm", "acceleration_unit": "m/s2", "columns": columns,
        "tests": [{**entry, "accelerometers": "t1-acc.csv"}],
    }  # fmt: skip
    (tmp_path / "import" / "map.yaml").write_text(yaml.safe_dump(mapping))
    source, made = tmp_path / "import" / "map.yaml", tmp_path / "made"
    assert main(["import-campaign", str(source), "--output", str(made)]) == 0
    for made, sign in (("c", 1.0), ("made", -1.0)):
        again = load_test(load_campaign(tmp_path / made), "t1")
        np.testing.assert_array_equal(again["accelerometer"], felt)
        # from millimetres and back: the last of 16 digits
        read = again["transducer_displacement"].sel(transducer=wires)
        np.testing.assert_allclose(read, pulled * [1.0, sign], rtol=4e-16)


def _set(change):
    def spoil(test):
        test["transducer_displacement"].values[:] = change(test["transducer_displacement"].to_numpy())
        return test

    return spoil


def _noise(read):
    noise = np.random.default_rng(1).normal(0.0, NOISE, read.shape)
    return noise - noise[0]


def _stated(test):
    test["transducer_displacement"].attrs["units"] = "mm"
    return test


REFUSED = {
    "unknown": (
        lambda test: test.assign_coords(transducer=["wire-1", "wire-9"]),
        "wire-9: expected displacement transducers of the structure: wire-1, rod-2",
    ),
    "stated millimetres": (_stated, "transducer_displacement.units: expected m, not 'mm'"),
    "kilometres": (_set(lambda read: 1e6 * read), "transducer_displacement: expected metres; a displacement of"),
    "millimetres at rest": (_set(lambda read: 1e3 * _noise(read)), "wire-1: expected metres; its noise at rest"),
    "not since the first": (_set(lambda read: read + 0.1), "wire-1: expected displacements since the first reading"),
    "silent": (_set(lambda read: np.where([True, False], np.nan, read)), "wire-1: expected readings; all are missing"),
}  # fmt: skip


@pytest.mark.parametrize("what", REFUSED)
def test_what_no_transducer_reads_is_refused_in_one_line(what, folder, tmp_path):
    spoil, message = REFUSED[what]
    with pytest.raises(InputError) as error:
        campaign_lines(_spoilt(folder, tmp_path, spoil))
    assert re.match(rf"{re.escape(str(tmp_path / TEST))}\.nc: {message}", str(error.value)), error.value
    assert "\n" not in str(error.value)


def test_gaps_noise_and_transducers_that_no_test_reads_are_told(folder, tmp_path):
    def spoil(test):
        test = test.isel(transducer=[0])
        test["transducer_displacement"].values[:] += 5.0 * _noise(test["transducer_displacement"])
        test["transducer_displacement"].values[1000:1308] = np.nan
        return test

    lines = campaign_lines(_spoilt(folder, tmp_path, spoil))
    assert "1 displacement transducers at 512 Hz with 10 % gaps" in lines[1]
    assert any(
        re.search(r"displacement transducer noise found [\d.]+ mm, stated 0\.2 mm", line) for line in lines
    )
    assert any("displacement transducer rod-2 of the structure is in no test" in line for line in lines)
