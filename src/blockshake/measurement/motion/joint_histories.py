"""Histories of every joint and of the base in a test, measured or simulated, from the markers in the same way."""

import numpy as np

from blockshake.geometry.rotations import rotation_matrices
from blockshake.measurement.motion.body_poses import POSE, body_poses, driven_body
from blockshake.measurement.motion.joint_coordinates import find_joints, joint_coordinates

_STILL = 5.0  # standard deviations of the base's displacement that it stays within while it is taken as still
_LONGEST_STILL = 1.0  # s


def joint_histories(test, structure, sensors, base=None):
    """Slip, opening and rotation of every joint, the motion of the base and of every body, with their noise.

    Parameters
    ----------
    test : xarray.Dataset
        As in a campaign's test file; a simulated run comes through `observe`.
    structure : Structure
        The campaign's, for a simulated run too, whatever was varied in it.
    sensors : Sensors
        Of the measured test, for a simulated one too.
    base : BaseMotion
        From `reconstruct_base` of the measured test, for a simulated one too: the same input.

    Returns
    -------
    xarray.Dataset
        ``slip(time, joint, tangent)``, ``opening(time, joint)`` [m] and ``rotation(time, joint, axis)`` [rad] as in
        `joint_coordinates`; ``base_displacement(time, axis)`` [m], inertial frame, and ``base_rotation(time, axis)``
        [rad] of the driven body's mass centre; ``body_displacement(time, body, axis)`` [m] and
        ``body_rotation(time, body, axis)`` [rad] against the driven body, in its frame. Each has ``NAME_noise``, the
        standard deviation of one value from the markers' noise, without the time. ``displacement``, ``velocity`` and
        ``acceleration(time)`` of the base along x as given. ``accelerometer(time_acc, channel)`` [m/s2], less its mean
        while the base was still. Coordinate ``known(body)`` as in `body_poses`, ``height(body)`` of
        the mass centres at the start [m], ``upper(joint)``, ``channel_body`` and ``channel_axis(channel)``.

    Notes
    -----
    Markers count from their mean while the base was still (its displacement within five standard deviations, at most
    1 s), not from the first reading alone, whose error would shift everything. NaN where a body was not read; a
    joint of a body whose rotation nobody can know is NaN throughout, and of a planar one the rotations about x and z.
    A direction that the markers of a body do not measure is NaN, of that body and of its joints; the others are found
    as if nothing moved along it, which errs by the products of small motions.
    With markers on a line a yaw of the table shows as a slip: it cannot be told from one.
    """
    time = test["time"].to_numpy()
    still = np.ones(len(time), dtype=bool) if base is None else _still_times(time, base, sensors.marker_noise)
    counted = test if base is None else _from_rest(test, still)
    poses = body_poses(counted, structure, sensors.marker_noise)
    driven = driven_body(structure, poses)
    # joint_coordinates counts from its first time: give it the mean pose of the structure file
    position = np.concatenate([structure.position[None], poses.position])
    rotation = np.concatenate([rotation_matrices(structure.orientation)[None], poses.rotation])
    histories = joint_coordinates(structure, position, rotation).isel(time=slice(1, None))
    against, turned = _against(position, rotation, driven)
    at_rest = rotation_matrices(structure.orientation[driven])
    histories = histories.assign(
        base_displacement=(("time", "axis"), poses.position[:, driven] - structure.position[driven], {"units": "m"}),
        base_rotation=(("time", "axis"), _small_rotation(poses.rotation[:, driven] @ at_rest.T), {"units": "rad"}),
        body_displacement=(("time", "body", "axis"), against, {"units": "m"}),
        body_rotation=(("time", "body", "axis"), turned, {"units": "rad"}),
    )  # fmt: skip
    whole = np.array([known == POSE for known in poses.known])
    pairs = find_joints(structure)[0]
    known_joints = whole[pairs].all(axis=1)
    histories["base_rotation"][:] = np.where(whole[driven], histories["base_rotation"], np.nan)
    # what a planar pose takes as none is not known
    for name, told in (("rotation", known_joints), ("body_rotation", whole & whole[driven])):
        histories[name][..., [0, 2]] = np.where(told[:, None], histories[name][..., [0, 2]], np.nan)
    _leave_unmeasured(histories, poses.told, driven, pairs)
    for name in ("displacement", "velocity", "acceleration") if base is not None else ():
        histories[name] = ("time", getattr(base, name)[: len(time)])
    histories = histories.assign(_noise(structure, poses, driven, 1.0 + 1.0 / max(still.sum(), 1)))
    if base is not None and "accelerometer" in test:
        force = test["accelerometer"].transpose("time_acc", "channel")
        before = test["time_acc"].to_numpy() <= time[still][-1] + 1e-9
        carriers = {
            f"{item.name}-{axis}": (item.body, axis)
            for item in structure.file.accelerometers
            for axis in item.axes
        }
        bodies, axes = zip(
            *[carriers.get(str(name), ("", "")) for name in test["channel"].values], strict=True
        )
        histories["accelerometer"] = force - force.isel(time_acc=before).mean("time_acc")
        histories = histories.assign_coords(
            channel_body=("channel", list(bodies)), channel_axis=("channel", list(axes))
        )
    return histories.assign_coords(
        time=("time", time, {"units": "s"}), body=structure.body_names, known=("body", poses.known),
        height=("body", structure.position[:, 2]),
    )  # fmt: skip


