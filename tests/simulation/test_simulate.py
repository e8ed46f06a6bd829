"""The run file of docs/guide/contracts.md, by both solvers."""

import json

import numpy as np
import pytest
import xarray as xr

from blockshake.dynamics.motion import ground_motion
from blockshake.errors import InputError
from blockshake.files import write_dataset
from blockshake.simulation.energy_residual import energy_extremes, energy_residual, residual_of
from blockshake.simulation.models import MODELS, split_parameters
from blockshake.simulation.simulate import simulate

DURATION = 0.5
SHAKE = ground_motion(
    "shake", np.linspace(0.0, 0.4, 81), {"x": 2.0 * np.sin(np.linspace(0, 6, 81))}, "acceleration"
)


@pytest.fixture(scope="module", params=sorted(MODELS))
def run(request):
    return simulate("configuration-1", SHAKE, request.param, time_step=1e-4 if request.param == "ls-dem" else None,
                    duration=DURATION)  # fmt: skip


def test_a_run_has_the_dimensions_and_variables_of_the_page_on_contracts(run):
    assert run["position"].dims == ("time", "body", "axis")
    assert run["orientation"].dims == ("time", "body", "quaternion")
    assert run["marker_displacement"].dims == ("time", "marker", "axis")
    assert run["energy"].dims == ("time", "term")
    assert run["joint_force"].dims == ("time", "joint", "axis")
    assert run["accelerometer"].dims == ("time_acc", "channel")
    assert list(run["axis"].values) == ["x", "y", "z"]
    assert list(run["quaternion"].values) == ["w", "x", "y", "z"]
    assert list(run["body"].values) == ["slab", "block-1", "block-2", "block-3"]
    assert list(run["lower"].values) == ["slab", "block-1", "block-2"]
    assert list(run["upper"].values) == ["block-1", "block-2", "block-3"]
    assert "block-1-acc-x" in run["channel"].values
    for name, variable in run.data_vars.items():
        assert variable.attrs.get("units"), name
        assert variable.attrs.get("long_name"), name


def test_output_is_uniform_from_zero_to_the_duration(run):
    np.testing.assert_array_equal(run["time"], np.arange(101) / 200.0)
    np.testing.assert_allclose(np.diff(run["time_acc"]), 1.0 / 512.0, rtol=1e-12)
    assert float(run["time_acc"][0]) == 0.0


def test_slab_follows_the_motion(run):
    slab = run["position"].sel(body="slab") - run["position"].sel(body="slab").isel(time=0)
    np.testing.assert_allclose(slab, SHAKE.evaluate(run["time"].values)[:, :3], atol=1e-12)
    # it rests after the last row at 0.4 s
    assert float(np.abs(run["velocity"].sel(body="slab").sel(time=slice(0.41, None))).max()) == 0.0


def test_lowest_joint_carries_the_weight_at_the_start(run):
    weight = 3 * 7363.699 * 9.81  # N, three chamfered blocks of 2400 kg/m3
    force = float(run["joint_force"].sel(axis="z").isel(joint=0, time=0))
    assert force == pytest.approx(weight, rel=1e-5)


def test_accelerometer_reads_gravity_on_an_upward_axis_at_the_start(run):
    first = run["accelerometer"].sel(channel="block-3-acc-z").isel(time_acc=slice(0, 3))
    np.testing.assert_allclose(first, 9.81, atol=0.05)


def test_attributes_tell_what_acted(run):
    acted = json.loads(run.attrs["parameters"])
    assert acted["friction.concrete.concrete"] == 0.75
    assert (
        acted[f"{MODELS[run.attrs['model']].prefix}.{'skin' if run.attrs['model'] == 'ls-dem' else 'theta'}"]
        > 0.0
    )
    assert run.attrs["status"] == "completed"
    assert run.attrs["source_digest"]
    assert run.attrs["energy_residual"] < 1e-2


