"""Files of a user: allowed content, and the one line that states what is wrong."""

import copy

import numpy as np
import pytest
import yaml

from blockshake.dynamics.load_motion import load_motion
from blockshake.dynamics.motion import ground_motion
from blockshake.errors import InputError
from blockshake.files import PACKAGE, load_yaml
from blockshake.geometry.structure import load_structure
from blockshake.own_files.check import check
from blockshake.quantities import USUAL
from blockshake.simulation.models import MODELS, solver_of
from blockshake.simulation.parameter_table import instances
from blockshake.statistics.intervals import SURE_FROM
from blockshake.study.config import check_config, load_config
from blockshake.study.config_checks import typical_structure
from blockshake.study.remarks import motion_remarks, structure_remarks, unusual_values
from blockshake.study.sampling.distributions import TABLE_2
from blockshake.study.sampling.sample_parameters import has_parameter

ROOT = PACKAGE.parents[1]


@pytest.fixture
def mapping(monkeypatch):
    monkeypatch.chdir(ROOT)  # a configuration names files from the project's root
    return copy.deepcopy(load_yaml("config/study.yaml"))


@pytest.mark.parametrize("study", ["study", "quick", "paper", "literal"])
def test_shipped_configurations_are_good(study, monkeypatch):
    monkeypatch.chdir(ROOT)
    config = load_config(f"config/{study}.yaml")
    assert config.name == study
    assert config.ensemble.distributions == TABLE_2


def test_paper_is_the_paper(monkeypatch):
    monkeypatch.chdir(ROOT)
    config = load_config("config/paper.yaml")
    assert config.models["ls-dem"].time_step == 1e-5
    assert config.models["nscd-rigid"].time_step == 1e-3
    assert all(config.samples(model, case.name) == 50 for model in config.models for case in config.cases)


def test_literal_is_as_printed(monkeypatch):
    """Zhou et al. (2023), sections LS-DEM and NSCD: steps, grid of level sets, Eqs. (2) and (3) without a change."""
    monkeypatch.chdir(ROOT)
    studies = [load_config(f"config/{name}.yaml").models for name in ("literal", "paper")]
    for models in studies:
        printed = models["ls-dem-as-printed"]
        assert printed.time_step == 1e-5
        assert printed.parameters == {
            "ls_dem.level_set": "grid",
            "ls_dem.grid_spacing": 0.02,
            "ls_dem.damping": "node",
            "ls_dem.pulling": True,
        }
        rigid = models["nscd-rigid-as-printed"]
        assert rigid.time_step == 1e-3
        assert rigid.parameters["nscd.impact_parts"] == 1
        # the plain ones are those of the paper's study
        assert {name: models[name] for name in ("ls-dem", "nscd-rigid")} == {
            name: studies[1][name] for name in ("ls-dem", "nscd-rigid")
        }
    singles = [
        one for name, one in studies[0].items() if solver_of(name).name != name and "as-printed" not in name
    ]
    together = (
        studies[0]["ls-dem-as-printed"].parameters.items()
        | studies[0]["nscd-rigid-as-printed"].parameters.items()
    )
    plain = studies[0]["nscd-rigid"].parameters.items()
    assert set().union(*(one.parameters.items() for one in singles)) - plain == together


def test_all_models_run_all_cases_of_the_default_study(mapping):
    config = check_config(mapping, "study.yaml")
    assert set(config.models) == set(MODELS)
    assert config.samples("nscd-rigid", "configuration-4") == config.ensemble.size
    few = config.samples("nscd-elastic", "configuration-4")
    assert 1 <= few < config.ensemble.size
    assert config.has_replicate("nscd-elastic", "configuration-4") == (few >= SURE_FROM)


