"""A campaign with causes hidden in it, or none, in one folder and its truth in another.

The diagnosis is given the campaign alone and shares no code with this but the solvers and the registry's parameters and
places.
"""

import hashlib
import shutil
from pathlib import Path

import numpy as np
import yaml
from case_noise import ACCELEROMETER_NOISE, MARKER_NOISE, add_noise, true_noise
from case_truth import (
    follow,
    true_causes,
    true_numerics,
    true_parameters,
    true_places,
    true_table,
)
from effect_forms import FORM_NUMERICS, FORMS, distort
from outside_forces import OUTSIDE

from blockshake.dynamics.load_motion import load_motion
from blockshake.effects.effect import Experiment
from blockshake.files import content_digest, write_dataset, write_json, write_text
from blockshake.geometry.structure import load_structure
from blockshake.measurement.sensors.instruments import Instruments
from blockshake.simulation.models import MODELS, part_parameters
from blockshake.sources import module_sources, source_digest
from blockshake.virtual.generate import DECIMALS
from blockshake.virtual.settings import VirtualCampaign
from blockshake.virtual.shake_table import shake

HERE = Path(__file__).parent
STRUCTURES = HERE / "structures"
DURATION = 6.0  # s
PLAN = (
    ("alkion", 1.0, "fit"),
    ("alkion", 2.5, "fit"),
    ("basso-tirreno", 2.0, "select"),
    ("alkion", 3.0, "sealed"),
    ("basso-tirreno", 2.5, "sealed"),
)
# on the scales of the plan, so that blocks rock and do not topple
STRONGER = {"single-block": 2.2, "trilithon": 1.15, "six-block-wall": 0.9}
_SCALES = (0.92, 1.08)  # on them, drawn test by test; those of two tests never meet
_STREAM = 6


def tests_of(structure_name, seed, sealed):
    """Motion, scale and role of every test of a case, with the sealed ones or without."""
    drawn = np.random.default_rng([seed, _STREAM]).uniform(*_SCALES, len(PLAN))
    factors = STRONGER.get(structure_name, 1.0) * drawn
    return [
        (motion, round(float(scale * factor), 2), role)
        for (motion, scale, role), factor in zip(PLAN, factors, strict=True)
        if sealed or role != "sealed"
    ]


def name_of_test(motion, scale):
    """Name of a planned test, such as ``alkion-250``."""
    return f"{motion}-{round(100 * scale):03d}"


def structure_file(name):
    """File of the structure of a name, such as ``two-blocks``."""
    return STRUCTURES / f"{name}.yaml"


def made_by():
    """Digest of every source that makes a case."""
    names = ("effect_forms.py", "outside_forces.py", "case_noise.py", "case_truth.py")
    own = [(HERE / name).read_bytes() for name in names]
    return content_digest(
        *own,
        Path(__file__).read_bytes(),
        *(path.read_bytes() for path in sorted(STRUCTURES.glob("*.yaml"))),
        source_digest(*module_sources("virtual/generate.py", *MODELS)),
    )


