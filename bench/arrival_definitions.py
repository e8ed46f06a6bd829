"""Contact stiffness by the definition of a wave's arrival and by the damping, and what that does to a stack.

In a chain of masses and springs every time goes with sqrt(m / K), dashpots included, whose ratio to critical is kept:
one test at any stiffness gives K for all definitions.
"""

import textwrap

import numpy as np
import xarray as xr
from similar_velocity import TOLERANCES, read_at_similar_velocity

from blockshake.dynamics.load_motion import load_motion
from blockshake.dynamics.system import Status
from blockshake.geometry.structure import load_structure
from blockshake.measurement.sensors.markers import block_markers, driven_marker
from blockshake.pages.wording import given, millimetres, percent
from blockshake.simulation.simulate import simulate
from blockshake.solvers.ls_dem.parameters import LsDemParameters, own_stiffness
from blockshake.study.stiffness.tower import tower_of
from blockshake.study.stiffness.wave_speed import target_wave_speeds, wave_tests
from blockshake.study.stiffness.wave_step import AXES, STEP_VELOCITY, crossing, send_step

LEVELS = {"10 %": 0.1, "50 %": 0.5, "90 %": 0.9}
DEFINITIONS = (*LEVELS, "first peak", "cross-correlation")
RESTITUTIONS = (0.1, 0.5, 1.0)
FREE_FACTORS = (1.0, 10.0, 100.0)  # on the shear stiffness, where blocks may turn
_FREE_PASSAGES = 12.0
NOMINAL = "50 %", 0.5  # definition and restitution of a study
# the first case of config/study.yaml
STRUCTURE, MOTION, SCALE = "configuration-1", "basso-tirreno", 2.0
TIME_STEP, DURATION = 1e-4, 6.0  # s, the first strong swings


def travel_time(times, velocity, definition):
    """Time that a step takes from the lowest to the highest block of a tower.

    Parameters
    ----------
    times : float64 array, shape (n_times,)
        [s], evenly spaced.
    velocity : float64 array, shape (n_times, n_blocks)
        From the lowest block up, base moving with `STEP_VELOCITY` from the start [m/s].
    definition : str
        One of `DEFINITIONS`. A level: the first instant at that share of the step's velocity. ``first peak``: the
        first local maximum of the velocity. ``cross-correlation``: the lag at which the accelerations of the two
        blocks agree best over the whole record.

    Returns
    -------
    float
        [s]; NaN where a block never reaches the level, its velocity never falls, or the highest is not the later one.
    """
    ends = velocity[:, [0, -1]]
    if definition in LEVELS:
        first, last = (crossing(times, history, LEVELS[definition] * STEP_VELOCITY) for history in ends.T)
    elif definition == "first peak":
        first, last = (_first_peak(times, history) for history in ends.T)
    else:
        acceleration = np.gradient(ends, times, axis=0)
        agreement = np.correlate(acceleration[:, 1], acceleration[:, 0], mode="full")[len(times) - 1 :]
        lags = np.arange(len(times)) * (times[1] - times[0])
        first, last = 0.0, _vertex(lags, agreement, int(np.argmax(agreement)))
    return last - first if last > first else np.nan


def _first_peak(times, history):
    falls = np.flatnonzero(
        (history[1:-1] >= history[:-2]) & (history[1:-1] > history[2:]) & (history[1:-1] > 0.0)
    )
    return _vertex(times, history, int(falls[0]) + 1) if len(falls) else np.nan


def _vertex(times, values, place):
    """Place of the largest value, by the parabola through it and its neighbours."""
    if not 0 < place < len(values) - 1:
        return float(times[place])
    before, at, after = values[place - 1 : place + 2]
    return float(times[place] + 0.5 * (before - after) / (before - 2.0 * at + after) * (times[1] - times[0]))


def stiffness_by_definition(structure):
    """Stiffness and wave speeds of a structure's tower of `tower_of`, by damping and definition.

    Returns
    -------
    xarray.Dataset
        Over (restitution, definition): ``stiffness(direction, ...)`` [N/m3] whose wave speed is that of the material
        by that definition; ``wave_speed(direction, ...)`` [m/s], at the stiffness of `NOMINAL`. ``target_wave_speed
        (direction)`` [m/s]. Over ``factor``: ``free_speed`` and ``blocked_speed`` [m/s], of a horizontal step with
        rotations free and blocked, at so many times the shear stiffness of `NOMINAL`. NaN where a definition names no
        instant.
    """
    start = LsDemParameters(**own_stiffness(structure))
    used = np.array([getattr(start, f"{direction}_stiffness") for direction in AXES])
    targets = target_wave_speeds(tower_of(structure))
    target = np.array([targets[direction] for direction in AXES])
    towers = [tower_of(structure.with_parameters({"restitution": one})) for one in RESTITUTIONS]
    speeds = np.array([[_speeds(tower, start, direction) for direction in AXES] for tower in towers])
    stiffness = used[:, None] * (target[:, None] / speeds) ** 2
    nominal = stiffness[RESTITUTIONS.index(NOMINAL[1]), :, DEFINITIONS.index(NOMINAL[0])]
    study = LsDemParameters(normal_stiffness=float(nominal[0]), shear_stiffness=float(nominal[1]))
    read = np.array([[_speeds(tower, study, direction) for direction in AXES] for tower in towers])
    of_all = ("restitution", "direction", "definition")
    return xr.Dataset(
        {
            "stiffness": (of_all, stiffness),
            "wave_speed": (of_all, read),
            "target_wave_speed": ("direction", target),
            "blocked_speed": ("factor", [_horizontal(structure, study, one, True) for one in FREE_FACTORS]),
            "free_speed": ("factor", [_horizontal(structure, study, one, False) for one in FREE_FACTORS]),
        },
        coords={
            "restitution": list(RESTITUTIONS), "direction": list(AXES), "definition": list(DEFINITIONS),
            "factor": list(FREE_FACTORS),
        },
    )  # fmt: skip


