"""A campaign of two blocks whose solver is a formula: a diagnosis from readings to verdict takes seconds."""

import numpy as np
import xarray as xr
from scipy.spatial.transform import Rotation

from blockshake.dynamics.load_motion import load_motion
from blockshake.effects.effect import Experiment
from blockshake.effects.registry import with_effect
from blockshake.files import write_dataset, write_text
from blockshake.geometry.structure import load_structure
from blockshake.measurement.sensors.instruments import Instruments, observe

DURATION = 2.5  # s
TESTS = {
    "one-100": ("one", 1.0, "fit"),
    "one-150": ("one", 1.5, "sealed"),
    "two-100": ("two", 1.0, "fit"),
}
FREQUENCY = {"one": 1.1, "two": 1.7}  # Hz, of each motion


def prescribed_run(
    structure, motion, model, parameters, time_step, duration, output_rate=200.0, accelerometers=False
):
    """Run of two blocks that rock and slip as the table's displacement states, the more the less friction there is.

    Stands in for `blockshake.simulation.simulate.simulate`: same arguments, same form of the run.
    """
    time = np.arange(round(duration * output_rate) + 1) / output_rate
    table = motion.evaluate(time)
    friction = parameters.get("friction.concrete.concrete", structure.file.friction[0].coefficient)
    weakest = min((joint.friction_factor for joint in structure.file.joints), default=1.0)
    loose = 0.75 / (friction * weakest)
    numerics = 1.05 if model == "ls-dem" else 0.95
    beyond = np.sign(table[:, 0]) * np.maximum(np.abs(table[:, 0]) - 4e-3, 0.0)
    position, orientation = [], []
    for body, place in enumerate(structure.position):
        angle = table[:, 3] + (0.0 if body == 0 else 0.3 * loose * numerics * beyond)
        arm = place - structure.position[0]
        moved = place + table[:, :3]
        moved[:, 0] += np.sin(angle) * arm[2] + 0.05 * body * loose * np.abs(beyond)
        moved[:, 2] += (np.cos(angle) - 1.0) * arm[2] + (0.4 * np.abs(np.sin(angle)) if body else 0.0)
        position.append(moved)
        turned = Rotation.from_rotvec(angle[:, None] * [0.0, 1.0, 0.0]).as_quat()
        orientation.append(turned[:, [3, 0, 1, 2]])
    return xr.Dataset(
        {
            "position": (("time", "body", "axis"), np.stack(position, axis=1)),
            "orientation": (("time", "body", "quaternion"), np.stack(orientation, axis=1)),
        },
        {"time": time},
        {"status": "completed"},
    )


def write_campaign(folder, structure, effect=None):
    """Write a campaign of three tests that `prescribed_run` makes, with an effect in them or none.

    Parameters
    ----------
    folder : Path
    structure : str or path
        Copied into the folder.
    effect : dict, optional
        ``name``, ``values`` and ``place``.
    """
    write_text(folder / "structure.yaml", structure.read_text(encoding="utf-8"))
    time = np.arange(round(DURATION * 200.0) + 1) / 200.0
    for name, frequency in FREQUENCY.items():
        window = np.sin(np.pi * np.clip((time - 0.3) / (DURATION - 1.0), 0.0, 1.0)) ** 2
        rows = zip(time, 1.6 * window * np.sin(2.0 * np.pi * frequency * time), strict=True)
        lines = ["time_s,acceleration_x", *(f"{at:.4f},{value:.6f}" for at, value in rows)]
        write_text(folder / f"{name}.csv", "\n".join(lines) + "\n")
    lines = ["name: tiny", "structure: structure.yaml", "tests:"]
    for seed, (name, (motion, scale, role)) in enumerate(TESTS.items()):
        entry = f"{{name: {name}, file: {name}.nc, motion: {motion}.csv, scale: {scale}, role: {role}}}"
        lines.append(f"  - {entry}")
        built = load_structure(folder / "structure.yaml")
        experiment = Experiment(built, load_motion(folder / f"{motion}.csv", scale), Instruments())
        experiment = with_effect(experiment, **effect) if effect else experiment
        run = prescribed_run(experiment.structure, experiment.motion, "nscd-rigid", {}, None, DURATION)
        write_dataset(folder / f"{name}.nc", observe(run, experiment.structure, experiment.instruments, seed))
    write_text(folder / "campaign.yaml", "\n".join(lines) + "\n")
