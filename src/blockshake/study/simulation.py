"""One simulation: structure, motion and parameters in, a run Dataset out (design contract, run file)."""

import json

import numpy as np
import xarray as xr

import blockshake
from blockshake.dynamics.load_motion import load_motion
from blockshake.dynamics.motion import GroundMotion
from blockshake.dynamics.system import ENERGY_TERMS
from blockshake.errors import InputError
from blockshake.files import source_digest
from blockshake.geometry.overlap import penetration_depth
from blockshake.geometry.rotations import rotate_into
from blockshake.geometry.structure import load_structure
from blockshake.measurement.accelerometers import FINE_RATE, accelerometer_readings
from blockshake.measurement.markers import marker_displacement
from blockshake.solvers.ls_dem.driver import simulate_ls_dem
from blockshake.solvers.ls_dem.parameters import LsDemParameters
from blockshake.solvers.nscd.driver import simulate_nscd
from blockshake.solvers.nscd.parameters import NscdParameters
from blockshake.sources import run_sources
from blockshake.validation import validated

# model name: solver, its numerical parameters, their prefix, its time step when nothing is said [s]
MODELS = {
    "ls-dem": (simulate_ls_dem, LsDemParameters, "ls_dem", 1e-5),
    "nscd-rigid": (simulate_nscd, NscdParameters, "nscd", 1e-3),
}
_WORST_RESIDUAL = 0.05  # a run whose energy audit misses more is not to be trusted
_DEEPEST_START = 1e-4  # m, contract: an equilibrium farther than this is not the start
_PREFIXES = tuple(f"{prefix}." for _, _, prefix, _ in MODELS.values())


def simulate(
    structure,
    motion,
    model,
    parameters=None,
    time_step=None,
    duration=None,
    output_rate=200.0,
    accelerometers=True,
    checkpoint=None,
):
    """Simulate one structure under one motion.

    Parameters
    ----------
    structure : str or path
        Shipped name or file.
    motion : GroundMotion, str or path
        Already scaled; or a shipped name or file.
    model : str
        One of `MODELS`.
    parameters : dict of str to value, optional
        By dotted name, physical and numerical; those of the other solver are ignored.
    time_step : float, optional
        [s]; the model's own by default.
    duration : float, optional
        [s]; the motion's by default; the ground rests after the motion's last row.
    output_rate : float
        [Hz]
    accelerometers : bool
        Compute the accelerometer channels, which takes a fine record.
    checkpoint : path, optional
        Where a long run is saved every minute, and from where it goes on, bit-identical, if it was cut short.

    Returns
    -------
    xarray.Dataset
        The run file of the contract.

    Raises
    ------
    InputError
        Unknown model or parameter, or a structure that is wrong.
    """
    solve, _, _, usual_step = _solver(model)
    physical, numerical = split_parameters(parameters or {}, model)
    built = load_structure(structure, physical)
    motion = motion if isinstance(motion, GroundMotion) else load_motion(motion)
    _check_start(built, motion)
    time_step = usual_step if time_step is None else time_step
    duration = motion.duration if duration is None else duration
    for name, value in (("time step", time_step), ("duration", duration), ("output rate", output_rate)):
        if not (np.isfinite(value) and value > 0.0):
            raise InputError(f"--{name.replace(' ', '-')}", "", f"expected a positive number, not {value}")
    coarse = np.arange(int(np.floor(duration * output_rate + 1e-9)) + 1) / output_rate
    fine = np.empty(0)
    if accelerometers and built.file.accelerometers:
        fine = np.arange(int(np.floor(duration * FINE_RATE + 1e-9)) + 1) / FINE_RATE
    times = np.union1d(coarse, fine)
    trajectory = solve(built, motion, numerical, times, time_step, checkpoint=checkpoint)
    run = _dataset(built, trajectory, np.searchsorted(times, coarse))
    if fine.size:
        _add_accelerometers(run, built, trajectory, np.searchsorted(times, fine))
    status, reason, residual = trajectory.status, trajectory.reason, energy_residual(trajectory.energy)
    if status in ("completed", "collapsed") and residual > _WORST_RESIDUAL:
        reason = f"the energy audit misses {residual:.0%} of the energy in play: take a smaller time step; {reason}"
        status, reason = "not-converged", reason.removesuffix("; ")
    run.attrs = {
        "Conventions": "CF-1.11",
        "title": f"{built.file.name} under {motion.name}, {model}",
        "model": model,
        "structure": built.file.name,
        "motion": motion.name,
        "status": status,
        "reason": reason,
        "end_time": trajectory.end_time,
        "energy_residual": residual,
        "time_step": time_step,
        "output_rate": output_rate,
        "seed": "none: a run is deterministic",
        "structure_file": built.file.model_dump_json(),
        "motion_scale": 1.0,
        "motion_synthetic": 0,
        **{f"motion_{name}": _plain(value) for name, value in motion.attributes.items()},
        "parameters": json.dumps(effective_parameters(built, model, numerical), sort_keys=True),
        **{f"numerics_{name}": value for name, value in trajectory.numerics.items()},
        "blockshake_version": blockshake.__version__,
        "source_digest": source_digest(*run_sources(model)),
        "history": "made by blockshake simulate",
    }
    return run