@pytest.mark.parametrize(
    ("path", "value", "line"),
    [
        (("colour",), "red", "study.yaml: colour: unknown key"),
        (
            ("cases", 1, "structure"),
            "configuration-1",
            "study.yaml: cases.0.name: expected a name of its own",
        ),
        (("convergence",), {"structure": "configuration-1"}, "study.yaml: convergence: "),
        (
            ("models", "no-such"),
            {"time_step": 1e-3},
            "study.yaml: models.no-such: expected one of ls-dem, nscd-rigid, nscd-elastic, nscd-viscoelastic, or one",
        ),
        (
            ("models", "ls-dem-As-Printed"),
            {"time_step": 1e-5},
            "study.yaml: models.ls-dem-As-Printed: expected one",
        ),
        (("models", "ls-dem-"), {"time_step": 1e-5}, "study.yaml: models.ls-dem-: expected one of"),
        (
            ("models", "ls-dem-as-printed"),
            {"time_step": 1e-5, "parameters": {"nscd.parts": 5}},
            "models.ls-dem-as-printed.parameters.nscd.parts: expected one of nscd.{theta, ",
        ),
        # what no machine can run
        (("models", "nscd-rigid", "time_step"), 1e-15, "nscd-rigid.time_step: expected at most 1e+11 steps"),
        (("output_rate",), 1e9, "output_rate: expected a run of at most 8.6 GB"),
        (("cases", 0, "duration"), 1e9, "cases.0.duration: expected at most"),
        (("ensemble", "size"), 10**9, "ensemble.size: input should be less than or equal to 1000000"),
    ],
)
def test_what_is_wrong_is_named(mapping, path, value, line):
    """Next to the wrong values of every key, tests/own_files/wrong_keys.py."""
    place = mapping
    for key in path[:-1]:
        place = place[key]
    place[path[-1]] = value
    with pytest.raises(InputError) as error:
        check_config(mapping, "study.yaml")
    assert line in str(error.value)
    assert "\n" not in str(error.value)


NEEDED = {
    "name": "mine",
    "description": "mine",
    "models": {"nscd-rigid": {"time_step": 1e-3}},
    "cases": [{"structure": "configuration-2", "motion": "alkion", "scale": 1.0, "duration": 2.0}],
    "ensemble": {"size": 10, "seed": 1},
}


def test_nothing_more_is_needed():
    config = check_config(copy.deepcopy(NEEDED), "mine.yaml")
    assert config.cases[0].measured is None
    assert config.calibration is None


@pytest.mark.parametrize("key", NEEDED)
def test_less_is_not_enough(key):
    mapping = {name: value for name, value in NEEDED.items() if name != key}
    with pytest.raises(InputError, match=f"^mine.yaml: {key}: missing key$"):
        check_config(mapping, "mine.yaml")


def test_all_wrong_keys_are_named_at_once_with_the_nearest_known_one():
    mapping = copy.deepcopy(NEEDED)
    mapping["modles"] = mapping.pop("models")
    mapping["cases"][0]["duraton"] = mapping["cases"][0].pop("duration")
    mapping["calibration"] = {"cases": {"nscd-rigid": ["configuration-2"]}, "lnked": {}, "zzz": 1}
    with pytest.raises(InputError) as error:
        check_config(mapping, "mine.yaml")
    assert str(error.value).removeprefix("mine.yaml: ").split("; ") == [
        "models: missing key",
        "cases.0.duration: missing key",
        "cases.0.duraton: unknown key, did you mean duration?",
        "calibration.lnked: unknown key, did you mean linked?",
        "calibration.zzz: unknown key",
        "modles: unknown key, did you mean models?",
    ]


def test_a_structure_may_have_several_cases_of_different_names():
    mapping = copy.deepcopy(NEEDED)
    mapping["cases"] += [mapping["cases"][0] | {"name": "stronger", "scale": 2.0}]
    config = check_config(mapping, "mine.yaml")
    assert [(case.name, case.scale) for case in config.cases] == [("configuration-2", 1.0), ("stronger", 2.0)]


def test_a_decimal_comma_is_named():
    mapping = copy.deepcopy(NEEDED)
    # {mean: 0,75} is in YAML a mean of 0 and a key 75
    mapping["ensemble"]["distributions"] = {
        "friction.concrete.concrete": {"distribution": "lognormal", "mean": 0.75, "cov": "0,10"}
    }
    with pytest.raises(InputError) as error:
        check_config(mapping, "mine.yaml")
    assert str(error.value) == (
        "mine.yaml: ensemble.distributions.friction.concrete.concrete.cov: input should be a valid number, not '0,10'; "
        "numbers take a decimal point, 0.75 and not 0,75"
    )
    mapping = copy.deepcopy(NEEDED)
    mapping["cases"][0] |= {"scale": 0, 75: None}
    with pytest.raises(
        InputError, match=r"cases\.0\.75: a key of letters was expected; numbers take a decimal point"
    ):
        check_config(mapping, "mine.yaml")


