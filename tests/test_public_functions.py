"""The functions of `import blockshake`: an editor sees them with their types, and a notebook their results."""

import ast
import inspect
import tomllib

import numpy as np
import pandas as pd
import pytest

import blockshake
from blockshake.errors import Argument, InputError
from blockshake.files import PACKAGE, load_yaml, shipped
from blockshake.measurement.campaigns.campaign import load_campaign
from blockshake.simulation.limits import check_limits
from blockshake.simulation.models import split_parameters
from blockshake.simulation.run_histories import run_histories

ROOT = PACKAGE.parents[1]
TIME = np.arange(200) / 100.0
SINE = np.sin(2.0 * np.pi * TIME)


def test_editors_see_the_same_names_as_the_running_program():
    tree = ast.parse((PACKAGE / "__init__.pyi").read_text(encoding="utf-8"))
    seen = [
        (node.module, alias) for node in tree.body if isinstance(node, ast.ImportFrom) for alias in node.names
    ]
    assert {alias.asname: module for module, alias in seen} == blockshake._HOMES
    assert all(alias.name == alias.asname for _, alias in seen)  # which makes a name public


@pytest.mark.parametrize("name", blockshake.__all__)
def test_every_argument_and_result_has_a_type(name):
    public = getattr(blockshake, name)
    signature = inspect.signature(public.__init__ if inspect.isclass(public) else public)
    untyped = [one.name for one in signature.parameters.values() if one.annotation is one.empty]
    assert [one for one in untyped if one != "self"] == []
    assert signature.return_annotation is not signature.empty


def test_the_type_checker_reads_the_module_of_every_public_function():
    files = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["mypy"]["files"]
    homes = {f"src/{home.replace('.', '/')}.py" for home in blockshake._HOMES.values()}
    assert homes <= set(files)
    assert all((ROOT / file).is_file() for file in files)
    assert "$(BIN)/mypy" in (ROOT / "Makefile").read_text()


@pytest.mark.parametrize("table", [dict, pd.DataFrame])
def test_a_motion_of_arrays_is_that_of_their_file(table, tmp_path):
    columns = table({"time_s": TIME + 1.0, "acceleration_x": SINE})
    pd.DataFrame({"time_s": TIME + 1.0, "acceleration_x": SINE}).to_csv(tmp_path / "sine.csv", index=False)
    read = blockshake.load_motion(tmp_path / "sine.csv", scale=2.0)
    given = blockshake.load_motion(columns, scale=2.0, name="sine")
    np.testing.assert_array_equal(given.table.coefficients, read.table.coefficients)
    assert (given.name, given.kind, given.duration) == ("sine", "acceleration", read.duration)
    assert given.attributes["first_time"] == 1.0
    again = blockshake.load_motion(given, scale=0.5)
    np.testing.assert_array_equal(again.table.coefficients, 0.5 * read.table.coefficients)


@pytest.mark.parametrize(
    ("arrays", "words"),
    [
        ({"time_s": TIME, "acceleration_x": SINE[1:]}, "arrays: .* two numbers, all of one length"),
        ({"time_s": TIME}, "arrays: expected at least one column of motion with time_s"),
        ({"time_s": TIME, "acceleration_u": SINE}, "arrays: column 'acceleration_u': expected one of"),
        ({"time_s": TIME, "acceleration_x": ["a"] * 200}, "arrays: expected arrays of at least two numbers"),
        ({"time_s": TIME[::-1], "acceleration_x": SINE}, "arrays: row 1, time_s: expected times that increase"),
        ({"time_s": TIME, "velocity_x": np.where(TIME == 1.0, np.nan, 0.0)}, "arrays: row 100, velocity_x: expected a"),
        (5, "arrays: expected a name, a path, or arrays by the names of columns"),
    ],
)  # fmt: skip
def test_arrays_that_are_no_motion_are_refused(arrays, words):
    with pytest.raises(InputError, match=words):
        blockshake.load_motion(arrays)


def test_a_structure_of_a_mapping_is_that_of_its_file():
    mapping = load_yaml(shipped("structures", "configuration-1"))
    kept = repr(mapping)
    given = blockshake.load_structure(mapping, {"friction.concrete.concrete": 0.6})
    read = blockshake.load_structure("configuration-1", {"friction.concrete.concrete": 0.6})
    assert given.content == read.content
    assert repr(mapping) == kept
    with pytest.raises(InputError, match="structure: frictoin: unknown key, did you mean friction"):
        blockshake.load_structure({**mapping, "frictoin": []})


def test_errors_of_functions_name_arguments():
    with pytest.raises(InputError, match=r"^parameters: nscd\.tolerence: expected one of nscd") as wrong:
        split_parameters({"nscd.tolerence": 1.0}, "nscd-rigid")
    assert isinstance(wrong.value.where, Argument)
    structure = blockshake.load_structure("configuration-1")
    with pytest.raises(InputError, match=r"^time_step: expected a positive number, not -1"):
        check_limits(structure, "ls-dem", -1.0, 1.0, 200.0, True, True)


