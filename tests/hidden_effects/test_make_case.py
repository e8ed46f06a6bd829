"""The maker: the same bytes for the same seed, nothing of the diagnosis in it, other forms and other numerics."""

import ast
import hashlib
import json
import subprocess
import sys
from pathlib import Path

import case_plan
import make_case
import mujoco_case
import numpy as np
import outside_forces
import own_laboratory
import pytest
import xarray as xr
from case_files import CALIBRATION_SEEDS, OPEN_SEEDS, SEEDS, load_plan
from case_noise import ACCELEROMETER_NOISE, MARKER_NOISE, add_noise, true_noise
from case_truth import (
    SIZES,
    follow,
    true_causes,
    true_numerics,
    true_parameters,
    true_table,
    unusual_numerics,
)
from effect_forms import FORM_NUMERICS, FORMS, distort
from make_case import structure_file
from outside_forces import OUTSIDE

from blockshake.diagnosis.nominal.nominal_model import MODELS, draw_nominal
from blockshake.dynamics.load_motion import load_motion
from blockshake.dynamics.motion import ground_motion
from blockshake.effects import places
from blockshake.effects.effect import Experiment
from blockshake.effects.registry import EFFECTS, with_effect
from blockshake.geometry.structure import load_structure
from blockshake.measurement.sensors.instruments import Instruments
from blockshake.own_files.check import check
from blockshake.simulation.simulate import simulate

STRUCTURE = structure_file("two-blocks")
PROGRAMS = Path(make_case.__file__).parent
SRC = PROGRAMS.parent / "src" / "blockshake"
LS_DEM_SEED, NSCD_SEED = 28, 1


@pytest.fixture
def short(monkeypatch):
    """Two tests of 2 s instead of the plan."""
    monkeypatch.setattr(case_plan, "PLAN", (("alkion", 1.0, "fit"), ("alkion", 2.5, "sealed")))
    monkeypatch.setattr(own_laboratory, "DURATION", 2.0)


def _make(folder, seed, *names, structure="two-blocks"):
    size = "large" if set(names) & set(EFFECTS) else None
    make_case.make_case(seed, names, size, folder / "campaign", folder / "truth", structure_name=structure)
    return folder


def _truth(folder):
    return json.loads((folder / "truth" / "truth.json").read_text())


def test_the_same_seed_gives_the_same_bytes(short, tmp_path):
    folders = [_make(tmp_path / again, 11, "stopper-contact") for again in ("one", "two")]
    files = [
        {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}
        for folder in folders
    ]
    assert files[0] == files[1]
    tests = [f"campaign/{name}.nc" for name in _truth(tmp_path / "one")["tests"]]
    assert len(tests) == 2
    assert sorted(files[0]) == sorted(
        ["campaign/README", "campaign/campaign.yaml", "campaign/structure.yaml", "truth/truth.json", *tests]
    )
    committed = hashlib.sha256(files[0]["truth/truth.json"]).hexdigest()
    assert committed in files[0]["campaign/README"].decode()


@pytest.mark.skipif(not mujoco_case.is_there(), reason="there is no mujoco: `make peers` sets it up")
def test_mujocos_laboratory_gives_the_same_bytes(monkeypatch, tmp_path):
    """And a push moves nothing next to a twin without it before it starts."""
    monkeypatch.setattr(case_plan, "STRONG_PLAN", (("alkion", 1.0, "fit"), ("basso-tirreno", 1.0, "fit")))
    monkeypatch.setattr(mujoco_case, "DURATION", 1.5)
    for again in ("one", "two"):
        make_case.make_case(
            7, ("outside-push",), None, tmp_path / again / "campaign", tmp_path / again / "truth", False,
            laboratory="mujoco", strength="middle",
        )  # fmt: skip
    one, two = (
        {path.name: path.read_bytes() for path in (tmp_path / again).rglob("*") if path.is_file()}
        for again in ("one", "two")
    )
    assert one == two
    check(tmp_path / "one" / "campaign")
    truth = _truth(tmp_path / "one")
    assert min(truth["causes"][0]["start"]) > 1.5
    assert truth["moved"] < 0.01


CLASSES = [(), *((name,) for name in (*EFFECTS, *OUTSIDE)), ("reduced-bearing", "outside-blow")]