def test_check_says_what_a_good_file_is(monkeypatch):
    monkeypatch.chdir(ROOT)
    assert "3 blocks of 22091 kg" in check("configuration-1")
    assert "9 blocks" in check("config/structures/configuration-3.yaml")
    assert "3 of 0.8 x 2.4 x 1.6 m, 7364 kg, height over width along x 2\n" in check("configuration-1")
    assert "3 blocks from block-1 up: mass centre at x 0 m, 2.4 m above the foot" in check("configuration-1")
    assert "a motion of 25 s, given as acceleration; peaks along x: " in check("alkion")
    said = check("config/study.yaml")
    assert said.startswith(
        "a study of 4 cases by ls-dem (50 samples), nscd-rigid (50 samples), nscd-elastic (1 to 6 samples), "
    )


def test_the_peaks_of_every_axis_that_moves_are_told():
    """Half a sine of amplitude a over T ends at a velocity of 2 a T / pi and a displacement of a T^2 / pi."""
    time = np.linspace(0.0, 1.0, 2001)
    half, along = np.sin(np.pi * time), {"x": 1.0, "y": 2.0, "z": 3.0}
    motion = ground_motion("all", time, {axis: size * half for axis, size in along.items()}, "acceleration")
    assert (
        "; peaks along x: 1 m/s2, 0.637 m/s, 0.318 m; peaks along y: 2 m/s2, 1.27 m/s, 0.637 m; "
        "peaks along z: 3 m/s2, 1.91 m/s, 0.955 m; arrays"
    ) in check(motion)
    vertical = ground_motion("up", time, {"z": half, "pitch_y": -0.02 * time}, "acceleration")
    assert "acceleration; peaks along z: 1 m/s2, 0.637 m/s, 0.318 m; pitch up to 0.02 rad; arrays" in check(
        vertical
    )
    still = ground_motion("still", time, {"x": 0.0 * time}, "acceleration")
    assert "; peaks along x: 0 m/s2, 0 m/s, 0 m; arrays" in check(still)


def test_slenderness_is_along_x_and_to_both_sides_of_an_eccentric_mass(make_mapping):
    """A block that is thin across the shaking: its width along x counts; the mass centre is 0.1 m towards +x."""
    body = {"name": "plate", "shape": "plate", "position": [0.0, 0.0, 0.5], "mass_offset": [0.1, 0.0, 0.0]}
    said = check(load_structure(make_mapping([body], shapes={"plate": {"box": [1.0, 0.2, 1.0]}})))
    assert "height over width along x 0.83 to -x and 1.2 to +x" in said
    tower = [{**body, "mass_offset": [0.0, 0.0, 0.0]}, {**body, "name": "upper", "position": [0.0, 0.0, 1.5]}]
    said = check(load_structure(make_mapping(tower, shapes={"plate": {"box": [1.0, 0.2, 1.0]}})))
    assert "2 blocks from plate up: mass centre at x 0.05 m, 1 m above the foot, " in said
    assert said.splitlines()[-1].endswith("height over width along x 1.8 to -x and 2.2 to +x")


@pytest.mark.parametrize("text", ["a: 1\n", "- 1\n", "a: [\n"])
def test_check_refuses_other_yaml(tmp_path, text):
    (tmp_path / "x.yaml").write_text(text)
    with pytest.raises(InputError, match=r"x\.yaml"):
        check(str(tmp_path / "x.yaml"))