def test_same_bytes_in_every_variable_and_file_round_trip(run, tmp_path):
    again = simulate("configuration-1", SHAKE, run.attrs["model"],
                     time_step=1e-4 if run.attrs["model"] == "ls-dem" else None, duration=DURATION)  # fmt: skip
    write_dataset(tmp_path / "run.nc", run)
    read = xr.load_dataset(tmp_path / "run.nc")
    for name in run.data_vars:
        assert run[name].values.tobytes() == again[name].values.tobytes(), name
        assert run[name].values.tobytes() == read[name].values.tobytes(), name


def test_rest_after_an_abort_is_nan():
    # a pulse of 3 g for 0.5 s overturns any block of b/h = 0.5
    pulse = ground_motion("pulse", [0.0, 0.5, 0.501, 3.0], {"x": [30.0, 30.0, 0.0, 0.0]}, "acceleration")
    run = simulate("configuration-1", pulse, "ls-dem", {"friction.concrete.concrete": 5.0,
                   "friction.concrete.foundation": 5.0}, time_step=1e-4, accelerometers=False)  # fmt: skip
    assert run.attrs["status"] == "collapsed"
    assert "block-" in run.attrs["reason"]
    after = run.sel(time=slice(run.attrs["end_time"] + 0.01, None))
    assert after.sizes["time"] > 0
    assert np.isnan(after["position"]).all()
    assert np.isfinite(run["position"].isel(time=0)).all()


def test_energy_residual_of_a_known_leak():
    energy = np.zeros((3, 7))
    energy[:, 6] = [0.0, 50.0, 100.0]  # input that nothing accounts for
    energy[:, 0] = [0.0, 50.0, 90.0]
    assert energy_residual(energy) == pytest.approx(0.1)
    assert energy_residual(np.zeros((3, 7))) == 0.0


def test_energy_residual_of_parts_is_that_of_the_whole_to_the_bit():
    energy = np.random.default_rng(1).normal(size=(50, 7)).cumsum(axis=0)
    energy[0, 3:] = 0.0  # nothing is dissipated or put in at the start
    energy[45:] = np.nan
    parts = [energy_extremes(part) for part in np.split(energy, [7, 8, 30, 46])]
    assert residual_of(parts) == energy_residual(energy)
    # the definition, term by term
    kinetic, potential, elastic, *lost, given = energy[:45].T
    missing = kinetic + potential + elastic + sum(lost) - given
    in_play = max(np.abs(given).max(), kinetic.max(), elastic.max(), 1e-6 * np.abs(potential).max())
    assert residual_of(parts) == pytest.approx(np.abs(missing - missing[0]).max() / in_play, rel=1e-12)
    assert np.isnan(residual_of([energy_extremes(energy[45:])]))


def test_parameters_go_where_they_belong():
    """The other solver's values are not this one's business."""
    physical, numerical = split_parameters(
        {"restitution": 0.3, "ls_dem.node_spacing": 0.1, "nscd.theta": 0.6}, "ls-dem"
    )
    assert physical == {"restitution": 0.3}
    assert numerical.node_spacing == 0.1


@pytest.mark.parametrize(
    ("parameters", "words"),
    [
        ({"ls_dem.nodes": 3}, "ls_dem.nodes: expected one of ls_dem."),
        ({"ls_dem.node_spacing": -1.0}, "ls_dem.node_spacing"),
        # of the other solver too
        ({"nscd.theta": "abc"}, "nscd.theta: input should be a valid number"),
    ],
)
def test_wrong_parameters_are_named(parameters, words):
    with pytest.raises(InputError, match=words):
        split_parameters(parameters, "ls-dem")


def test_unknown_model_is_refused_by_name():
    with pytest.raises(InputError, match=f"expected one of {', '.join(MODELS)}, not 'nscd-plastic'"):
        simulate("configuration-1", SHAKE, "nscd-plastic")


@pytest.mark.parametrize(
    ("name", "value"), [("duration", "3 s"), ("time_step", "1e-4"), ("output_rate", [200])]
)
def test_an_argument_that_is_no_number_is_refused_by_its_name(name, value):
    with pytest.raises(InputError, match=f"{name}: expected a number, not"):
        simulate("configuration-1", "alkion", "nscd-rigid", **{name: value})
