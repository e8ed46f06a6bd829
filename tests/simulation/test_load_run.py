import json

import numpy as np
import pytest
import xarray as xr

from blockshake.errors import InputError
from blockshake.files import write_dataset
from blockshake.simulation.load_run import load_run


def test_a_run_comes_back_with_its_structure(leaning_file, leaning_run):
    run, structure = load_run(leaning_file)
    xr.testing.assert_equal(run, leaning_run[0])
    assert structure.content == leaning_run[1].content


def test_times_after_an_abort_are_left_out(leaning_run, tmp_path):
    run = leaning_run[0].where(leaning_run[0]["time"] < 0.5)
    run = run.assign_coords(leaning_run[0].coords)
    write_dataset(tmp_path / "run.nc", run.assign_attrs(leaning_run[0].attrs))
    loaded, _ = load_run(tmp_path / "run.nc")
    assert loaded.sizes["time"] == 20
    assert np.isfinite(loaded["energy"]).all()


def changed(run, change):
    """Copies of a run that are none."""
    if change == "foreign":
        return xr.Dataset({"temperature": ("time", [1.0, 2.0])})
    if change == "other dims":
        return run.transpose("axis", ...)
    if change == "no attribute":
        return run.drop_attrs()
    if change == "no structure":
        return run.assign_attrs(structure_file="{")
    if change == "other bodies":
        return run.assign_coords(body=["slab", "lower", "other"])
    if change == "never reached":
        return run.assign(position=run["position"] * np.nan)
    mapping = json.loads(run.attrs["structure_file"])
    mapping["shapes"]["cube"] = {"mesh": "lost.stl"}
    return run.assign_attrs(structure_file=json.dumps(mapping))


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ("foreign", "expected a run file of blockshake simulate"),
        ("other dims", "position: expected a run file"),
        ("no attribute", "structure_file: expected a run file"),
        ("no structure", "structure_file: expected a structure as JSON"),
        ("other bodies", "body: expected slab, lower, upper"),
        ("never reached", "position: expected at least one time"),
        ("lost mesh", "shapes.cube.mesh: expected a readable mesh file"),
    ],
)
def test_a_file_that_is_no_run_is_refused(leaning_run, tmp_path, change, words):
    write_dataset(tmp_path / "x.nc", changed(leaning_run[0], change))
    with pytest.raises(InputError, match=words) as refused:
        load_run(tmp_path / "x.nc")
    assert "x.nc" in str(refused.value)


@pytest.mark.parametrize("kept", [0.0, 0.1, 0.5, 0.9])
def test_a_truncated_file_is_refused_in_one_line(leaning_file, tmp_path, kept):
    content = leaning_file.read_bytes()
    (tmp_path / "x.nc").write_bytes(content[: int(kept * len(content))])
    with pytest.raises(InputError, match=r"x\.nc") as refused:
        load_run(tmp_path / "x.nc")
    assert "\n" not in str(refused.value)


def test_a_file_that_is_not_there_is_refused(tmp_path):
    with pytest.raises(InputError, match="there is no such file"):
        load_run(tmp_path / "x.nc")


def test_meshes_are_found_in_the_folder_that_is_named(leaning_run, leaning_file, tmp_path):
    import trimesh

    trimesh.creation.box((1.0, 1.0, 1.0)).export(tmp_path / "lost.stl")
    (tmp_path / "runs").mkdir()
    write_dataset(tmp_path / "runs" / "x.nc", changed(leaning_run[0], "lost mesh"))
    _, structure = load_run(tmp_path / "runs" / "x.nc", tmp_path)
    assert len(structure.solids["cube"].vertices) == 8
