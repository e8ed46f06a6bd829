"""Contact stiffness follows a structure's own materials and sizes, wherever it comes from."""

import json

import numpy as np
import pandas as pd
import pytest
import yaml

from blockshake.diagnosis.nominal.nominal_model import draw_nominal
from blockshake.errors import InputError
from blockshake.geometry.reference_block import reference_block
from blockshake.geometry.structure import load_structure
from blockshake.simulation.parameter_table import parameter_table
from blockshake.simulation.simulate import simulate
from blockshake.store import Store
from blockshake.study.ensembles.drift_limits import drift_limits
from blockshake.study.stiffness.tower import tower_of
from blockshake.study.stiffness.wave_speed import calibrate_design, calibrate_stiffness, wave_tests
from blockshake.virtual.truth import true_parameters

MATERIALS = {
    "concrete": {"density": 2400.0, "youngs_modulus": 3.45e10, "poisson_ratio": 0.2},
    "granite": {"density": 2700.0, "youngs_modulus": 5.0e10, "poisson_ratio": 0.25},
}
BOXES = {1.6: [0.8, 2.4, 1.6], 0.2: [0.1, 0.3, 0.2]}
FLAT = 0.76 * 2.36 / (0.8 * 2.4)  # of the area of a block of the paper within its chamfers
NAMES = "normal_stiffness", "shear_stiffness"


def own_file(material, height, **changes):
    """Three equal blocks on a steel plate."""
    box = BOXES[height]
    blocks = [
        {"name": f"b{n}", "shape": "block", "material": material, "position": [0.0, 0.0, (n + 0.5) * height]}
        for n in range(3)
    ]
    steel = {"density": 7850.0, "youngs_modulus": 2.1e11, "poisson_ratio": 0.3}
    return {
        "name": "own",
        "materials": {material: MATERIALS[material], "plate": steel},
        "shapes": {"table": {"box": [2.0 * box[1], 2.0 * box[1], 0.1]}, "block": {"box": box}},
        "bodies": [
            {"name": "table", "shape": "table", "material": "plate", "position": [0, 0, -0.05], "driven": True},
            *blocks,
        ],
        "friction": [
            {"pair": [material, material], "coefficient": 0.6},
            {"pair": [material, "plate"], "coefficient": 0.5},
        ],
        "markers": [
            {"name": "on-the-table", "body": "table", "position": [0.0, 0.0, 0.05]},
            {"name": "on-top", "body": "b2", "position": [0.0, 0.0, 0.0]},
        ],
        **changes,
    }  # fmt: skip


@pytest.fixture
def own(tmp_path):
    def made(material, height, **changes):
        path = tmp_path / "own.yaml"
        path.write_text(yaml.safe_dump(own_file(material, height, **changes)))
        return path

    return made


def by_area(material, height):
    """E/h and G/h [N/m3]."""
    one = MATERIALS[material]
    young = one["youngs_modulus"]
    return np.array([young, young / (2.0 + 2.0 * one["poisson_ratio"])]) / height


@pytest.fixture(scope="module")
def paper():
    """Calibrated stiffness of the paper's blocks, had they no chamfer, over E/h and G/h."""
    found = calibrate_stiffness("configuration-2")
    return FLAT * np.array([found[name] for name in NAMES]) / by_area("concrete", 1.6)


@pytest.mark.parametrize("height", BOXES)
@pytest.mark.parametrize("material", MATERIALS)
def test_wave_test_is_of_the_own_blocks(own, paper, material, height):
    """Facts: a chain of masses and springs has no length of its own, so the stiffness goes with E/h and G/h."""
    structure = own(material, height)
    found = calibrate_stiffness(structure)
    expected = paper * by_area(material, height)
    # nodes of other blocks lie elsewhere on the plate: a few per cent of the first joint's stiffness
    np.testing.assert_allclose([found[name] for name in NAMES], expected, rtol=0.04)
    waves = wave_tests(structure)
    np.testing.assert_allclose(waves["stiffness"], [found[name] for name in NAMES])
    young, density = MATERIALS[material]["youngs_modulus"], MATERIALS[material]["density"]
    assert waves["target_wave_speed"].sel(direction="normal").item() == pytest.approx(
        np.sqrt(young / density)
    )


@pytest.mark.parametrize("height", BOXES)
@pytest.mark.parametrize("material", MATERIALS)
def test_default_and_null_model_go_with_the_own_blocks(own, material, height):
    structure = load_structure(own(material, height))
    # the default of the paper's blocks is E/h and G/h to three and two digits
    usual = by_area(material, height) / by_area("concrete", 1.6) * [2.16e10, 9.0e9]
    run = simulate(structure, "alkion", "ls-dem", duration=0.005)
    acted = json.loads(run.attrs["parameters"])
    np.testing.assert_allclose([acted[f"ls_dem.{name}"] for name in NAMES], usual, rtol=1e-12)
    drawn = draw_nominal(structure, "ls-dem", 3).parameters
    softer = drawn[f"materials.{material}.youngs_modulus"] / MATERIALS[material]["youngs_modulus"]
    np.testing.assert_allclose([drawn[f"ls_dem.{name}"] for name in NAMES], usual * softer, rtol=1e-12)


