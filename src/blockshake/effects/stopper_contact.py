"""A block meets a stop of the retaining frame that the model leaves out."""

from blockshake.effects.effect import Effect, EffectParameter, Signature
from blockshake.effects.places import stops


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
    signature=Signature("displacement", "one-sided", "block"),
    confused_with=("eccentricity",),
    told_apart_by="accelerometer on the block: spikes at the same displacement",
    places=stops,
    act=_act,
)
