"""One simulation: structure, motion and parameters in, a run Dataset out."""

import json

import numpy as np

import blockshake
from blockshake.dynamics.load_motion import load_motion
from blockshake.dynamics.motion import GroundMotion
from blockshake.dynamics.system import FINISHED, Status
from blockshake.errors import InputError
from blockshake.geometry.overlap import penetration_depth
from blockshake.geometry.rotations import rotate_into
from blockshake.geometry.structure import START_TOLERANCE, load_structure
from blockshake.measurement.sensors.accelerometers import FINE_RATE
from blockshake.measurement.sensors.markers import RATE
from blockshake.simulation.energy_residual import energy_residual
from blockshake.simulation.models import model_of, split_parameters
from blockshake.simulation.run_dataset import (
    add_accelerometers,
    add_transducers,
    effective_parameters,
    plain_attribute,
    run_dataset,
)
from blockshake.sources import module_sources, source_digest

_LONGEST_STEP = 0.01  # s
_WORST_RESIDUAL = 0.05  # a run whose energy audit misses more is not to be trusted


def simulate(
    structure,
    motion,
    model,
    parameters=None,
    time_step=None,
    duration=None,
    output_rate=None,
    accelerometers=True,
    checkpoint=None,
):
    """Simulate one structure under one motion.

    Parameters
    ----------
    structure : Structure, str or path
        Loaded; or a shipped name or file.
    motion : GroundMotion, str or path
        Already scaled; or a shipped name or file.
    model : str
        One of `blockshake.simulation.models.MODELS`.
    parameters : dict of str to value, optional
        By dotted name, physical and numerical; those of the other solver are ignored. A contact stiffness that is
        not given goes with the material and the height of the structure's blocks.
    time_step : float, optional
        [s]; the model's own by default.
    duration : float, optional
        [s]; the motion's by default; the ground rests after the motion's last row.
    output_rate : float, optional
        [Hz]; the optical system's by default.
    accelerometers : bool
        Compute the accelerometer channels, which takes a fine record, and the displacement transducers beside them.
    checkpoint : path, optional
        Where a long run is saved every minute, and from where it goes on, bit-identical, if it was cut short.

    Returns
    -------
    xarray.Dataset
        The content of a run file.

    Raises
    ------
    InputError
        Unknown model or parameter, or a structure that is wrong.
    """
    solver = model_of(model)
    physical, _ = split_parameters(parameters or {}, model)
    built = load_structure(structure, physical)
    numerical = split_parameters(solver.stiffness_of(built) | (parameters or {}), model)[1]
    motion = motion if isinstance(motion, GroundMotion) else load_motion(motion)
    _check_start(built, motion)
    time_step = solver.time_step if time_step is None else time_step
    duration = motion.duration if duration is None else duration
    output_rate = RATE if output_rate is None else output_rate
    for name, value in (("time step", time_step), ("duration", duration), ("output rate", output_rate)):
        if not (np.isfinite(value) and value > 0.0):
            raise InputError(f"--{name.replace(' ', '-')}", "", f"expected a positive number, not {value}")
    if time_step > _LONGEST_STEP:
        raise InputError(
            "--time-step", "", f"expected at most {_LONGEST_STEP:g} s, not {time_step:g}: impacts last less"
        )
    coarse = np.arange(int(np.floor(duration * output_rate + 1e-9)) + 1) / output_rate
    fine = np.empty(0)
    if accelerometers and (built.file.accelerometers or built.file.displacement_transducers):
        fine = np.arange(int(np.floor(duration * FINE_RATE + 1e-9)) + 1) / FINE_RATE
    times = np.union1d(coarse, fine)
    trajectory = solver.solve(built, motion, numerical, times, time_step, checkpoint=checkpoint)
    run = run_dataset(built, trajectory, np.searchsorted(times, coarse))
    if fine.size:
        rows = np.searchsorted(times, fine)
        if built.file.accelerometers:
            add_accelerometers(run, built, trajectory, rows)
        if built.file.displacement_transducers:
            add_transducers(run, built, trajectory, rows)
    status, reason, residual = trajectory.status, trajectory.reason, energy_residual(trajectory.energy)
    if status in FINISHED and residual > _WORST_RESIDUAL:
        reason = f"the energy audit misses {residual:.0%} of the energy in play: take a smaller time step; {reason}"
        status, reason = Status.NOT_CONVERGED, reason.removesuffix("; ")
    run.attrs = {
        "Conventions": "CF-1.11",
        "title": f"{built.file.name} under {motion.name}, {model}",
        "model": model,
        "structure": built.file.name,
        "motion": motion.name,
        "status": str(status),
        "reason": reason,
        "end_time": trajectory.end_time,
        "energy_residual": residual,
        "time_step": time_step,
        "output_rate": output_rate,
        "seed": "none: a run is deterministic",
        "structure_file": built.file.model_dump_json(),
        "motion_scale": 1.0,
        "motion_synthetic": 0,
        **{f"motion_{name}": plain_attribute(value) for name, value in motion.attributes.items()},
        "parameters": json.dumps(effective_parameters(built, model, numerical), sort_keys=True),
        **{f"numerics_{name}": value for name, value in trajectory.numerics.items()},
        "blockshake_version": blockshake.__version__,
        "source_digest": source_digest(*module_sources("simulation/simulate.py", model)),
        "history": "made by blockshake simulate",
    }
    return run


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
            if depth > START_TOLERANCE:
                name = structure.body_names[body]
                raise InputError(
                    motion.name,
                    "pitch_y",
                    f"its first value pushes the slab {1e3 * depth:.2g} mm into {name}",
                )
