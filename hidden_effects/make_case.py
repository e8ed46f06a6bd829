"""A campaign with causes hidden in it, or none, in one folder and its truth in another.

The diagnosis is given the campaign alone and shares no code with this but the solvers, in the laboratories that use
them, and the registry's parameters and places.
"""

import hashlib
import shutil
from pathlib import Path

import case_plan
import foreign_sensors
import mujoco_case
import numpy as np
import own_laboratory
import yaml
from case_noise import ACCELEROMETER_NOISE, MARKER_NOISE, add_noise, true_noise
from case_plan import most_tilt, name_of_test
from case_truth import true_causes
from effect_forms import distort
from outside_forces import OUTSIDE

from blockshake.files import content_digest, write_dataset, write_json, write_text
from blockshake.geometry.structure import load_structure
from blockshake.simulation.models import MODELS
from blockshake.sources import module_sources, source_digest
from blockshake.virtual.generate import DECIMALS

HERE = Path(__file__).parent
STRUCTURES = HERE / "structures"
SHIPPED = HERE.parent / "config" / "structures"
MAKER = (
    "make_case", "case_plan", "case_truth", "case_noise", "effect_forms", "outside_forces", "own_laboratory",
    "mujoco_case", "mujoco_laboratory", "foreign_sensors",
)  # fmt: skip
LABORATORIES = {
    "home": "the own solvers, sensors as drawn by instruments",
    "mujoco": "MuJoCo, sensors with slow noise",
    "unusual": "the own solvers with unusual numerics, sensors with slow noise and gains that vary",
}


def structure_file(name):
    """File of the structure of a name, such as ``two-blocks`` or ``configuration-3``."""
    own = STRUCTURES / f"{name}.yaml"
    return own if own.exists() else SHIPPED / f"{name}.yaml"


def made_by():
    """Digest of every source that makes a case."""
    own = [HERE / f"{name}.py" for name in MAKER]
    structures = [*STRUCTURES.glob("*.yaml"), *SHIPPED.glob("*.yaml")]
    return content_digest(
        *(path.read_bytes() for path in (*own, *sorted(structures))),
        source_digest(*module_sources("virtual/generate.py", *MODELS)),
    )


def make_case(
    seed, names, size, folder, truth_folder, sealed=True, structure_name="two-blocks", hollow=0.0, causes=None,
    laboratory="home", strength=None,
):  # fmt: skip
    """Write the campaign, then its truth, then the README that commits to the truth.

    Parameters
    ----------
    seed : int
        Everything that is drawn.
    names : sequence of str
        Effects of the registry and causes from `OUTSIDE`, which act in this order; none of a clean case.
    size : str or None
        ``small`` or ``large``; of no meaning without an effect of the registry.
    folder, truth_folder : Path
    sealed : bool
        Whether there are sealed tests too, on which a gain can be measured.
    structure_name : str
        File of `STRUCTURES` or of the shipped structures, without its suffix.
    hollow : float
        Depth of the true blocks' faces in their middle, which the campaign's structure does not state [m]. Nonsmooth
        contact has no faces that could be hollow.
    causes : list of dict, optional
        As of `true_causes`, in place of those that are drawn.
    laboratory : str
        Key of `LABORATORIES`.
    strength : str or None
        Key of `case_plan.STRENGTHS`; None for the tests of `case_plan.PLAN`.
    """
    plan = case_plan.planned_tests(structure_name, seed, sealed, strength)
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "README").unlink(missing_ok=True)
    structure = load_structure(structure_file(structure_name))
    shutil.copyfile(structure_file(structure_name), folder / "structure.yaml")
    causes = causes or true_causes(names, size, structure, len(plan), seed)
    tilt = most_tilt(structure, strength)
    true, shaken = _laboratory(laboratory, structure, seed, hollow)
    happened, done, exact = {}, [], []
    for number, (test, scale, facts) in enumerate(shaken(plan, causes, tilt)):
        motion, _, role = plan[number]
        name = name_of_test(motion, scale) if strength is None else f"test-{number + 1}"
        done.append((name, motion, scale, role))
        exact.append(test["marker_displacement"].to_numpy().copy())
        happened[name] = {"role": role} | facts | {"drift": _drift(test, structure)}
        for cause in causes:
            _distort(test, cause)
        test = _seen(test, true, seed, number)
        test.attrs |= {"motion": motion, "motion_scale": scale}
        write_dataset(folder / f"{name}.nc", test, DECIMALS)
    write_text(folder / "campaign.yaml", _campaign_yaml(done, structure_name))
    truth = {
        "causes": causes, "size": size, "seed": seed, "structure": structure_name, "sealed": sealed,
        "laboratory": laboratory, "strength": strength, "hollow": hollow, **true, "tests": happened,
        "moved": _moved(shaken, done, causes, exact), "made_by": made_by(),
    }  # fmt: skip
    write_json(truth_folder / "truth.json", truth)
    committed = hashlib.sha256((truth_folder / "truth.json").read_bytes()).hexdigest()
    write_text(
        folder / "README",
        "SYNTHETIC: simulated runs seen through noisy sensors. Nothing here was measured.\n"
        f"What is hidden in it, if anything, is in a file with sha256 {committed}.\n",
    )


