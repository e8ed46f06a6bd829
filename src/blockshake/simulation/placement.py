"""Blocks that do not stand exactly where the structure file has them."""

from scipy.spatial.transform import Rotation


def placed(structure, places):
    """Start poses of the free bodies: ``bodies.NAME.position`` and ``bodies.NAME.orientation`` of the structure.

    ``places`` (n_bodies, 3): off the structure file, along x and y [m], turned about z [rad]. Driven bodies stay, and
    so do those behind the last place, which an effect has added.
    """
    poses = {}
    for body, (along_x, along_y, turn) in zip(structure.file.bodies, places, strict=False):
        if body.driven:
            continue
        x, y, z = body.position
        turned = Rotation.from_rotvec([0.0, 0.0, turn]) * Rotation.from_quat(
            body.orientation, scalar_first=True
        )
        poses[f"bodies.{body.name}.position"] = [x + float(along_x), y + float(along_y), z]
        poses[f"bodies.{body.name}.orientation"] = turned.as_quat(scalar_first=True).tolist()
    return poses
