"""One simulation: structure, motion and parameters in, a run Dataset or a run file out."""

import json
from collections.abc import Mapping, Sequence
from numbers import Real
from pathlib import Path
from typing import Any, NamedTuple, overload

import numba
import numpy as np
import xarray as xr

import blockshake
from blockshake.dynamics.baseline import check_window
from blockshake.dynamics.load_motion import MotionSource, load_motion, plain_attributes, provenance
from blockshake.dynamics.motion import GroundMotion, ground_motion
from blockshake.dynamics.system import FINISHED, Status
from blockshake.errors import Argument, InputError
from blockshake.files import AnyPath, history
from blockshake.geometry.structure import Structure, StructureSource, load_structure
from blockshake.measurement.sensors.accelerometers import FINE_RATE
from blockshake.measurement.sensors.markers import RATE
from blockshake.simulation.falling import still_falling
from blockshake.simulation.limits import check_limits, has_fine_record
from blockshake.simulation.models import MODELS, model_of, split_parameters
from blockshake.simulation.run_dataset import add_readings, effective_parameters
from blockshake.simulation.run_parts import RunParts, reduced, write_run
from blockshake.simulation.settling import quiet_until, settling
from blockshake.solvers.checkpoint import KeptRows
from blockshake.sources import kernel_sources, module_sources, source_digest

_WORST_RESIDUAL = 0.05  # a run whose energy audit misses more is not to be trusted


@overload
def simulate(
    structure: StructureSource, motion: MotionSource, model: str, parameters: Mapping[str, Any] | None = None,
    time_step: float | None = None, duration: float | None = None, output_rate: float | None = None,
    accelerometers: bool = True, checkpoint: AnyPath | None = None, scale: float = 1.0,
) -> xr.Dataset: ...  # fmt: skip


@overload
def simulate(
    structure: StructureSource, motion: MotionSource, *, models: Sequence[str],
    parameters: Mapping[str, Any] | None = None, time_step: float | None = None, duration: float | None = None,
    output_rate: float | None = None, accelerometers: bool = True, scale: float = 1.0,
) -> dict[str, xr.Dataset]: ...  # fmt: skip


def simulate(
    structure: StructureSource,
    motion: MotionSource,
    model: str | None = None,
    parameters: Mapping[str, Any] | None = None,
    time_step: float | None = None,
    duration: float | None = None,
    output_rate: float | None = None,
    accelerometers: bool = True,
    checkpoint: AnyPath | None = None,
    scale: float = 1.0,
    models: Sequence[str] | None = None,
) -> xr.Dataset | dict[str, xr.Dataset]:
    """Simulate one structure under one motion, by one model or by several.

    Parameters
    ----------
    structure : Structure, str, path or mapping
        As `blockshake.load_structure` takes it: a shipped name, a file or its content.
    motion : GroundMotion, str, path or mapping of str to array
        As `blockshake.load_motion` takes it: a shipped name, a file or arrays.
    model : str
        ``ls-dem``, ``nscd-rigid``, ``nscd-elastic`` or ``nscd-viscoelastic``.
    parameters : dict of str to value, optional
        By dotted name, physical and numerical; those of the other solver are ignored. A contact stiffness that is
        not given goes with the material and the height of the structure's blocks.
    time_step : float, optional
        [s]; the model's own by default.
    duration : float, optional
        [s]; the motion's by default; the ground rests after the motion's last row.
    output_rate : float, optional
        [Hz]; the optical system's by default. The run ends at its last whole row within the duration.
    accelerometers : bool
        Compute the accelerometer channels, which takes a fine record, and the displacement transducers with them.
    checkpoint : path, optional
        Where a long run is saved every minute, and from where it goes on, bit-identical, if it was cut short.
    scale : float
        Multiplies the motion, not 0 [1].
    models : list of str, optional
        In place of ``model``: several, each once, and no checkpoint.

    Returns
    -------
    xarray.Dataset, or dict of str to xarray.Dataset
        The content of a run file; of ``models`` one by the name of each.

    Raises
    ------
    InputError
        Unknown model or parameter, a structure that is wrong, or a run beyond the limits of `check_run`.

    Examples
    --------
    >>> import blockshake
    >>> runs = blockshake.simulate("my.yaml", "alkion", models=["ls-dem", "nscd-rigid"], duration=0.2)
    >>> for model, run in runs.items():
    ...     print(model, run.attrs["status"], dict(run["position"].sizes))
    ls-dem completed {'time': 41, 'body': 3, 'axis': 3}
    nscd-rigid completed {'time': 41, 'body': 3, 'axis': 3}
    """
    motion = load_motion(motion, scale)
    if models is not None:
        if isinstance(models, str) or model is not None or checkpoint is not None:
            wrong = "expected a list of models, without model and without checkpoint"
            raise InputError(Argument("models"), "", wrong)
        several = {one: model_of(one) for one in models}
        common = parameters, time_step, duration, output_rate, accelerometers
        return {one: simulate(structure, motion, one, *common) for one in several}
    if model is None:
        raise InputError(Argument("model"), "", f"expected one of {', '.join(MODELS)}")
    of = _set_up(structure, motion, model, parameters, time_step, duration, output_rate, accelerometers)
    trajectory = of.solve(checkpoint=checkpoint)
    parts = RunParts(of.structure, of.coarse, of.fine, trajectory)
    _, run = parts.histories()
    times = parts.reading_times()
    if times.size and parts.channels:
        add_readings(run, "accelerometer", times, np.column_stack([*parts.readings()]), parts.channels)
    if times.size and parts.transducers:
        lengthened = np.concatenate([*parts.lengthenings()])
        add_readings(run, "transducer_displacement", times, lengthened, parts.transducers)
    run.attrs = of.attributes(trajectory, parts)
    return run


