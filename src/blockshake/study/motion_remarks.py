"""Remarks on a ground motion that is well formed, but perhaps not what was meant."""

import numpy as np

from blockshake.dynamics.intensity import acceleration_segments, motion_figures
from blockshake.dynamics.load_motion import provenance
from blockshake.dynamics.motion import PITCH

_ONE_G = 9.81  # m/s2
_WEAKEST, _STRONGEST = 0.5, 30.0  # m/s2, of peak accelerations that move blocks and that were ever recorded
_FARTHEST = 1.0  # m, of a shake table or of the ground
_STEEPEST = 0.05  # rad, of a table
_FASTEST_END = 0.05  # m/s
_LONGEST = 600.0  # s, of a test or of an earthquake
_SHORTEST = 0.1  # s
# by kind of motion: its unit, and smaller ones that are perhaps meant
_UNITS = {"acceleration": "m/s2", "velocity": "m/s", "displacement": "m"}
_SMALLER = {"acceleration": "cm/s2 or mm/s2", "velocity": "cm/s or mm/s", "displacement": "mm"}


def motion_line(motion):
    """Duration, kind, peaks along x and provenance of a `GroundMotion`, in one line."""
    peaks = motion_figures(motion)
    return (
        f"a motion of {motion.duration:g} s, given as {motion.kind}; peaks along x: "
        f"{peaks['peak_acceleration']:.3g} m/s2, {peaks['peak_velocity']:.3g} m/s, "
        f"{peaks['peak_displacement']:.3g} m; {provenance(motion.attributes)}"
    )


def motion_remarks(motion):
    """One sentence for everything about a `GroundMotion` that looks like a slip of the pen; a list of str."""
    remarks = []
    ends = [end for axis in "xyz" for end in acceleration_segments(motion, axis)[1:]]
    peak = float(max(np.abs(end).max() for end in ends))
    place = motion.evaluate(motion.table.breaks) - motion.evaluate(motion.table.breaks[:1])
    moved, pitched = float(np.abs(place[:, :PITCH]).max()), float(np.abs(place[:, PITCH]).max())
    strength = f"the peak acceleration is {peak / _ONE_G:.2g} g"
    if peak == 0.0 and pitched == 0.0:
        remarks.append("nothing moves")
    elif 0.0 < peak < _WEAKEST:
        meant = "expected m/s2, not g" if motion.kind == "acceleration" else "it moves no block"
        remarks.append(f"{strength}: {meant}")
    if peak > _STRONGEST:
        remarks.append(f"{strength}: expected {_UNITS[motion.kind]}, not {_SMALLER[motion.kind]}")
    end = float(np.abs(motion.evaluate(motion.table.breaks[-1:], derivative=1)[0, :PITCH]).max())
    if end > _FASTEST_END and peak <= _STRONGEST:
        remarks.append(f"the ground still moves at {end:.2g} m/s at the end: an offset of the {motion.kind}?")
    if moved > _FARTHEST:
        remarks.append(f"the ground moves by {moved:.3g} m")
    if pitched > _STEEPEST:
        remarks.append(f"the table pitches by {pitched:.2g} rad")
    if motion.duration > _LONGEST:
        remarks.append(f"the motion lasts {motion.duration:.0f} s: expected s, not ms")
    if motion.duration < _SHORTEST:
        remarks.append(f"the motion lasts {motion.duration:.2g} s: were its times in s already?")
    return remarks