def _leave_unmeasured(histories, told, driven, pairs):
    """Make displacements missing along directions that the bodies' markers do not tell; ``told`` (n_bodies, 3)."""
    of_joints = told[pairs].all(axis=1)
    for name, known in (
        ("slip", of_joints[:, :2]),
        ("opening", of_joints[:, 2]),
        ("base_displacement", told[driven]),
        ("body_displacement", told & told[driven]),
    ):
        histories[name][:] = np.where(known, histories[name], np.nan)


def _from_rest(test, still):
    """The test with every marker's displacement counted from its mean at these times, where it has one."""
    displacement = test["marker_displacement"]
    rest = displacement.isel(time=still).mean("time")
    return test.assign(marker_displacement=displacement - rest.fillna(0.0))


def _still_times(time, base, noise):
    """Leading times at which the base has not moved yet; the first one always."""
    moving = np.abs(base.displacement[: len(time)]) > _STILL * noise
    end = int(np.argmax(moving)) if moving.any() else len(time)
    still = np.zeros(len(time), dtype=bool)
    still[: max(end, 1)] = True
    return still & (time <= time[0] + _LONGEST_STILL)


def _against(position, rotation, driven):
    """Displacement and rotation of all bodies in the driven body's frame since the first row, without that row."""
    inverse = rotation[:, driven].transpose(0, 2, 1)
    seen = np.einsum("tij,tbj->tbi", inverse, position - position[:, driven, None])
    turned = inverse[:, None] @ rotation
    return seen[1:] - seen[:1], _small_rotation(turned[1:] @ turned[0].transpose(0, 2, 1))


def _small_rotation(matrices):
    """Skew part of rotation matrices, shape (..., 3): the rotation vector to third order [rad]."""
    return 0.5 * np.stack(
        [
            matrices[..., 2, 1] - matrices[..., 1, 2],
            matrices[..., 0, 2] - matrices[..., 2, 0],
            matrices[..., 1, 0] - matrices[..., 0, 1],
        ],
        axis=-1,
    )


def _noise(structure, poses, driven, shared):
    """Standard deviations by first-order propagation of the poses' covariances; ``shared`` adds the reference's."""
    pairs, centres = find_joints(structure)
    bodies = np.arange(len(structure.mass))
    turns = rotation_matrices(structure.orientation)

    def relative(lower, upper, point):
        own = _at_point(poses.covariance[upper], point - structure.position[upper])
        other = _at_point(poses.covariance[lower], point - structure.position[lower])
        turn = np.kron(np.eye(2), turns[lower].T)
        # of one body against itself: nothing
        return np.zeros(6) if lower == upper else np.sqrt(shared * np.diag(turn @ (own + other) @ turn.T))

    of_joints = np.array([relative(*pair, centre) for pair, centre in zip(pairs, centres, strict=True)])
    of_bodies = np.array([relative(driven, body, structure.position[body]) for body in bodies])
    of_base = np.sqrt(shared * np.diag(poses.covariance[driven]))
    return {
        "slip_noise": (("joint", "tangent"), of_joints[:, :2]),
        "opening_noise": ("joint", of_joints[:, 2]),
        "rotation_noise": (("joint", "axis"), of_joints[:, 3:]),
        "base_displacement_noise": ("axis", of_base[:3]),
        "base_rotation_noise": ("axis", of_base[3:]),
        "body_displacement_noise": (("body", "axis"), of_bodies[:, :3]),
        "body_rotation_noise": (("body", "axis"), of_bodies[:, 3:]),
    }


def _at_point(covariance, arm):
    """Covariance of the displacement of a body's point and of its rotation, (6, 6)."""
    x, y, z = arm
    change = np.eye(6)
    change[:3, 3:] = -np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return change @ covariance @ change.T
