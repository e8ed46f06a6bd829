"""The mapping of a structure file: parameters replaced in it, names checked, pairs of materials resolved."""

from collections import Counter
from typing import NamedTuple

import numpy as np

from blockshake.errors import InputError
from blockshake.geometry.rotations import rotation_matrices
from blockshake.geometry.schema import AXES, EXTENSION
from blockshake.validation import called

_SHORTEST_WIRE = 1e-3  # m; a shorter one has no direction
_BEHIND = 0.02  # m, by which a face may lie behind the point given of the rod, as blocks out of place make it
# A mast or a bracket of a sensor is shorter than its block; a frame on a slab may be some times as high as wide. Places
# in centimetres or from the structure's origin lie farther off.
_REMARKED, _REFUSED = 0.5, 3.0  # of the body's longest edge


def replace_into(mapping, key, value, source):
    """Set one dotted key of a structure's mapping in place; pairs of materials or bodies in either order.

    Part of a vector goes by its axis, as in ``bodies.NAME.mass_offset.x``. Returns the key by which `validated` names
    the value.

    Raises
    ------
    InputError
        The structure has no such parameter.
    """
    parts = key.removeprefix(EXTENSION).split(".")
    if parts[0] == "friction":
        entry = _entry_of_pair(mapping, "friction", "pair", parts)
        if entry is None:
            raise InputError(
                source,
                key,
                "expected friction.MATERIAL.MATERIAL or friction.MATERIAL.MATERIAL.KEY of a pair in the file",
            )
        name = parts[3] if len(parts) == 4 else "coefficient"
        entry[name] = value
        return f"friction.{called(0, entry)}.{name}"
    if parts[0] == "joints":
        if len(parts) != 4:
            raise InputError(source, key, "expected joints.BODY.BODY.KEY")
        entry = _entry_of_pair(mapping, "joints", "bodies", parts)
        if entry is None:
            # two bodies have a joint whether the file mentions it or not
            entry = {"bodies": parts[1:3]}
            mapping["joints"] = [*mapping.get("joints", ()), entry]
        entry[parts[3]] = value
        return f"joints.{called(0, entry)}.{parts[3]}"
    node = mapping
    for part in parts[:-1]:
        if isinstance(node, list):
            items = [(index, item) for index, item in enumerate(node) if isinstance(item, dict)]
            node = next((item for index, item in items if item.get("name", str(index)) == part), None)
        elif isinstance(node, dict):
            node = node.get(part)
        if not isinstance(node, (dict, list)):
            raise InputError(source, key, f"expected a parameter of this structure; it has no '{part}' here")
    if _is_vector(node) and parts[-1] in AXES:
        axis = AXES.index(parts[-1])
        node[axis] = value
        return ".".join([*parts[:-1], str(axis)])
    if not isinstance(node, dict):
        raise InputError(source, key, "expected a parameter of this structure")
    if parts[0] == "bodies" and parts[-1] == "position":  # no longer laid on another body
        node.pop("on", None), node.pop("offset", None)
    node[parts[-1]] = value
    return ".".join(parts)


def _is_vector(node):
    return (
        isinstance(node, list) and len(node) == len(AXES) and all(type(one) in (int, float) for one in node)
    )


def dotted_values(node, name=""):
    """Every value of a structure's mapping by the dotted name by which `replace_into` sets it."""
    if isinstance(node, dict):
        named = node.items()
    elif _is_vector(node):
        named = zip(AXES, node, strict=True)
    elif isinstance(node, list) and all(isinstance(item, dict) for item in node):
        named = [(called(index, item), item) for index, item in enumerate(node)]
    else:
        return {name: node}
    parts = [dotted_values(value, f"{name}.{key}" if name else key) for key, value in named]
    return {key: value for part in parts for key, value in part.items()}