def test_results_show_themselves_in_a_line_and_in_a_table():
    structure, motion = blockshake.load_structure("configuration-1"), blockshake.load_motion("alkion")
    campaign = load_campaign(ROOT / "data" / "virtual-campaign" / "configuration-1")
    assert repr(structure) == "<Structure configuration-1: 3 blocks of 2.209e+04 kg in all, 1 driven>"
    assert repr(motion) == "<GroundMotion alkion: 25 s, given as acceleration>"
    for result, cell in (
        (structure, "<td>block-1</td>"),
        (motion, "<td>baseline</td>"),
        (campaign, "<td>fit</td>"),
    ):
        assert cell in result._repr_html_()
        assert len(repr(result)) < 120
    design = blockshake.draw_samples(10)
    assert repr(design).startswith("<SampleDesign 10 samples of 9 variables")
    assert "<td>" in design._repr_html_()


def test_a_run_and_its_file_give_the_same_tables(leaning_run, leaning_file, tmp_path):
    of_run = blockshake.export(leaning_run[0], tmp_path / "a.csv")
    of_file = blockshake.export(leaning_file, tmp_path / "b.csv")
    assert [one.read_bytes() for one in of_run] == [one.read_bytes() for one in of_file]
    assert blockshake.animate(leaning_file, tmp_path / "a.gif", speed=5.0) == tmp_path / "a.gif"
    blockshake.plot(leaning_run[0], tmp_path / "a.svg")
    blockshake.plot(leaning_file, tmp_path / "b.svg")
    assert (tmp_path / "a.svg").read_bytes() == (tmp_path / "b.svg").read_bytes()


def test_the_largest_responses_of_a_run_are_those_of_its_histories(leaning_run):
    run, structure = leaning_run
    largest, histories = blockshake.largest_responses(run), run_histories(run, structure)
    assert largest.index.tolist() == ["lower", "upper"]
    for body, joint in (("lower", "slab-lower"), ("upper", "lower-upper")):
        drift = np.hypot(*histories["drift"].sel(body=body, axis=["x", "y"]).to_numpy().T)
        assert largest.loc[body, "drift"] == pytest.approx(drift.max(), abs=1e-12)
        for name in ("uplift", "slip"):
            seen = float(histories[name].sel(joint=joint).max())
            assert largest.loc[body, name] == pytest.approx(seen, abs=1e-9)
    quaternion = run["orientation"].sel(body="upper").to_numpy()
    tilt = 2.0 * np.arccos(np.abs(quaternion[:, 0]))  # about y alone
    assert largest.loc["upper", "tilt"] == pytest.approx(tilt.max(), abs=1e-9)


def test_several_models_at_once_are_one_run_each():
    common = {"duration": 0.1, "scale": 2.0, "output_rate": 50.0}
    runs = blockshake.simulate("configuration-1", "alkion", models=["nscd-rigid", "ls-dem"], **common)
    assert list(runs) == ["nscd-rigid", "ls-dem"]
    for model, run in runs.items():
        alone = blockshake.simulate("configuration-1", "alkion", model, **common)
        np.testing.assert_array_equal(run["position"], alone["position"])
        assert run.attrs["model"] == model


@pytest.mark.parametrize(
    ("asked", "words"),
    [
        ({"models": "ls-dem"}, "^models: expected a list of models"),
        ({"models": ["ls-dem"], "model": "ls-dem"}, "^models: expected a list of models, without model"),
        ({"models": ["nscd-rigid", "dem"]}, "^model: expected one of ls-dem.* not .dem."),
        ({}, "^model: expected one of ls-dem"),
    ],
)
def test_models_that_are_no_list_of_models_are_refused(asked, words):
    with pytest.raises(InputError, match=words):
        blockshake.simulate("configuration-1", "alkion", duration=10.0, **asked)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda motion: blockshake.motion_figures(motion, "u"), "^axis: expected x, y or z, not 'u'"),
        (lambda motion: blockshake.response_spectrum(motion, [0.0]), "^periods: expected periods above 0 s"),
        (
            lambda motion: blockshake.response_spectrum(motion, [1.0], damping=1.0),
            "^damping: expected a share",
        ),
    ],
)
def test_figures_of_a_motion_that_cannot_be_are_refused(call, words):
    with pytest.raises(InputError, match=words):
        call(blockshake.load_motion({"time_s": TIME, "acceleration_x": SINE}))


def test_joints_have_names_in_a_run(leaning_run):
    run, structure = leaning_run
    assert run["joint_force"].sel(joint="slab-lower", axis="z").values[0] == 2e4
    assert run_histories(run, structure)["joint"].values.tolist() == ["slab-lower", "lower-upper"]


def test_what_was_read_is_checked_as_its_file_is():
    for source in ("configuration-1", "alkion"):
        load = blockshake.load_motion if source == "alkion" else blockshake.load_structure
        assert blockshake.check(load(source)) == blockshake.check(source)
