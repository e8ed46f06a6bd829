"""Statements of the paper that no study decides, and departures from it: the tables of docs/results/the-paper.md."""

import ast
import re
from decimal import Decimal

import numpy as np
import pytest

from blockshake.files import HOME, load_yaml
from blockshake.geometry.reference_block import reference_block
from blockshake.geometry.structure import load_structure
from blockshake.measurement.campaigns.campaign import load_campaign
from blockshake.measurement.sensors import accelerometers, markers
from blockshake.simulation.models import MODELS
from blockshake.solvers.ls_dem.interfaces import damping_ratio
from blockshake.solvers.ls_dem.parameters import LsDemParameters
from blockshake.solvers.nscd.parameters import DeformableParameters, NscdParameters
from blockshake.study.analyses import OF_THE_PAPER
from blockshake.study.calibration.answers import LEVEL
from blockshake.study.calibration.settings import FRICTION
from blockshake.study.config import load_config
from blockshake.study.ensembles.ensemble import RESIDUAL_WINDOW
from blockshake.study.sampling.distributions import LINKED, TABLE_2
from blockshake.study.stiffness.wave_step import STEP_VELOCITY

PAGE = HOME / "docs" / "results" / "the-paper.md"
CAMPAIGNS = HOME / "data" / "virtual-campaign"


def table(heading):
    """Rows of the table under a heading of the page."""
    text = PAGE.read_text(encoding="utf-8").split(f"\n## {heading}\n")[1].split("\n## ")[0]
    rows = [line.strip("| ").split(" | ") for line in text.splitlines() if line.startswith("| ")]
    return rows[2:]


UNDECIDED, DEPARTURES = table("Decided by no study"), table("Departures")


@pytest.fixture(scope="module")
def structures():
    return {name: load_structure(name) for name in OF_THE_PAPER}


@pytest.fixture(scope="module")
def studies():
    """The default study and that of the paper."""
    return [load_config(HOME / "config" / f"{name}.yaml") for name in ("study", "paper")]


def test_every_figure_table_and_equation_of_the_paper_stands_once(monkeypatch):
    monkeypatch.syspath_prepend(str(HOME / "bench"))
    from the_paper import STATEMENTS

    stated = [one[:2] for one in STATEMENTS]
    stated += [(row[0], row[1]) for row in UNDECIDED]
    assert len({claim for _, claim in stated}) == len(stated)
    places = " ".join(place for place, _ in stated)
    places += " 12 13" * ("Figs. 11 to 14" in places)
    for equation in range(1, 9):
        assert f"({equation})" in places
    for figure in range(1, 15):
        assert re.search(rf"\b{figure}\b", places), figure
    for number in (1, 2):
        assert f"Table {number}" in places


@pytest.mark.parametrize("row", UNDECIDED, ids=lambda row: row[1][:60])
def test_the_test_that_holds_a_statement_is_there(row):
    named = re.fullmatch(r"`(tests/[\w/]+\.py)`: `(test_\w+)`|none", row[3])
    assert named, row[3]
    if named[1]:
        tree = ast.parse((HOME / named[1]).read_text(encoding="utf-8"))
        assert named[2] in {node.name for node in tree.body if isinstance(node, ast.FunctionDef)}


def test_defaults_are_the_printed_ones():
    """Zhou et al. (2023), sections LS-DEM, LMGC90 and Case Study."""
    assert LsDemParameters().node_spacing == DeformableParameters().mesh_size == 0.2  # m
    assert LsDemParameters().grid_spacing == 0.02  # m
    assert {name: model.time_step for name, model in MODELS.items()} == {
        "ls-dem": 1e-5, **dict.fromkeys(("nscd-rigid", "nscd-elastic", "nscd-viscoelastic"), 1e-3)
    }  # fmt: skip
    assert {load_structure(name).file.nscd_restitution for name in OF_THE_PAPER} == {0.0}
    assert (accelerometers.RATE, accelerometers.CUTOFF, markers.RATE) == (512.0, 50.0, 200.0)  # Hz


