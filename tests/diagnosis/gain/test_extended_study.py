"""A made verdict becomes a variable of a tiny study, by the one path by which an effect enters a simulation."""

import numpy as np
import pandas as pd
import pytest
import yaml
from made_up_decision import made_up_cause
from numpy.testing import assert_allclose

from blockshake.cli import main
from blockshake.diagnosis.gain.extended_model import extended_experiment
from blockshake.diagnosis.gain.extended_study import extend_study
from blockshake.diagnosis.verdict.verdict import Misfit, Verdict, write_verdict
from blockshake.effects.effect import Experiment
from blockshake.errors import InputError
from blockshake.files import file_digest, load_yaml
from blockshake.geometry.structure import load_structure
from blockshake.geometry.structure_file import dotted_values
from blockshake.measurement.sensors.instruments import Instruments
from blockshake.study.config import load_config
from blockshake.study.sampling.latin_hypercube import draw_design
from blockshake.study.sampling.sample_parameters import sample_parameters

STRUCTURE = load_structure("configuration-1")
STUDY = {
    "name": "tiny",
    "description": "three blocks",
    "models": {"nscd-rigid": {"time_step": 1e-3}},
    "cases": [{"structure": "configuration-1", "motion": "alkion", "scale": 1.0, "duration": 1.0}],
    "ensemble": {"size": 10, "seed": 1},
    "fragility": {"cases": ["configuration-1"], "size": 3},
}
SHARES = (np.arange(40) + 0.5) / 40


def members(**ends):
    """Forty members, each parameter even between two ends and in an order of its own."""
    orders = [np.random.default_rng(seed).permutation(SHARES) for seed in range(len(ends))]
    columns = {
        name: low + (high - low) * order
        for (name, (low, high)), order in zip(ends.items(), orders, strict=True)
    }
    return tuple({name: float(values[row]) for name, values in columns.items()} for row in range(40))


CAUSES = {
    "reduced-bearing": made_up_cause("reduced-bearing", {}, members=members(inset=(0.03, 0.05))),
    "weak-joint": made_up_cause(
        "weak-joint", {"joint": ["slab", "block-1"]}, members=members(factor=(0.2, 0.4))
    ),
    "stopper-contact": made_up_cause(
        "stopper-contact",
        {"body": "block-3", "height": 0.5},
        members=tuple(
            {**one, "side": 1.0, "other_gap": 1e3}
            for one in members(stiffness=(8e6, 1.2e7), gap=(0.01, 0.03))
        ),
    ),
    "eccentricity": made_up_cause(
        "eccentricity", {"body": "block-2"}, members=members(offset=(-0.05, -0.03))
    ),
    "rate-weakening-friction": made_up_cause(
        "rate-weakening-friction", {}, members=members(drop=(0.3, 0.6), scale=(0.005, 0.02))
    ),
    "joint-compliance": made_up_cause(
        "joint-compliance", {"joint": ["block-1", "block-2"]}, members=members(compliance=(1e-10, 3e-10))
    ),
    "push": made_up_cause(
        "push",
        {"body": "block-3", "height": 0.42},
        members=members(force=(1800.0, 2200.0)),
        when={"starts": {"t1": 2.0}},
    ),
    "loose-weight": made_up_cause(
        "loose-weight", {"body": "block-3"}, members=members(mass=(400.0, 600.0)), when={"grip": 0.2}
    ),
}


@pytest.fixture
def written(tmp_path):
    """Writer of a verdict and a study: their paths, and that of the extended study."""

    def write(*causes, study=STUDY, **changed):
        values = {
            "decision": "named", "causes": ["weak-joint"], "probabilities": {}, "runs": 0, "word": "established",
            "misfit": Misfit(p=0.01, where="block-1"), "extension": causes, "structure": STRUCTURE.content,
        }  # fmt: skip
        write_verdict(tmp_path / "verdict.json", Verdict(**values | changed))
        (tmp_path / "study.yaml").write_text(yaml.safe_dump(study))
        return tmp_path / "verdict.json", tmp_path / "study.yaml", tmp_path / "made" / "extended.yaml"

    return write


