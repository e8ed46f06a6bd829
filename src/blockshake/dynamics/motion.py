"""Ground motion as one piecewise cubic displacement, evaluated the same way everywhere."""

from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
from scipy.interpolate import CubicSpline, PPoly

from blockshake.errors import InputError
from blockshake.jit import kernel_without_allocation
from blockshake.tables.shown import Shown

CHANNELS = ("x", "y", "z", "pitch_y")
PITCH = CHANNELS.index("pitch_y")


class MotionTable(NamedTuple):
    """A ground motion as kernels read it.

    ``breaks``: float64 (n_rows,), time of each row [s]. ``coefficients``: float64
    (n_rows - 1, 4, 4), displacement x, y, z [m] and pitch [rad] of each segment as the
    polynomial ``c0 + c1 s + c2 s^2 + c3 s^3`` in the time ``s`` since its first row.
    """

    breaks: np.ndarray
    coefficients: np.ndarray


@dataclass(frozen=True, repr=False)
class GroundMotion(Shown):
    """Motion of the driven body."""

    name: str  # name that reports use
    table: MotionTable  # displacement and pitch; the body rests after the last row
    kind: str  # what the source gave: ``acceleration``, ``velocity`` or ``displacement``
    # provenance for outputs: ``source``, ``synthetic`` (bool), ``baseline`` and the like
    attributes: dict[str, Any] = field(default_factory=dict)

    def _words(self):
        return f"{self.name}: {self.duration:g} s, given as {self.kind}"

    def _rows(self):
        yield "of the motion", "value"
        peaks = np.abs(self.evaluate(self.table.breaks, 2)).max(axis=0)
        for channel, unit, peak in zip(CHANNELS, ("m/s2", "m/s2", "m/s2", "rad/s2"), peaks, strict=True):
            yield f"peak acceleration, {channel}", f"{peak:.4g} {unit}"
        yield from self.attributes.items()

    @property
    def duration(self) -> float:
        """Time of the last row [s]."""
        return float(self.table.breaks[-1])

    @property
    def first_pitch(self) -> float:
        """Pitch at the first row, with which a run starts [rad]."""
        return float(self.table.coefficients[0, PITCH, 0])

    def scaled(self, factor: float) -> "GroundMotion":
        """The same motion with every column multiplied by ``factor``; the attribute ``scale`` gathers it."""
        table = MotionTable(self.table.breaks, self.table.coefficients * factor)
        scale = float(self.attributes.get("scale", 1.0) * factor)
        return replace(self, table=table, attributes={**self.attributes, "scale": scale})

    def turned(self, heading: float) -> "GroundMotion":
        """The same motion from another heading: x and y turned about z by ``heading``, from x to y [rad].

        Raises
        ------
        InputError
            A motion with a pitch, which is about y alone.
        """
        if heading == 0.0:
            return self
        breaks, coefficients = self.table
        if coefficients[:, PITCH].any():
            raise InputError(self.name, "heading", "expected a motion without pitch, to be turned")
        cosine, sine = np.cos(heading), np.sin(heading)
        along, across = coefficients[:, 0], coefficients[:, 1]
        turned = coefficients.copy()
        turned[:, 0], turned[:, 1] = cosine * along - sine * across, sine * along + cosine * across
        attributes = {**self.attributes, "heading": self.attributes.get("heading", 0.0) + heading}
        return replace(self, table=MotionTable(breaks, turned), attributes=attributes)

    def delayed(self, late: float) -> "GroundMotion":
        """The same motion, ``late`` after a rest at its first row; not negative [s]."""
        if late == 0.0:
            return self
        breaks, coefficients = self.table
        rest = np.zeros((1, *coefficients.shape[1:]))
        rest[..., 0] = coefficients[0, :, 0]
        rows = np.concatenate([breaks[:1], breaks + late])
        return replace(self, table=MotionTable(rows, np.concatenate([rest, coefficients])))

    def evaluate(self, times: npt.ArrayLike, derivative: int = 0) -> np.ndarray:
        """Displacement (or a time derivative) and pitch at any times.

        Parameters
        ----------
        times : float64 array, shape (n,)
            [s]; zero velocity and acceleration outside the rows.
        derivative : int
            0 displacement, 1 velocity, 2 acceleration.

        Returns
        -------
        float64 array, shape (n, 4)
            x, y, z [m, m/s, m/s2] and pitch [rad, rad/s, rad/s2].
        """
        breaks, coefficients = self.table
        inside = np.clip(times, breaks[0], breaks[-1])
        # PPoly wants the highest power first, as (power, segment, channel)
        polynomial = PPoly(coefficients[:, :, ::-1].transpose(2, 0, 1), breaks)
        values = polynomial(inside, nu=derivative)
        if derivative > 0:
            values[(np.asarray(times) < breaks[0]) | (np.asarray(times) > breaks[-1])] = 0.0
        return values