@pytest.mark.parametrize(
    ("changes", "remark"),
    [
        ({"bodies.slab.driven": False}, "remark: no body is driven"),
        (
            {"bodies.block-3.position": [0.0, 0.0, 4.7]},
            "remark: block-3 touches nothing that stands on a driven",
        ),
        ({"gravity": [0.0, 0.0, 9.81]}, "remark: gravity is 9.81 m/s2 along z: it does not press"),
        (
            {"bodies.block-3.velocity": [0.0, 0.0, 300.0]},
            "remark: bodies.block-3.velocity is [0.0, 0.0, 300.0] m/s: -10 to 10 m/s is usual",
        ),
    ],
)
def test_check_remarks_what_was_hardly_meant(changes, remark):
    structure = load_structure("configuration-1", changes)
    assert any(f"remark: {line}".startswith(remark) for line in structure_remarks(structure))


def test_check_remarks_a_structure_in_millimetres(tmp_path):
    file = load_yaml(ROOT / "config" / "structures" / "configuration-1.yaml")
    for shape in file["shapes"].values():
        shape["box"] = [1e3 * edge for edge in shape["box"]]
    for item in [*file["bodies"], *file["markers"], *file["accelerometers"]]:
        item["position"] = [1e3 * place for place in item["position"]]
    (tmp_path / "mm.yaml").write_text(yaml.safe_dump(file))
    said = check(str(tmp_path / "mm.yaml"))
    assert "block-1 is 2.4e+03 m long and weighs 7.37e+12 kg: expected m, perhaps given in mm" in said


@pytest.mark.parametrize(
    ("key", "value", "words"),
    [
        ("materials.stone.density", 2.65, "2.65 kg/m3: 100 to 25000 kg/m3 is usual; perhaps given in g/cm3"),
        ("materials.stone.density", 2650e3, "2.65e+06 kg/m3: 100 to 25000 kg/m3 is usual; perhaps given in g/m3"),
        ("materials.stone.density", 24.0, "24 kg/m3: 100 to 25000 kg/m3 is usual; perhaps given in kN/m3"),
        ("materials.stone.density", 50e3, "50000 kg/m3: 100 to 25000 kg/m3 is usual"),
        ("materials.stone.youngs_modulus", 34.5, "34.5 Pa: 1e+07 to 1e+12 Pa is usual; perhaps given in GPa"),
        ("materials.stone.youngs_modulus", 34500.0, "34500 Pa: 1e+07 to 1e+12 Pa is usual; perhaps given in MPa"),
        (
            "gravity", [0.0, 0.0, -9810.0],
            "[0.0, 0.0, -9810.0] m/s2: -30 to 30 m/s2 is usual; perhaps given in mm/s2",
        ),
    ],
)  # fmt: skip
def test_a_remark_says_in_which_unit_a_value_was_perhaps_given(cube, key, value, words):
    assert f"{key} is {words}" in unusual_values(load_structure(cube, {key: value}))


@pytest.mark.parametrize(("edge", "density"), [(0.02, 2650.0), (50.0, 2650.0), (1.0, 100.0), (1.0, 23000.0)])
def test_blocks_of_laboratories_and_of_buildings_of_cork_and_of_platinum_are_usual(
    make_mapping, edge, density
):
    body = {"name": "block", "shape": "cube", "position": [0.0, 0.0, 0.5 * edge], "density": density}
    shapes = {"cube": {"box": [edge] * 3}, "slab": {"box": [2.0 * edge, 2.0 * edge, 0.2]}}
    assert structure_remarks(load_structure(make_mapping([body], shapes=shapes))) == []


def test_a_table_that_turns_by_more_than_a_right_angle_is_refused(tmp_path):
    (tmp_path / "deg.csv").write_text("time_s,pitch_y\n0,0\n1,1\n2,2\n3,30\n")
    wrong = r"deg.csv: pitch_y: expected at most pi/2 rad, found 2 rad at 2 s; perhaps given in degrees"
    with pytest.raises(InputError, match=wrong):
        check(str(tmp_path / "deg.csv"))
    (tmp_path / "rad.csv").write_text("time_s,pitch_y\n0,0\n1,0.5\n2,1.5\n")
    assert "remark: the table pitches by 1.5 rad, 86 degrees" in check(str(tmp_path / "rad.csv"))
    with pytest.raises(InputError, match="found -3 rad at 2 s"):
        load_motion(tmp_path / "rad.csv", scale=-2.0)


