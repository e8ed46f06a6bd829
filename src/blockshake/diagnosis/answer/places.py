"""Places of causes, in words and as files have them."""

from blockshake.diagnosis.outside.registry import FORMS
from blockshake.effects.registry import EFFECTS

EVERYWHERE = "all"


def place_name(place):
    """A place in words: body and height, or a joint; ``all`` where the cause is everywhere."""
    if "joint" in place:
        return "-".join(place["joint"])
    return f"{place['body']}@{place['height']:g}" if "height" in place else place.get("body", EVERYWHERE)


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
