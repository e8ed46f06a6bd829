"""Measurements without a shake: readings of a weighing, a slow tilt, a snap release or a jack, and those of causes.

A reading is named by its kind and its place, such as ``("centre", "block-1")``. Forces from outside that belong to the
shaking (a push, a blow, a viscous drag) are not there in a static test.
"""

from typing import NamedTuple

import numpy as np

WEIGHING, TILT, SNAP, JACK, WEDGE = "weighing", "slow tilt", "snap release", "jack", "wedge"
_CENTRE = 2e-3  # m, of a mass centre by load cells of 0.2 % under two supports 1 m apart
_MASS = 0.04  # of a block's: the scatter of densities, Zhou et al. (2023), Table 2; a scale is far better
_ANGLE = 1e-3  # rad, of an inclinometer as a joint opens
_FORCE = 0.01  # of a jack's force, by its load cell
_LAYER = 5e-11  # m3/N, of elastic blocks and of the rotation of a closed joint
# of undamaged blocks, as among the nuisances of the rows: edges alike, edges to one side [m], friction [1]
_EDGES, _SIDE, _SLIDING = 6.7e-3, 1.4e-3, 0.13
_TABLE = 2.5e-11  # rad/(N m), of an undamaged table
_TURN = 1.5e-5  # rad, of the slab's rotation
_PULLED = 0.02  # m, by which a jack or a snap release moves the top


class StaticTest(NamedTuple):
    """A measurement: its kind, in words, and the standard deviation of each of its readings."""

    kind: str
    words: str
    readings: dict


def static_tests(seen, unmoved=()):
    """`StaticTest` of a structure, as of a `ReconstructedTest`; of tilts, releases, pulls and wedges where joints are a
    tree.

    ``unmoved`` are indices of faces that opened in no test, and may be opened by a wedge.
    """
    structure = seen.structure
    found = [
        StaticTest(
            WEIGHING,
            f"weigh {structure.body_names[body]} on two supports",
            {("centre", structure.body_names[body]): _CENTRE, ("mass", structure.body_names[body]): _MASS},
        )
        for body in seen.free
    ]
    for face in seen.faces:
        words = f"push {structure.body_names[face.upper]} with a jack near its bottom until it slides"
        found.append(StaticTest(JACK, words, {("friction", face.name): np.hypot(_SLIDING, _FORCE)}))
    if not seen.tree:
        return found
    lowest = min(range(len(seen.faces)), key=lambda index: _level(seen, index))
    face, weight, height = seen.faces[lowest], _carried(seen, lowest) * 9.81, _centre_above(seen, lowest)
    error = height * _ANGLE
    edges = {
        ("lever", face.name): float(np.hypot(_EDGES, error / np.sqrt(2.0))),
        ("lean", face.name): float(np.hypot(_SIDE, error / np.sqrt(2.0))),
    }
    pull = weight * face.half_width / (2.0 * height)  # N, at the top, as the joint opens
    follows = {("spring", "top"): _FORCE * pull / _PULLED, ("hysteresis", "top"): _FORCE * pull}
    soft = {("layer", face.name): _LAYER}
    for index in unmoved:
        upper, error = seen.faces[index], _centre_above(seen, index) * _ANGLE / np.sqrt(2.0)
        opened = {
            ("lever", upper.name): float(np.hypot(_EDGES, error)),
            ("lean", upper.name): float(np.hypot(_SIDE, error)),
        }
        words = (
            f"weigh {structure.body_names[upper.upper]} by a wedge under each edge until {upper.name} opens"
        )
        found.append(StaticTest(WEDGE, words, opened))
    base = {("base", "slab"): float(np.hypot(_TABLE, _TURN / (weight * face.half_width)))}
    return [
        *found,
        StaticTest(TILT, "tilt the slab slowly to both sides until a joint opens", edges | soft),
        StaticTest(SNAP, "pull the top by 20 mm and release it, to both sides", edges | follows),
        StaticTest(
            JACK,
            "pull the top slowly with a jack by 20 mm and back, to both sides",
            edges | follows | soft | base,
        ),
    ]


def expected_readings(seen, name, place, values):
    """Readings that a cause would make, by name, of those that it changes.

    Parameters
    ----------
    seen : ReconstructedTest
    name : str
        Effect, or form from outside.
    place : dict
        As files have it.
    values : dict of str to float
        Parameters and what else the cause is.
    """
    names, mass, size = seen.structure.body_names, seen.structure.mass, next(iter(values.values()), 0.0)
    body, pair = place.get("body"), sorted(place.get("joint", ()))
    joint = next(
        (face.name for face in seen.faces if sorted((names[face.lower], names[face.upper])) == pair), None
    )
    if name == "eccentricity":
        index = names.index(body)
        over = [
            number for number in range(len(seen.faces)) if seen.tree and index in carried_bodies(seen, number)
        ]
        leans = {
            ("lean", seen.faces[number].name): size * mass[index] / _carried(seen, number) for number in over
        }
        return {("centre", body): size, **leans}
    if name == "loose-weight":
        return {("mass", body): size / mass[names.index(body)]}
    if name == "reduced-bearing":
        return {("lever", face.name): -size for face in seen.faces if joint in (None, face.name)}
    if name == "changed-edge":
        edge = values.get("edge", 0)
        return {("lever", joint): -size * (0.5 if edge else 1.0), ("lean", joint): -0.5 * edge * size}
    changed = {
        "block-mass": (("mass", body), size),
        "stopper-contact": (("spring", "top"), size if values.get("gap", 0.0) < _PULLED else 0.0),
        "weak-joint": (("friction", joint), 1.0 - size),
        "joint-compliance": (("layer", joint), size),
        "base-compliance": (("base", "slab"), size),
        "rope": (("spring", "top"), size),
        "spring-and-damper": (("spring", "top"), size),
        "dry-drag": (("hysteresis", "top"), size),
    }
    return dict([changed[name]]) if name in changed else {}


def distance(test, first, first_errors, second, second_errors):
    """Squared distance of two causes' expected readings in a `StaticTest`, in standard deviations.

    ``first_errors`` and ``second_errors`` are the standard deviations of the readings from those of the causes' sizes.
    """
    total = 0.0
    for reading, deviation in test.readings.items():
        apart = first.get(reading, 0.0) - second.get(reading, 0.0)
        errors = deviation, first_errors.get(reading, 0.0), second_errors.get(reading, 0.0)
        total += apart**2 / sum(error**2 for error in errors)
    return float(total)


def carried_bodies(seen, face):
    """Free bodies that a face of a tree carries."""
    carried = [seen.faces[face].upper]
    for body in carried:
        carried += [one.upper for one in seen.faces if one.lower == body]
    return carried


def _carried(seen, face):
    return float(seen.structure.mass[carried_bodies(seen, face)].sum())


def _centre_above(seen, face):
    """Height of the mass centre of what a face carries above it [m]."""
    bodies = carried_bodies(seen, face)
    mass = seen.structure.mass[bodies]
    return float(mass @ seen.structure.position[bodies, 2] / mass.sum() - _level(seen, face))


def _level(seen, face):
    """Height of the middle of a face at the start [m]."""
    face = seen.faces[face]
    return float(seen.structure.position[face.upper, 2] + face.on_upper[2])