def test_springs_and_moduli_are_those_of_ls_dem_alone():
    soft, rigid = MODELS["ls-dem"], MODELS["nscd-rigid"]
    assert (len(soft.stiffness), len(rigid.stiffness)) == (2, 0)
    assert "youngs_modulus" in rigid.without_effect
    assert "youngs_modulus" not in soft.without_effect


def test_structure_files_have_no_stopper(structures):
    assert not [name for name, one in structures.items() if one.file.stoppers]


def test_the_ladder_is_the_printed_one(studies):
    for study in studies:
        assert (study.ladder.first, study.ladder.increment, study.ladder.largest_drift) == (0.5, 0.25, 0.4)


def test_shipped_campaigns_have_no_sinusoidal_test():
    for folder in sorted(CAMPAIGNS.glob("configuration-*")):
        assert "sine" not in {test.motion for test in load_campaign(folder).tests.values()}


def test_instruments_of_the_structure_files(structures):
    files = [one.file for one in structures.values()]
    (words,) = [row[2] for row in UNDECIDED if row[0] == "Case Study, Figs. 6 and 7"]
    assert [int(number) for number in re.findall(r"\d+", words)] == [
        max(sum(len(sensor.axes) for sensor in file.accelerometers) for file in files),
        max(len(file.displacement_transducers) for file in files),
        max(len(file.markers) for file in files),
    ]


def test_friction_is_searched_in_more_than_the_printed_range(studies):
    for study in studies:
        searched = {**study.calibration.ranges}.get("friction.concrete.concrete", FRICTION)
        assert searched.lowest <= 0.3
        assert searched.highest >= 0.8


def numbers(words):
    """Numbers of a cell as printed; those in names, as of configuration-1, are none."""
    return re.findall(r"(?<![\w^.-])\d+(?:\.\d+)?(?:e-?\d+)?(?!\w)", words)


def agrees(printed, value):
    """Whether a printed number is the value rounded to its digits."""
    last = Decimal(printed).as_tuple().exponent
    return abs(float(printed) - value) <= 0.5 * 10.0**last * (1.0 + 1e-9)


def rebound(ratio):
    """Rebound of a mass on a spring and a dashpot that do not pull (Schwager and Poeschel 2007) [1]."""
    frequency = np.sqrt(1.0 - ratio**2)
    phase = np.arctan2(2.0 * ratio * frequency, frequency**2 - ratio**2)
    return np.exp(-ratio / frequency * (np.pi - phase))


def of_ls_dem(structures):
    first, share = structures["configuration-1"], LsDemParameters().perimeter_inset
    block = reference_block(first)
    chamfer = first.file.shapes[first.file.bodies[block.body].shape].chamfer
    width, restitution = float(block.size[0]), first.file.restitution
    flat, decay, ratio = width - 2.0 * chamfer, -np.log(restitution), damping_ratio(restitution)
    printed = decay / np.sqrt(np.pi**2 - 2.0 * decay)  # with ln(C_res^2) for (ln C_res)^2
    return {
        "Nodes cover the surface, chamfer included.": [
            1e2 * share, width, 1e3 * chamfer, 1e3 * (0.5 - share) * flat,
        ],
        "ln C_res^2 in Eq. (3).": [ratio, restitution, printed],
        "Eq. (2), which can pull.": [restitution, rebound(ratio)],
    }  # fmt: skip


def of_structures(structures):
    fourth = structures["configuration-4"]
    file, block = fourth.file, reference_block(fourth)
    young = {name: one.youngs_modulus for name, one in file.materials.items()}
    concrete, steel = (file.materials[name].poisson_ratio for name in ("concrete", "steel"))
    height = {name: file.shapes[shape].box[2] for name, shape in _shapes(file).items()}
    masses = dict(zip(fourth.body_names, fourth.mass, strict=True))
    stiffer, upright = young["steel"] / young["concrete"], float(block.size[2])
    own_stiffness = MODELS["ls-dem"].stiffness_of(structures["configuration-1"])
    return {
        "No Poisson's ratio is stated.": [concrete, steel, 1.0 / (2.0 + 2.0 * concrete)],
        "Nothing is said of lying blocks and beams.": [
            1.0, stiffer, upright / height["top"], stiffer * upright / height["beam-1"],
        ],
        "The section of the steel beams is not stated.": [
            *file.shapes["beam"].box, masses["beam-1"], 1e2 * masses["beam-1"] / masses["top"],
        ],
        "Calibrated stiffness everywhere.": [
            *(1e-9 * own_stiffness[f"ls_dem.{name}_stiffness"] for name in ("normal", "shear")),
            MODELS["ls-dem"].time_step, MODELS["nscd-rigid"].time_step,
        ],
    }  # fmt: skip