@pytest.mark.hidden_effects
@pytest.mark.parametrize("names", CLASSES)
def test_a_campaign_of_every_class_is_in_order_and_says_nothing(names, short, tmp_path):
    folder = _make(tmp_path, LS_DEM_SEED, *names)
    check(folder / "campaign")
    truth = _truth(folder)
    assert tuple(cause["name"] for cause in truth["causes"]) == names
    # the pads of a brake hang on springs of the table
    assert {test["status"] for test in truth["tests"].values()} <= {
        "completed", "falling" if "outside-dry-drag" in names else "completed"
    }  # fmt: skip
    known = b"".join(path.read_bytes() for path in (folder / "campaign").iterdir())
    assert not any(name.encode() in known for name in names)


@pytest.fixture(scope="module")
def bare(tmp_path_factory):
    """A clean case whose blocks rock."""
    return _make(tmp_path_factory.mktemp("bare"), NSCD_SEED)


@pytest.mark.hidden_effects
@pytest.mark.parametrize("name", OUTSIDE)
def test_a_cause_from_outside_acts_in_its_tests_alone(name, bare, tmp_path):
    folder = _make(tmp_path, NSCD_SEED, name)
    truth, moved = _truth(folder), []
    for test, start in zip(truth["tests"], truth["causes"][0]["start"], strict=True):
        plain, other = (
            xr.load_dataset(case / "campaign" / f"{test}.nc")["marker_displacement"].to_numpy()
            for case in (bare, folder)
        )
        moved.append(float(np.nanmax(np.abs(plain - other))))
        # noise is of the seed, so that a test without the cause is the same to the bit
        assert start is not None or moved[-1] == 0.0
    assert max(moved) > 1e-3


def test_a_brake_gives_a_dry_drag():
    """Against the block's velocity, of the stated size while it moves: springs of the pads tell the force."""
    structure = load_structure(STRUCTURE)
    cause = {"values": {"share": 0.07, "height": 0.0}, "place": {"body": "block-1"}}
    plain = Experiment(structure, load_motion("alkion", 2.5), Instruments())
    braked = outside_forces.OUTSIDE["outside-dry-drag"].act(plain, cause, 0.0)
    run = simulate(
        braked.structure, braked.motion, "nscd-rigid", {}, time_step=4e-4, duration=6.0, accelerometers=False
    )
    x = run["position"].sel(axis="x") - run["position"].sel(axis="x", time=0.0)
    against = x - x.sel(body="slab", drop=True)
    rate = np.gradient(against.sel(body="block-1").to_numpy(), run["time"].to_numpy())
    springs = 2.0 * outside_forces._PAD_SPRING
    drag = -springs * against.sel(body=["pad-front", "pad-back"]).sum("body").to_numpy()
    fast = np.abs(rate) > 0.03
    assert fast.sum() > 10
    expected = 0.07 * structure.mass[structure.body_names.index("block-1")] * 9.81
    assert (drag[fast] * rate[fast] < 0.0).all()
    # the friction is along the slip, which is not quite along x
    assert np.abs(drag[fast]).mean() == pytest.approx(expected, rel=0.1)


def _imported(path):
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            yield "." * node.level + (node.module or "")


def test_nothing_in_the_package_imports_the_programs():
    names = {path.stem for path in PROGRAMS.glob("*.py")}
    for source in SRC.rglob("*.py"):
        for module in _imported(source):
            first = module.split(".")[0]
            assert first not in names | {"tests", "hidden_effects"}, f"{source} imports {module}"
            assert not module.startswith("."), f"{source} imports {module}"


def test_the_maker_loads_nothing_of_the_diagnosis():
    code = "import make_case, sys; print(*(m for m in sys.modules if m.startswith('blockshake.diagnosis')))"
    loaded = subprocess.run(
        [sys.executable, "-c", code], cwd=PROGRAMS, capture_output=True, text=True, check=True
    )
    assert loaded.stdout.strip() == ""
    for name in make_case.MAKER:
        assert not any(
            module.startswith(("blockshake.diagnosis", "case_files", "score"))
            for module in _imported(PROGRAMS / f"{name}.py")
        )


