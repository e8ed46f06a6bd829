"""Remarks on a ground motion that is well formed, but perhaps not what was meant."""

import numpy as np

from blockshake.dynamics.intensity import motion_figures

_GRAVITY = 9.81  # m/s2
_WEAKEST, _STRONGEST = 0.5, 30.0  # m/s2, of peak accelerations that move blocks and that were ever recorded
_FARTHEST = 1.0  # m, of a shake table or of the ground
_FASTEST_END = 0.05  # m/s


def motion_line(motion):
    """Duration, kind and peaks along x of a `GroundMotion`, in one line."""
    peaks = motion_figures(motion)
    return (
        f"a motion of {motion.duration:g} s, given as {motion.kind}; peaks along x: "
        f"{peaks['peak_acceleration']:.3g} m/s2, {peaks['peak_velocity']:.3g} m/s, "
        f"{peaks['peak_displacement']:.3g} m"
    )


def motion_remarks(motion):
    """One sentence for everything about a `GroundMotion` that looks like a slip of the pen; a list of str."""
    peaks, remarks = motion_figures(motion), []
    peak, moved = peaks["peak_acceleration"], peaks["peak_displacement"]
    if 0.0 < peak < _WEAKEST:
        remarks.append(f"the peak acceleration is {peak / _GRAVITY:.2g} g: expected m/s2, not g")
    if peak > _STRONGEST:
        remarks.append(f"the peak acceleration is {peak / _GRAVITY:.2g} g: expected m/s2, not cm/s2")
    end = float(np.abs(motion.evaluate(motion.table.breaks[-1:], derivative=1)[0, :3]).max())
    if end > _FASTEST_END:
        remarks.append(f"the ground still moves at {end:.2g} m/s at the end: an offset of the acceleration?")
    if moved > _FARTHEST:
        remarks.append(f"the ground moves by {moved:.3g} m")
    return remarks