def _laboratory(laboratory, structure, seed, hollow):
    """Truth of a case in a laboratory next to its causes, and its tests by plan, causes and largest tilt."""
    if laboratory == "mujoco":
        true = mujoco_case.truth(structure, seed)
        tests = mujoco_case.tests
    else:
        true = own_laboratory.truth(structure, seed, hollow, laboratory == "unusual")
        tests = own_laboratory.tests
    noise = (
        {"noise": true_noise(seed)}
        if laboratory == "home"
        else {"sensors": foreign_sensors.true_sensors(seed, gains=laboratory == "unusual")}
    )
    return true | noise, lambda plan, causes, tilt: tests(structure, plan, causes, true, seed, tilt)


def _seen(test, true, seed, number):
    """Readings of a test from exact ones, by the sensors of its laboratory."""
    if "noise" in true:
        return add_noise(test, true["noise"], seed, number)
    return foreign_sensors.read(test, true["sensors"], seed, number)


def _moved(shaken, done, causes, exact):
    """How far causes from outside move a marker next to a twin without them: the most in open tests, over its noise
    [1].

    None without such a cause.
    """
    others = [cause for cause in causes if cause["name"] not in OUTSIDE]
    if len(others) == len(causes):
        return None
    plan = [(motion, scale, role) for _, motion, scale, role in done]
    twins = (test["marker_displacement"].to_numpy() for test, *_ in shaken(plan, others, np.inf))
    apart = [
        np.nanmax(np.abs(twin - own))
        for twin, own, (*_, role) in zip(twins, exact, plan, strict=True)
        if role != "sealed"
    ]
    return float(max(apart) / MARKER_NOISE)


def _distort(test, cause):
    """Readings of markers with their fault, in place."""
    markers = [str(marker) for marker in test["marker"].values]
    test["marker_displacement"].values[:] = distort(
        test["time"].to_numpy(), test["marker_displacement"].to_numpy(), markers, cause
    )


def _drift(test, structure):
    """How far the upper marker of each block that has one goes against the slab's, to either side [m]."""
    moved = test["marker_displacement"].sel(axis="x")
    drift = moved - moved.sel(marker="slab-face", drop=True)
    known = set(map(str, test["marker"].values))
    upper = {
        body.name: drift.sel(marker=f"{body.name}-upper")
        for body in structure.file.bodies
        if not body.driven and f"{body.name}-upper" in known
    }
    return {body: [float(way.min()), float(way.max())] for body, way in upper.items()}


def _campaign_yaml(done, structure_name):
    mapping = {
        "name": f"{structure_name} on a virtual table",
        "structure": "structure.yaml",
        "sensors": {"marker_noise": MARKER_NOISE, "accelerometer_noise": ACCELEROMETER_NOISE},
        "tests": [
            {"name": name, "file": f"{name}.nc", "motion": motion, "scale": scale, "role": role}
            for name, motion, scale, role in done
        ],
    }
    return yaml.safe_dump(mapping, sort_keys=False, default_flow_style=None, width=200)