@pytest.mark.parametrize("seeds", [SEEDS, CALIBRATION_SEEDS, OPEN_SEEDS])
def test_causes_are_as_planned_and_within_the_priors(seeds):
    cases = load_plan(seeds).cases
    names = {case.structure for case in cases}
    structures = {name: load_structure(structure_file(name)) for name in names}
    for case in cases:
        structure = structures[case.structure]
        causes = true_causes(case.causes, case.size, structure, 3, case.seed)
        assert tuple(cause["name"] for cause in causes) == case.causes
        assert not case.hollow or true_numerics(case.seed)[0] == "ls-dem"
        for cause in causes:
            if cause["name"] in OUTSIDE:
                assert {"body": cause["place"]["body"]} in places.blocks(structure)
                continue
            effect = EFFECTS[cause["name"]]
            low, high = SIZES[case.size]
            assert low <= abs(cause["size"]) <= high
            assert cause["place"] in effect.places(structure)
            for item in effect.parameters:
                assert item.lower <= cause["values"][item.name] <= item.upper


def test_a_third_of_the_cases_is_by_ls_dem_and_no_two_tests_have_one_name():
    models = [true_numerics(seed)[0] for seed in range(900)]
    # four standard deviations of a share of a third
    assert abs(models.count("ls-dem") / 900 - 1.0 / 3.0) < 4.0 * np.sqrt(2.0 / 9.0 / 900)
    for case in load_plan().cases:
        tests = case_plan.planned_tests(case.structure, case.seed, sealed=True)
        assert len({case_plan.name_of_test(motion, scale) for motion, scale, _ in tests}) == 5


def _unusual(seed):
    model, time_step, numerics, more = unusual_numerics(load_structure(STRUCTURE), seed)
    return model, time_step, numerics | more


@pytest.mark.parametrize("numerics_of", [true_numerics, _unusual])
def test_the_discretisation_is_outside_what_the_nominal_model_draws(numerics_of):
    drawn = {
        model: [draw_nominal(load_structure(STRUCTURE), model, number) for number in range(60)]
        for model in MODELS
    }
    used = set()
    for seed in range(60):
        model, time_step, numerics = numerics_of(seed)
        used.add(model)
        assert time_step not in {draw.time_step for draw in drawn[model]}
        for name, value in numerics.items():
            usual = [draw.parameters.get(name, 0.0) for draw in drawn[model]]
            assert not min(usual) <= value <= max(usual)
    assert used == set(MODELS)


def test_a_fifth_of_the_cases_scatters_half_as_much_again():
    structure = load_structure(STRUCTURE)
    drawn = [true_parameters(structure, seed) for seed in range(2000)]
    wider = np.array([wide for _, wide in drawn])
    assert abs(wider.mean() - 0.2) < 4.0 * np.sqrt(0.2 * 0.8 / 2000)
    friction = np.log([values["friction.concrete.concrete"] for values, _ in drawn])
    # of a log-normal with 10 and 15 %, sqrt(ln(1 + cov^2)); error of a standard deviation 1 / sqrt(2 n)
    for chosen, cov in ((~wider, 0.10), (wider, 0.15)):
        expected = np.sqrt(np.log1p(cov**2))
        assert abs(friction[chosen].std() / expected - 1.0) < 4.0 / np.sqrt(2.0 * chosen.sum())


@pytest.mark.parametrize("frequency", [0.5, 2.0, 8.0])
def test_the_table_follows_by_its_transfer_function(frequency):
    time = np.arange(0.0, 20.0, 1.0 / 1000.0)
    turn = 2.0 * np.pi * frequency * time
    table = {"gain": 0.99, "high": 0.015, "corner": 2.5}
    made = follow(ground_motion("sine", time, {"x": np.sin(turn)}, "displacement"), table).evaluate(time)[
        :, 0
    ]
    late = time >= 10.0
    found = 2.0 * (made[late] * np.exp(-1j * turn[late])).mean() * 1j
    expected = 0.99 + 0.015 * 1j * frequency / (2.5 + 1j * frequency)
    assert abs(found - expected) < 2e-5


def test_the_table_follows_within_four_per_cent():
    for seed in range(100):
        table = true_table(seed)
        assert abs(table["gain"] - 1.0) + abs(table["high"]) < 0.036