def _speeds(tower, parameters, direction, *choices):
    """Wave speed by every definition, from one test [m/s]; ``choices``: the last two of `send_step`."""
    test = send_step(tower, parameters, direction, *choices)
    return [test.height / travel_time(test.time, test.velocity, one) for one in DEFINITIONS]


def _horizontal(structure, parameters, factor, blocked):
    """Speed of a horizontal step at so many times the shear stiffness, by the definition of `NOMINAL` [m/s]."""
    stiffer = parameters.model_copy(update={"shear_stiffness": factor * parameters.shear_stiffness})
    passages = 3.0 if blocked else _FREE_PASSAGES * np.sqrt(factor)
    return _speeds(tower_of(structure), stiffer, "shear", passages, blocked)[DEFINITIONS.index(NOMINAL[0])]


def top_peaks(found):
    """Peaks of the highest block of `STRUCTURE` relative to the slab along x, shape (run, restitution, definition) [m].

    Nominal runs with each stiffness of `stiffness_by_definition`, at its restitution and at that of `NOMINAL`; NaN
    where there is no stiffness or a run did not complete.
    """
    structure, motion = load_structure(STRUCTURE), load_motion(MOTION, SCALE)
    duration = motion.attributes.get("record_start", 0.0) + DURATION
    height = dict(zip(structure.body_names, structure.position[:, 2], strict=True))
    markers = block_markers(structure)
    top = markers[max(markers, key=height.get)]

    def peak(stiffness, restitution):
        if not np.isfinite(stiffness).all():
            return np.nan
        parameters = {"restitution": restitution}
        parameters |= {f"ls_dem.{one}_stiffness": float(stiffness.sel(direction=one)) for one in AXES}
        run = simulate(structure, motion, "ls-dem", parameters, TIME_STEP, duration, accelerometers=False)
        if run.attrs["status"] != Status.COMPLETED:
            return np.nan
        along = run["marker_displacement"].sel(axis="x")
        return float(np.abs(along.sel(marker=top) - along.sel(marker=driven_marker(structure))).max())

    return np.array(
        [
            [
                [
                    peak(found["stiffness"].sel(restitution=one, definition=name), used or one)
                    for name in DEFINITIONS
                ]
                for one in RESTITUTIONS
            ]
            for used in (None, NOMINAL[1])
        ]
    )


def arrival_words(found, peaks):
    """How far the stiffness and the peak hang on the definition and on the damping, in lines of a page."""
    normal = found["stiffness"].sel(direction="normal").transpose("restitution", "definition")
    ratio = normal / float(normal.sel(definition=NOMINAL[0], restitution=NOMINAL[1]))
    similar = read_at_similar_velocity(wave_tests(STRUCTURE))["stiffness_ratio"]
    words = (
        "The normal stiffness that meets the wave speed of the same material is "
        f"{_range(ratio.sel(restitution=NOMINAL[1]))} times that of the study over the definitions at the damping of "
        f"the study, and {_range(ratio.sel(definition=list(LEVELS)))} times over the levels of velocity and all "
        f"dampings. Read once the velocities of all blocks are within {percent(TOLERANCES[0])} to "
        f"{percent(TOLERANCES[-1])} % of each other, as the paper states, the stiffness is "
        f"{_range(similar.sel(direction='normal'))} times that of the study for normal and "
        f"{_range(similar.sel(direction='shear'))} times for shear waves, where the blocks come so near to each other. "
        "Nominal runs that differ in stiffness and damping only give the highest block of "
        f"{STRUCTURE} a peak between {millimetres(np.nanmin(peaks))} and {millimetres(np.nanmax(peaks))} mm in the "
        f"first {given(DURATION)} s."
    )
    return "\n".join(textwrap.wrap(words, 100, break_on_hyphens=False))


def _range(values):
    """Smallest and largest of the values that there are."""
    return f"{float(values.min()):.2f} to {float(values.max()):.2f}"
