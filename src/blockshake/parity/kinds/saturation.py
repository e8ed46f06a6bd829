"""A sensor stops at the end of its range: reading = truth between -r and r, or bends towards r.

Readings that are equal at an end of a column are gaps before any check. A limit that acts before the noise is added
leaves no equal ones. It is found by the other markers of the body: they tell of motion beyond r, in which the reading
stands still but for its noise.
"""

import numpy as np

from blockshake.parity.body_markers import FEWEST_MARKERS
from blockshake.parity.finding import chance_of_misfit
from blockshake.parity.kinds.kind import Kind

_TRIED = np.linspace(0.2, 0.95, 16)  # of the largest motion; ends of the range
_FEWEST_BEYOND = 20  # readings beyond the end
_BEYOND, _STILL = 10.0, 3.0  # standard deviations: of the motion there, and of the readings that stand still
_ALIKE = 40  # readings that count as one: their noise may be slow


def _leave_out(test, findings, structure):
    for finding in findings:
        test["marker_displacement"].loc[{"marker": finding.where[0]}] = np.nan


RANGE = Kind("range", "sensor-saturation", "reading = truth between -r and r", units=("m", "m/s2"))
LIMIT = Kind(
    "limit",
    "sensor-saturation",
    "reading = truth that bends towards an end, -r or r",
    _leave_out,
    units=("m", "m/s2"),
)


def saturation(tests, level):
    """Findings of columns that stop at an end of their range; a column has two ends."""
    looked_at = 2 * sum(
        3 * test.sizes["marker"] + test.sizes.get("channel", 0) + test.sizes.get("transducer", 0)
        for test in tests.values()
    )
    return [
        RANGE.finding((fault.sensor,), fault.p * looked_at, (name,), [abs(fault.value)])
        for name, test in tests.items()
        for fault in test.attrs.get("faulty", ())
        if fault.kind == "clipped" and fault.p * looked_at < level
    ]


def limited_markers(bodies, marker_noise, level):
    """Findings of markers that stand still while their body moves on; their readings are left out.

    Parameters
    ----------
    bodies : iterable of BodyMarkers
        A body has to carry more than three: the others give its pose without the one that is looked at.
    marker_noise : float
        Standard deviation of a reading [m].
    level : Level
    """
    found = []
    for body in bodies:
        for marker in range(len(body.markers) if len(body.markers) > FEWEST_MARKERS else 0):
            read, moved = _along_the_shaking(body, marker)
            limit, p = _limit(read, moved, marker_noise)
            p *= level.hypotheses * len(_TRIED)
            if p < level.chance:
                found.append(LIMIT.finding((body.markers[marker],), p, body.tests, [limit]))
    return found


def _along_the_shaking(body, marker):
    """Displacement of a marker along the axis of its largest one, as read, and as the others give it [m]."""
    read, moved = [], []
    for number in range(len(body.tests)):
        one = body.in_test(number)
        ((_, displacement),) = one.readings
        others = displacement.copy()
        others[:, marker] = np.nan
        pose, point = one.frame(others), body.points[marker]
        given = pose.position + pose.rotation @ point - (one.position + one.rotation @ point)
        known = one.upright(pose.rotation) & np.isfinite(displacement[:, marker]).all(axis=1)
        read.append(displacement[known, marker])
        moved.append(given[known])
    read, moved = np.concatenate(read), np.concatenate(moved)
    axis = int(np.argmax(np.ptp(moved, axis=0))) if len(moved) else 0
    return read[:, axis], moved[:, axis]


def _limit(read, moved, noise):
    """End of the range, and the chance that a faultless reading or a gain looks like it; 1 where it does not.

    Beyond the end the reading has to stand still while the body moves on by far more than noise.
    """
    best = None
    for end in _TRIED * np.abs(moved).max(initial=0.0):
        beyond = np.abs(moved) > end + _STILL * noise
        if beyond.sum() < _FEWEST_BEYOND or np.abs(moved).max() < end + _BEYOND * noise:
            continue
        stands = np.abs(read[beyond])
        if stands.std() > _STILL * noise:
            continue
        limit = float(np.median(stands))
        after = float(((read - np.clip(moved, -limit, limit)) ** 2).sum())
        if best is None or after < best[1]:
            best = limit, after
    if best is None:
        return 0.0, 1.0
    limit, after = best
    gain = (moved @ read) / (moved @ moved)
    before = min(((read - moved) ** 2).sum(), ((read - gain * moved) ** 2).sum())
    return limit, chance_of_misfit(before, after, _ALIKE * after / len(read))
