"""The run file: trajectory, audit and readings of one simulation as a Dataset, with every parameter that acted."""

import numpy as np
import xarray as xr

from blockshake.dynamics.system import ENERGY_TERMS
from blockshake.geometry.schema import AXES, QUATERNION
from blockshake.measurement.sensors.markers import marker_position
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
# dimension, unit and name of the readings of a run file
READINGS = {
    "accelerometer": ("channel", "m s-2", "specific force along the body's axis, 50 Hz low-pass"),
    "transducer_displacement": (
        "transducer",
        "m",
        "lengthening of the displacement transducer since the start",
    ),
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
            "joint": joint_names(lower, upper),
            "lower": ("joint", np.array(lower, dtype=str)),
            "upper": ("joint", np.array(upper, dtype=str)),
        },
    )


def joint_names(lower, upper):
    """Names of joints, ``LOWER-UPPER``, array of str, from those of their bodies."""
    return np.array([f"{one}-{other}" for one, other in zip(lower, upper, strict=True)], dtype=str)


def add_readings(run, name, times, values, sensors):
    """Add the readings ``name(time_acc, sensor)`` of `READINGS`, by the names of their sensors, at their times [s]."""
    dimension, unit, long_name = READINGS[name]
    run[name] = ("time_acc", dimension), values, {"units": unit, "long_name": long_name}
    run["time_acc"] = "time_acc", times, _TIME
    run[dimension] = sensors


def effective_parameters(structure, model, numerical):
    """Every parameter that acted in a run, by dotted name."""
    file = structure.file
    acted = {"gravity": list(file.gravity)}
    acted |= {name: getattr(file, name) for name in ("restitution", "nscd_restitution")}
    acted |= {f"friction.{'.'.join(entry.pair)}": entry.coefficient for entry in file.friction}
    acted |= {
        f"bodies.{body.name}.mass_offset": list(body.mass_offset) for body in file.bodies if not body.driven
    }
    acted |= {f"bodies.{body.name}.inertia": list(body.inertia) for body in file.bodies if body.inertia}
    groups = {f"materials.{name}": material.model_dump() for name, material in file.materials.items()}
    for entry in file.friction:
        groups[f"friction.{'.'.join(entry.pair)}"] = entry.model_dump(exclude={"pair", "coefficient"})
    for joint in file.joints:
        groups[f"joints.{'.'.join(joint.bodies)}"] = joint.model_dump(exclude={"bodies"})
    groups[model_of(model).prefix] = numerical.model_dump()
    return acted | {
        f"{group}.{key}": value for group, values in groups.items() for key, value in values.items()
    }