def make_case(
    seed, names, size, folder, truth_folder, sealed=True, structure_name="two-blocks", hollow=0.0, causes=None
):
    """Write the campaign, then its truth, then the README that commits to the truth.

    Parameters
    ----------
    seed : int
        Of everything that is drawn.
    names : sequence of str
        Effects of the registry and causes from `OUTSIDE`, which act in this order; none of a clean case.
    size : str or None
        ``small`` or ``large``; of no meaning without an effect of the registry.
    folder, truth_folder : Path
    sealed : bool
        Whether there are sealed tests too, on which a gain can be measured.
    structure_name : str
        File of `STRUCTURES`, without its suffix.
    hollow : float
        Depth of the true blocks' faces in their middle, which the campaign's structure does not state [m]. Nonsmooth
        contact has no faces that could be hollow.
    causes : list of dict, optional
        As of `true_causes`, in place of those that are drawn.
    """
    plan = tests_of(structure_name, seed, sealed)
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "README").unlink(missing_ok=True)
    structure = load_structure(structure_file(structure_name))
    shutil.copyfile(structure_file(structure_name), folder / "structure.yaml")
    causes = causes or true_causes(names, size, structure, len(plan), seed)
    parameters, wider = true_parameters(structure, seed)
    physical, own = part_parameters(parameters)
    physical |= {"shapes.block.hollow": hollow} if hollow else {}
    model, time_step, numerics = true_numerics(seed)
    table, noise = true_table(seed), true_noise(seed)
    happened = {}
    for number, (motion, scale, role) in enumerate(plan):
        experiment = Experiment(
            structure.with_parameters(physical), follow(load_motion(motion, scale), table),
            Instruments(marker_noise=0.0, accelerometer_noise=0.0),
        )  # fmt: skip
        test, run = _shaken(
            experiment, number, own | numerics, causes, true_places(structure, seed, number), structure,
            {"seed": seed, "model": model, "time_step": time_step},
        )  # fmt: skip
        happened[name_of_test(motion, scale)] = {"role": role} | _happened(test, run, structure)
        for cause in causes:
            _distort(test, cause)
        test = add_noise(test, noise, seed, number)
        test.attrs |= {"motion": motion, "motion_scale": scale}
        write_dataset(folder / f"{name_of_test(motion, scale)}.nc", test, DECIMALS)
    write_text(folder / "campaign.yaml", _campaign_yaml(plan, structure_name))
    truth = {
        "causes": causes, "size": size, "forms": [_words(name) for name in names], "seed": seed,
        "structure": structure_name, "sealed": sealed, "model": model, "time_step": time_step,
        "numerics": numerics, "parameters": parameters, "wider": wider, "table": table, "noise": noise,
        "hollow": hollow, "tests": happened, "made_by": made_by(),
    }  # fmt: skip
    write_json(truth_folder / "truth.json", truth)
    committed = hashlib.sha256((truth_folder / "truth.json").read_bytes()).hexdigest()
    write_text(
        folder / "README",
        "SYNTHETIC: simulated runs seen through noisy sensors. Nothing here was measured.\n"
        f"What is hidden in it, if anything, is in a file with sha256 {committed}.\n",
    )


def _shaken(experiment, number, solver, causes, places, structure, settings):
    """Exact readings of a test and its run, with what is hidden."""
    for cause in causes:
        name = cause["name"]
        if name in OUTSIDE:
            start = cause["start"][number]
            experiment = experiment if start is None else OUTSIDE[name].act(experiment, cause, start)
        else:
            experiment = FORMS[name][1](experiment, cause["values"], cause["place"])
            solver = solver | FORM_NUMERICS.get(name, {})
    campaign = VirtualCampaign(name="case", instruments=experiment.instruments, **settings)
    return shake(
        experiment.structure, solver, None, experiment.motion, campaign, places, DURATION, settings["seed"], structure,
    )  # fmt: skip


def _distort(test, cause):
    """Readings of markers with their fault, in place."""
    markers = [str(marker) for marker in test["marker"].values]
    test["marker_displacement"].values[:] = distort(
        test["time"].to_numpy(), test["marker_displacement"].to_numpy(), markers, cause
    )


def _words(name):
    """Form of what is hidden."""
    return OUTSIDE[name].words if name in OUTSIDE else FORMS[name][0]


def _happened(test, run, structure):
    """How a test ended, and how far the upper marker of each block went against the slab's to either side [m]."""
    moved = test["marker_displacement"].sel(axis="x")
    drift = moved - moved.sel(marker="slab-face", drop=True)
    blocks = [body.name for body in structure.file.bodies if not body.driven]
    return {
        "status": run.attrs["status"],
        "end_time": float(run.attrs["end_time"]),
        "drift": {
            body: [
                float(drift.sel(marker=f"{body}-upper").min()),
                float(drift.sel(marker=f"{body}-upper").max()),
            ]
            for body in blocks
        },
    }


def _campaign_yaml(plan, structure_name):
    mapping = {
        "name": f"{structure_name} on a virtual table",
        "structure": "structure.yaml",
        "sensors": {"marker_noise": MARKER_NOISE, "accelerometer_noise": ACCELEROMETER_NOISE},
        "tests": [
            {
                "name": name_of_test(motion, scale), "file": f"{name_of_test(motion, scale)}.nc", "motion": motion,
                "scale": scale, "role": role,
            }
            for motion, scale, role in plan
        ],
    }  # fmt: skip
    return yaml.safe_dump(mapping, sort_keys=False, default_flow_style=None, width=200)
