"""Known changes of the readings (mirrored, late, copied, in another order) change the findings as they must.

On the functions that every diagnosis goes through, with the readings of a clean case of the maker.
"""

import copy
import shutil

import numpy as np
import pytest
import yaml
from make_case import DURATION, structure_file
from mirror import mirrored_effect, mirrored_features, mirrored_structure, mirrored_test

from blockshake.diagnosis.features.reading import read_off
from blockshake.diagnosis.libraries.null_model import draw_nominal
from blockshake.diagnosis.libraries.repeated_readings import without_repeats
from blockshake.dynamics.load_motion import load_motion
from blockshake.effects.effect import Experiment
from blockshake.effects.registry import with_effect
from blockshake.files import load_yaml
from blockshake.forces.joint_forces import joint_forces
from blockshake.forces.outside.force_laws import fit_laws
from blockshake.forces.outside.push_history import push_history
from blockshake.geometry.structure import build_structure, load_structure
from blockshake.measurement.campaigns.campaign import Sensors, load_campaign
from blockshake.measurement.sensors.instruments import Instruments, observe
from blockshake.parity.parity import check_parity
from blockshake.simulation.models import part_parameters
from blockshake.simulation.simulate import simulate

LAG, NEAR = 5e-3, 1e-3  # s; of a clock that is put behind, and how near it must be found


def _features(test, structure):
    read = read_off(test, structure, Sensors())
    return dict(zip(map(str, read["feature"].values), read["value"].to_numpy(), strict=True))


def _by_joint(test, structure):
    """Features by name, joints by theirs: the order of the bodies in a file numbers them."""
    read = read_off(test, structure, Sensors())
    numbers = {f"joint{number}": str(name) for number, name in enumerate(read["joint"].values, start=1)}
    names = [str(name).partition(".") for name in read["feature"].values]
    return {
        (numbers.get(head, head), tail): float(value)
        for (head, _, tail), value in zip(names, read["value"].to_numpy(), strict=True)
    }


def _pushed(forces, name):
    """Force from outside on a block by the laws that its history may follow, and what the history is made of."""
    push = push_history(forces, forces.structure.body_names.index(name))
    told = {"told": push.told.sum(), "ends": np.isfinite(push.lower).sum(), "error": np.nanmedian(push.error)}
    return told | {one.name: one.information for one in fit_laws(forces.motion.time, push)}


def _assert_same(found, expected):
    assert sorted(found) == sorted(expected)
    for name, value in found.items():
        assert value == pytest.approx(expected[name], rel=1e-6, abs=1e-9), name


def _named(parity):
    return {(finding.effect, finding.where, finding.quantity) for finding in parity.findings}


@pytest.fixture(scope="module")
def parity(open_tests, two_blocks):
    return check_parity(open_tests, two_blocks, Sensors())


def test_sound_sensors_of_a_case_give_no_finding(parity):
    assert _named(parity) == set()


@pytest.mark.parametrize("name", ["alkion-100", "alkion-250"])
def test_features_of_mirrored_readings_are_mirrored(name, open_tests, two_blocks):
    plain = _features(open_tests[name], two_blocks)
    mirrored = _features(mirrored_test(open_tests[name]), mirrored_structure(STRUCTURE))
    _assert_same(mirrored, mirrored_features(plain))


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
    physical, numerics = part_parameters(draw_nominal(structure, "nscd-rigid", 3).parameters)
    silent = Instruments(marker_noise=0.0, accelerometer_noise=0.0)
    experiment = Experiment(structure.with_parameters(physical), load_motion("alkion", scale), silent)
    if effect is not None:
        experiment = with_effect(experiment, **effect)
    run = simulate(
        experiment.structure, experiment.motion, "nscd-rigid", numerics,
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


def test_another_order_of_bodies_and_markers_changes_nothing(open_tests, two_blocks, parity):
    mapping = copy.deepcopy(load_yaml(STRUCTURE))
    for kind in ("bodies", "markers", "accelerometers", "friction"):
        mapping[kind] = mapping[kind][::-1]
    turned = build_structure(mapping, "turned.yaml", ".")
    for test in open_tests.values():
        shuffled = test.isel(marker=slice(None, None, -1), channel=slice(None, None, -1))
        _assert_same(_by_joint(shuffled, turned), _by_joint(test, two_blocks))
        of_file, of_turned = (
            joint_forces(test, two_blocks, Sensors()),
            joint_forces(shuffled, turned, Sensors()),
        )
        for name in ("block-1", "block-2"):
            _assert_same(_pushed(of_turned, name), _pushed(of_file, name))
    other = check_parity(open_tests, turned, Sensors())
    np.testing.assert_allclose(other.clock["lag"], parity.clock["lag"], atol=1e-6)


def test_a_copy_of_a_test_is_no_further_test(clean_campaign, tmp_path):
    folder = tmp_path / "campaign"
    shutil.copytree(clean_campaign.folder, folder)
    file = load_yaml(folder / "campaign.yaml")
    copied = next(test for test in file["tests"] if test["name"] == "alkion-250")
    shutil.copyfile(folder / copied["file"], folder / "again.nc")
    file["tests"].append({**copied, "name": "again", "file": "again.nc"})
    (folder / "campaign.yaml").write_text(yaml.safe_dump(file))
    names = ["alkion-100", "alkion-250", "again"]
    assert without_repeats(load_campaign(folder), names) == names[:-1]
    assert without_repeats(load_campaign(folder), names[::-1]) == ["again", "alkion-100"]


def test_the_mirrored_structure_is_one():
    plain, mirrored = load_structure(STRUCTURE), mirrored_structure(STRUCTURE)
    assert mirrored.body_names == plain.body_names
    for own, other in zip(plain.file.markers, mirrored.file.markers, strict=True):
        assert other.position == (-own.position[0], *own.position[1:])