def test_every_parameter_with_a_usual_range_is_remarked_beyond_it():
    """Half beyond either end, where the structure file takes such a value at all."""
    remarked = set()
    structure = load_structure(
        "configuration-1",
        {
            "joints.slab.block-1.compliance": 1e-9,
            "bodies.block-1.density": 2400.0,
            "stoppers": [
                {"body": "block-3", "position": [0.4, 0, 0.8], "axis": "+x", "gap": 0.05, "stiffness": 1e7}
            ],
        },
    )
    for pattern, (low, high) in USUAL.items():
        name, value = list(instances(pattern, structure.file))[-1]
        for beyond in (1.5 * low if low < 0.0 else 0.5 * low or -0.5, 1.5 * high):
            try:
                changed = structure.with_parameters(
                    {name: [beyond] * 3 if isinstance(value, tuple) else beyond}
                )
            except InputError:
                continue
            assert any(said.startswith(f"{name} is ") for said in unusual_values(changed)), (name, beyond)
            remarked.add(pattern)
    assert remarked == USUAL.keys()


@pytest.mark.parametrize("number", [1, 2, 3, 4])
def test_shipped_structures_have_no_remarks(number):
    assert structure_remarks(load_structure(f"configuration-{number}")) == []


def motion_file(folder, values, column="acceleration_x", clock=1.0):
    time = np.arange(0.0, 20.0, 0.01)
    rows = "\n".join(f"{clock * t:.5f},{value:.6g}" for t, value in zip(time, values(time), strict=True))
    path = folder / "motion.csv"
    path.write_text(f"time_s,{column}\n{rows}\n")
    return str(path)


@pytest.mark.parametrize(
    ("scale", "offset", "remark"),
    [
        (0.3, 0.0, "the peak acceleration is 0.031 g: expected m/s2, not g"),
        (300.0, 0.0, "the peak acceleration is 31 g: expected m/s2, not cm/s2 or mm/s2"),
        (3.0, 0.1, "an offset of the acceleration?"),
        (0.0, 0.0, "nothing moves"),
    ],
)
def test_check_remarks_a_motion_in_other_units_or_with_an_offset(tmp_path, scale, offset, remark):
    file = motion_file(tmp_path, lambda t: scale * np.sin(2.0 * np.pi * t) + offset)
    assert remark in check(file)


@pytest.mark.parametrize(
    ("column", "size", "clock", "remark"),
    [
        ("acceleration_y", 900.0, 1.0, "g: expected m/s2, not cm/s2 or mm/s2"),
        ("displacement_x", 80.0, 1.0, "expected m, not mm"),
        ("displacement_z", 0.08, 1.0, ""),
        ("acceleration_x", 3.0, 1000.0, "the motion lasts 19990 s: expected s, not ms"),
        ("acceleration_x", 3.0, 0.001, "the motion lasts 0.02 s: were its times in s already?"),
    ],
)
def test_check_remarks_any_direction_kind_and_clock(tmp_path, column, size, clock, remark):
    file = motion_file(tmp_path, lambda t: size * np.sin(2.0 * np.pi * t) * np.exp(-t), column, clock)
    said = check(file)
    assert remark in said if remark else "remark" not in said


@pytest.mark.parametrize("name", ["alkion", "basso-tirreno"])
def test_shipped_motions_have_no_remarks(name):
    assert motion_remarks(load_motion(name)) == []


def own_study(mapping, folder, structure, **changes):
    """The default study with an own structure alone, by rigid contact dynamics and without what hangs on others."""
    (folder / "own.yaml").write_text(yaml.safe_dump(structure))
    case = {"structure": str(folder / "own.yaml"), "motion": "alkion", "scale": 1.0, "duration": 5.0}
    for key in ("calibration", "fragility", "diagnosis"):
        del mapping[key]
    return {**mapping, "models": {"nscd-rigid": {"time_step": 1e-3}}, "cases": [case]} | changes


