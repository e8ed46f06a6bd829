"""How the definition of a wave's arrival and the damping move the stiffness, and what that does to a stack."""

import numpy as np
import xarray as xr

from blockshake.dynamics.load_motion import load_motion
from blockshake.dynamics.system import Status
from blockshake.geometry.structure import load_structure
from blockshake.measurement.sensors.markers import block_markers, driven_marker
from blockshake.simulation.simulate import simulate
from blockshake.simulation.structure_digest import structure_digest
from blockshake.solvers.ls_dem.own_stiffness import own_stiffness
from blockshake.solvers.ls_dem.parameters import LsDemParameters
from blockshake.study.described import describe
from blockshake.study.stiffness.tower import tower_of
from blockshake.study.stiffness.wave_speed import target_wave_speeds
from blockshake.study.stiffness.wave_step import AXES, STEP_VELOCITY, crossing, send_step

LEVELS = {"10 %": 0.1, "50 %": 0.5, "90 %": 0.9}
DEFINITIONS = (*LEVELS, "first peak", "cross-correlation")
RESTITUTIONS = (0.1, 0.5, 1.0)
FREE_FACTORS = (1.0, 10.0, 100.0)  # on the shear stiffness, where blocks may turn
_FREE_PASSAGES = 12.0
_LONGEST = 6.0  # s of the record; the first strong swings
_NOMINAL = "50 %", 0.5  # definition and restitution of the study
_DESCRIBED = {
    "stiffness": ("stiffness per area whose wave speed is the material's", "N m-3"),
    "speed_ratio": ("speed reached with it over the target", "1"),
    "target_wave_speed": ("wave speed of the material", "m s-1"),
    "wave_speed": ("wave speed at the study's stiffness", "m s-1"),
    "top_peak": ("peak of the highest block relative to the slab, this restitution", "m"),
    "top_peak_same_damping": ("peak of the highest block relative to the slab, the study's restitution", "m"),
    "blocked_speed": ("speed of a horizontal step, rotations blocked", "m s-1"),
    "free_speed": ("speed of a horizontal step, rotations free", "m s-1"),
    "restitution": ("restitution of LS-DEM's dashpot", "1"),
    "factor": ("shear stiffness over the study's", "1"),
}


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


def compare_definitions(case, time_step, store):
    """Stiffness by definition and damping, and the top block's peak with each.

    Parameters
    ----------
    case : dict
        ``structure``, of whose blocks the tower of the wave tests is, ``motion``, ``scale`` and ``baseline`` of what is
        then shaken, and ``duration`` [s], of which at most 6 s are simulated, from the record's start on.
    time_step : float
        Of that run [s].
    store : Store
        Of tests and runs.

    Returns
    -------
    xarray.Dataset
        Over (restitution, definition): ``stiffness(direction, ...)`` [N/m3] whose wave speed is that of the
        material by that definition; ``speed_ratio(direction, ...)`` [1], speed reached over target in a test
        with it; ``wave_speed(direction, ...)`` [m/s], at the stiffness of the study's own definition and
        damping; ``top_peak`` and ``top_peak_same_damping`` [m], largest displacement of the highest block
        relative to the slab along x in a nominal run with that stiffness and that restitution, or the study's.
        Over ``factor``: ``free_speed`` and ``blocked_speed`` [m/s], of a horizontal step with rotations free
        and blocked, at so many times the study's shear stiffness. NaN where a definition names no instant.

    Notes
    -----
    In a chain of masses and springs every time goes with sqrt(m / K), dashpots included, whose ratio to critical is
    kept: one test at any stiffness gives K for all definitions, and a second confirms it.
    """
    structure = load_structure(case["structure"])
    motion = load_motion(case["motion"], case["scale"], case["baseline"])
    duration = motion.attributes.get("record_start", 0.0) + min(case["duration"], _LONGEST)

    rows = {restitution: _stiffness(structure, restitution, store) for restitution in RESTITUTIONS}
    study = rows[_NOMINAL[1]].sel(definition=_NOMINAL[0])["stiffness"]
    for restitution, row in rows.items():
        row["wave_speed"] = _speeds_at(structure, restitution, study, store)
        for name, used in (("top_peak", restitution), ("top_peak_same_damping", _NOMINAL[1])):
            peaks = [
                _top_peak(
                    structure, motion, time_step, duration, used, row["stiffness"].sel(definition=one), store
                )
                for one in DEFINITIONS
            ]
            row[name] = ("definition", peaks)
    result = xr.concat(rows.values(), dim=xr.Variable("restitution", list(rows)))
    result = result.merge(_free_rotations(structure, study, store))
    return _described(result, case, duration)