@pytest.mark.parametrize("name", CAUSES)
def test_a_sample_is_the_structure_that_the_diagnosis_simulates(name, written):
    """Where the variables are set to a member's values, the extended structure is that of this member."""
    cause = CAUSES[name]
    paths = written(cause)
    extend_study(*paths)
    config = load_config(paths[2])
    extended = load_structure(config.cases[1].structure)
    for number in (0, 17):
        wanted = extended_experiment(Experiment(STRUCTURE, None, Instruments()), cause, number, "").structure
        values = dotted_values(wanted.file.model_dump(mode="json"))
        names = [one for one in config.ensemble.distributions if one.startswith("extension.")]
        row = {one: values[one.removeprefix("extension.")] for one in names}
        made = extended.with_parameters(sample_parameters(row_of(row), extended, config.ensemble.linked))
        same = made.file.model_copy(update={"name": STRUCTURE.file.name, "extension": ""})
        (found, others), (numbers, wanted) = map(
            numbers_apart, (dotted_values(same.model_dump(mode="json")), values)
        )
        assert others == wanted
        assert found == pytest.approx(numbers, rel=1e-12)
    # and no variable of the cause reaches the nominal case
    assert sample_parameters(row_of(row), STRUCTURE, config.ensemble.linked) == {}


def numbers_apart(values):
    """Numbers, and all else."""
    numbers = {name: value for name, value in values.items() if isinstance(value, float)}
    others = {name: value for name, value in values.items() if name not in numbers}
    return numbers, others


def row_of(values):
    """A row of a design."""
    return pd.Series(values, dtype=float)


def design_of(ensemble, **changed):
    """The design that a study draws."""
    return draw_design({**ensemble.model_dump(), "distributions": ensemble.distributions, **changed})


def test_the_posterior_comes_back_from_the_design(written):
    paths = written(CAUSES["weak-joint"])
    extend_study(*paths)
    config = load_config(paths[2])
    design = design_of(config.ensemble, size=200)
    drawn = design.values["extension.joints.slab.block-1.friction_factor"]
    given = [one["factor"] for one in CAUSES["weak-joint"].members]
    assert_allclose(np.quantile(drawn, (0.1, 0.5, 0.9)), np.quantile(given, (0.1, 0.5, 0.9)), rtol=5e-3)


def test_values_that_go_together_are_linked_or_correlated(written, tmp_path):
    paths = written(CAUSES["rate-weakening-friction"])
    extend_study(*paths)
    linked = load_config(paths[2]).ensemble.linked
    first, second = "extension.friction.concrete.concrete", "extension.friction.concrete.foundation"
    assert linked[f"{second}.rate_drop"] == f"{first}.rate_drop"
    assert linked[f"{second}.rate_scale"] == f"{first}.rate_scale"
    together = tuple(
        {"stiffness": 1e7 * (1.0 + share), "gap": 0.03 - 0.01 * share, "side": 1.0, "other_gap": 1e3}
        for share in SHARES
    )
    paths = written(CAUSES["stopper-contact"].model_copy(update={"members": together}))
    extend_study(*paths)
    config = load_config(paths[2])
    design = design_of(config.ensemble)
    names = ["extension.stoppers.0.gap", "extension.stoppers.0.stiffness"]
    assert design.correlation.loc[names[0], names[1]] < -0.98


def test_the_study_runs_both_and_says_where_it_comes_from(written, capsys):
    verdict, study, output = written(CAUSES["reduced-bearing"])
    assert main(["extend-study", str(verdict), str(study), "--output", str(output)]) == 0
    assert "extension.shapes.block.chamfer [m]" in capsys.readouterr().out
    made = load_yaml(output)
    assert made["name"] == "tiny-extended"
    assert made["extension"] == {"cases": {"configuration-1-extended": "configuration-1"}, "named_by": []}
    assert made["fragility"]["cases"] == ["configuration-1", "configuration-1-extended"]
    for path in (output, output.with_name("extended-configuration-1.yaml")):
        assert f"digest {file_digest(verdict)}, version 4" in path.read_text()
    assert load_structure(str(output.with_name("extended-configuration-1.yaml"))).file.extension
    assert main(["check", str(output)]) == 0


