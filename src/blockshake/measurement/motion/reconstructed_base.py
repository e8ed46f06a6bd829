"""The base's motion in a test: the input of its simulations and what their features are held against."""

import numpy as np

from blockshake.measurement.motion.base_motion import smoothed_base
from blockshake.measurement.motion.body_poses import body_poses, driven_body


def reconstruct_base(test, structure, sensors):
    """`BaseMotion` along x of the driven body's mass centre, from its markers and, where there is one, accelerometer.

    See `smoothed_base`.
    """
    poses = body_poses(test, structure, sensors.marker_noise, asked=structure.driven)
    body = driven_body(structure, poses)
    moved = poses.position[:, body, 0]
    moved = moved - moved[np.isfinite(moved)][0]
    noise = np.sqrt(poses.covariance[body, 0, 0])
    channels = [str(name) for name in test["channel"].values] if "accelerometer" in test else []
    own = [
        f"{sensor.name}-x"
        for sensor in structure.file.accelerometers
        if sensor.body == structure.body_names[body] and f"{sensor.name}-x" in channels
    ]
    time = test["time"].to_numpy()
    if not own:
        return smoothed_base(time, moved, noise)
    readings = test["accelerometer"].transpose("time_acc", "channel").to_numpy()[:, channels.index(own[0])]
    return smoothed_base(
        time, moved, noise, test["time_acc"].to_numpy(), readings, sensors.accelerometer_noise
    )