def _shapes(file):
    return {body.name: body.shape for body in file.bodies}


def of_solvers():
    rigid, soft = NscdParameters(), DeformableParameters()
    return {
        "A unit step of velocity is given to the ground of the tower.": [STEP_VELOCITY],
        "Nonlinear Gauss-Seidel.": [rigid.tolerance, rigid.max_iterations],
        "Contact areas are shrunk by an amount not stated.": [rigid.shrink],
        "Surface nodes of deformable blocks.": [soft.modes, soft.contact_spacing, soft.elastic_theta],
        "Residual displacements after a test.": [RESIDUAL_WINDOW],
    }


def of_studies(studies):
    study, paper = studies
    (parts,) = {one.models["nscd-rigid"].parameters["nscd.impact_parts"] for one in studies}
    assert {case.input for case in paper.cases} == {"commanded"}
    ((motion, scale),) = {(case.motion, case.scale) for case in study.cases}
    assert motion == "basso-tirreno"
    rise = load_yaml(HOME / "config" / "virtual-campaign.yaml")["intensities"]["increment"]
    medians = {name: one.stratum_medians(study.ensemble.size) for name, one in TABLE_2.items()}
    short = [1.0 - one.std() / one.mean() / TABLE_2[name].cov for name, one in medians.items()]
    assert [list(one.calibration.cases) for one in studies] == [["ls-dem", "nscd-rigid"], ["nscd-rigid"]]
    (window,) = {case.duration for case in study.cases}
    *walls, last = (case.samples for case in study.cases)
    (fewer,) = {count for samples in walls for count in samples.values()}
    (fewest,) = set(last.values())
    return {
        "Steps of 1e-5 s.": [one.models["ls-dem"].time_step for one in studies],
        "Steps are taken whole.": [parts, NscdParameters().impact_parts],
        "Record and level of Figs. 11 to 14 are not stated.": [scale],
        "Tests start at 50 % and rise by about 25 %.": [1e2 * study.ladder.increment, 1e2 * rise],
        "The values of the strata are not stated.": [
            study.ensemble.size, 1e2 * min(short), 1e2 * max(short),
        ],
        "Slab, and steel on steel and on the slab, are not in Table 2.": [len(LINKED)],
        "The mean friction is drawn at random from 0.3 to 0.8, with 50 samples by both models.": [
            one.calibration.size for one in studies
        ],
        "The mean friction whose envelope contains the test.": [1e2 * LEVEL],
        "50 samples over whole records.": [window, fewer, fewest],
    }  # fmt: skip


def test_departures_have_the_numbers_of_the_program(structures, studies):
    """Every number of the column, and no other; a row without numbers stands in none of the lists."""
    held = of_ls_dem(structures) | of_structures(structures) | of_solvers() | of_studies(studies)
    here = {row[1]: numbers(row[2]) for row in DEPARTURES}
    assert {claim for claim, printed in here.items() if printed} == set(held)
    for claim, values in held.items():
        assert len(here[claim]) == len(values), (claim, here[claim], values)
        for printed, value in zip(here[claim], values, strict=True):
            assert agrees(printed, value), (claim, printed, value)


def test_a_number_that_is_off_by_a_digit_does_not_agree():
    assert agrees("0.215", 0.21545)
    assert not agrees("0.216", 0.21545)
    assert not agrees("1e-05", 2e-5)
    assert numbers("configuration-1: 2.4 x 0.2 m in 20 parts, 1e-05 s") == ["2.4", "0.2", "20", "1e-05"]