def test_a_cause_without_a_place_goes_to_another_structure_and_one_with_a_place_does_not(written):
    study = {**STUDY, "cases": [{**STUDY["cases"][0], "structure": "configuration-2"}]}
    del study["fragility"]
    paths = written(CAUSES["reduced-bearing"], study=study)
    assert str(paths[2]) in extend_study(*paths)
    with pytest.raises(InputError, match=r"study.yaml: cases: expected a case of the structure"):
        extend_study(*written(CAUSES["weak-joint"], study=study))
    both = {**STUDY, "cases": [STUDY["cases"][0], study["cases"][0]]}
    lines = extend_study(*written(CAUSES["weak-joint"], study=both))
    assert lines[0] == "configuration-2 is left out: its structure is not the one that was tested"


PITCH = made_up_cause("table-pitch", {}, members=({"coefficient": 1e-5, "frequency": 15.0},))
BLOW = made_up_cause(
    "blow", {"body": "block-3", "height": 0.4}, members=({"impulse": 1e3},), when={"blows": {}}
)
FREE = made_up_cause("unknown-force", {"body": "block-3"}, members=())
MASS = made_up_cause("block-mass", {"body": "block-2", "height": 0.0}, members=members(excess=(0.05, 0.08)))


@pytest.mark.parametrize(
    ("causes", "changed", "line"),
    [
        ((), {"decision": "none", "causes": (), "word": "no misfit larger than chance"},
         "verdict.json: extension: expected a cause that acts in blocks, joints or forces and lasts; its word is: no"),
        ((), {"word": "probable", "missing": ("it is not proposed",)}, "its word is: probable; it is not proposed"),
        ((PITCH,), {}, "verdict.json: extension: expected a cause that acts in blocks, joints or forces and lasts; "
         "found table-pitch"),
        ((BLOW,), {}, "found blow"),
        ((FREE,), {}, "found unknown-force"),
        ((CAUSES["weak-joint"],), {"structure": "0123456789ab"}, "study.yaml: cases: expected a case of the structure"),
        ((MASS,), {}, "study.yaml: ensemble.distributions.materials.concrete.density: expected no variable that"),
    ],
)  # fmt: skip
def test_what_cannot_be_extended_is_one_line_and_leaves_nothing(causes, changed, line, written, capsys):
    verdict, study, output = written(*causes, **changed)
    assert main(["extend-study", str(verdict), str(study), "--output", str(output)]) == 2
    said = capsys.readouterr().err
    assert line in said
    assert said.count("\n") == 1
    assert not output.parent.exists()


def test_a_verdict_of_another_version_is_refused(written):
    verdict, study, output = written(CAUSES["weak-joint"])
    verdict.write_text(verdict.read_text().replace('"version": 4', '"version": 3'))
    with pytest.raises(InputError, match=r"verdict.json: version: "):
        extend_study(verdict, study, output)


def test_an_extended_study_is_not_extended_again_and_a_bad_one_leaves_the_one_before(written):
    verdict, study, output = written(CAUSES["weak-joint"])
    extend_study(verdict, study, output)
    with pytest.raises(InputError, match="extension: expected a study that has no cause yet"):
        extend_study(verdict, output, output.with_name("again.yaml"))
    before = output.read_bytes()
    clash = {**STUDY, "cases": [*STUDY["cases"], {**STUDY["cases"][0], "name": "configuration-1-extended"}]}
    with pytest.raises(InputError, match="expected a name of its own"):
        extend_study(*written(CAUSES["weak-joint"], study=clash))
    assert output.read_bytes() == before


def test_other_parts_of_the_verdict_are_named_as_left_out(written):
    paths = written(PITCH, CAUSES["weak-joint"], decision="combination", causes=("table-pitch", "weak-joint"))
    assert extend_study(*paths)[0] == "table-pitch is left out: no structure file can state it"


def test_structures_of_other_shapes_have_variables_of_their_own(written):
    cases = [{**STUDY["cases"][0], "structure": f"configuration-{number}"} for number in (1, 3)]
    paths = written(CAUSES["reduced-bearing"], study={**STUDY, "cases": cases})
    extend_study(*paths)
    config = load_config(paths[2])
    names = ["extension.shapes.block.chamfer", "extension.shapes.top.chamfer"]
    assert config.ensemble.linked[names[1]] == names[0]
    row = row_of({names[0]: 0.06})
    for case, reached in ((config.cases[1], names[:1]), (config.cases[3], names)):
        given = sample_parameters(row, load_structure(case.structure), config.ensemble.linked)
        assert given == dict.fromkeys(reached, 0.06)
