"""Causes that no registry of effects holds: forces from outside, a loose weight, an edge that breaks between two tests.

The diagnosis is to call them unknown and to describe them: the block, the time, the law. Nothing here knows the forms
that it tries.
"""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

_RAMP = 0.25  # s, over which a push grows
_STEPS = 5  # of a ramp and of a blow
_WEIGHT = "loose-weight"


class OutsideKind(NamedTuple):
    """In words, values by name with their ends, and the change of an experiment in the test of a number."""

    words: str
    ends: dict
    act: callable


def draw_outside(name, structure, motions, generator):
    """Values, place and times of a cause from outside.

    Parameters
    ----------
    name : str
        Key of `OUTSIDE`.
    structure : Structure
    motions : int
        Number of tests.
    generator : numpy.random.Generator

    Returns
    -------
    dict
        ``name``, ``values``, ``place`` (a block) and ``size`` as of an effect, and ``start`` by test [s]: None in a
        test that the cause leaves alone.
    """
    free = [body.name for body in structure.file.bodies if not body.driven]
    values = {key: float(generator.uniform(*ends)) for key, ends in OUTSIDE[name].ends.items()}
    values["side"] = float(generator.choice([-1.0, 1.0]))
    place = {"body": free[-1] if name == "outside-weight" else str(generator.choice(free))}
    start = generator.uniform(1.5, 3.5, motions).tolist()
    if name in ("outside-blow", "outside-edge"):
        # in one of the strong tests that are not sealed, see the plan
        only = int(generator.choice([1, 2]))
        start = [at if number == only else None for number, at in enumerate(start)]
    return {"name": name, "values": values, "place": place, "size": None, "start": start}


def _push(experiment, effect, number):
    own, weight = effect["values"], _weight(experiment, effect)
    start, part = effect["start"][number], own["side"] * own["share"] * weight / _STEPS
    return _with_forces(
        experiment, effect,
        [{"amplitude": part, "start": start + _RAMP * step / _STEPS} for step in range(_STEPS)],
    )  # fmt: skip


def _blow(experiment, effect, number):
    own, start = effect["values"], effect["start"][number]
    if start is None:
        return experiment
    step = own["length"] / _STEPS
    heights = np.sin(np.pi * (np.arange(_STEPS) + 0.5) / _STEPS)
    peak = own["side"] * own["impulse"] / (heights.sum() * step)
    return _with_forces(
        experiment, effect,
        [
            {"amplitude": float(peak * height), "start": start + place * step, "end": start + (place + 1) * step}
            for place, height in enumerate(heights)
        ],
    )  # fmt: skip


def _rope(experiment, effect, number):
    return _with_forces(experiment, effect, [{"stiffness": effect["values"]["stiffness"]}])


def _drag(experiment, effect, number):
    return _with_forces(experiment, effect, [{"damping": effect["values"]["damping"]}])


def _loose_weight(experiment, effect, number):
    structure = experiment.structure
    index = structure.body_names.index(effect["place"]["body"])
    body = structure.file.bodies[index]
    length, depth, height = structure.file.shapes[body.shape].box
    edge = 0.25 * length
    mapping = structure.file.model_dump(mode="json")
    mapping["shapes"][_WEIGHT] = {"box": [2.0 * edge, 0.5 * depth, edge]}
    density = effect["values"]["share"] * structure.mass[index] / (edge * edge * depth)
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
    mapping["joints"].append({"bodies": [body.name, _WEIGHT], "friction_factor": effect["values"]["grip"]})
    return replace(experiment, structure=structure.with_mapping(mapping))


def _broken_edge(experiment, effect, number):
    if effect["start"][number] is None:
        return experiment
    file = experiment.structure.file
    body = next(body for body in file.bodies if body.name == effect["place"]["body"])
    shape = file.shapes[body.shape]
    worn = {"box": list(shape.box), "chamfer": shape.chamfer + effect["values"]["depth"]}
    return experiment.with_parameters(
        **{f"shapes.{body.name}-broken": worn, f"bodies.{body.name}.shape": f"{body.name}-broken"}
    )


def _weight(experiment, effect):
    """Weight of the block [N]."""
    structure = experiment.structure
    return float(structure.mass[structure.body_names.index(effect["place"]["body"])]) * 9.81


def _with_forces(experiment, effect, forces):
    """External forces at one height of the block."""
    shared = {"body": effect["place"]["body"], "position": [0.0, 0.0, effect["values"]["height"]]}
    return experiment.with_parameters(external_forces=[shared | force for force in forces])


_HEIGHT = {"height": (-0.3, 0.7)}  # m, above the centroid
OUTSIDE = {
    "outside-push": OutsideKind("a push that grows over 0.25 s and stays", {"share": (0.04, 0.1), **_HEIGHT}, _push),
    "outside-blow": OutsideKind(
        "a blow in one test", {"impulse": (1500.0, 4000.0), "length": (0.04, 0.1), **_HEIGHT}, _blow
    ),
    "outside-rope": OutsideKind(
        "an elastic rope to the table, taut both ways", {"stiffness": (1e5, 4e5), **_HEIGHT}, _rope
    ),
    "outside-drag": OutsideKind("a drag by the velocity against the table", {"damping": (1e4, 5e4), **_HEIGHT}, _drag),
    "outside-weight": OutsideKind(
        "a loose weight that slides on the top", {"share": (0.1, 0.25), "grip": (0.1, 0.4)}, _loose_weight
    ),
    "outside-edge": OutsideKind("edges of one block broken in one test", {"depth": (0.04, 0.08)}, _broken_edge),
}  # fmt: skip
