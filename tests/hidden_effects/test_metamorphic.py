"""Known changes of the readings (mirrored, late, copied, in another order) change the findings as they must.

On the functions that every diagnosis goes through, with the readings of a clean case of the maker.
"""

import copy
import shutil

import numpy as np
import pytest
import yaml
from case_plan import DURATION
from make_case import structure_file
from mirror import mirrored_effect, mirrored_structure, mirrored_test

from blockshake.diagnosis.answer.answer import rank
from blockshake.diagnosis.answer.explain import gather_evidence
from blockshake.diagnosis.evidence.slab_motion import explain_slab, slab_motion
from blockshake.dynamics.load_motion import load_motion
from blockshake.effects.effect import Experiment
from blockshake.effects.registry import with_effect
from blockshake.files import load_yaml
from blockshake.forces.seen.reconstructed_test import reconstruct_test
from blockshake.geometry.structure import build_structure, load_structure
from blockshake.measurement.campaigns.campaign import Sensors, load_campaign
from blockshake.measurement.campaigns.open_readings import read_open_tests
from blockshake.measurement.motion.body_frame import without_outliers
from blockshake.measurement.sensors.instruments import Instruments, observe
from blockshake.parity.parity import check_parity
from blockshake.simulation.simulate import simulate

LAG, NEAR = 5e-3, 1e-3  # s; of a clock that is put behind, and how near it must be found


def _seen(tests, structure):
    return [
        reconstruct_test(name, without_outliers(test, structure), structure, Sensors())
        for name, test in tests.items()
    ]


def _gains(seen):
    """Evidence over none of every cause in the joints and in the slab's motion, in nats."""
    slab = explain_slab([slab_motion(test) for test in seen])
    return {rival.cause: rival.gain for rival in rank(gather_evidence(seen))} | {
        name: explained.gain for name, explained in slab.items()
    }


def _size_of_rows(test):
    """Length of the forces that no face may carry, by instant [N]: the rows' directions are a basis of no meaning."""
    return np.sqrt(np.bincount(test.rows.instant, test.rows.value**2))


def _assert_same(found, expected):
    assert sorted(found) == sorted(expected)
    for name, value in found.items():
        assert value == pytest.approx(expected[name], rel=1e-6, abs=1e-5), name


def _named(parity):
    return {(finding.effect, finding.where, finding.quantity) for finding in parity.findings}


@pytest.fixture(scope="module")
def parity(open_tests, two_blocks):
    return check_parity(open_tests, two_blocks, Sensors())


def test_sound_sensors_of_a_case_give_no_finding(parity):
    assert _named(parity) == set()


@pytest.fixture(scope="module")
def seen(open_tests, two_blocks):
    return _seen(open_tests, two_blocks)


def test_mirrored_readings_turn_and_carry_the_mirror_image(seen, open_tests):
    mirrored = _seen(
        {name: mirrored_test(test) for name, test in open_tests.items()}, mirrored_structure(STRUCTURE)
    )
    assert sum(len(test.rows.value) for test in seen) > 50  # a case that rocks
    for own, image in zip(seen, mirrored, strict=True):
        np.testing.assert_allclose(image.joints.rotation, -own.joints.rotation, atol=1e-9)
        np.testing.assert_array_equal(image.rows.instant, own.rows.instant)
        np.testing.assert_allclose(_size_of_rows(image), _size_of_rows(own), rtol=1e-6)
    _assert_same(_gains(mirrored), _gains(seen))


def test_a_faulty_marker_is_the_same_one_in_mirrored_readings(open_tests, two_blocks):
    tests = {name: test.copy(deep=True) for name, test in open_tests.items()}
    for test in tests.values():
        test["marker_displacement"].loc[{"marker": "block-1-upper"}] *= 1.04
    plain = check_parity(tests, two_blocks, Sensors())
    mirrored = {name: mirrored_test(test) for name, test in tests.items()}
    other = check_parity(mirrored, mirrored_structure(STRUCTURE), Sensors())
    assert _named(plain) == _named(other) == {("sensor-gain", ("block-1-upper",), "gain")}
    assert other.findings[0].estimate == pytest.approx(plain.findings[0].estimate, rel=1e-3)
    assert plain.findings[0].estimate[0] == pytest.approx(0.04, abs=0.01)


