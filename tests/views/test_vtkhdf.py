"""The layout of the VTKHDF files after the format's description; VTK itself reads them where it is installed."""

import netCDF4
import numpy as np
import pytest

from blockshake.simulation.run_histories import run_histories
from blockshake.views.vtkhdf import write_vtkhdf


@pytest.fixture(scope="module")
def files(leaning_run, tmp_path_factory):
    run, structure = leaning_run
    path = tmp_path_factory.mktemp("vtkhdf") / "run.vtkhdf"
    return write_vtkhdf(path, run, run_histories(run, structure), structure)


def test_blocks_and_joints_have_a_file_each(files):
    assert [file.name for file in files] == ["run.vtkhdf", "run-joints.vtkhdf"]


def test_every_step_finds_its_points_and_cells(files):
    for file in files:
        with netCDF4.Dataset(file) as content:
            root = content["VTKHDF"]
            assert root.Type == "PolyData"
            steps, n_points = root["Steps"], int(root["NumberOfPoints"][0])
            assert steps.NSteps == len(steps["Values"]) == 41
            np.testing.assert_array_equal(steps["PointOffsets"], n_points * np.arange(41))
            assert root["Points"].shape == (41 * n_points, 3)
            n_cells = 0
            for kind in ("Vertices", "Lines", "Polygons", "Strips"):
                own = int(root[kind]["NumberOfCells"][0])
                offsets, corners = root[kind]["Offsets"][:], root[kind]["Connectivity"][:]
                assert len(offsets) == own + 1
                assert offsets[0] == 0
                assert offsets[-1] == len(corners) == root[kind]["NumberOfConnectivityIds"][0]
                assert ((corners >= 0) & (corners < n_points)).all()
                n_cells += own
            for name, offsets in steps["CellDataOffsets"].variables.items():
                per_step = n_cells if name != "body" else 0
                np.testing.assert_array_equal(offsets[:], per_step * np.arange(41))
                assert len(root["CellData"][name]) == n_cells * (41 if per_step else 1)


def test_every_body_and_joint_has_its_number_by_its_name(files, leaning_run):
    for file, expected in zip(
        files, (["slab", "lower", "upper"], ["slab-lower", "lower-upper"]), strict=True
    ):
        with netCDF4.Dataset(file) as content:
            numbers = content["VTKHDF"]["FieldData"].variables
            assert {name: number[:].tolist() for name, number in numbers.items()} == {
                name: [place] for place, name in enumerate(expected)
            }
            for offsets in content["VTKHDF"]["Steps"]["FieldDataOffsets"].variables.values():
                assert offsets[:].tolist() == [0] * 41


def test_points_are_the_corners_of_the_turned_blocks(files, leaning_run):
    run, structure = leaning_run
    with netCDF4.Dataset(files[0]) as content:
        root = content["VTKHDF"]
        n_points = int(root["NumberOfPoints"][0])
        last = root["Points"][-n_points:]
    corners = structure.solid(2).vertices
    angle = 0.05
    turn = np.array([[np.cos(angle), 0, np.sin(angle)], [0, 1, 0], [-np.sin(angle), 0, np.cos(angle)]])
    expected = corners @ turn.T + run["position"].sel(body="upper").isel(time=-1).to_numpy()
    np.testing.assert_allclose(last[-len(corners) :], expected, atol=1e-6)


def test_vtk_reads_blocks_and_joints_over_time(files, leaning_run):
    vtk = pytest.importorskip("vtk", reason="VTK reads its own format: pip install vtk (100 MB)")
    reader = vtk.vtkHDFReader()
    for file, name, expected in ((files[0], "velocity", 0.1), (files[1], "force", 3e3)):
        reader.SetFileName(str(file))
        reader.UpdateInformation()
        reader.UpdateTimeStep(1.0)
        cells = reader.GetOutputDataObject(0).GetCellData()
        assert cells.GetArray(name).GetTuple(0)[0] == pytest.approx(expected)
        last = (
            reader.GetOutputDataObject(0)
            .GetFieldData()
            .GetArray("upper" if name == "velocity" else "lower-upper")
        )
        assert [last.GetValue(row) for row in range(last.GetNumberOfValues())] == [
            2 if name == "velocity" else 1
        ]


def test_a_run_in_national_coordinates_counts_from_a_local_origin(files, leaning_run, tmp_path):
    """32 bits are 0.25 m apart at 4000 km: the same points as at the origin, and the origin said."""
    run, structure = leaning_run
    origin = np.array([500_000.0, 4_000_000.0, 0.0])
    moved = run.assign(position=run["position"] + origin)
    mapping = structure.file.model_dump(mode="json")
    for body in mapping["bodies"]:
        body["position"] = (origin + body["position"]).tolist()
    structure = structure.with_mapping(mapping)
    far = write_vtkhdf(tmp_path / "far.vtkhdf", moved, run_histories(moved, structure), structure)
    for near, file in zip(files, far, strict=True):
        with netCDF4.Dataset(near) as expected, netCDF4.Dataset(file) as found:
            np.testing.assert_array_equal(found["VTKHDF"].LocalOrigin, origin)
            assert "LocalOrigin" not in expected["VTKHDF"].ncattrs()
            np.testing.assert_allclose(found["VTKHDF"]["Points"], expected["VTKHDF"]["Points"], atol=1e-6)
            for name, values in expected["VTKHDF"]["CellData"].variables.items():
                np.testing.assert_allclose(found["VTKHDF"]["CellData"][name], values, rtol=1e-6, atol=1e-6)
