"""Blocks bear on less than their whole face: edges worn on all sides, which takes 3 % of the mass at 9 cm."""

from itertools import pairwise

import numpy as np

from blockshake.effects.effect import DesignMatrix, Effect, EffectParameter
from blockshake.effects.places import face_of, joints, nowhere
from blockshake.forces.seen.wrench_histories import edge_inward

_SCALE, _STEP = 0.05, 0.015  # m: of the inset, and of its change from knot to knot
_KNOTS = np.array([0.3, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0]) * 1e-3  # rad, of a law of any shape
_ROLLED, _MOST_ROLLED = 0.02, 1.5  # rad, and share of it, of an edge that rolls
_SMALLEST = 1e-5  # rad


def _act(experiment, values, place):
    worn = _worn(experiment.structure)
    return experiment.with_parameters(
        **{f"shapes.{name}.chamfer": shape.chamfer + values["inset"] for name, shape in worn.items()}
    )


def _worn(structure):
    """Shapes of blocks whose edges wear, by name: boxes of the material that weighs most."""
    file, mass = structure.file, {}
    for body, kilograms, driven in zip(file.bodies, structure.mass, structure.driven, strict=True):
        mass[body.material] = mass.get(body.material, 0.0) + (0.0 if driven else kilograms)
    blocks = max(mass, key=mass.get)  # steel beams keep their edges
    names = sorted({body.shape for body in file.bodies if not body.driven and body.material == blocks})
    return {name: file.shapes[name] for name in names if file.shapes[name].box is not None}


def _columns(seen, place):
    """Edges further in alike at all rotations, edges that roll, and, of one joint, an inset of any shape over rotation.

    The last is a random walk over knots of the rotation: the edge of a worn or crushed block has no simple form.
    """
    faces = [face_of(seen, place)] if place else range(len(seen.faces))
    insets = [seen.rows.along(edge_inward(seen, face)) for face in faces]
    turns = [np.abs(seen.joints.rotation[seen.rows.instant, face]) for face in faces]
    plain = sum(insets)
    # no block is narrower than its edges lie further in
    most = min((0.5 * min(one.box) - one.chamfer for one in _worn(seen.structure).values()), default=np.inf)
    shares = [np.clip(turn / _ROLLED, 0.0, _MOST_ROLLED) for turn in turns]
    rolled = [
        sum(inset * share**power for inset, share in zip(insets, shares, strict=True)) for power in (1, 2)
    ]
    variants = [
        DesignMatrix({"inset": "alike"}, plain[:, None], (_SCALE,), True, most),
        DesignMatrix({"inset": "rolling"}, np.stack([plain, *rolled], axis=1), (_SCALE,) * 3, True, most),
    ]
    if place:
        shape = np.stack([plain, *(plain * ramp for ramp in _ramps(turns[0]))], axis=1)
        scales = (_SCALE,) + (_STEP,) * (len(_KNOTS) - 1)
        variants.append(DesignMatrix({"inset": "by rotation"}, shape, scales, True, most))
    return variants


def _ramps(turn):
    """From knot to knot of the rotation, even in its logarithm: 0 before, 1 after."""
    turn, knots = np.log(np.maximum(turn, _SMALLEST)), np.log(_KNOTS)
    return [np.clip((turn - a) / (b - a), 0.0, 1.0) for a, b in pairwise(knots)]


EFFECT = Effect(
    name="reduced-bearing",
    title="reduced bearing width",
    acts="geometry",
    equation="chamfer of every block + r: it rocks about edges r further in, above g (b - r) / h, and weighs less",
    source="Housner (1963) with the half width b - r",
    parameters=(EffectParameter("inset", "m", "of the edge", 0.0, 0.0, 0.15, 0.06),),
    confused_with=("impact-restitution",),
    distinguished_by="onset of rocking at several intensities; contact prints on the faces",
    places=nowhere,
    act=_act,
    columns=_columns,
    seen_at=lambda structure: [{}, *joints(structure)],
    extends=lambda experiment, values, place: _act(experiment, values, {}),
    reads=lambda values, size, between: {"inset": np.maximum(size, 0.0)},
)