def test_what_is_given_is_taken_and_the_rest_follows_the_parameters(own):
    given = {"ls_dem.normal_stiffness": 1e9, "materials.granite.youngs_modulus": 2.5e10}
    acted = json.loads(
        simulate(own("granite", 1.6), "alkion", "ls-dem", given, duration=0.005).attrs["parameters"]
    )
    assert acted["ls_dem.normal_stiffness"] == 1e9
    assert acted["ls_dem.shear_stiffness"] == pytest.approx(9.0e9 * 2.5 / 3.45 * 1.2 / 1.25)


def test_parameters_of_a_structure_are_printed_with_its_stiffness(own):
    shown = {name: default for name, _, default, _, _ in parameter_table(own("granite", 0.2))}
    assert float(shown["ls_dem.normal_stiffness"]) == pytest.approx(2.16e10 * 5.0 / 3.45 * 8.0, rel=1e-5)


def test_samples_of_an_own_material_have_their_own_stiffness(own, tmp_path):
    design = pd.DataFrame({"materials.granite.youngs_modulus": [4e10, 6e10]})
    found = calibrate_design(own("granite", 1.6), design, {}, Store(tmp_path, "source"))
    np.testing.assert_allclose(found.iloc[1] / found.iloc[0], 1.5, rtol=0.01)


def test_virtual_truth_is_of_the_own_blocks(own):
    """A concrete of the user's own is not that of Table 2."""
    soft = {**MATERIALS["concrete"], "youngs_modulus": 1.5e10}
    structure = load_structure(own("concrete", 1.6)).with_parameters(
        {f"materials.concrete.{name}": value for name, value in soft.items()}
    )
    truth, usual = true_parameters(structure, 3), true_parameters(load_structure("configuration-1"), 3)
    young = "materials.concrete.youngs_modulus"
    assert truth[young] == pytest.approx(usual[young] * 1.5 / 3.45)
    assert truth["ls_dem.normal_stiffness"] == pytest.approx(
        FLAT * usual["ls_dem.normal_stiffness"] * 1.5 / 3.45, rel=0.04
    )
    granite = true_parameters(load_structure(own("granite", 0.2)), 3)
    assert granite["ls_dem.normal_stiffness"] == pytest.approx(FLAT * 1.813e10 * 8.0 * 5.0 / 3.45, rel=0.04)


def test_shipped_structures_have_one_tower():
    towers = [tower_of(load_structure(f"configuration-{number}")).file for number in (1, 2, 3, 4)]
    paper = load_structure("configuration-2").file
    for tower in towers:
        assert tower.bodies == paper.bodies
        assert tower.shapes == paper.shapes
        assert tower.materials == paper.materials


def test_reference_block_is_of_the_heaviest_material_and_its_usual_height(own):
    lying = {"orientation": [0.5**0.5, 0.0, 0.5**0.5, 0.0], "shape": "block", "material": "granite"}
    file = own_file("granite", 1.6)
    file["bodies"].append({"name": "first", "position": [0.0, 0.0, 5.2], **lying})
    structure = load_structure(own("granite", 1.6, bodies=file["bodies"]))
    assert reference_block(structure).body == 1
    table, last = file["bodies"][0], {**file["bodies"][4], "position": [0.0, 0.0, 0.4]}
    alone = load_structure(own("granite", 1.6, bodies=[table, last], markers=[]))
    np.testing.assert_allclose(reference_block(alone).size, [2.4, 1.6, 0.8])


def test_the_limit_of_drifts_is_half_of_the_thickness(own):
    np.testing.assert_array_equal(drift_limits(load_structure("configuration-3"))[1:9], 0.4)
    # the capping block lies across both walls
    assert drift_limits(load_structure("configuration-3"))[9] == 0.8
    np.testing.assert_array_equal(drift_limits(load_structure(own("granite", 0.2)))[1:], 0.05)


@pytest.mark.parametrize("thin", [1, 2, 3])
def test_every_block_has_the_limit_of_its_own_width(own, thin):
    """A slender block among wide ones may slide less than these; a limit that is given holds for all."""
    file = own_file("granite", 1.6)
    file["shapes"]["thin"] = {"box": [0.5, *file["shapes"]["block"]["box"][1:]]}
    file["bodies"][thin]["shape"] = "thin"
    changes = {key: file[key] for key in ("shapes", "bodies")}
    structure = load_structure(own("granite", 1.6, **changes))
    expected = np.full(len(file["bodies"]), 0.4)
    expected[[0, thin]] = np.nan, 0.25
    np.testing.assert_array_equal(drift_limits(structure), expected)
    np.testing.assert_array_equal(drift_limits(structure, 0.1)[1:], 0.1)


def test_a_structure_of_driven_bodies_has_no_blocks(own):
    structure = load_structure(own("granite", 1.6, bodies=own_file("granite", 1.6)["bodies"][:1], markers=[]))
    with pytest.raises(InputError, match=r"bodies: expected a body that is not driven"):
        calibrate_stiffness(structure)
