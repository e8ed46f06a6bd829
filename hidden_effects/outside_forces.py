"""Causes that no registry of effects holds: forces from outside, a loose weight, edges that change from test to test.

The diagnosis is to call them unknown and to describe them: the form, the block, the time. Nothing here knows the
histories of force that it tries.
"""

from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from effect_forms import with_stops

_RAMP = 0.25  # s, over which a push grows
_STEPS = 5  # of a ramp and of a blow
_LEAST = 0.3  # of the mass of all blocks: a cause on a small block is as large as on a block of that mass
_STRONG = (1, 2)  # tests that are not sealed and in which blocks rock, see the plan
_WEIGHT = "loose-weight"
_PAD, _PAD_MASS, _PAD_SPRING, _PAD_DAMPING = (0.2, 0.1, 0.2), 30.0, 5e6, 1e4  # m, kg, N/m, N s/m


class OutsideKind(NamedTuple):
    """A cause from outside.

    Attributes
    ----------
    form : str
        As a verdict calls it.
    words : str
    ends : dict
        Ends of the values by name.
    act : callable
        Changes an experiment in the test of a number.
    starts : bool
        Whether it starts at a time of its own, not with the test.
    where : str
        ``all`` tests, ``one`` strong test, or one strong test and at times the tests after it: ``since``.
    """

    form: str
    words: str
    ends: dict
    act: Callable
    starts: bool = False
    where: str = "all"


def draw_outside(name, structure, tests, generator):
    """Values, place and times of a cause from outside.

    Parameters
    ----------
    name : str
        Key of `OUTSIDE`.
    structure : Structure
    tests : int
        Their number.
    generator : numpy.random.Generator

    Returns
    -------
    dict
        ``name``, ``values``, ``place`` (a block) and ``size`` as of an effect, and ``start`` by test [s]: None in a
        test that the cause leaves alone.
    """
    kind = OUTSIDE[name]
    values = {key: float(generator.uniform(*ends)) for key, ends in kind.ends.items()}
    values["side"] = float(generator.choice([-1.0, 1.0]))
    bodies = _bodies(name, structure)
    place = {"body": bodies[generator.integers(len(bodies))]}
    if "height" in values:
        values["height"] *= float(_box(structure, place["body"])[2])
    start = generator.uniform(1.5, 3.5, tests).tolist() if kind.starts else [0.0] * tests
    if kind.where != "all":
        first, lasts = int(generator.choice(_STRONG)), kind.where == "since" and generator.random() < 0.5
        start = [
            at if number == first or (lasts and number > first) else None for number, at in enumerate(start)
        ]
    return {"name": name, "values": values, "place": place, "size": None, "start": start}


def _bodies(name, structure):
    """Blocks on which a cause may act.

    A weight lies on the top, a brake needs two free faces across the shaking, what follows the motion acts where there
    is motion, and edges matter where a joint opens: at the blocks that stand on the slab.
    """
    free = [body for body in structure.file.bodies if not body.driven]
    if name == "outside-weight":
        free = free[-1:]
    if name == "outside-dry-drag":
        free = [body for body in free if body.position[1] == 0.0]
    if name in ("outside-rope", "outside-drag", "outside-spring-once"):
        highest = max(body.position[2] for body in free)
        free = [body for body in free if body.position[2] > 0.4 * highest]
    if name == "outside-edge":
        lowest = min(body.position[2] for body in free)
        free = [body for body in free if body.position[2] == lowest]
    return [body.name for body in free]


def _push(experiment, cause, start):
    own = cause["values"]
    part = own["side"] * own["share"] * acting_mass(experiment.structure, cause) * 9.81 / _STEPS
    return _with_forces(
        experiment, cause,
        [{"amplitude": part, "start": start + _RAMP * step / _STEPS} for step in range(_STEPS)],
    )  # fmt: skip


def _blow(experiment, cause, start):
    own = cause["values"]
    step = own["length"] / _STEPS
    heights = np.sin(np.pi * (np.arange(_STEPS) + 0.5) / _STEPS)
    peak = own["side"] * own["speed"] * acting_mass(experiment.structure, cause) / (heights.sum() * step)
    return _with_forces(
        experiment, cause,
        [
            {"amplitude": float(peak * height), "start": start + place * step, "end": start + (place + 1) * step}
            for place, height in enumerate(heights)
        ],
    )  # fmt: skip


def _rope(experiment, cause, start):
    stiffness = cause["values"]["stiffness"] * acting_mass(experiment.structure, cause)
    return _with_forces(experiment, cause, [{"stiffness": stiffness}])


def _drag(experiment, cause, start):
    damping = cause["values"]["damping"] * acting_mass(experiment.structure, cause)
    return _with_forces(experiment, cause, [{"damping": damping}])


