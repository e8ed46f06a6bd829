"""A block meets a stop of the retaining frame that the model leaves out."""

import numpy as np

from blockshake.effects.effect import DesignMatrix, Effect, EffectParameter
from blockshake.effects.places import blocks, stops
from blockshake.forces.seen.point_rows import point_rows

_SCALE = 1e7  # N/m
_GAP_STEP = 0.002  # m
_GAPS = np.concatenate([[0.002, 0.004], np.arange(0.006, 0.0601, _GAP_STEP)])  # m
_NEVER = 1e3  # m, gap of no stop
_HEIGHTS = (0.0, 0.5)  # of the stop above the mass centre, over the block's height


def _act(experiment, values, place):
    structure = experiment.structure
    body = structure.file.bodies[structure.body_names.index(place["body"])]
    corner = structure.solids[body.shape].vertices.max(axis=0)  # from the centroid, as the file counts
    side = 1.0 if place["axis"] == "+x" else -1.0
    stop = {
        "body": place["body"],
        "position": [side * float(corner[0]), 0.0, float(corner[2])],
        "axis": place["axis"],
        "gap": values["gap"],
        "stiffness": values["stiffness"],
    }
    present = [stopper.model_dump() for stopper in structure.file.stoppers]
    return experiment.with_parameters(stoppers=[*present, stop])


def _seen_at(structure):
    return [{**place, "height": height} for place in blocks(structure) for height in _HEIGHTS]


def _columns(seen, place):
    """Springs beyond a gap on either side, all gaps of one side first."""
    point = point_rows(seen, place["body"], place["height"])
    return [
        DesignMatrix(
            {"gap": float(gap), "side": side}, spring_rows(point, side, gap)[:, None], (_SCALE,), True
        )
        for side in (1, -1)
        for gap in _GAPS
    ]


def spring_rows(point, side, gap):
    """Rows of a spring of 1 N/m that a point meets beyond a gap towards a side of x, through the kernel."""
    closure = np.maximum(side * point.fine - gap, 0.0)
    return -side * point.unit * point.through_kernel(closure)


def _variant(seen, place, values):
    point = point_rows(seen, place["body"], place["height"])
    return np.stack([spring_rows(point, int(side), gap) for side, gap in values["gaps"].items()], axis=1)


def _reads(values, size, between):
    """Stiffness and gap of the stop, or of the nearer of two; ``side`` of it, and ``other_gap`` of the other."""
    near, *other = sorted(values["gaps"], key=values["gaps"].get)
    return {
        "stiffness": np.maximum(size, 0.0),
        "gap": values["gaps"][near] + _GAP_STEP * between,
        "side": float(near),
        "other_gap": values["gaps"][other[0]] if other else _NEVER,
    }


def _extends(experiment, values, place):
    for side, gap in ((values["side"], values["gap"]), (-values["side"], values["other_gap"])):
        if gap < _NEVER:
            axis = "+x" if side > 0.0 else "-x"
            stop = {"stiffness": values["stiffness"], "gap": gap}
            experiment = _act(experiment, stop, {"body": place["body"], "axis": axis})
    return experiment


EFFECT = Effect(
    name="stopper-contact",
    title="contact with a stop",
    acts="force",
    equation="force = k max(0, u - g) against u, at the top of the block's side",
    source="one-sided linear spring, by definition",
    parameters=(
        EffectParameter("stiffness", "N/m", "of the stop", 0.0, 0.0, 3e7, 1e7),
        EffectParameter("gap", "m", "clearance at the start", 0.02, 0.002, 0.06, 0.015),
    ),
    confused_with=("eccentricity",),
    distinguished_by="accelerometer on the block: spikes at the same displacement",
    places=stops,
    act=_act,
    columns=_columns,
    seen_at=_seen_at,
    variant=_variant,
    reads=_reads,
    extends=_extends,
)
