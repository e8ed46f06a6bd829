"""The run file: trajectory, audit and readings of one simulation as a Dataset, with every parameter that acted."""

import numpy as np
import xarray as xr

from blockshake.dynamics.system import ENERGY_TERMS
from blockshake.geometry.schema import AXES, QUATERNION
from blockshake.measurement.sensors.accelerometers import accelerometer_channels
from blockshake.measurement.sensors.markers import marker_position
from blockshake.measurement.sensors.transducers import transducer_names
from blockshake.simulation.models import model_of


def run_dataset(structure, rows, start):
    """Rows of a run as the run file's Dataset, without accelerometers and attributes.

    ``start``: positions (1, n_bodies, 3) [m] and orientations (1, n_bodies, 4) at the run's first time, from which the
    markers' displacements count.
    """
    displacement = marker_position(structure, rows.position, rows.orientation) - marker_position(
        structure, *start
    )
    names = structure.body_names
    lower, upper = ([names[body] for body in rows.joints[:, side]] for side in (0, 1))
    markers = np.array([marker.name for marker in structure.file.markers], dtype=str)

    def variable(dims, values, units, long_name):
        return (dims.split(), values, {"units": units, "long_name": long_name})

    return xr.Dataset(
        {
            "position": variable("time body axis", rows.position, "m", "mass centre, inertial frame"),
            "orientation": variable(
                "time body quaternion", rows.orientation, "1", "unit quaternion, body to inertial frame"
            ),
            "velocity": variable(
                "time body axis", rows.velocity, "m s-1", "velocity of the mass centre, inertial frame"
            ),
            "angular_velocity": variable(
                "time body axis", rows.angular_velocity, "rad s-1", "angular velocity, inertial frame"
            ),
            "marker_displacement": variable(
                "time marker axis", displacement, "m", "displacement of the marker since the start, inertial frame",
            ),
            "energy": variable("time term", rows.energy, "J", "energy audit of the free bodies"),
            "joint_force": variable(
                "time joint axis", rows.joint_force, "N", "resultant contact force on the upper body"
            ),
        },
        coords={
            "time": variable("time", rows.time, "s", "time since the start of the motion"),
            "body": names,
            "axis": list(AXES),
            "quaternion": list(QUATERNION),
            "marker": markers,
            "marker_body": ("marker", np.array([marker.body for marker in structure.file.markers], dtype=str)),
            "term": list(ENERGY_TERMS),
            "lower": ("joint", np.array(lower, dtype=str)),
            "upper": ("joint", np.array(upper, dtype=str)),
        },
    )  # fmt: skip


def add_accelerometers(run, structure, times, values):
    """Add readings ``accelerometer(time_acc, channel)`` [m/s2] to a run, at their times [s]."""
    run["accelerometer"] = (
        ("time_acc", "channel"),
        values,
        {"units": "m s-2", "long_name": "specific force along the body's axis, 50 Hz low-pass"},
    )
    run["time_acc"] = ("time_acc", times, {"units": "s", "long_name": "time since the start of the motion"})
    run["channel"] = accelerometer_channels(structure)


def add_transducers(run, structure, times, values):
    """Add readings ``transducer_displacement(time_acc, transducer)`` [m] to a run, at their times [s]."""
    run["transducer_displacement"] = (
        ("time_acc", "transducer"),
        values,
        {"units": "m", "long_name": "lengthening of the displacement transducer since the start"},
    )
    run["time_acc"] = ("time_acc", times, {"units": "s", "long_name": "time since the start of the motion"})
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