def _entry_of_pair(mapping, kind, named, parts):
    """Entry of a list whose two names are the second and third part of a key, or None."""
    for entry in mapping.get(kind, ()):
        if (
            len(parts) in (3, 4)
            and isinstance(entry, dict)
            and sorted(entry.get(named, ())) == sorted(parts[1:3])
        ):
            return entry
    return None


def check_names(file, source):
    """Check that names stand once and that what they point at exists, or raise `InputError`."""
    for kind in ("bodies", "markers", "accelerometers", "displacement_transducers"):
        for name, count in Counter(item.name for item in getattr(file, kind)).items():
            if count > 1:
                raise InputError(source, f"{kind}.{name}", "expected every name once")
    bodies = {body.name for body in file.bodies}
    for body in file.bodies:
        for key, known in (("shape", file.shapes), ("material", file.materials)):
            if getattr(body, key) not in known:
                raise InputError(
                    source,
                    f"bodies.{body.name}.{key}",
                    f"expected one of {', '.join(known)}, not '{getattr(body, key)}'",
                )
        if body.driven and any(body.velocity + body.angular_velocity):
            raise InputError(
                source, f"bodies.{body.name}", "expected no velocity of a driven body: it follows the motion"
            )
    for kind in ("stoppers", "external_forces", "markers", "accelerometers", "displacement_transducers"):
        for index, item in enumerate(getattr(file, kind)):
            if item.body not in bodies:
                name = getattr(item, "name", index)
                raise InputError(
                    source, f"{kind}.{name}.body", f"expected a body of this structure, not '{item.body}'"
                )
    joints = set()
    for joint in file.joints:
        key = f"joints.{joint.bodies[0]}.{joint.bodies[1]}"
        for name in joint.bodies:
            if name not in bodies:
                raise InputError(source, key, f"expected two bodies of this structure, not '{name}'")
        pair = frozenset(joint.bodies)
        if len(pair) == 1 or pair in joints:
            raise InputError(source, key, "expected two different bodies, and every joint once")
        joints.add(pair)
    driven = {body.name for body in file.bodies if body.driven}
    for kind in ("external_forces", "stoppers"):
        for index, item in enumerate(getattr(file, kind)):
            if item.body in driven:
                raise InputError(source, f"{kind}.{index}.body", "expected a body that is not driven")
    if file.stoppers and not driven:
        raise InputError(source, "stoppers", "expected a driven body to fix the stoppers to")


def check_transducers(file, orientation, source):
    """Refuse displacement transducers that read nothing, or whose name is another sensor's.

    ``orientation`` (n_bodies, 4): unit quaternions (w, x, y, z), body to world.

    Raises
    ------
    InputError
        A reference that is no other body of the structure; a wire without length; a rod that points away from its face.
    """
    names = [body.name for body in file.bodies]
    taken = {item.name for item in file.markers}
    taken |= {f"{item.name}-{axis}" for item in file.accelerometers for axis in item.axes}
    turn = rotation_matrices(orientation)
    for item in file.displacement_transducers:
        key = f"displacement_transducers.{item.name}"
        if item.name in taken:
            raise InputError(source, key, "expected a name that no marker and no accelerometer channel has")
        if item.reference not in names or item.reference == item.body:
            raise InputError(
                source, f"{key}.reference", f"expected another body of this structure, not '{item.reference}'"
            )
        body, carrier = names.index(item.body), names.index(item.reference)
        gap = file.bodies[body].position + turn[body] @ item.position
        gap -= file.bodies[carrier].position + turn[carrier] @ item.reference_position
        if item.axis is None and np.linalg.norm(gap) < _SHORTEST_WIRE:
            raise InputError(source, f"{key}.reference_position", "expected ends of the wire that lie apart")
        if item.axis is not None and gap @ turn[carrier] @ signed_axis(item.axis) < -_BEHIND:
            raise InputError(
                source,
                f"{key}.axis",
                f"expected a rod that points to its face, which lies against {item.axis}",
            )