def split_parameters(parameters, model):
    """Physical parameters, for the structure, and numerical ones, for the solver, of a flat mapping."""
    _, schema, prefix, _ = _solver(model)
    physical, _ = part_parameters(parameters)
    own = {
        key.removeprefix(f"{prefix}."): value
        for key, value in parameters.items()
        if key.startswith(f"{prefix}.")
    }
    for key in parameters:
        for _, other, other_prefix, _ in MODELS.values():
            if (
                key.startswith(f"{other_prefix}.")
                and key.removeprefix(f"{other_prefix}.") not in other.model_fields
            ):
                raise InputError(
                    "--set", key, f"expected one of {other_prefix}.{{{', '.join(other.model_fields)}}}"
                )
    return physical, validated(schema, own, "--set", prefix)


def part_parameters(parameters):
    """Parameters of the structure and those of any solver, as two mappings."""
    numerical = {name: value for name, value in parameters.items() if name.startswith(_PREFIXES)}
    return {name: value for name, value in parameters.items() if name not in numerical}, numerical


def effective_parameters(structure, model, numerical):
    """Every parameter that acted in a run, by dotted name."""
    file = structure.file
    acted = {
        "gravity": list(file.gravity),
        "restitution": file.restitution,
        "nscd_restitution": file.nscd_restitution,
    }
    for name, material in file.materials.items():
        acted |= {f"materials.{name}.{key}": value for key, value in material.model_dump().items()}
    for entry in file.friction:
        pair = f"friction.{'.'.join(entry.pair)}"
        acted[pair] = entry.coefficient
        acted |= {
            f"{pair}.{key}": value for key, value in entry.model_dump(exclude={"pair", "coefficient"}).items()
        }
    acted |= {
        f"bodies.{body.name}.mass_offset": list(body.mass_offset) for body in file.bodies if not body.driven
    }
    for joint in file.joints:
        own = joint.model_dump(exclude={"bodies"})
        acted |= {f"joints.{'.'.join(joint.bodies)}.{key}": value for key, value in own.items()}
    prefix = MODELS[model][2]
    return acted | {f"{prefix}.{key}": value for key, value in numerical.model_dump().items()}


def energy_residual(energy):
    """What the energy audit fails to explain, relative to the energy in play.

    Parameters
    ----------
    energy : float64 array, shape (n_times, 7)
        `ENERGY_TERMS` [J].

    Returns
    -------
    float
        Largest ``|kinetic + potential + elastic + dissipated - input - initial|`` over the largest of the
        work done on the bodies, their kinetic and their elastic energy and a millionth of their potential
        energy [1].
    """
    energy = energy[np.isfinite(energy).all(axis=1)]
    if not len(energy):
        return float("nan")
    held = energy[:, :3].sum(axis=1)
    missing = held + energy[:, 3:6].sum(axis=1) - energy[:, 6] - held[0]
    least = 1e-6 * np.abs(energy[:, 1]).max()
    in_play = max(np.abs(energy[:, 6]).max(), energy[:, 0].max(), energy[:, 2].max(), least)
    return float(np.abs(missing).max() / in_play) if in_play > 0.0 else 0.0


