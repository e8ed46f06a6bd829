"""The run file: trajectory, audit and readings of one simulation as a Dataset, with every parameter that acted."""

import numpy as np
import xarray as xr

from blockshake.dynamics.system import ENERGY_TERMS
from blockshake.geometry.schema import AXES, QUATERNION
from blockshake.measurement.sensors.accelerometers import accelerometer_channels
from blockshake.measurement.sensors.markers import marker_position
from blockshake.measurement.sensors.transducers import transducer_names
from blockshake.simulation.models import model_of

_TIME = {"units": "s", "long_name": "time since the start of the motion"}
# dimensions, unit and name of the histories of a run file
RUN_HISTORIES = {
    "position": ("time body axis", "m", "mass centre, inertial frame"),
    "orientation": ("time body quaternion", "1", "unit quaternion, body to inertial frame"),
    "velocity": ("time body axis", "m s-1", "velocity of the mass centre, inertial frame"),
    "angular_velocity": ("time body axis", "rad s-1", "angular velocity, inertial frame"),
    "marker_displacement": (
        "time marker axis",
        "m",
        "displacement of the marker since the start, inertial frame",
    ),
    "energy": ("time term", "J", "energy audit of the free bodies"),
    "joint_force": ("time joint axis", "N", "resultant contact force on the upper body"),
}


def histories(table, values):
    """Variables of a Dataset from their values by name and a table such as `RUN_HISTORIES`."""
    return {
        name: (dims.split(), values[name], {"units": units, "long_name": long_name})
        for name, (dims, units, long_name) in table.items()
    }


def run_dataset(structure, rows, start):
    """Rows of a run as the run file's Dataset, without accelerometers and attributes.

    ``start``: positions (1, n_bodies, 3) [m] and orientations (1, n_bodies, 4) at the run's first time, from which the
    markers' displacements count.
    """
    names = structure.body_names
    lower, upper = ([names[body] for body in rows.joints[:, side]] for side in (0, 1))
    markers = structure.file.markers
    moved = marker_position(structure, rows.position, rows.orientation) - marker_position(structure, *start)
    return xr.Dataset(
        histories(RUN_HISTORIES, {**vars(rows), "marker_displacement": moved}),
        coords={
            "time": ("time", rows.time, _TIME),
            "body": names,
            "axis": list(AXES),
            "quaternion": list(QUATERNION),
            "marker": np.array([marker.name for marker in markers], dtype=str),
            "marker_body": ("marker", np.array([marker.body for marker in markers], dtype=str)),
            "term": list(ENERGY_TERMS),
            "lower": ("joint", np.array(lower, dtype=str)),
            "upper": ("joint", np.array(upper, dtype=str)),
        },
    )


def add_accelerometers(run, structure, times, values):
    """Add readings ``accelerometer(time_acc, channel)`` [m/s2] to a run, at their times [s]."""
    described = {"units": "m s-2", "long_name": "specific force along the body's axis, 50 Hz low-pass"}
    run["accelerometer"] = ("time_acc", "channel"), values, described
    run["time_acc"] = "time_acc", times, _TIME
    run["channel"] = accelerometer_channels(structure)


def add_transducers(run, structure, times, values):
    """Add readings ``transducer_displacement(time_acc, transducer)`` [m] to a run, at their times [s]."""
    described = {"units": "m", "long_name": "lengthening of the displacement transducer since the start"}
    run["transducer_displacement"] = ("time_acc", "transducer"), values, described
    run["time_acc"] = "time_acc", times, _TIME
    run["transducer"] = transducer_names(structure)


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
    prefix = model_of(model).prefix
    return acted | {f"{prefix}.{key}": value for key, value in numerical.model_dump().items()}
