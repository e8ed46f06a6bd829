"""Limits of sight: which motions and joints of a campaign its sensors do not show, in plain lines."""

import numpy as np

from blockshake.measurement.motion.body_poses import PLANAR, POSE

_LOST = 0.1  # of a test, for which a motion may be unknown without a word


def cannot_see(seen_tests):
    """Lines about what the sensors of a campaign do not show.

    Parameters
    ----------
    seen_tests : list of SeenTest

    Returns
    -------
    list of str
        Empty where every motion of every body is read in every test, and every joint has moved in some test.
    """
    if not seen_tests:
        return ["no open test: nothing is judged"]
    resting = [seen for seen in seen_tests if seen.still.any()]
    lines = [
        f"{seen.name}: no quiet start, from which its readings would count; nothing of it is judged"
        for seen in seen_tests
        if not seen.still.any()
    ]
    if not resting:
        return lines
    lines += [line for body in range(len(resting[0].structure.mass)) for line in _of_body(resting, body)]
    if len(resting) == 1:
        lines.append(f"{resting[0].name} alone: a cause that acts once is not told from one that lasts")
    if not resting[0].tree:
        lines.append("bodies that stand on several joints: the force of each joint is known in part")
    return [*lines, *_of_joints(resting)]


def _of_body(tests, body):
    name, driven = tests[0].structure.body_names[body], tests[0].structure.driven[body]
    known = {seen.motion.known[body] for seen in tests}
    if not known <= {POSE, PLANAR}:
        lost = "a pitch of the table and a soft base are" if driven else "forces of the joints at it are"
        yield f"{name}: its rotation is not read; {lost} not judged"
        return
    if PLANAR in known and not driven:
        yield f"{name}: turns out of the plane of shaking are not read, and taken as none"
    lost = max(float(np.mean(~np.isfinite(seen.required.wrench[:, body]).all(axis=1))) for seen in tests)
    if lost > _LOST:
        yield f"{name}: its motion is unknown for up to {100.0 * lost:.0f} % of a test"


def _of_joints(tests):
    for index, face in enumerate(tests[0].faces):
        read = [seen for seen in tests if np.isfinite(seen.forces.force[:, index]).any()]
        moved = any(
            seen.states.edge[:, index].any()
            or seen.states.slip[:, index].any()
            or seen.states.lifted[:, index].any()
            for seen in read
        )
        if read and not moved:
            yield f"{face.name}: turned, slipped and lifted in no test; of its causes a soft layer alone would show"
