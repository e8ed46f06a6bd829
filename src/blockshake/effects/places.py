"""Where an effect may be in a structure: nowhere in particular, a joint, a block or a marker."""

from blockshake.geometry.schema import Joint
from blockshake.measurement.motion.joints import find_joints


def stated_joint(experiment, place):
    """Entry of a joint in the structure of an experiment, defaults where the structure file states nothing."""
    for joint in experiment.structure.file.joints:
        if sorted(joint.bodies) == sorted(place["joint"]):
            return joint
    return Joint(bodies=place["joint"])


def nowhere(structure):
    """The one place of an effect that has none."""
    return [{}]


def joints(structure):
    """Every joint, ``{"joint": [lower, upper]}``."""
    pairs, _ = find_joints(structure)
    names = structure.body_names
    return [{"joint": [names[lower], names[upper]]} for lower, upper in pairs]


def blocks(structure):
    """Every free body, ``{"body": name}``."""
    return [{"body": body.name} for body in structure.file.bodies if not body.driven]


def markers(structure):
    """Every marker, ``{"marker": name}``."""
    return [{"marker": marker.name} for marker in structure.file.markers]


def stops(structure):
    """Both sides of every free body, ``{"body": name, "axis": "+x" or "-x"}``."""
    return [{**place, "axis": axis} for place in blocks(structure) for axis in ("+x", "-x")]


def face_of(seen, place):
    """Index of the face of a joint among those of a seen test."""
    names = seen.structure.body_names
    pair = [names.index(name) for name in place["joint"]]
    return next(
        index for index, face in enumerate(seen.faces) if sorted((face.lower, face.upper)) == sorted(pair)
    )
