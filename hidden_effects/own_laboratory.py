"""A test by the own solvers: drawn numerics, a table that errs, and what is hidden, in forms of `effect_forms`."""

import numpy as np
from case_plan import DURATION
from case_truth import follow, true_numerics, true_parameters, true_places, true_table, unusual_numerics
from effect_forms import FORM_NUMERICS, FORMS
from outside_forces import OUTSIDE

from blockshake.dynamics.load_motion import load_motion
from blockshake.effects.effect import Experiment
from blockshake.measurement.sensors.instruments import Instruments
from blockshake.simulation.models import part_parameters
from blockshake.virtual.settings import VirtualCampaign
from blockshake.virtual.shake_table import shake

_SMALLER = 0.9  # of a motion in which a block tilts too far
_TRIES = 12


def truth(structure, seed, hollow, unusual):
    """Truth of a case next to its causes: model, numerics, parameters, table."""
    parameters, wider = true_parameters(structure, seed)
    if unusual:
        model, time_step, numerics, more = unusual_numerics(structure, seed)
        parameters |= more
    else:
        model, time_step, numerics = true_numerics(seed)
    return {
        "model": model, "time_step": time_step, "numerics": numerics, "parameters": parameters, "wider": wider,
        "table": true_table(seed, 5.0 / 3.0 if unusual else 1.0), "hollow": hollow,
    }  # fmt: skip


def tests(structure, plan, causes, true, seed, most_tilt):
    """Exact readings of every test of a plan, one by one, with the run's facts.

    Yields
    ------
    test : xarray.Dataset
        As in a campaign's test file.
    scale : float
        Of the motion: the plan's, or less where a block would tilt farther than ``most_tilt`` [rad].
    facts : dict
        ``status``, ``end_time`` and ``tilt`` of the run.
    """
    physical, own = part_parameters(true["parameters"])
    physical |= {"shapes.block.hollow": true["hollow"]} if true["hollow"] else {}
    standing = structure.with_parameters(physical)
    settings = {"seed": seed, "model": true["model"], "time_step": true["time_step"]}
    for number, (motion, scale, _) in enumerate(plan):
        for _ in range(_TRIES):
            experiment = Experiment(
                standing, follow(load_motion(motion, scale), true["table"]),
                Instruments(marker_noise=0.0, accelerometer_noise=0.0),
            )  # fmt: skip
            test, run = _shaken(
                experiment, number, own | true["numerics"], causes, true_places(structure, seed, number), structure,
                settings,
            )  # fmt: skip
            tilt = _tilt(run, structure)
            if tilt <= most_tilt:
                break
            scale = round(_SMALLER * scale, 3)
        yield test, scale, {
            "status": run.attrs["status"], "end_time": float(run.attrs["end_time"]), "tilt": tilt,
        }  # fmt: skip


def _tilt(run, structure):
    """Largest angle of a block's upward axis against the vertical [rad]."""
    blocks = [body.name for body in structure.file.bodies if not body.driven]
    turn = run["orientation"].sel(body=blocks).to_numpy()
    upward = 1.0 - 2.0 * (turn[..., 1] ** 2 + turn[..., 2] ** 2)
    return float(np.arccos(np.clip(np.nanmin(upward), -1.0, 1.0)))


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
