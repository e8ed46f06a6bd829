"""Bodies laid on others, and samples whose sizes are drawn."""

import copy

import numpy as np
import pytest
import yaml

from blockshake.dynamics.load_motion import load_motion
from blockshake.errors import InputError
from blockshake.files import parse_yaml
from blockshake.geometry.structure import load_structure
from blockshake.study.config import check_config

STATUE = """
name: statue
materials: {stone: {density: 2400.0, youngs_modulus: 3.0e+10, poisson_ratio: 0.2}}
shapes: {slab: {box: [3.0, 3.0, 0.4]}, pedestal: {box: [0.6, 0.6, 1.0]}, statue: {box: [0.3, 0.3, 1.2]}}
bodies:
  - {name: slab, shape: slab, material: stone, position: [0, 0, -0.2], driven: true}
  - {name: pedestal, shape: pedestal, material: stone, on: slab}
  - {name: statue, shape: statue, material: stone, on: pedestal, offset: [0.05, 0, 0]}
friction: [{pair: [stone, stone], coefficient: 0.6}]
markers: [{name: slab, body: slab, position: [0, 0, 0.2]}, {name: top, body: statue, position: [0, 0, 0.6]}]
"""


@pytest.fixture
def statue():
    return parse_yaml(STATUE, "statue")


def test_a_body_stands_on_the_one_below(statue):
    structure = load_structure(statue)
    np.testing.assert_allclose(structure.centroid[1:], [[0.0, 0.0, 0.5], [0.05, 0.0, 1.6]], atol=1e-15)
    assert structure.touching[0, 1]
    assert structure.touching[1, 2]


def test_a_size_moves_what_stands_above(statue):
    structure = load_structure(statue).with_parameters({"shapes.pedestal.box.z": 1.3})
    np.testing.assert_allclose(structure.centroid[1:, 2], [0.65, 1.9], atol=1e-15)
    moved = structure.with_parameters({"bodies.statue.offset.x": -0.1, "bodies.statue.offset.z": 0.02})
    np.testing.assert_allclose(moved.centroid[2], [-0.1, 0.0, 1.92], atol=1e-15)
    assert not moved.touching[1, 2]


def test_a_tilted_body_stands_on_its_lowest_corner(statue):
    half = np.radians(10.0) / 2.0
    statue["bodies"][1]["orientation"] = [float(np.cos(half)), 0.0, float(np.sin(half)), 0.0]
    solid = load_structure(statue)
    lowest = 0.5 * (np.cos(2 * half) + 0.6 * np.sin(2 * half))
    assert solid.centroid[1, 2] == pytest.approx(lowest, rel=1e-14)


def test_the_file_keeps_the_laying_and_a_position_ends_it(statue):
    structure = load_structure(statue)
    stated = structure.file.model_dump(mode="json")["bodies"][2]
    assert stated["on"] == "pedestal"
    assert "position" not in stated
    free = structure.with_parameters({"bodies.statue.position": [0.0, 0.0, 1.6]})
    assert free.file.bodies[2].on is None


@pytest.mark.parametrize(
    ("change", "line"),
    [
        ({"on": "plinth"}, "expected another body of this structure, not 'plinth'"),
        ({"on": "statue"}, "expected bodies that end on one with a position"),
        ({"position": [0, 0, 0]}, "expected either position, or on"),
        ({"on": None}, "expected either position, or on"),
    ],
)
def test_a_wrong_laying_is_refused(statue, change, line):
    statue["bodies"][1] |= change
    with pytest.raises(InputError, match=line):
        load_structure(statue)


def study(structure, **variables):
    return {
        "name": "statue",
        "description": "d",
        "models": {"nscd-rigid": {"time_step": 1e-3}},
        "cases": [{"structure": structure, "motion": "alkion", "duration": 2.0}],
        "ensemble": {"size": 10, "seed": 1, "distributions": variables},
    }


def written(tmp_path, mapping):
    path = tmp_path / "statue.yaml"
    path.write_text(yaml.safe_dump(mapping), encoding="utf-8")
    return str(path)


HEIGHT = {"shapes.pedestal.box.z": {"mean": 1.0, "cov": 0.05}}


def test_sizes_of_laid_blocks_can_be_drawn(tmp_path, statue):
    config = check_config(study(written(tmp_path, statue), **HEIGHT), "study.yaml")
    assert list(config.ensemble.distributions) == ["shapes.pedestal.box.z"]


def test_a_draw_that_opens_or_overlaps_is_refused_before_the_first_job(tmp_path, statue):
    apart = copy.deepcopy(statue)
    apart["bodies"][2] = {"name": "statue", "shape": "statue", "material": "stone", "position": [0, 0, 1.6]}
    with pytest.raises(
        InputError, match=r"shapes\.pedestal\.box\.z: .*overlaps|lay it there by `on: pedestal`"
    ):
        check_config(study(written(tmp_path, apart), **HEIGHT), "study.yaml")
    lower = {"shapes.pedestal.box.z": {"distribution": "uniform", "loc": 0.9, "scale": 0.05}}
    with pytest.raises(
        InputError, match=r"sample 0: .*expected statue to rest on pedestal .* `on: pedestal`"
    ):
        check_config(study(written(tmp_path, apart), **lower), "study.yaml")


def test_a_heading_turns_the_motion():
    motion = load_motion("alkion")
    turned = motion.turned(np.pi / 3.0)
    times = np.linspace(0.0, 8.0, 50)
    before, after = motion.evaluate(times), turned.evaluate(times)
    np.testing.assert_allclose(after[:, 0], 0.5 * before[:, 0] - np.sqrt(0.75) * before[:, 1], atol=1e-12)
    np.testing.assert_allclose(
        np.hypot(after[:, 0], after[:, 1]), np.hypot(before[:, 0], before[:, 1]), atol=1e-12
    )
