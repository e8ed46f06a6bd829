import numpy as np
import pytest

from blockshake.pages.scene.structure_picture import plot_understood
from blockshake.simulation.run_histories import run_histories
from blockshake.views.figure import plot, plot_run, run_title


@pytest.fixture(scope="module")
def figure(leaning_run):
    return plot(leaning_run[0])


def panel(figure, start):
    return next(axes for axes in figure.axes if axes.get_ylabel().startswith(start))


def test_every_quantity_has_a_panel_with_its_unit(figure):
    labels = [axes.get_ylabel().replace("\n", " ") for axes in figure.axes if axes.get_ylabel()]
    assert labels == [
        "drift along x [mm]",
        "normal force [kN]",
        "friction ratio T / (\N{MICRO SIGN} N) [1]",
        "uplift [mm]",
        "energy [kJ]",
        "audit's residual [J]",
    ]
    assert figure.get_suptitle() == "test under push (synthetic) at 50 %, LS-DEM"


def test_curves_are_those_of_the_run_in_printed_units(figure, leaning_run):
    run, structure = leaning_run
    histories = run_histories(run, structure)
    lower, upper = panel(figure, "drift").lines
    assert [lower.get_label(), upper.get_label()] == ["lower", "upper"]
    np.testing.assert_allclose(upper.get_ydata(), 1e3 * histories["drift"].sel(body="upper", axis="x"))
    np.testing.assert_allclose(panel(figure, "normal").lines[0].get_ydata(), 20.0)
    potential = panel(figure, "energy").lines[1]
    np.testing.assert_allclose(potential.get_ydata(), 1e-3 * 10.0 * run["time"])  # since the start
    (residual,) = panel(figure, "audit").lines
    np.testing.assert_allclose(residual.get_ydata(), histories["residual"])
    assert any("4.3e-02" in text.get_text() for axes in figure.axes for text in axes.texts)


def test_displacement_transducers_have_a_panel_over_their_own_times(leaning_run):
    run, structure = leaning_run
    read = np.array([[0.0, 0.0], [1e-3, -2e-3], [np.nan, np.nan]])
    read_run = run.assign(transducer_displacement=(("time_acc", "transducer"), read, {"units": "m"}))
    read_run = read_run.assign_coords(time_acc=[0.0, 0.1, 0.2], transducer=["wire", "rod"])
    wire, rod = panel(plot_run(read_run, run_histories(read_run, structure)), "transducers\n[mm]").lines
    assert [wire.get_label(), rod.get_label()] == ["wire", "rod"]
    np.testing.assert_allclose(wire.get_xydata(), [[0.0, 0.0], [0.1, 1.0]])
    np.testing.assert_allclose(rod.get_ydata(), [0.0, -2.0])


def test_a_peak_of_an_impact_is_cut_off_and_said(leaning_run):
    run, structure = leaning_run
    struck = run.copy(deep=True)
    struck["joint_force"][20, 0, 2] = 1e6
    axes = panel(plot_run(struck, run_histories(struck, structure)), "normal")
    assert axes.get_ylabel().endswith("; up to 1000")
    assert axes.get_ylim()[1] < 500.0


def test_a_title_says_how_a_run_ended_and_breaks_long_lines(leaning_run):
    attributes = {"status": "collapsed", "reason": "upper tipped over", "motion_scale": 1.0}
    run = leaning_run[0].assign_attrs(attributes, motion_synthetic=0)
    assert run_title(run, 80) == "test under push, LS-DEM\ncollapsed: upper tipped over"
    assert max(map(len, run_title(run, 20).splitlines())) <= 20


@pytest.fixture(scope="module")
def tower(make_structure):
    cubes = [{"name": f"cube-{n}", "shape": "cube", "position": [0.0, 0.0, n + 0.5]} for n in range(12)]
    return make_structure(cubes)


def test_many_blocks_are_a_map_with_a_row_each(leaning_run, tower):
    run = leaning_run[0]
    names = tower.body_names
    many = run.isel(body=[0] + [1] * 12, joint=[0] * 12).assign_coords(
        body=names, lower=("joint", names[:-1]), upper=("joint", names[1:])
    )
    many["position"] = many["position"].dims, np.tile(tower.position, (41, 1, 1))
    many["position"][:, 5, 0] = 0.001 * many["time"].to_numpy()
    figure = plot_run(many, run_histories(many, tower))
    (image,) = figure.axes[0].get_images()
    assert image.get_array().shape == (12, 41)
    np.testing.assert_allclose(image.get_array()[4], run["time"], atol=1e-9)  # mm, of cube-4
    assert figure.axes[0].get_yticklabels()[4].get_text() == "cube-4"


def test_a_structure_is_shown_with_names_and_joints(tower):
    figure = plot_understood(tower)
    front, side, _ = figure.axes
    assert {text.get_text() for text in front.texts} == set(tower.body_names)
    assert (front.get_xlabel(), front.get_ylabel(), side.get_xlabel()) == ("x [m]", "z [m]", "y [m]")
    joints, centres = front.lines[:2]
    np.testing.assert_allclose(centres.get_ydata(), np.arange(12.0) + 0.5, atol=1e-9)
    assert centres.get_label() == "mass centres"
    np.testing.assert_allclose(joints.get_ydata(), np.arange(12.0), atol=1e-9)
    assert joints.get_label() == "12 joints found"
    assert figure.get_suptitle() == "test: 12 blocks"