def test_noise_is_coloured_with_gaps_and_outliers():
    n_times, n_markers = 40000, 4
    exact = xr.Dataset(
        {
            "marker_displacement": (("time", "marker", "axis"), np.zeros((n_times, n_markers, 3))),
            "marker_initial_position": (("marker", "axis"), np.zeros((n_markers, 3))),
            "accelerometer": (("time_acc", "channel"), np.zeros((n_times, 2))),
        }
    )
    noise = true_noise(7)
    read = add_noise(exact, noise, 7, 0)
    markers = read["marker_displacement"].to_numpy() + read["marker_initial_position"].to_numpy()
    lost = np.isnan(markers[..., 0])
    assert lost[0].sum() == 0
    assert (
        abs(lost.mean() - 0.0095) < 0.002
    )  # bursts of 10: 1 % less what two of them share; the error of 160 bursts
    far = (np.abs(markers) > 6.0 * MARKER_NOISE * noise["marker"]).any(axis=2)
    assert 0.005 < far.mean() < 0.011
    # median absolute deviation, to which outliers are little: 0.6745 sigma
    usual = np.nanmedian(np.abs(markers)) / 0.6745
    assert abs(usual / (MARKER_NOISE * noise["marker"]) - 1.0) < 0.03
    fast = read["accelerometer"].to_numpy()
    fast = fast - fast.mean(axis=0)
    assert abs(fast.std() / (ACCELEROMETER_NOISE * noise["accelerometer"]) - 1.0) < 0.03
    assert abs((fast[1:] * fast[:-1]).mean() / fast.var() - noise["memory"]) < 0.02


def _effect(name, structure):
    values = {
        item.name: min(SIZES["large"][1] * item.visible, item.upper)
        if place == 0
        else 0.5 * (item.lower + item.upper)
        for place, item in enumerate(EFFECTS[name].parameters)
    }
    if name == "vertical-motion":
        values["delay"] = 0.0
    return {"name": name, "values": values, "place": EFFECTS[name].places(structure)[-1]}


HIDDEN = sorted(
    {("sliding-blocks", name) for name in EFFECTS}
    | {
        (case.structure, name)
        for seeds in (SEEDS, CALIBRATION_SEEDS)
        for case in load_plan(seeds).cases
        for name in case.causes
        if name in EFFECTS
    }
)


@pytest.mark.parametrize(("structure", "name"), HIDDEN)
def test_every_effect_has_another_form_than_the_registrys(structure, name):
    """Not the registry's experiment, or other readings of it; and one that can be built."""
    structure = load_structure(structure_file(structure))
    effect = _effect(name, structure)
    silent = Instruments(marker_noise=0.0, accelerometer_noise=0.0)
    plain = Experiment(structure, load_motion("alkion"), silent)
    theirs = with_effect(plain, **effect)
    ours = FORMS[name][1](plain, effect["values"], effect["place"])
    time = np.arange(200) / 200.0
    names = [marker.name for marker in structure.file.markers]
    moved = 0.05 * np.sin(time)[:, None, None] * np.ones((200, len(names), 3))
    same_motion = np.array_equal(ours.motion.table.coefficients, theirs.motion.table.coefficients)
    same = (ours.structure.file, ours.instruments, same_motion) == (
        theirs.structure.file,
        theirs.instruments,
        True,
    )
    other_readings = not np.array_equal(distort(time, moved, names, effect), moved)
    assert not same or name in FORM_NUMERICS or other_readings


def test_the_pitching_table_follows_slow_acceleration_by_its_coefficient():
    """Far below the frequency the pitch is c a, and 3 % more at the largest acceleration."""
    time = np.arange(0.0, 12.0, 0.005)
    motion = ground_motion("slow", time, {"x": np.sin(2.0 * np.pi * 0.2 * time)}, "acceleration")
    plain = Experiment(load_structure(STRUCTURE), motion, Instruments())
    pitched = FORMS["table-pitch"][1](plain, {"coefficient": 1e-3, "frequency": 15.0}, {})
    assert np.abs(pitched.motion.evaluate(time)[:, 3]).max() == pytest.approx(1.03e-3, rel=2e-3)
