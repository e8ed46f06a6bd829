"""Poses from tables and netCDF files, and one clear line for each file that is wrong."""

import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import xarray as xr
import yaml

from blockshake.errors import InputError
from blockshake.geometry.structure import load_structure
from blockshake.measurement.campaigns.campaign import load_campaign
from blockshake.measurement.checks.campaign_check import campaign_lines
from blockshake.own_files.import_campaign import make_campaign
from blockshake.own_files.import_map import load_map
from blockshake_flight.pose_file import read_poses
from blockshake_flight.tracked_test import load_tracked

STRUCTURE = {
    "name": "one block",
    "materials": {"steel": {"density": 7850.0, "youngs_modulus": 2.0e11, "poisson_ratio": 0.3}},
    "shapes": {"floor": {"box": [5.0, 5.0, 0.2]}, "block": {"box": [0.1, 0.1, 0.3]}},
    "bodies": [
        {
            "name": "floor",
            "shape": "floor",
            "material": "steel",
            "position": [0.0, 0.0, -0.1],
            "driven": True,
        },
        {"name": "block", "shape": "block", "material": "steel", "position": [0.0, 0.0, 1.0]},
    ],
    "friction": [{"pair": ["steel", "steel"], "coefficient": 0.4}],
}
TIME = np.arange(40) / 100.0
ANGLE = 0.3 + 2.0 * TIME


@pytest.fixture
def structure(tmp_path):
    (tmp_path / "structure.yaml").write_text(yaml.safe_dump(STRUCTURE))
    return load_structure(tmp_path / "structure.yaml")


def planar(**changes):
    columns = {"time_s": TIME, "block.x": 0.1 * TIME, "block.z": 1.0 - 4.9 * TIME**2, "block.angle_y": ANGLE}
    return pd.DataFrame({**columns, **changes})


def in_space():
    half = 0.5 * ANGLE
    turned = {
        "block.qw": np.cos(half),
        "block.qx": 0.0 * half,
        "block.qy": np.sin(half),
        "block.qz": 0.0 * half,
    }
    return planar(**{"block.y": 0.0 * TIME}).drop(columns="block.angle_y").assign(**turned)


def written(folder, table):
    path = folder / "drop.csv"
    table.to_csv(path, index=False)
    return path


def test_an_angle_about_y_and_a_quaternion_are_the_same_pose(tmp_path, structure):
    flat = read_poses(written(tmp_path, planar()), structure)
    whole = read_poses(written(tmp_path, in_space()), structure)
    assert (flat.attrs["planar"], whole.attrs["planar"]) == (True, False)
    np.testing.assert_allclose(flat["rotation"], whole["rotation"], atol=1e-12)
    # right-handed about +y: the body's z axis leans to +x
    np.testing.assert_allclose(flat["rotation"][:, 0, 2], np.sin(ANGLE), atol=1e-12)
    assert np.isnan(flat["position"].sel(axis="y")).all()


def test_a_run_file_is_a_test_file(tmp_path, structure):
    table = in_space()
    quaternion = np.stack([table[f"block.q{one}"] for one in "wxyz"], axis=1)
    place = np.stack([table["block.x"], table["block.y"], table["block.z"]], axis=1)
    run = xr.Dataset(
        {
            "position": (("time", "body", "axis"), np.stack([0.0 * place, place], axis=1), {"units": "m"}),
            "orientation": (
                ("time", "body", "quaternion"),
                np.stack([np.tile([1.0, 0.0, 0.0, 0.0], (len(place), 1)), quaternion], axis=1),
                {"units": "1"},
            ),
        },
        {"time": TIME, "body": ["floor", "block"], "axis": list("xyz"), "quaternion": list("wxyz")},
    )
    run.to_netcdf(tmp_path / "run.nc")
    read, same = read_poses(tmp_path / "run.nc", structure), read_poses(written(tmp_path, table), structure)
    xr.testing.assert_allclose(read.drop_attrs(), same.drop_attrs())


def test_signs_of_quaternions_may_jump_and_empty_cells_are_gaps(tmp_path, structure):
    table, smooth = in_space(), read_poses(written(tmp_path, in_space()), structure)
    names = [f"block.q{one}" for one in "wxyz"]
    table.loc[10:19, names] *= -1.0
    table.loc[25, names] = np.nan
    read = read_poses(written(tmp_path, table), structure)
    assert np.flatnonzero(np.isnan(read["rotation"]).all(axis=(1, 2))).tolist() == [25]
    np.testing.assert_allclose(read["rotation"].drop_isel(time=25), smooth["rotation"].drop_isel(time=25))


@pytest.mark.parametrize(
    ("table", "key"),
    [
        (planar(**{"block.z": 1e3 * planar()["block.z"]}), "expected metres"),
        (planar(**{"block.angle_y": np.degrees(40.0 * ANGLE)}), "expected rotations in radians"),
        (planar().drop(columns="block.z"), "block.z"),
        (planar().drop(columns="block.angle_y"), "block.qw"),
        (planar(**{"block.roll": ANGLE}), "block.roll"),
        (in_space().assign(**{"block.qw": 1.5}), "expected unit quaternions"),
        (in_space().assign(**{"block.angle_y": ANGLE}), "an angle or a quaternion, not both"),
        (planar(**{"block.z": np.nan}), "all are missing"),
        (planar(time_s=TIME[::-1]), "expected times that increase"),
        (planar(time_s=1e3 * TIME), "expected seconds"),
    ],
)
def test_a_wrong_table_is_refused_in_one_line(tmp_path, structure, table, key):
    with pytest.raises(InputError, match=key):
        read_poses(written(tmp_path, table), structure)


