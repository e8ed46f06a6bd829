"""The mapping of a structure file: parameters replaced in it, names checked, pairs of materials resolved."""

import numpy as np

from blockshake.errors import InputError


def replace_into(mapping, key, value, source):
    """Set one dotted key of a structure's mapping in place; friction pairs in either order.

    Raises
    ------
    InputError
        The structure has no such parameter.
    """
    parts = key.split(".")
    if parts[0] == "friction":
        for entry in mapping.get("friction", []):
            if (
                len(parts) == 3
                and isinstance(entry, dict)
                and sorted(entry.get("pair", ())) == sorted(parts[1:])
            ):
                entry["coefficient"] = value
                return
        raise InputError(source, key, "expected friction.MATERIAL.MATERIAL of a pair in the file")
    place = mapping
    for part in parts[:-1]:
        if isinstance(place, list):
            items = [(index, item) for index, item in enumerate(place) if isinstance(item, dict)]
            place = next((item for index, item in items if item.get("name", str(index)) == part), None)
        elif isinstance(place, dict):
            place = place.get(part)
        if not isinstance(place, (dict, list)):
            raise InputError(source, key, f"expected a parameter of this structure; it has no '{part}' here")
    if not isinstance(place, dict):
        raise InputError(source, key, "expected a parameter of this structure")
    place[parts[-1]] = value


def check_names(file, source):
    """Check that names stand once and that what they point at exists, or raise `InputError`."""
    for kind in ("bodies", "markers", "accelerometers"):
        names = [item.name for item in getattr(file, kind)]
        for name in names:
            if names.count(name) > 1:
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
    for kind in ("stoppers", "markers", "accelerometers"):
        for index, item in enumerate(getattr(file, kind)):
            if item.body not in bodies:
                name = getattr(item, "name", index)
                raise InputError(
                    source, f"{kind}.{name}.body", f"expected a body of this structure, not '{item.body}'"
                )
    if file.stoppers and not any(body.driven for body in file.bodies):
        raise InputError(source, "stoppers", "expected a driven body to fix the stoppers to")


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
    n_bodies = len(file.bodies)
    friction = np.full((n_bodies, n_bodies), np.nan)
    for a, body_a in enumerate(file.bodies):
        for b, body_b in enumerate(file.bodies):
            if a == b or (body_a.driven and body_b.driven):
                continue
            key = tuple(sorted((body_a.material, body_b.material)))
            if key not in known:
                raise InputError(
                    source, f"friction.{key[0]}.{key[1]}", "missing; expected a coefficient for this pair"
                )
            friction[a, b] = known[key]
    return friction