def ground_motion(name, time, columns, kind, attributes=None):
    """Ground motion from sampled columns, integrated exactly.

    Acceleration and velocity are linear between rows, displacement is a cubic spline; displacement and, but for
    ``velocity``, velocity are zero at the first row. No baseline correction is made.

    Parameters
    ----------
    name : str
    time : float64 array, shape (n_rows,)
        Increasing, not necessarily uniform [s].
    columns : dict of str to float64 array, shape (n_rows,)
        By channel: ``x``, ``y``, ``z`` in the unit of ``kind``, ``pitch_y`` in rad (always an angle, a cubic spline).
    kind : str
        ``acceleration`` [m/s2], ``velocity`` [m/s] or ``displacement`` [m].
    attributes : dict, optional
        Provenance.
    """
    time = np.asarray(time, dtype=float)
    coefficients = np.zeros((len(time) - 1, 4, 4))
    for channel, values in columns.items():
        values = np.asarray(values, dtype=float)
        cubic = "displacement" if channel == "pitch_y" else kind
        coefficients[:, CHANNELS.index(channel)] = _cubic(time, values, cubic)
    return GroundMotion(name, MotionTable(time, coefficients), kind, dict(attributes or {}))


def check_finite(motion, where):
    """Refuse a motion with a displacement beyond all numbers, which very large values integrate to: `InputError`."""
    if not np.isfinite(motion.table.coefficients).all():
        raise InputError(where, "", "expected a motion with finite displacements; its values are too large")


def _cubic(time, values, kind):
    """Displacement polynomials of one channel, shape (n_rows - 1, 4), lowest power first."""
    step = np.diff(time)
    if kind == "displacement":
        return CubicSpline(time, values).c[::-1].T if len(time) > 2 else _line(values, step)
    slope = np.diff(values) / step
    if kind == "velocity":
        c1, c2, c3 = values[:-1], slope / 2.0, np.zeros_like(slope)
    else:
        gained = np.concatenate([[0.0], np.cumsum(step * (values[:-1] + values[1:]) / 2.0)])
        c1, c2, c3 = gained[:-1], values[:-1] / 2.0, slope / 6.0
    moved = np.cumsum(step * (c1 + step * (c2 + step * c3)))
    return np.column_stack([np.concatenate([[0.0], moved[:-1]]), c1, c2, c3])


def _line(values, step):
    return np.array([[values[0], (values[1] - values[0]) / step[0], 0.0, 0.0]])


def rest_table():
    """Table of a ground that never moves."""
    return MotionTable(np.array([0.0, 1.0]), np.zeros((1, 4, 4)))


@kernel_without_allocation
def find_segment(breaks, t, segment):
    """Index of the segment that holds ``t``, searched from the last one found.

    ``segment`` is where the search starts; the answer is ``len(breaks) - 1`` after the last row.
    """
    while segment > 0 and t < breaks[segment]:
        segment -= 1
    while segment < breaks.size - 1 and t >= breaks[segment + 1]:
        segment += 1
    return segment


@kernel_without_allocation
def ground_state_into(table, segment, t, displacement, velocity):
    """Ground displacement and velocity at the time ``t`` [s] in a segment from `find_segment`, into two arrays (4,).

    They hold x, y, z and pitch [m, rad] and their rates [m/s, rad/s].
    """
    breaks, coefficients = table.breaks, table.coefficients
    at_rest = segment >= breaks.size - 1
    if at_rest:
        segment = breaks.size - 2
        t = breaks[breaks.size - 1]
    s = max(t - breaks[segment], 0.0)
    for channel in range(4):
        c = coefficients[segment, channel]
        displacement[channel] = c[0] + s * (c[1] + s * (c[2] + s * c[3]))
        velocity[channel] = 0.0 if at_rest else c[1] + s * (2.0 * c[2] + s * 3.0 * c[3])