def campaign(tmp_path, *entries, table=None):
    written(tmp_path, planar() if table is None else table)
    tests = [{"name": "drop", "file": "drop.csv", "role": "fit"}, *entries]
    text = yaml.safe_dump({"name": "drops", "structure": "structure.yaml", "tests": tests})
    (tmp_path / "campaign.yaml").write_text(text)
    return tmp_path


@pytest.mark.usefixtures("structure")
def test_a_campaign_without_base_motion_is_described(tmp_path):
    lines = campaign_lines(campaign(tmp_path))
    assert "1 test of block (23.55 kg) over a ground at rest" in lines[0]
    assert "0.39 s at 100 Hz, poses in the plane of x and z, 0 % gaps" in lines[1]
    assert lines[-1] == "no inconsistency found"


@pytest.mark.usefixtures("structure")
def test_a_campaign_without_base_motion_needs_the_package_of_free_flight(tmp_path, monkeypatch):
    for module in [name for name in sys.modules if name.startswith("blockshake_flight")]:
        monkeypatch.delitem(sys.modules, module)
    without = [folder for folder in sys.path if not Path(folder, "blockshake_flight").is_dir()]
    monkeypatch.setattr(sys, "path", without)
    with pytest.raises(
        InputError, match=r"campaign\.yaml: tests: expected a motion .* package blockshake_flight"
    ):
        campaign_lines(campaign(tmp_path))


@pytest.mark.usefixtures("structure")
def test_a_motion_is_of_all_tests_or_of_none(tmp_path):
    folder = campaign(
        tmp_path, {"name": "shaken", "file": "drop.csv", "role": "fit", "motion": "alkion", "scale": 1.0}
    )
    with pytest.raises(InputError, match=r"tests\.drop\.motion"):
        load_campaign(folder)


@pytest.mark.usefixtures("structure")
def test_a_body_below_the_ground_is_refused(tmp_path):
    folder = campaign(tmp_path, table=planar(**{"block.z": -planar()["block.z"]}))
    with pytest.raises(InputError, match="z up"):
        load_tracked(load_campaign(folder), ["drop"])


@pytest.mark.usefixtures("structure")
@pytest.mark.parametrize(("factor", "refused"), [(1.0, False), (1.0 / 0.3048, True)])
def test_heights_in_feet_are_refused_by_where_the_body_comes_to_rest(tmp_path, factor, refused):
    """A block of 0.3 m drops to the ground and stands there, 0.15 m high at its middle."""
    fallen = np.maximum(0.15, 0.5 - 4.9 * TIME**2) * factor
    folder = campaign(tmp_path, table=planar(**{"block.z": fallen, "block.angle_y": 0.0 * TIME}))
    if not refused:
        assert load_tracked(load_campaign(folder), ["drop"]).tests
        return
    with pytest.raises(InputError, match="rest 342 mm above the ground"):
        load_tracked(load_campaign(folder), ["drop"])


def test_more_than_one_free_body_is_refused(tmp_path):
    second = {**STRUCTURE["bodies"][1], "name": "second", "position": [1.0, 0.0, 1.0]}
    mapping = {**STRUCTURE, "bodies": [*STRUCTURE["bodies"], second]}
    (tmp_path / "structure.yaml").write_text(yaml.safe_dump(mapping))
    with pytest.raises(InputError, match="one free body"):
        load_tracked(load_campaign(campaign(tmp_path)), ["drop"])


def test_a_table_in_other_units_is_imported(tmp_path, structure):
    table = pd.DataFrame(
        {"t": TIME, "across": 100.0 * TIME, "up": 1e3 - 4900.0 * TIME**2, "turn": -np.degrees(ANGLE)}
    )
    table.to_csv(tmp_path / "filmed.txt", index=False, sep=";")
    mapping = {
        "name": "filmed", "structure": "structure.yaml", "time": "t", "displacement_unit": "mm", "rotation_unit": "deg",
        "columns": {
            "block.x": "across", "block.z": "up", "block.angle_y": {"column": "turn", "reversed": True},
        },
        "tests": [{"name": "drop", "file": "filmed.txt", "role": "fit"}],
    }  # fmt: skip
    (tmp_path / "map.yaml").write_text(yaml.safe_dump(mapping))
    lines = make_campaign(load_map(tmp_path / "map.yaml"), tmp_path / "made", "map.yaml")
    assert "1 test of block" in lines[0]
    read = read_poses(tmp_path / "made" / "drop.csv", structure)
    same = read_poses(written(tmp_path, planar()), structure)
    np.testing.assert_allclose(read["position"], same["position"], rtol=1e-12)
    np.testing.assert_allclose(read["rotation"], same["rotation"], atol=1e-12)


def test_a_map_with_a_column_of_no_pose_is_refused(tmp_path, structure):
    planar().to_csv(tmp_path / "filmed.csv", index=False)
    mapping = {
        "name": "filmed", "structure": "structure.yaml", "time": "time_s", "displacement_unit": "m",
        "columns": {"block.x": "block.x", "block.tilt": "block.angle_y"},
        "tests": [{"name": "drop", "file": "filmed.csv", "role": "fit"}],
    }  # fmt: skip
    (tmp_path / "map.yaml").write_text(yaml.safe_dump(mapping))
    with pytest.raises(InputError, match=r"columns\.block\.tilt"):
        make_campaign(load_map(tmp_path / "map.yaml"), tmp_path / "made", "map.yaml")
    assert not (tmp_path / "made").exists()
