"""Tests whose joints move as prescribed: what each joint coordinate must come out as is known."""

from typing import NamedTuple

import numpy as np
import xarray as xr
from scipy.spatial.transform import Rotation

from blockshake.files import load_yaml, shipped
from blockshake.geometry.structure import build_structure
from blockshake.measurement.campaigns.campaign import Sensors
from blockshake.measurement.motion.joints import find_joints
from blockshake.measurement.sensors.instruments import Instruments, observe


def _structure():
    """Configuration 1 with four markers on every block, not on a line, and the slab's spread over it."""
    content = load_yaml(shipped("structures", "configuration-1"))
    places = {
        "slab": [(1.5, 0.0, 0.0), (-1.2, -1.5, 0.05), (1.2, -1.5, 0.05)],
        **{
            f"block-{number}": [(0.4, 0.0, 0.0), (-0.3, -1.2, 0.65), (0.3, -1.2, -0.65), (-0.3, -1.2, -0.65)]
            for number in (1, 2, 3)
        },
    }
    content["markers"] = [
        {"name": f"{body}-{letter}", "body": body, "position": list(place)}
        for body, own in places.items()
        for letter, place in zip("abcd", own, strict=False)
    ]
    return build_structure(content, "configuration-1", ".")


STRUCTURE = _structure()
SENSORS = Sensors()
TIME = np.arange(1201) / 200.0
END = 4.5  # s, from when the base rests


class BaseMotion(NamedTuple):
    """Motion of the slab along x [s, m, m/s, m/s2]."""

    time: np.ndarray
    displacement: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray


def base_motion(time=TIME, size=0.03, frequency=1.5):
    """Base at rest until 0.3 s and from `END` on, in between a sine under a smooth window; exact derivatives."""
    fine = np.linspace(time[0], time[-1], 8 * (len(time) - 1) + 1)
    share = np.clip((fine - 0.3) / (END - 0.3), 0.0, 1.0)
    d = size * np.sin(np.pi * share) ** 4 * np.sin(2.0 * np.pi * frequency * fine)
    v = np.gradient(d, fine)
    a = np.gradient(v, fine)
    return BaseMotion(time, d[::8], v[::8], a[::8])


def moved_run(base, rocking=(), slips=(), edge=(0.38, 0.38), pitch=0.0, yaw=0.0, vertical=0.0, lateral=0.0):
    """Run of configuration 1 with joints that rock about their edges and slip.

    `rocking` and `slips` have one history a joint from below; a positive angle turns about the edge at +edge[0], a
    negative one about -edge[1]. `pitch`, `yaw`, `vertical` and `lateral` are the slab's own, about its mass centre.
    """
    n_times, n_bodies = len(base.time), len(STRUCTURE.mass)
    _, centres = find_joints(STRUCTURE)
    rotvec = np.zeros((n_times, 3))
    rotvec[:, 1], rotvec[:, 2] = pitch, yaw
    turn = Rotation.from_rotvec(rotvec).as_matrix()
    shift = np.zeros((n_times, 3))
    shift[:, 0], shift[:, 1], shift[:, 2] = base.displacement, lateral, vertical
    # every body's map from start to now: x -> turn x + shift
    shift = shift + STRUCTURE.position[0] - turn @ STRUCTURE.position[0]
    position = np.empty((n_times, n_bodies, 3))
    orientation = np.empty((n_times, n_bodies, 4))
    for body in range(n_bodies):
        if body > 0:
            angle = np.broadcast_to(rocking[body - 1] if body <= len(rocking) else 0.0, n_times)
            slip = np.broadcast_to(slips[body - 1] if body <= len(slips) else 0.0, n_times)
            rotvec = np.zeros((n_times, 3))
            rotvec[:, 1] = angle
            own = Rotation.from_rotvec(rotvec).as_matrix()
            pivot = (
                centres[body - 1]
                + np.array([1.0, 0.0, 0.0]) * np.where(angle > 0.0, edge[0], -edge[1])[:, None]
            )
            moved = pivot - np.einsum("tij,tj->ti", own, pivot) + slip[:, None] * [1.0, 0.0, 0.0]
            shift = np.einsum("tij,tj->ti", turn, moved) + shift
            turn = turn @ own
        position[:, body] = turn @ STRUCTURE.position[body] + shift
        orientation[:, body] = Rotation.from_matrix(turn).as_quat()[:, [3, 0, 1, 2]]
    return xr.Dataset(
        {
            "position": (("time", "body", "axis"), position),
            "orientation": (("time", "body", "quaternion"), orientation),
        },
        {"time": base.time},
    )


def seen(run, seed=0, marker_noise=0.0, **faults):
    """Test as read, without noise unless requested."""
    return observe(run, STRUCTURE, Instruments(marker_noise=marker_noise, **faults), seed)


def bump(time, begin, length, size):
    """Half a sine, zero elsewhere."""
    share = (time - begin) / length
    return np.where((share > 0.0) & (share < 1.0), size * np.sin(np.pi * np.clip(share, 0.0, 1.0)), 0.0)


def ramp(time, begin, length, size):
    """Smooth rise by a size."""
    share = np.clip((time - begin) / length, 0.0, 1.0)
    return size * share**2 * (3.0 - 2.0 * share)
