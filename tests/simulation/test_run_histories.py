import numpy as np
import pytest
import xarray as xr

from blockshake.simulation.run_histories import joint_figures, run_histories


@pytest.fixture(scope="module")
def histories(leaning_run):
    return run_histories(*leaning_run)


def test_drift_is_against_the_base_in_its_motion(histories):
    angle = 0.05 * histories["time"]
    x = 0.38 - 0.38 * np.cos(angle) + 0.8 * np.sin(angle)
    np.testing.assert_allclose(histories["drift"].sel(body="upper", axis="x"), x, atol=1e-12)
    np.testing.assert_allclose(histories["drift"].sel(body=["slab", "lower"]), 0.0, atol=1e-12)


def test_drift_turns_with_a_base_that_pitches(leaning_run):
    """A rigid turn of everything about the base is no drift."""
    run, structure = leaning_run
    angle = 0.1 * run["time"].to_numpy()
    cos, sin, zero = np.cos(angle), np.sin(angle), np.zeros_like(angle)
    turn = np.stack([cos, zero, sin, zero, zero + 1.0, zero, -sin, zero, cos], axis=1).reshape(-1, 3, 3)
    arms = structure.position - structure.position[0]
    whole = run.copy()
    whole["position"] = run["position"].dims, structure.position[0] + np.einsum("tij,bj->tbi", turn, arms)
    quaternion = np.stack([np.cos(angle / 2), zero, np.sin(angle / 2), zero], axis=1)
    whole["orientation"] = run["orientation"].dims, np.repeat(quaternion[:, None], 3, axis=1)
    found = run_histories(whole, structure)
    np.testing.assert_allclose(found["drift"], 0.0, atol=1e-12)
    np.testing.assert_allclose(found["uplift"], 0.0, atol=1e-12)


def test_uplift_and_slip_are_those_of_a_turn_about_an_edge(histories):
    angle = 0.05 * histories["time"]
    own = histories.isel(joint=1)
    assert own["joint"].item() == "lower-upper"
    np.testing.assert_allclose(own["uplift"], 0.38 * np.sin(angle), atol=1e-12)
    np.testing.assert_allclose(own["slip"], 0.38 * (1.0 - np.cos(angle)), atol=1e-12)


def test_forces_are_parted_along_and_across_the_face(histories):
    own = histories.isel(joint=0)
    np.testing.assert_allclose(own["normal_force"], 2e4)
    np.testing.assert_allclose(own["shear_force"], 5e3)
    np.testing.assert_allclose(own["friction_ratio"], 5e3 / (0.5 * 2e4))  # the pair's coefficient is 0.5
    # 100 N on a block of 72 kN
    assert np.isnan(histories.isel(joint=1)["friction_ratio"]).all()


def test_a_pair_in_the_other_order_has_the_same_forces(leaning_run, histories):
    run, structure = leaning_run
    other = run.assign_coords(lower=run["upper"], upper=run["lower"]).assign(joint_force=-run["joint_force"])
    found = run_histories(other, structure)
    for name in ("normal_force", "shear_force", "uplift", "slip"):
        np.testing.assert_allclose(found[name], histories[name], atol=1e-9)


def test_a_pair_that_did_not_touch_at_the_start_has_a_place_and_no_face(leaning_run):
    run, structure = leaning_run
    late = run.assign_coords(lower=("joint", np.array(["slab", "slab"])), joint=["slab-lower", "slab-upper"])
    found = run_histories(late, structure).isel(joint=1)
    assert found["joint"].item() == "slab-upper"
    for name in ("normal_force", "friction_ratio", "uplift"):
        assert np.isnan(found[name]).all()
    assert np.isfinite(found["joint_position"]).all()


def test_a_joint_is_where_its_faces_meet(histories):
    start = histories["joint_position"].isel(time=0)
    np.testing.assert_allclose(start, [[0.0, 0.0, 0.0], [0.0, 0.0, 1.6]], atol=1e-12)


def test_residual_is_what_the_audit_leaves_over_time(histories):
    np.testing.assert_allclose(histories["residual"], -0.5 * histories["time"], atol=1e-9)


def test_a_turn_about_an_edge_lifts_the_middle_by_half_the_width(leaning_run):
    run, structure = leaning_run
    found = joint_figures(run, structure)
    assert list(found["joint"].values) == ["slab-lower", "lower-upper"]
    angle = 0.05 * float(run["time"][-1])
    np.testing.assert_allclose(found["joint_uplift"], [0.0, 0.38 * np.sin(angle)], atol=1e-12)
    np.testing.assert_allclose(found["joint_slip"], [0.0, 0.38 * (1.0 - np.cos(angle))], atol=1e-12)


def test_the_compression_leaves_an_impact_out(leaning_run):
    run, structure = leaning_run
    longer = run.isel(time=np.arange(201) % run.sizes["time"])
    longer["joint_force"][{"time": 0, "joint": 0, "axis": 2}] = 1e9
    assert float(joint_figures(longer, structure)["joint_compression"].sel(joint="slab-lower")) == 2e4


def test_joints_are_those_of_the_start_in_any_order_of_the_run(leaning_run):
    run, structure = leaning_run
    other = run.assign_coords(lower=run["upper"], upper=run["lower"]).assign(joint_force=-run["joint_force"])
    other = other.isel(joint=[1, 0])
    xr.testing.assert_allclose(joint_figures(other, structure), joint_figures(run, structure), atol=1e-9)


def test_a_joint_that_no_longer_touches_is_not_known(leaning_run):
    run, structure = leaning_run
    found = joint_figures(run.isel(joint=[0]), structure)
    assert np.isnan(found["joint_uplift"].sel(joint="lower-upper"))
    assert np.isfinite(found["joint_uplift"].sel(joint="slab-lower"))
