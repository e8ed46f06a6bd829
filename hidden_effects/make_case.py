"""A campaign with an effect hidden in it, or none, in one folder and its truth in another.

Runs in a process of its own: ``python hidden_effects/make_case.py --seed 7 --case table-pitch --size large
--output CAMPAIGN --truth TRUTH``. The diagnosis is given the campaign alone and shares no code with this but the
solvers and the registry's parameters and places.
"""

import argparse
import hashlib
import shutil
import sys
from functools import partial
from pathlib import Path

import numpy as np
import yaml
from case_noise import ACCELEROMETER_NOISE, MARKER_NOISE, add_noise, true_noise
from case_truth import (
    NONE,
    SIZES,
    follow,
    true_effect,
    true_numerics,
    true_parameters,
    true_places,
    true_table,
)
from effect_forms import FORM_NUMERICS, FORMS, distort
from outside_forces import OUTSIDE

from blockshake.dynamics.load_motion import load_motion
from blockshake.effects.effect import Experiment
from blockshake.effects.registry import EFFECTS
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
# the same in every case: libraries of simulated tests depend on structure and motions alone
PLAN = (
    ("alkion", 1.0, "fit"),
    ("alkion", 2.5, "fit"),
    ("basso-tirreno", 2.0, "select"),
    ("alkion", 3.0, "sealed"),
    ("basso-tirreno", 2.5, "sealed"),
)


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


def make_case(seed, name, size, folder, truth_folder, sealed=True, structure_name="two-blocks", hollow=0.0):
    """Write the campaign, then its truth, then the README that commits to the truth.

    Parameters
    ----------
    seed : int
        Of everything that is drawn.
    name : str
        Effect of the registry, cause from `OUTSIDE`, or ``none``.
    size : str
        ``small`` or ``large``; of no meaning without an effect of the registry.
    folder, truth_folder : Path
    sealed : bool
        Whether there are sealed tests too, on which a gain can be measured.
    structure_name : str
        File of `STRUCTURES`, without its suffix.
    hollow : float
        Depth of the true blocks' faces in their middle, which the campaign's structure does not state [m].
    """
    plan = [test for test in PLAN if sealed or test[2] != "sealed"]
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "README").unlink(missing_ok=True)
    structure = load_structure(structure_file(structure_name))
    shutil.copyfile(structure_file(structure_name), folder / "structure.yaml")
    effect = true_effect(name, size, structure, len(plan), seed)
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
        shaken = partial(
            _shaken, experiment, number, own | numerics, true_places(structure, seed, number),
            structure=structure, settings={"seed": seed, "model": model, "time_step": time_step},
        )  # fmt: skip
        test, run = shaken(effect)
        happened[name_of_test(motion, scale)] = _happened(test, run, structure)
        if effect is not None:
            _distort(test, effect)
            if role != "sealed":
                bare, _ = shaken(None)
                happened[name_of_test(motion, scale)]["trace"] = _farthest(test, bare)
        test = add_noise(test, noise, seed, number)
        test.attrs |= {"motion": motion, "motion_scale": scale}
        write_dataset(folder / f"{name_of_test(motion, scale)}.nc", test, DECIMALS)
    write_text(folder / "campaign.yaml", _campaign_yaml(plan, structure_name))
    truth = {
        "truth": name, "size_class": size if name in FORMS else None, "effect": effect,
        "form": _words(name), "seed": seed, "structure": structure_name,
        "sealed": sealed, "model": model, "time_step": time_step,
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


def _shaken(experiment, number, solver, places, effect, structure, settings):
    """Exact readings of a test and its run, with what is hidden or, without an effect, with nothing."""
    if effect is not None and effect["name"] in OUTSIDE:
        experiment = OUTSIDE[effect["name"]].act(experiment, effect, number)
    elif effect is not None:
        experiment = FORMS[effect["name"]][1](experiment, effect["values"], effect["place"])
        solver = solver | FORM_NUMERICS.get(effect["name"], {})
    campaign = VirtualCampaign(name="case", instruments=experiment.instruments, **settings)
    return shake(
        experiment.structure, solver, None, experiment.motion, campaign, places, DURATION, settings["seed"], structure,
    )  # fmt: skip


def _distort(test, effect):
    """Readings of markers with their fault, in place."""
    markers = [str(marker) for marker in test["marker"].values]
    test["marker_displacement"].values[:] = distort(
        test["time"].to_numpy(), test["marker_displacement"].to_numpy(), markers, effect
    )


def _farthest(test, bare):
    """Largest difference that an effect makes to a marker's exact reading while both runs last [m]."""
    return float(np.nanmax(np.abs(test["marker_displacement"] - bare["marker_displacement"])))


def _words(name):
    """Form of what is hidden."""
    if name in OUTSIDE:
        return OUTSIDE[name].words
    return FORMS[name][0] if name in FORMS else None


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


def main(arguments):
    """Make one case, as the command line says."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--case", choices=[NONE, *EFFECTS, *OUTSIDE], required=True)
    parser.add_argument("--size", choices=list(SIZES), default="large")
    parser.add_argument(
        "--structure", choices=sorted(path.stem for path in STRUCTURES.glob("*.yaml")), default="two-blocks"
    )
    parser.add_argument("--output", type=Path, required=True)
    parser.add_argument("--truth", type=Path, required=True)
    parser.add_argument(
        "--no-sealed", dest="sealed", action="store_false", help="no tests to measure a gain on"
    )
    asked = parser.parse_args(arguments)
    make_case(
        asked.seed, asked.case, asked.size, asked.output, asked.truth, asked.sealed, asked.structure
    )  # fmt: skip


if __name__ == "__main__":
    main(sys.argv[1:])