STRUCTURE = structure_file("two-blocks")
EFFECTS_WITH_A_SIDE = {
    "none": None,
    "eccentricity": {"name": "eccentricity", "values": {"offset": 0.08}, "place": {"body": "block-1"}},
    "stopper-contact": {
        "name": "stopper-contact",
        "values": {"stiffness": 1e7, "gap": 0.004},
        "place": {"body": "block-2", "axis": "+x"},
    },
    "vertical-motion": {"name": "vertical-motion", "values": {"ratio": 0.5, "delay": 0.02}, "place": {}},
    "table-pitch": {"name": "table-pitch", "values": {"coefficient": 6e-4, "frequency": 12.0}, "place": {}},
}


def _simulated(effect, scale):
    """Exact readings of a rocking stack, blocks as stated."""
    structure = load_structure(STRUCTURE)
    silent = Instruments(marker_noise=0.0, accelerometer_noise=0.0)
    experiment = Experiment(structure, load_motion("alkion", scale), silent)
    if effect is not None:
        experiment = with_effect(experiment, **effect)
    run = simulate(
        experiment.structure, experiment.motion, "nscd-rigid", {"nscd.shrink": 0.01},
        time_step=5e-4, duration=DURATION, accelerometers=False,
    )  # fmt: skip
    return observe(run, experiment.structure, experiment.instruments, 1)["marker_displacement"]


@pytest.mark.parametrize("name", EFFECTS_WITH_A_SIDE)
def test_the_mirrored_effect_under_the_mirrored_motion_gives_mirrored_readings(name):
    """So that mirrored readings are answered by the same name at the mirrored place, with the mirrored sign."""
    effect = EFFECTS_WITH_A_SIDE[name]
    middle = ["slab-face", "block-1-face", "block-2-face"]  # markers that are their own mirror images
    plain = _simulated(effect, 2.5).sel(marker=middle)
    image = _simulated(effect and mirrored_effect(effect), -2.5).sel(marker=middle)
    assert np.abs(plain - plain.sel(marker="slab-face")).sel(axis="x").max() > 3e-3  # it does rock
    # rounding, which rocking makes grow
    np.testing.assert_allclose(image.sel(axis="x"), -plain.sel(axis="x"), atol=1e-6)
    np.testing.assert_allclose(image.sel(axis="z"), plain.sel(axis="z"), atol=1e-6)


def test_a_known_extra_lag_is_found_as_that_lag(open_tests, two_blocks):
    """Accelerometers' times moved by -5 ms are an optical clock that is 5 ms behind."""
    late = {name: test.assign_coords(time_acc=test["time_acc"] - LAG) for name, test in open_tests.items()}
    parity = check_parity(late, two_blocks, Sensors())
    assert _named(parity) == {("clock-lag", ("optical clock",), "lag")}
    assert abs(parity.findings[0].estimate[0] - LAG) < NEAR


def test_another_order_of_bodies_and_markers_changes_nothing(seen, open_tests, parity):
    mapping = copy.deepcopy(load_yaml(STRUCTURE))
    for kind in ("bodies", "markers", "accelerometers", "friction"):
        mapping[kind] = mapping[kind][::-1]
    turned = build_structure(mapping, "turned.yaml", ".")
    shuffled = _seen(
        {
            name: test.isel(marker=slice(None, None, -1), channel=slice(None, None, -1))
            for name, test in open_tests.items()
        },
        turned,
    )
    for own, other in zip(seen, shuffled, strict=True):
        np.testing.assert_allclose(_size_of_rows(other), _size_of_rows(own), rtol=1e-6)
    _assert_same(_gains(shuffled), _gains(seen))
    other = check_parity(open_tests, turned, Sensors())
    np.testing.assert_allclose(other.clock["lag"], parity.clock["lag"], atol=1e-6)


def test_a_copy_of_a_test_is_no_further_test(clean_campaign, tmp_path):
    folder = tmp_path / "campaign"
    shutil.copytree(clean_campaign.folder, folder)
    file = load_yaml(folder / "campaign.yaml")
    slow, strong = file["tests"]
    shutil.copyfile(folder / strong["file"], folder / "again.nc")
    file["tests"].append({**strong, "name": "again", "file": "again.nc"})
    (folder / "campaign.yaml").write_text(yaml.safe_dump(file))
    names = [slow["name"], strong["name"], "again"]
    campaign = load_campaign(folder)
    assert list(read_open_tests(campaign, names).tests) == names[:-1]
    assert list(read_open_tests(campaign, names[::-1]).tests) == ["again", slow["name"]]


def test_the_mirrored_structure_is_one():
    plain, mirrored = load_structure(STRUCTURE), mirrored_structure(STRUCTURE)
    assert mirrored.body_names == plain.body_names
    for own, other in zip(plain.file.markers, mirrored.file.markers, strict=True):
        assert other.position == (-own.position[0], *own.position[1:])
