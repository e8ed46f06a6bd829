"""A mass that is fixed to a body and not in the model: a lifting frame, instruments, water."""

import numpy as np

from blockshake.diagnosis.evidence.explanation import best_of
from blockshake.diagnosis.outside.form import Form
from blockshake.effects.effect import Columns
from blockshake.forces.seen.wrench_histories import force_at

_SCALE = 0.2  # of the body's mass


def explain_unmodelled_mass(likelihood, tests, point):
    """`Explanation` of a mass at one point, which weighs and is shaken with the body."""
    height = float(point.place.rpartition("@")[2])
    scale = _SCALE * tests[0].seen.structure.mass[point.body]
    rows = [Columns({}, _rows(test.seen, point.body, height)[:, None], (scale,), True) for test in tests]
    return best_of(likelihood, "unmodelled-mass", point.place, [rows])


def _rows(seen, body, height):
    """Rows of 1 kg: ``-(a - g)`` of its point."""
    motion = seen.motion
    solid = seen.structure.solids[seen.structure.file.bodies[body].shape]
    arm = height * float(np.ptp(solid.vertices[:, 2])) * motion.rotation[:, body, :, 2]
    spin = motion.angular_velocity[:, body]
    further = np.cross(motion.angular_acceleration[:, body], arm) + np.cross(spin, np.cross(spin, arm))
    force = np.array(seen.structure.file.gravity) - motion.acceleration[:, body] - further
    return seen.rows.along(force_at(seen, body, force, arm=arm))


def _of_test(test, place, when):
    return _rows(test.seen, test.seen.structure.body_names.index(place["body"]), place["height"])


def _act(experiment, size, place, when, test):
    """The body heavier, and its mass centre drawn to the point."""
    structure = experiment.structure
    index = structure.body_names.index(place["body"])
    file, share = structure.file, max(size, 0.0) / structure.mass[index]
    body = file.bodies[index]
    tall = float(np.ptp(structure.solids[body.shape].vertices[:, 2]))
    raised = place["height"] * tall * share / (1.0 + share)
    density = body.density or file.materials[body.material].density
    return experiment.with_parameters(
        **{
            f"bodies.{body.name}.density": density * (1.0 + share),
            f"bodies.{body.name}.mass_offset": [*body.mass_offset[:2], body.mass_offset[2] + raised],
        }
    )


FORM = Form("unmodelled-mass", "a mass that the model lacks", "mass", "kg", _of_test, _act)