def _parameters(stiffness):
    return LsDemParameters(
        normal_stiffness=float(stiffness.sel(direction="normal")),
        shear_stiffness=float(stiffness.sel(direction="shear")),
    )


def _read(store, tower, parameters, direction, *choices):
    """Wave speed by every definition, from one test [m/s]; ``choices`` as of `send_step`."""

    def read(_):
        test = send_step(tower, parameters, direction, *choices)
        return [test.height / travel_time(test.time, test.velocity, one) for one in DEFINITIONS]

    given = "step", structure_digest(tower), parameters.model_dump(), direction, *choices
    return np.array(store.value(given, read))


def _stiffness(structure, restitution, store):
    tower = tower_of(structure.with_parameters({"restitution": restitution}))
    targets = target_wave_speeds(tower)
    stiffness, ratio = (np.full((len(AXES), len(DEFINITIONS)), np.nan) for _ in range(2))
    for row, direction in enumerate(AXES):
        start = LsDemParameters(**own_stiffness(structure))
        found = _read(store, tower, start, direction)
        stiffness[row] = getattr(start, f"{direction}_stiffness") * (targets[direction] / found) ** 2
        for column in np.flatnonzero(np.isfinite(stiffness[row])):
            confirmed = start.model_copy(update={f"{direction}_stiffness": float(stiffness[row, column])})
            ratio[row, column] = _read(store, tower, confirmed, direction)[column] / targets[direction]
    pair = ("direction", "definition")
    return xr.Dataset(
        {
            "stiffness": (pair, stiffness),
            "speed_ratio": (pair, ratio),
            "target_wave_speed": ("direction", [targets[direction] for direction in AXES]),
        },
        coords={"direction": list(AXES), "definition": list(DEFINITIONS)},
    )


def _speeds_at(structure, restitution, stiffness, store):
    tower = tower_of(structure.with_parameters({"restitution": restitution}))
    speeds = [_read(store, tower, _parameters(stiffness), direction) for direction in AXES]
    return ("direction", "definition"), np.array(speeds)


def _top_peak(structure, motion, time_step, duration, restitution, stiffness, store):
    """Largest displacement of the highest block relative to the slab along x in one nominal run [m]."""
    if not np.isfinite(stiffness).all():
        return np.nan
    parameters = {"restitution": restitution}
    parameters |= {f"ls_dem.{one}_stiffness": float(stiffness.sel(direction=one)) for one in AXES}

    def shake(_):
        run = simulate(structure, motion, "ls-dem", parameters, time_step, duration, accelerometers=False)
        if run.attrs["status"] != Status.COMPLETED:
            return np.nan
        height = dict(zip(structure.body_names, structure.position[:, 2], strict=True))
        markers = block_markers(structure)
        along, marker = run["marker_displacement"].sel(axis="x"), markers[max(markers, key=height.get)]
        return float(np.abs(along.sel(marker=marker) - along.sel(marker=driven_marker(structure))).max())

    shaken = structure_digest(structure), *motion.table
    return store.value(("peak", *shaken, parameters, time_step, duration), shake)


def _free_rotations(structure, stiffness, store):
    """Speed of a horizontal step where blocks may turn, beside that where they may not."""
    tower = tower_of(structure)
    speeds = {True: [], False: []}
    for factor in FREE_FACTORS:
        parameters = _parameters(stiffness)
        parameters = parameters.model_copy(update={"shear_stiffness": factor * parameters.shear_stiffness})
        for blocked, found in speeds.items():
            passages = 3.0 if blocked else _FREE_PASSAGES * np.sqrt(factor)
            speeds_read = _read(store, tower, parameters, "shear", passages, blocked)
            found.append(speeds_read[DEFINITIONS.index(_NOMINAL[0])])
    return xr.Dataset(
        {"blocked_speed": ("factor", speeds[True]), "free_speed": ("factor", speeds[False])},
        coords={"factor": list(FREE_FACTORS)},
    )


def _described(result, case, duration):
    result["target_wave_speed"] = result["target_wave_speed"].isel(restitution=0, drop=True)
    describe(result, _DESCRIBED)
    result.attrs = {
        "Conventions": "CF-1.11",
        "title": "contact stiffness by definition of arrival and by damping",
        "structure": str(case["structure"]), "motion": str(case["motion"]), "motion_scale": float(case["scale"]),
        "duration": float(duration), "step_velocity": STEP_VELOCITY,
        "definition": _NOMINAL[0], "study_restitution": _NOMINAL[1],
    }  # fmt: skip
    return result
