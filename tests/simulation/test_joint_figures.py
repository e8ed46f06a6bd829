"""Figures of joints: of a block that turns about an edge, and of one at rest."""

import numpy as np

from blockshake.simulation.joint_figures import joint_figures


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
    for name, values in joint_figures(run, structure).items():
        np.testing.assert_allclose(joint_figures(other, structure)[name], values, atol=1e-9)


def test_a_joint_that_no_longer_touches_is_not_known(leaning_run):
    run, structure = leaning_run
    found = joint_figures(run.isel(joint=[0]), structure)
    assert np.isnan(found["joint_uplift"].sel(joint="lower-upper"))
    assert np.isfinite(found["joint_uplift"].sel(joint="slab-lower"))