@pytest.fixture
def cube(make_mapping):
    """A stone cube with a marker on itself and one on the slab."""
    body = {"name": "cube", "shape": "cube", "position": [0.0, 0.0, 0.5]}
    markers = [
        {"name": f"{body}-face", "body": body, "position": [0.0, -0.5, 0.0]} for body in ("slab", "cube")
    ]
    return make_mapping([body], markers=markers)


def stone(**more):
    """Ensemble of ten samples with a density of stone."""
    density = {"distribution": "lognormal", "mean": 2400.0, "cov": 0.04}
    return {"size": 10, "seed": 1, "distributions": {"materials.stone.density": density, **more}}


def test_a_study_needs_markers_of_the_base_and_of_a_block(mapping, cube, tmp_path):
    check_config(own_study(dict(mapping), tmp_path, cube, ensemble=stone()), "study.yaml")
    for left, line in ((1, "expected a marker on a driven body"), (0, "a body that is not driven")):
        bare = {**cube, "markers": [cube["markers"][left]]}
        with pytest.raises(InputError, match=line):
            check_config(own_study(dict(mapping), tmp_path, bare, ensemble=stone()), "study.yaml")


def test_variables_that_no_structure_has_are_refused_but_for_table_2(mapping, cube, tmp_path):
    of_concrete = own_study(dict(mapping), tmp_path, cube, ensemble={"size": 10, "seed": 1})
    (tmp_path / "study.yaml").write_text(yaml.safe_dump(of_concrete))
    assert "all of its samples are alike" in check(tmp_path / "study.yaml")
    wrong = {"friction.ston.stone": {"distribution": "lognormal", "mean": 0.5, "cov": 0.1}}
    study = own_study(dict(mapping), tmp_path, cube, ensemble=stone(**wrong))
    with pytest.raises(
        InputError, match=r"distributions\.friction\.ston\.stone: expected a parameter that one of"
    ):
        check_config(study, "study.yaml")


def test_a_study_remarks_what_its_structures_hardly_mean(mapping, cube, tmp_path):
    cube["materials"]["stone"]["youngs_modulus"] = 34.5
    study = own_study(dict(mapping), tmp_path, cube, ensemble=stone())
    study["cases"][0]["duration"] = 80.0
    study["output_rate"] = 5.0
    study["ensemble"]["distributions"]["materials.stone.density"]["cov"] = 1.1
    (tmp_path / "study.yaml").write_text(yaml.safe_dump(study))
    told = check(tmp_path / "study.yaml")
    assert "materials.stone.density has a cov of 1.1: expected a share, 0.1 for 10 %" in told
    assert "5 rows a second miss the peaks of drifts and forces: 200 is usual" in told
    assert "materials.stone.youngs_modulus is 34.5 Pa: 1e+07 to 1e+12 Pa is usual" in told
    assert "80 s are simulated of a motion of" in told


@pytest.mark.parametrize(
    ("axis", "duration", "remarked"),
    [("x", 4.4, True), ("x", 4.6, False), ("y", 4.4, True), ("z", 4.4, True)],
)
def test_a_window_that_cuts_the_strong_motion_is_remarked(mapping, cube, tmp_path, axis, duration, remarked):
    """Even shaking from 1 to 4.684 s: 95 % of its Arias intensity is there after 3.5 s of it, at 4.5 s."""
    time = np.arange(2001) / 200.0
    strong = np.where((time >= 1.0) & (time <= 1.0 + 3.5 / 0.95), 2.0 * np.sin(2.0 * np.pi * 5.0 * time), 0.0)
    rows = np.column_stack([time, strong])
    np.savetxt(tmp_path / "even.csv", rows, delimiter=",", header=f"time_s,acceleration_{axis}", comments="")
    study = own_study(dict(mapping), tmp_path, cube, ensemble=stone())
    study["cases"][0] |= {"duration": duration, "motion": str(tmp_path / "even.csv")}
    (tmp_path / "study.yaml").write_text(yaml.safe_dump(study))
    told = check(tmp_path / "study.yaml")
    line = f"own: {duration:g} s are simulated of a motion that is strong until 4.5"
    assert (line in told) == remarked
    assert ("strong until" in told) == remarked


