"""Convergence of LS-DEM: what its numerical parameters, varied one at a time, change in two short runs."""

import time

import pandas as pd

from blockshake.geometry.structure import load_structure
from blockshake.simulation.models import model_of
from blockshake.simulation.structure_digest import structure_digest
from blockshake.solvers.ls_dem.own_stiffness import own_stiffness
from blockshake.solvers.ls_dem.parameters import LsDemParameters
from blockshake.study.convergence.runs import rocking_block, shaken_stack
from blockshake.study.convergence.table import COLUMNS, EXACT, OBSERVABLES

NUDGE = 1e-6  # share by which kick and ground acceleration are larger in the run that the floor comes from
_MODEL = "ls-dem"
_TIME_STEP = model_of(_MODEL).time_step  # s; the others are varied from it


def study_convergence(settings, store):
    """Run the two cases with each numerical parameter varied about its default, the others kept at theirs.

    Parameters
    ----------
    settings : Convergence
        Of the configuration.
    store : Store
        Of pairs of runs; it says the CPU time of each that is made, which stays out of the table.

    Returns
    -------
    pandas.DataFrame
        One row for each ``parameter`` (``time_step`` [s], ``node_spacing``, ``perimeter_inset``, ``grid_spacing``
        [m]), its ``setting`` (a spacing of the grid of 0 is the exact distance; ``usual`` marks the default) and
        ``observable`` with its ``unit`` (`OBSERVABLES`): ``value``; ``difference`` from that at the smallest
        setting; and ``floor``, the size of the difference that a ground acceleration and a kick larger by one
        part in a million make to the run with default parameters. NaN where a run did not come so far.

    Notes
    -----
    Rocking is sensitive: a difference that is no larger than the floor says nothing of the parameter.
    """
    structure = load_structure(settings.structure)
    identity, stiffness = structure_digest(structure), own_stiffness(structure)
    usual = LsDemParameters(**stiffness)

    def observe(said, numerical=usual, time_step=_TIME_STEP, strength=1.0):
        shaken = strength * settings.acceleration, settings.frequency, settings.duration

        def run(_):
            started = time.process_time()
            read = rocking_block(structure, _MODEL, numerical, time_step, strength)
            read |= shaken_stack(structure, numerical, time_step, *shaken)
            store.say(f"{said}: {time.process_time() - started:.2f} CPU s")
            return read

        return store.value(
            ("convergence", identity, numerical.model_dump(), time_step, strength, shaken), run
        )

    def vary(name, **others):
        return {
            value: observe(f"{name} {value:g} m", LsDemParameters(**stiffness, **{name: value}, **others))
            for value in sorted(settings.numerical[name])
        }

    reference = observe("default parameters")
    nudged = observe(f"default parameters, {NUDGE:g} stronger", strength=1.0 + NUDGE)
    floor = {name: abs(nudged[name] - reference[name]) for name in OBSERVABLES}
    runs = {
        "time_step": {
            value: observe(f"time_step {value:g} s", time_step=value) for value in sorted(settings.time_steps)
        },
        "node_spacing": vary("node_spacing"),
        "perimeter_inset": vary("perimeter_inset"),
        "grid_spacing": {EXACT: reference} | vary("grid_spacing", level_set="grid"),
    }
    defaults = usual.model_dump() | {"time_step": _TIME_STEP, "grid_spacing": EXACT}
    rows = []
    for parameter, by_setting in runs.items():
        finest = next(iter(by_setting.values()))
        rows += [
            (
                parameter, setting, setting == defaults[parameter], name, unit,
                read[name], read[name] - finest[name], floor[name],
            )
            for setting, read in by_setting.items()
            for name, unit in OBSERVABLES.items()
        ]  # fmt: skip
    return pd.DataFrame(rows, columns=COLUMNS)