def signed_axis(name):
    """Unit vector of a name of `SIGNED_AXES`: float64 array, shape (3,)."""
    return np.where([axis == name[1] for axis in AXES], -1.0 if name[0] == "-" else 1.0, 0.0)


def unit_quaternions(file, source):
    """Orientations of the bodies, normalised: float64 array, shape (n_bodies, 4)."""
    for body in file.bodies:
        if abs(np.linalg.norm(body.orientation) - 1.0) > 1e-3:
            raise InputError(
                source, f"bodies.{body.name}.orientation", "expected a unit quaternion [w, x, y, z]"
            )
    quaternions = np.array([body.orientation for body in file.bodies])
    return quaternions / np.linalg.norm(quaternions, axis=1)[:, None]


def friction_matrix(file, source):
    """Coulomb's coefficient of every pair of bodies, NaN between driven ones; a missing pair is an error."""
    known = {}
    for entry in file.friction:
        for material in entry.pair:
            if material not in file.materials:
                raise InputError(
                    source, "friction", f"expected pairs of this file's materials, not '{material}'"
                )
        key = tuple(sorted(entry.pair))
        if key in known:
            raise InputError(source, f"friction.{entry.pair[0]}.{entry.pair[1]}", "expected every pair once")
        known[key] = entry.coefficient
    # materials in the order of the bodies, so that the pair named first is the first one met
    materials = list(dict.fromkeys(body.material for body in file.bodies))
    material = np.array([materials.index(body.material) for body in file.bodies])
    driven = np.array([body.driven for body in file.bodies])
    together = driven[:, None] & driven[None, :]
    np.fill_diagonal(together, True)
    coefficient = np.full((len(materials), len(materials)), np.nan)
    for a, first in enumerate(materials):
        for b, second in enumerate(materials):
            key = tuple(sorted((first, second)))
            if key in known:
                coefficient[a, b] = known[key]
            elif not together[np.ix_(material == a, material == b)].all():
                raise InputError(
                    source, f"friction.{key[0]}.{key[1]}", "missing; expected a coefficient for this pair"
                )
    return np.where(together, np.nan, coefficient[material[:, None], material[None, :]])


class _Point(NamedTuple):
    key: str
    body: str
    away: float
    edge: float


def check_points(file, solids, source):
    """Refuse points farther off their bodies than three times these bodies' longest edge, with `InputError`.

    ``solids``: `Solid` by shape name.
    """
    for point in _points(file, solids):
        if point.away > _REFUSED * point.edge:
            raise InputError(
                source, point.key,
                f"expected a place near {point.body}, whose longest edge is {point.edge:.3g} m, in its own frame; "
                f"it lies {point.away:.3g} m off",
            )  # fmt: skip


def point_remarks(structure):
    """One sentence for every point that is off its body by more than half of the longest edge; a list of str."""
    return [
        f"{point.key} lies {point.away:.3g} m off {point.body}, whose longest edge is {point.edge:.3g} m"
        for point in _points(structure.file, structure.solids)
        if point.away > _REMARKED * point.edge
    ]


def _points(file, solids):
    """Every point of the file, and how far it lies outside of its body's bounding box [m]."""
    boxes = {
        body.name: (solids[body.shape].vertices.min(axis=0), solids[body.shape].vertices.max(axis=0))
        for body in file.bodies
    }
    named = [
        (f"{kind}.{getattr(item, 'name', index)}.position", item.body, item.position)
        for kind in ("markers", "accelerometers", "displacement_transducers", "stoppers", "external_forces")
        for index, item in enumerate(getattr(file, kind))
    ]
    named += [
        (f"displacement_transducers.{item.name}.reference_position", item.reference, item.reference_position)
        for item in file.displacement_transducers
    ]
    for key, body, position in named:
        low, high = boxes[body]
        outside = np.maximum(np.maximum(low - position, position - high), 0.0)
        yield _Point(key, body, float(np.linalg.norm(outside)), float((high - low).max()))
