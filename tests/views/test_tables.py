import numpy as np
import pandas as pd
import pytest

from blockshake.errors import InputError
from blockshake.simulation.run_histories import run_histories
from blockshake.views.export import export
from blockshake.views.tables import write_tables


@pytest.fixture(scope="module")
def tables(leaning_run, tmp_path_factory):
    run, structure = leaning_run
    path = tmp_path_factory.mktemp("tables") / "run.csv"
    files = write_tables(path, run, run_histories(run, structure))
    return {file.name: pd.read_csv(file) for file in files}


def test_there_is_a_table_a_kind_of_thing_and_none_without_rows(tables):
    assert list(tables) == ["run-bodies.csv", "run-joints.csv", "run-markers.csv", "run-energy.csv"]


def test_a_row_is_a_time_and_a_body_with_all_digits(tables, leaning_run):
    run, table = leaning_run[0], tables["run-bodies.csv"]
    assert len(table) == run.sizes["time"] * run.sizes["body"]
    own = table[table["body"] == "upper"]
    np.testing.assert_array_equal(own["time_s"], run["time"])
    np.testing.assert_array_equal(own["position_z_m"], run["position"].sel(body="upper", axis="z"))
    np.testing.assert_array_equal(own["orientation_y"], run["orientation"].sel(body="upper", quaternion="y"))
    np.testing.assert_array_equal(own["velocity_x_m_s"], run["velocity"].sel(body="upper", axis="x"))
    np.testing.assert_array_equal(own["angular_velocity_y_rad_s"], 0.05)


def test_joints_markers_and_energy_have_their_units_in_their_names(tables, leaning_run):
    joints = tables["run-joints.csv"]
    first = joints[joints["joint"] == "slab-lower"]
    assert set(first["lower"]) == {"slab"}
    assert (first["joint_force_y_N"] == -4e3).all()
    assert (first["normal_force_N"] == 2e4).all()
    # unknown is an empty cell
    assert joints[joints["joint"] == "lower-upper"]["friction_ratio"].isna().all()
    markers, energy = tables["run-markers.csv"], tables["run-energy.csv"]
    np.testing.assert_array_equal(
        markers["marker_displacement_x_m"], leaning_run[0]["marker_displacement"].sel(marker="top", axis="x")
    )
    np.testing.assert_allclose(energy["residual_J"], -0.5 * energy["time_s"], atol=1e-9)
    np.testing.assert_array_equal(energy["kinetic_J"], leaning_run[0]["energy"].sel(term="kinetic"))


@pytest.mark.parametrize(
    ("variable", "dimension", "unit", "file", "column"),
    [
        ("accelerometer", "channel", "m s-2", "run-accelerometers.csv", "acceleration_m_s2"),
        ("transducer_displacement", "transducer", "m", "run-transducers.csv", "displacement_m"),
    ],
)
def test_sensors_have_times_of_their_own_and_no_row_after_the_end(
    leaning_run, tmp_path, variable, dimension, unit, file, column
):
    run, structure = leaning_run
    read = np.array([[0.0, 0.0], [1e-3, -2e-3], [np.nan, np.nan]])
    run = run.assign({variable: (("time_acc", dimension), read, {"units": unit})})
    run = run.assign_coords({"time_acc": [0.0, 0.1, 0.2], dimension: ["a", "b"]})
    *_, written = write_tables(tmp_path / "run.csv", run, run_histories(run, structure))
    table = pd.read_csv(written)
    assert (written.name, table.columns.tolist()) == (file, ["time_s", dimension, column])
    assert table[column].tolist() == [0.0, 0.0, 1e-3, -2e-3]


def test_a_suffix_that_is_no_format_is_refused(leaning_run, tmp_path):
    with pytest.raises(InputError, match=r"expected one of the suffixes \.csv"):
        export(leaning_run[0], tmp_path / "run.vtk")
    assert list(tmp_path.iterdir()) == []