def _brake(experiment, cause, start):
    """Two pads on springs of the table, which a force presses on the faces across the shaking."""
    structure, own = experiment.structure, cause["values"]
    index = structure.body_names.index(cause["place"]["body"])
    body = structure.file.bodies[index]
    depth = _box(structure, body.name)[1]
    mapping = structure.file.model_dump(mode="json")
    mapping["shapes"]["pad"] = {"box": list(_PAD)}
    grip = next(item.coefficient for item in structure.file.friction if item.pair == (body.material,) * 2)
    pressed = own["share"] * acting_mass(experiment.structure, cause) * 9.81 / (2.0 * grip)
    for name, side in (("pad-front", -1.0), ("pad-back", 1.0)):
        place = structure.centroid[index] + [0.0, side * 0.5 * (depth + _PAD[1]), own["height"]]
        mapping["bodies"].append(
            {
                "name": name, "shape": "pad", "material": body.material, "position": place.tolist(),
                "density": _PAD_MASS / float(np.prod(_PAD)),
            }
        )  # fmt: skip
        spring = {"body": name, "stiffness": _PAD_SPRING, "damping": _PAD_DAMPING}
        mapping["external_forces"] += [
            {"body": name, "axis": "y", "amplitude": -side * pressed, "damping": _PAD_DAMPING},
            *({**spring, "axis": "x", "position": [0.0, 0.0, end * _PAD[2]]} for end in (-0.5, 0.5)),
            *({**spring, "axis": "z", "position": [end * _PAD[0], 0.0, 0.0]} for end in (-0.5, 0.5)),
        ]
    return replace(experiment, structure=structure.with_mapping(mapping))


def _spring_once(experiment, cause, start):
    own = cause["values"]
    stop = {
        "body": cause["place"]["body"],
        "position": [0.5 * own["side"] * _box(experiment.structure, cause["place"]["body"])[0], 0.0, own["height"]],
        "axis": "+x" if own["side"] > 0.0 else "-x", "gap": own["gap"], "stiffness": own["stiffness"],
    }  # fmt: skip
    return with_stops(experiment, [stop])


def _loose_weight(experiment, cause, start):
    structure = experiment.structure
    index = structure.body_names.index(cause["place"]["body"])
    body = structure.file.bodies[index]
    length, depth, height = _box(structure, body.name)
    edge = min(0.25 * length, 0.2)
    mapping = structure.file.model_dump(mode="json")
    mapping["shapes"][_WEIGHT] = {"box": [2.0 * edge, 0.5 * depth, edge]}
    density = cause["values"]["share"] * structure.mass[index] / (edge * edge * depth)
    place = structure.centroid[index] + [0.0, 0.0, 0.5 * (height + edge)]
    mapping["bodies"].append(
        {
            "name": _WEIGHT,
            "shape": _WEIGHT,
            "material": body.material,
            "position": place.tolist(),
            "density": density,
        }
    )
    mapping["joints"].append({"bodies": [body.name, _WEIGHT], "friction_factor": cause["values"]["grip"]})
    return replace(experiment, structure=structure.with_mapping(mapping))


def _broken_edge(experiment, cause, start):
    """Edges of a block, and of those with it across the shaking, on which it would stand otherwise."""
    file = experiment.structure.file
    bodies = {body.name: body for body in file.bodies}
    at = bodies[cause["place"]["body"]].position
    changed = {}
    for name, body in bodies.items():
        if (body.position[0], body.position[2]) == (at[0], at[2]):
            shape = file.shapes[body.shape]
            worn = {"box": list(shape.box), "chamfer": shape.chamfer + cause["values"]["depth"]}
            changed |= {f"shapes.{name}-broken": worn, f"bodies.{name}.shape": f"{name}-broken"}
    return experiment.with_parameters(**changed)


def _box(structure, name):
    """Lengths of a block's edges [m]."""
    file = structure.file
    return file.shapes[next(body for body in file.bodies if body.name == name).shape].box


def acting_mass(structure, cause):
    """Mass by which a cause is as large as on the two blocks [kg]."""
    own = structure.mass[structure.body_names.index(cause["place"]["body"])]
    return float(max(own, _LEAST * structure.mass[~structure.driven].sum()))


def _with_forces(experiment, cause, forces):
    """External forces at one height of the block."""
    shared = {"body": cause["place"]["body"], "position": [0.0, 0.0, cause["values"]["height"]]}
    return experiment.with_parameters(external_forces=[shared | force for force in forces])


_HEIGHT = {"height": (-0.2, 0.45)}  # of the block's height above its centroid; then in m
OUTSIDE = {
    "outside-push": OutsideKind(
        "push", "a push that grows over 0.25 s and stays", {"share": (0.04, 0.1), **_HEIGHT}, _push, True
    ),
    "outside-blow": OutsideKind(
        "blow", "a blow in one test", {"speed": (0.2, 0.5), "length": (0.04, 0.1), **_HEIGHT}, _blow, True, "one"
    ),
    "outside-rope": OutsideKind(
        "rope", "an elastic rope to the table, taut both ways", {"stiffness": (14.0, 54.0), **_HEIGHT}, _rope
    ),
    "outside-drag": OutsideKind(
        "drag", "a drag by the velocity against the table", {"damping": (1.4, 6.8), **_HEIGHT}, _drag
    ),
    "outside-dry-drag": OutsideKind(
        "dry-drag", "a brake: two pads of the table pressed on the block",
        {"share": (0.03, 0.07), "height": (-0.1, 0.1)}, _brake,
    ),
    "outside-spring-once": OutsideKind(
        "spring-once", "a stop in one test", {"stiffness": (4e6, 1.5e7), "gap": (0.0, 0.012), **_HEIGHT}, _spring_once,
        where="one",
    ),
    "outside-weight": OutsideKind(
        "loose-weight", "a loose weight that slides on the top", {"share": (0.1, 0.25), "grip": (0.1, 0.4)},
        _loose_weight,
    ),
    "outside-edge": OutsideKind(
        "changed-edge", "edges of one block broken in one test or from one test on", {"depth": (0.04, 0.08)},
        _broken_edge, where="since",
    ),
}  # fmt: skip
