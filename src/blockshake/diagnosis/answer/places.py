"""Places of causes, in words and as files have them."""

import numpy as np

from blockshake.diagnosis.outside.registry import FORMS
from blockshake.effects.registry import EFFECTS

EVERYWHERE = "all"


def place_name(place):
    """A place in words: body and height, or a joint; ``all`` where the cause is everywhere."""
    if "joint" in place:
        return "-".join(place["joint"])
    return f"{place['body']}@{place['height']:g}" if "height" in place else place.get("body", EVERYWHERE)


def unmoved_joints(tests):
    """Indices of the joints whose force some test reads, and that turned, slipped or lifted in none of these."""
    found = []
    for index in range(len(tests[0].faces)):
        read = [seen for seen in tests if np.isfinite(seen.forces.force[:, index]).any()]
        moved = (
            (
                seen.states.edge[:, index].any(),
                seen.states.slip[:, index].any(),
                seen.states.lifted[:, index].any(),
            )
            for seen in read
        )
        if read and not any(map(any, moved)):
            found.append(index)
    return found


def joined_bodies(tests):
    """Sets of names of free bodies whose common joints moved in no seen test: no test tells which a cause acts on."""
    structure, faces = tests[0].structure, tests[0].faces
    groups = [{structure.body_names[body]} for body in tests[0].free]
    for index in unmoved_joints(tests):
        pair = {structure.body_names[faces[index].lower], structure.body_names[faces[index].upper]}
        held = [group for group in groups if group & pair]
        if len(held) > 1:  # the slab is in none
            groups = [group for group in groups if not group & pair] + [set().union(*held)]
    return [group for group in groups if len(group) > 1]


def place_of(cause, name, seen):
    """The place of an effect or a form, as files have it, from its name in words as of `place_name`."""
    structure = seen.structure
    if cause in FORMS:
        joints = {
            face.name: [structure.body_names[face.lower], structure.body_names[face.upper]]
            for face in seen.faces
        }
        if name in joints:
            return {"joint": joints[name]}
        body, _, height = name.rpartition("@")
        return {"body": body, "height": float(height)} if body else {"body": name}
    effect = EFFECTS[cause]
    places = (effect.seen_at or effect.places)(structure)
    return next(place for place in places if place_name(place) == name)