def simulate_to_file(
    path, structure, motion, model, parameters=None, time_step=None, duration=None, output_rate=None
):
    """Simulate one structure under one motion to a run file, its record on disk as it grows.

    The run goes on from ``PATH.checkpoint`` if it was cut short, with the rows in ``PATH.checkpoint.rows``; both are
    taken away once the run file is whole.

    The file at ``path`` is written whole or not at all, and holds what `simulate`, whose arguments the others are,
    returns, to the bit. Errors are those of `simulate`, and a file that cannot be written.
    """
    of = _set_up(
        structure, motion, model, parameters, time_step, duration, output_rate, accelerometers=True, in_memory=False
    )  # fmt: skip
    checkpoint = Path(f"{path}.checkpoint")
    kept = KeptRows(f"{checkpoint}.rows", lambda rows: reduced(of.structure, rows, of.coarse, of.fine))
    trajectory = of.solve(checkpoint=checkpoint, kept=kept)
    parts = RunParts(of.structure, of.coarse, of.fine, trajectory, kept)
    write_run(path, parts, of.attributes(trajectory, parts))
    checkpoint.unlink(missing_ok=True)
    kept.remove()


def check_run(structure, motion, model, parameters, time_step, duration, output_rate):
    """Refuse a simulation that `simulate`, whose arguments these are, would refuse; nothing is simulated."""
    of = _set_up(structure, motion, model, parameters, time_step, duration, output_rate, accelerometers=True)
    model_of(model).refuse(of.structure, of.numerical)