def test_a_study_of_the_viscoelastic_model_needs_a_viscous_modulus(mapping, cube, tmp_path):
    study = own_study(dict(mapping), tmp_path, cube, ensemble=stone())
    study["models"] = {"nscd-viscoelastic": {"time_step": 1e-3}}
    with pytest.raises(InputError, match=r"nscd-viscoelastic: .*viscous_modulus: expected above 0"):
        check_config(study, "study.yaml")
    study["ensemble"]["distributions"]["materials.stone.viscous_modulus"] = {"mean": 1.5e8, "cov": 0.1}
    check_config(study, "study.yaml")


def test_a_variable_beyond_what_is_usual_is_remarked(mapping, cube, tmp_path):
    study = own_study(dict(mapping), tmp_path, cube, ensemble=stone())
    study["ensemble"]["distributions"]["friction.stone.stone"] = {"mean": 60.0, "cov": 0.1}
    (tmp_path / "study.yaml").write_text(yaml.safe_dump(study))
    assert "friction.stone.stone is 59.7022: 0.05 to 1.5 is usual" in check(tmp_path / "study.yaml")


def _extended(tmp_path):
    """A study of one case without and with a cause, which a structure file states."""
    structure = load_yaml(ROOT / "config" / "structures" / "configuration-2.yaml")
    structure["extension"] = "worn edges"
    (tmp_path / "worn.yaml").write_text(yaml.safe_dump(structure))
    study = copy.deepcopy(NEEDED)
    study["cases"].append({**study["cases"][0], "name": "worn", "structure": str(tmp_path / "worn.yaml")})
    study["ensemble"]["distributions"] = {
        "friction.concrete.concrete": {"distribution": "lognormal", "mean": 0.75, "cov": 0.1},
        "extension.shapes.block.chamfer": {"distribution": "tabulated", "values": [0.03, 0.05]},
    }
    study["extension"] = {"cases": {"worn": "configuration-2"}}
    return study


def test_a_cause_is_a_variable_of_the_structures_that_state_it(tmp_path):
    config = check_config(_extended(tmp_path), "mine.yaml")
    worn, plain = (load_structure(case.structure) for case in config.cases[::-1])
    assert has_parameter(worn, "extension.shapes.block.chamfer")
    assert not has_parameter(plain, "extension.shapes.block.chamfer")
    typical = typical_structure(worn, config.ensemble)
    assert typical.file.shapes["block"].chamfer == pytest.approx(0.04)
    assert config.nominal(config.case("worn")).name == "configuration-2"
    assert config.nominal(config.cases[0]) is config.cases[0]


@pytest.mark.parametrize(
    ("path", "value", "line"),
    [
        (
            ("extension", "cases"),
            {"torn": "configuration-2"},
            "extension.cases: expected one of configuration-2, worn",
        ),
        (
            ("extension", "cases"),
            {"worn": "torn"},
            "extension.cases.worn: expected one of configuration-2, worn",
        ),
        (
            ("extension", "cases"),
            {"configuration-2": "worn"},
            "extension.cases.configuration-2: expected a structure that states an `extension`, and one that does not",
        ),
        (
            ("extension", "named_by"),
            ["configuration-2"],
            "extension.named_by: expected one of worn, not configuration-2",
        ),
        (
            ("cases", 1, "scale"),
            2.0,
            "extension.cases.worn: expected the motion, window, samples and test of configur",
        ),
        (
            ("ensemble", "distributions", "extension.shapes.block.chamfer", "values"),
            [0.5, 0.9],
            "ensemble.distributions.extension.shapes.block.chamfer: ",
        ),
        (
            ("ensemble", "distributions", "extension.stoppers.0.gap"),
            {"distribution": "tabulated", "values": [0.01, 0.02]},
            "ensemble.distributions.extension.stoppers.0.gap: ",
        ),
    ],
)
def test_a_wrong_extension_is_named(tmp_path, path, value, line):
    place = study = _extended(tmp_path)
    for key in path[:-1]:
        place = place[key]
    place[path[-1]] = value
    with pytest.raises(InputError) as error:
        check_config(study, "mine.yaml")
    assert f"mine.yaml: {line}" in str(error.value)
