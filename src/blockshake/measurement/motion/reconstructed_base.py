"""The base's motion in a test: what the features of simulated and measured tests are held against."""

from blockshake.measurement.motion.base_motion import smoothed_base
from blockshake.measurement.motion.base_readings import base_accelerometer, base_coordinates


def reconstruct_base(test, structure, sensors):
    """`BaseMotion` along x of the driven body's mass centre, from its markers and, where there is one, accelerometer.

    See `smoothed_base`.
    """
    values, noise = base_coordinates(test, structure, sensors)
    read = test["time"].to_numpy(), values[:, 0], noise[0]
    channel = base_accelerometer(test, structure, "x")
    return (
        smoothed_base(*read)
        if channel is None
        else smoothed_base(*read, *channel, sensors.accelerometer_noise)
    )