class _SetUp(NamedTuple):
    """A simulation before its first step; times are ``coarse`` of histories and ``fine`` of accelerometers [s]."""

    structure: Structure
    motion: GroundMotion
    model: str
    numerical: Any
    time_step: float
    output_rate: float
    coarse: np.ndarray
    fine: np.ndarray

    def solve(self, **options):
        """`Trajectory` of the simulation."""
        times = np.union1d(self.coarse, self.fine)
        return model_of(self.model).solve(
            self.structure, self.motion, self.numerical, times, self.time_step, **options
        )

    def attributes(self, trajectory, parts):
        """Attributes of the run file, from how the run ended and its `RunParts`."""
        file, motion, residual = self.structure.file, self.motion, parts.energy_residual()
        status, reason = trajectory.status, trajectory.reason
        if status is Status.COMPLETED:
            last = (
                part[-1]
                for part in (trajectory.position, trajectory.orientation, trajectory.angular_velocity)
            )
            falls = still_falling(self.structure, *last)
            if falls:
                status = Status.FALLING
                reason = f"{falls} still falls at {trajectory.end_time:.3f} s, when the window ends"
        if status in FINISHED and residual > _WORST_RESIDUAL:
            reason = f"the energy audit misses {residual:.0%} of the energy in play: take a smaller time step; {reason}"
            status, reason = Status.NOT_CONVERGED, reason.removesuffix("; ")
        at_rest = parts.row_at(quiet_until(self.structure, motion))
        settled = settling(self.structure, at_rest.position[0], at_rest.orientation[0])
        if status in FINISHED and settled:
            reason = "; ".join(filter(None, (reason, settled)))
        return {
            "Conventions": "CF-1.11",
            "title": f"{file.name} under {motion.name}, {self.model}",
            "model": self.model,
            "structure": file.name,
            "motion": motion.name,
            "status": str(status),
            "reason": reason,
            "settled": settled,
            "end_time": trajectory.end_time,
            "energy_residual": residual,
            "time_step": self.time_step,
            "output_rate": self.output_rate,
            "seed": "none: a run is deterministic",
            "structure_file": file.model_dump_json(),
            "motion_scale": 1.0,
            "motion_synthetic": 0,
            **{f"motion_{name}": value for name, value in plain_attributes(motion.attributes).items()},
            "parameters": json.dumps(
                effective_parameters(self.structure, self.model, self.numerical), sort_keys=True
            ),
            **{f"numerics_{name}": value for name, value in trajectory.numerics.items()},
            "blockshake_version": blockshake.__version__,
            "source_digest": source_digest(*module_sources("simulation/simulate.py", self.model)),
            "history": history(
                motion.attributes.get("history"),
                f"simulate: {file.name} under {motion.name} of {provenance(motion.attributes)}",
            ),
        }


def _set_up(
    structure, motion, model, parameters, time_step, duration, output_rate, accelerometers, in_memory=True
):
    """`_SetUp` from the arguments of `simulate`."""
    solver = model_of(model)
    physical, _ = split_parameters(parameters or {}, model)
    built = load_structure(structure, physical)
    numerical = split_parameters(solver.stiffness_of(built) | (parameters or {}), model)[1]
    motion = load_motion(motion)
    try:
        motion.name.encode()
    except UnicodeEncodeError:  # a run file holds it
        raise InputError(Argument("motion"), motion.name, "expected a name in UTF-8") from None
    _check_start(built, motion)
    time_step = solver.time_step if time_step is None else time_step
    duration = motion.duration if duration is None else duration
    output_rate = RATE if output_rate is None else output_rate
    for name, value in (("time_step", time_step), ("duration", duration), ("output_rate", output_rate)):
        if not isinstance(value, Real):
            raise InputError(Argument(name), "", f"expected a number, not {value!r}")
    fine = np.empty(0)
    sensed = accelerometers and has_fine_record(built)
    check_limits(built, model, time_step, duration, output_rate, sensed, in_memory)
    check_window(motion, duration, Argument("duration"), "")
    coarse = np.arange(int(np.floor(duration * output_rate + 1e-9)) + 1) / output_rate
    if sensed:
        fine = np.arange(int(np.floor(duration * FINE_RATE + 1e-9)) + 1) / FINE_RATE
    return _SetUp(built, motion, model, numerical, time_step, output_rate, coarse, fine)


def _check_start(structure, motion):
    """Refuse a pitch that does not begin at 0 where no common turn of the table and all that stands on it is meant."""
    driven = np.flatnonzero(structure.driven)
    if motion.first_pitch != 0.0 and len(driven) > 1:
        first, second, *_ = (structure.body_names[body] for body in driven)
        wrong = (
            f"expected a pitch that begins at 0, as {first} and {second} turn each about its own mass centre"
        )
        raise InputError(motion.name, "pitch_y", wrong)


def compile_kernels(model):
    """Run a solver for a moment; the model and the digests of its compiled kernels are returned, JSON-like."""
    still = ground_motion("rest", np.array([0.0, 0.1]), {"x": np.zeros(2)}, "acceleration")
    simulate("configuration-1", still, model, duration=0.01)
    return {"model": model, "kernels": source_digest(*kernel_sources(model)), "numba": numba.__version__}