def _check_start(structure, motion):
    """Refuse a first pitch that pushes the driven body into what stands on it."""
    pitch = float(motion.evaluate(np.zeros(1))[0, 3])
    if pitch == 0.0:
        return
    orientation = structure.orientation.copy()
    turned = np.array([0.0, pitch, 0.0])
    for driven in np.flatnonzero(structure.driven):
        rotate_into(structure.orientation[driven], turned, orientation[driven])
        for body in np.flatnonzero(~structure.driven):
            depth = penetration_depth(
                structure.solid(driven), structure.position[driven], orientation[driven],
                structure.solid(body), structure.position[body], orientation[body],
            )  # fmt: skip
            if depth > _DEEPEST_START:
                name = structure.body_names[body]
                raise InputError(
                    motion.name,
                    "pitch_y",
                    f"its first value pushes the slab {1e3 * depth:.2g} mm into {name}",
                )


def _plain(value):
    """Attribute as netCDF can hold it."""
    if isinstance(value, bool):
        return int(value)
    return value if isinstance(value, (str, float, int)) else str(value)


def _solver(model):
    if model not in MODELS:
        raise InputError("--model", "", f"expected one of {', '.join(MODELS)}, not '{model}'")
    return MODELS[model]


def _dataset(structure, trajectory, rows):
    names = structure.body_names
    lower, upper = ([names[body] for body in trajectory.joints[:, side]] for side in (0, 1))
    markers = np.array([marker.name for marker in structure.file.markers], dtype=str)
    position, orientation = trajectory.position[rows], trajectory.orientation[rows]

    def variable(dims, values, units, long_name):
        return (dims, values, {"units": units, "long_name": long_name})

    return xr.Dataset(
        {
            "position": variable(("time", "body", "axis"), position, "m", "mass centre, inertial frame"),
            "orientation": variable(
                ("time", "body", "quaternion"), orientation, "1", "unit quaternion, body to inertial frame"
            ),
            "velocity": variable(
                ("time", "body", "axis"),
                trajectory.velocity[rows],
                "m s-1",
                "velocity of the mass centre, inertial frame",
            ),
            "angular_velocity": variable(
                ("time", "body", "axis"),
                trajectory.angular_velocity[rows],
                "rad s-1",
                "angular velocity, inertial frame",
            ),
            "marker_displacement": variable(
                ("time", "marker", "axis"),
                marker_displacement(structure, position, orientation),
                "m",
                "displacement of the marker since the start, inertial frame",
            ),
            "energy": variable(
                ("time", "term"), trajectory.energy[rows], "J", "energy audit of the free bodies"
            ),
            "joint_force": variable(
                ("time", "joint", "axis"),
                trajectory.joint_force[rows],
                "N",
                "resultant contact force on the upper body",
            ),
        },
        coords={
            "time": variable(("time",), trajectory.time[rows], "s", "time since the start of the motion"),
            "body": names,
            "axis": ["x", "y", "z"],
            "quaternion": ["w", "x", "y", "z"],
            "marker": markers,
            "marker_body": (
                "marker",
                np.array([marker.body for marker in structure.file.markers], dtype=str),
            ),
            "term": list(ENERGY_TERMS),
            "lower": ("joint", np.array(lower, dtype=str)),
            "upper": ("joint", np.array(upper, dtype=str)),
        },
    )


def _add_accelerometers(run, structure, trajectory, rows):
    times, values, channels = accelerometer_readings(
        structure,
        trajectory.time[rows],
        trajectory.orientation[rows],
        trajectory.velocity[rows],
        trajectory.angular_velocity[rows],
    )
    run["accelerometer"] = (
        ("time_acc", "channel"),
        values,
        {"units": "m s-2", "long_name": "specific force along the body's axis, 50 Hz low-pass"},
    )
    run["time_acc"] = ("time_acc", times, {"units": "s", "long_name": "time since the start of the motion"})
    run["channel"] = channels
