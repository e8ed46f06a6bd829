"""A campaign whose second test begins where the first one ended: all of it starts from the surveyed places."""

import numpy as np
import pytest
from simulated_tests import STRUCTURES

from blockshake.diagnosis.answer.decide import decide
from blockshake.diagnosis.evidence.reconstructed_campaign import reconstruct_campaign
from blockshake.diagnosis.misfit.judged_test import judged_test, measured_histories
from blockshake.diagnosis.misfit.misfit import misfit
from blockshake.diagnosis.nominal.ensemble import nominal_members, simulate_members
from blockshake.diagnosis.nominal.planned_test import planned_sealed, planned_test
from blockshake.dynamics.load_motion import load_motion
from blockshake.files import write_dataset
from blockshake.geometry.structure import load_structure
from blockshake.measurement.campaigns.campaign import load_campaign
from blockshake.measurement.campaigns.initial_poses import placed
from blockshake.measurement.sensors.instruments import Instruments, observe
from blockshake.simulation.simulate import simulate
from blockshake.store import Store

DURATION = 6.0  # s
SOLVER = "nscd-rigid"
STRUCTURE = load_structure(STRUCTURES / "two-blocks.yaml")
# m, m, rad: block-1 shifted by 20 mm and turned by 2 degrees, block-2 shifted less on it
PLACES = np.array([[0.0, 0.0, 0.0], [0.02, 0.0, 0.035], [-0.004, 0.0, 0.01]])
TESTS = {
    "first": ("alkion", 2.5, "fit", np.zeros((3, 3))),
    "second": ("basso-tirreno", 2.0, "fit", PLACES),
    "third": ("basso-tirreno", 2.3, "sealed", PLACES),
}


def _read(motion, scale, places, seed):
    """Readings of a test that contact dynamics makes, with the survey before it."""
    stands = load_structure(STRUCTURE, placed(STRUCTURE, places))
    run = simulate(
        stands, load_motion(motion, scale), SOLVER, {}, time_step=5e-4, duration=DURATION, output_rate=200.0
    )
    test = observe(run, stands, Instruments(), seed).drop_vars("marker_initial_position")
    test, zero = test.assign_coords(body=STRUCTURE.body_names), np.zeros(3)
    test["initial_offset"] = ("body", "axis"), np.column_stack([places[:, 0], places[:, 1], zero])
    test["initial_rotation"] = ("body", "axis"), np.column_stack([zero, zero, places[:, 2]])
    return test


@pytest.fixture(scope="module")
def campaigns(tmp_path_factory):
    """The campaign, and the same readings without the survey; what the sealed test reads is of no matter."""
    readings, found = {}, {}
    for seed, (name, (motion, scale, role, places)) in enumerate(TESTS.items()):
        readings[name] = readings["second"] if role == "sealed" else _read(motion, scale, places, seed)
    for surveyed in (True, False):
        folder = tmp_path_factory.mktemp("inherited")
        (folder / "two-blocks.yaml").write_text((STRUCTURES / "two-blocks.yaml").read_text())
        lines = ["name: inherited", "structure: two-blocks.yaml", "tests:"]
        for name, (motion, scale, role, _) in TESTS.items():
            lines.append(
                f"  - {{name: {name}, file: {name}.nc, motion: {motion}, scale: {scale}, role: {role}}}"
            )
            test = readings[name]
            write_dataset(folder / f"{name}.nc", test if surveyed else test.drop_dims("body"))
        (folder / "campaign.yaml").write_text("\n".join(lines) + "\n")
        found[surveyed] = load_campaign(folder)
    return found


def _misfit(campaign, folder):
    """Misfit of the second test with nominal models by contact dynamics."""
    planned = planned_test(campaign, "second", STRUCTURE)
    ensemble = simulate_members(nominal_members("second", planned, SOLVER, 9, 2), Store(folder, "test"))
    measured = measured_histories(campaign, ["second"], ())["second"]
    return misfit([judged_test("second", measured, [ensemble])])


def test_nominal_models_that_start_as_surveyed_hold_the_reading_and_others_are_farther(campaigns, tmp_path):
    there, elsewhere = (_misfit(campaigns[surveyed], tmp_path / str(surveyed)) for surveyed in (True, False))
    assert float(there["p"]) > 0.1
    assert float(elsewhere["p"]) < float(there["p"])
    largest = [float((one["score"] / one["usual"]).max()) for one in (there, elsewhere)]
    assert largest[0] < 1.0 < largest[1]


def test_a_sealed_test_is_simulated_from_its_survey(campaigns):
    for surveyed, places in ((True, PLACES), (False, np.zeros((3, 3)))):
        campaign = campaigns[surveyed]
        opened = {name: planned_test(campaign, name, STRUCTURE) for name in campaign.open}
        stands = planned_sealed(campaign, "third", opened, STRUCTURE).structure
        np.testing.assert_allclose(stands.position - STRUCTURE.position, places * [1.0, 1.0, 0.0], atol=1e-12)
    np.testing.assert_array_equal(opened["first"].structure.position, STRUCTURE.position)


def test_joints_have_the_levers_of_the_places(campaigns):
    seen = {test.name: test for test in reconstruct_campaign(campaigns[True]).tests}
    lower, upper = seen["second"].faces
    assert [face.name for face in seen["second"].faces] == [face.name for face in seen["first"].faces]
    # block-1 has its own width along its own edges, wherever it stands on the slab
    turn = PLACES[1, 2]
    np.testing.assert_allclose(lower.axes[:, 0], [np.cos(turn), np.sin(turn), 0.0], atol=1e-9)
    assert lower.half_width == pytest.approx(seen["first"].faces[0].half_width, rel=1e-9)
    # the two blocks share less than the width of either, and its middle is off that of block-2
    off = PLACES[1, 0] - PLACES[2, 0]
    assert 2.0 * upper.half_width == pytest.approx(2.0 * seen["first"].faces[1].half_width - off, abs=1e-4)
    assert upper.on_upper[0] == pytest.approx(0.5 * off, abs=1e-3)


def test_a_clean_campaign_names_nothing_from_the_surveyed_places_and_a_false_fault_without(campaigns):
    clean = reconstruct_campaign(campaigns[True])
    decision = decide(clean.tests).decision
    assert not clean.parity.findings
    assert not decision.parts
    assert not any(one.changes for one in decision.histories)
    assert "block-1 20 mm and 35 mrad" in clean.parity.gaps["second"][0]
    # a turn that nobody tells is taken for a marker that drifts
    blind = reconstruct_campaign(campaigns[False])
    assert {name.rpartition("-")[0] for finding in blind.parity.findings for name in finding.where} == {
        "block-1"
    }
    assert blind.parity.gaps["second"] == []
