"""A weight that lies loose on the top block: it presses, slides by Coulomb's law, and drags."""

from dataclasses import replace

import numpy as np
from scipy.ndimage import gaussian_filter1d

from blockshake.diagnosis.evidence.explanation import best_of
from blockshake.diagnosis.outside.form import LoadShape
from blockshake.effects.effect import DesignMatrix
from blockshake.forces.seen.wrench_histories import force_at

_GRIPS = (0.05, 0.1, 0.2, 0.3)  # coefficients of friction; one that holds is mass of the block
_SHARE_SCALE = 0.2  # of the block's mass


def explain_loose_weight(likelihood, tests, place, body):
    """`Explanation` of a weight on the top of a body."""
    scale = _SHARE_SCALE * tests[0].seen.structure.mass[body]
    variants = [
        [
            DesignMatrix({"grip": grip}, _rows(test.seen, body, grip)[:, None], (scale,), True)
            for test in tests
        ]
        for grip in _GRIPS
    ]
    return best_of(likelihood, "loose-weight", place, variants)


def _rows(seen, body, grip):
    """Rows of a weight of 1 kg."""
    motion = seen.motion
    axes = np.nan_to_num(motion.rotation[:, body])
    along, up = axes[..., 0], axes[..., 2]
    solid = seen.structure.solids[seen.structure.file.bodies[body].shape]
    top = 0.5 * float(np.ptp(solid.vertices[:, 2]))
    force = motion.acceleration[:, body] - np.array(seen.structure.file.gravity)
    force = force + np.cross(motion.angular_acceleration[:, body], top * up)
    demand, pressed = (
        np.nan_to_num((force * along).sum(axis=1)),
        np.nan_to_num((force * up).sum(axis=1), nan=9.81),
    )
    step = motion.time[1] - motion.time[0]
    slid, shear = _slide(demand, np.maximum(pressed, 0.0), grip, step)
    shear = gaussian_filter1d(shear, motion.width / step)  # it jumps where the weight turns back
    weight = -(shear[:, None] * along + np.maximum(pressed, 0.0)[:, None] * up)
    return seen.rows.along(force_at(seen, body, weight, arm=top * up + slid[:, None] * along))


def _slide(demand, pressed, grip, step):
    """Displacement along the top, and the shear by mass that the weight is given, by Coulomb's law.

    ``demand`` is the acceleration along the top, less gravity, that holds the weight in place; ``pressed`` the same
    across it.
    """
    slid, shear, rate = np.zeros(len(demand)), np.zeros(len(demand)), 0.0
    for now in range(1, len(demand)):
        limit = grip * pressed[now]
        # what would bring it to rest within the step, within the cone: the friction at the end of the step
        shear[now] = np.clip(demand[now] - rate / step, -limit, limit)
        rate += (shear[now] - demand[now]) * step
        slid[now] = slid[now - 1] + rate * step
    return slid, shear


_NAME = "loose-weight"
_FLAT = 0.25  # height of the weight over the block's length


def _act(experiment, size, place, when, test):
    """A box of the mass ``size`` on the middle of the body's top."""
    structure = experiment.structure
    index = structure.body_names.index(place["body"])
    body, solid = structure.file.bodies[index], structure.solids[structure.file.bodies[index].shape]
    length, depth, height = np.ptp(solid.vertices, axis=0)
    box = [0.5 * length, 0.5 * depth, _FLAT * length]
    mapping = structure.file.model_dump(mode="json")
    mapping["shapes"][_NAME] = {"box": [float(edge) for edge in box]}
    above = structure.centroid[index] + np.array([0.0, 0.0, 0.5 * (height + box[2])])
    mapping["bodies"].append({
        "name": _NAME, "shape": _NAME, "material": body.material, "position": above.tolist(),
        "density": float(max(size, 1e-3) / np.prod(box)),
    })  # fmt: skip
    mapping["joints"].append(
        {"bodies": [body.name, _NAME], "friction_factor": _factor(structure, body, when["grip"])}
    )
    return replace(experiment, structure=structure.with_mapping(mapping))


def _factor(structure, body, grip):
    pair = {body.material}
    coefficient = next(one.coefficient for one in structure.file.friction if set(one.pair) == pair)
    return min(grip, 1.0) / coefficient


def _of_test(test, place, when):
    return _rows(test.seen, test.seen.structure.body_names.index(place["body"]), when["grip"])


FORM = LoadShape("loose-weight", "a loose weight on top", "mass", "kg", _of_test, _act)
