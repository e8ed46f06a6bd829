"""The table moves vertically in proportion to its horizontal motion, earlier or later."""

import numpy as np
from scipy.interpolate import CubicSpline

from blockshake.dynamics.motion import CHANNELS
from blockshake.effects.effect import Effect, EffectParameter
from blockshake.effects.places import nowhere

_SIZES = (2e-4, 1e-3, 5e-3, 2e-2)  # m
_MEMORY = 0.15  # s
_VERTICAL = CHANNELS.index("z")


def _act(experiment, values, place):
    breaks = experiment.motion.table.breaks
    delayed = experiment.motion.evaluate(breaks - values["delay"])[:, 0]
    vertical = values["ratio"] * (delayed - delayed[0])
    return experiment.with_motion(_VERTICAL, CubicSpline(breaks, vertical).c[::-1].T)


def _lifts(slab):
    """Covariance of the slab's vertical displacement by size: a smooth random motion of a scale of 0.15 s."""
    apart = slab.time[slab.at][:, None] - slab.time[slab.at]
    return [size**2 * np.exp(-0.5 * (apart / _MEMORY) ** 2) for size in _SIZES]


EFFECT = Effect(
    name="vertical-motion",
    title="vertical motion of the table",
    acts="input",
    equation="d_z(t) = r (d_x(t - tau) - d_x(-tau))",
    source="coupling of a table's axes, by definition",
    parameters=(
        EffectParameter("ratio", "1", "vertical over horizontal motion", 0.0, -0.8, 0.8, 0.5),
        EffectParameter("delay", "s", "of the vertical motion", 0.0, -0.2, 0.2, 0.0),
    ),
    confused_with=("impact-restitution",),
    distinguished_by="vertical accelerometer on the slab",
    places=nowhere,
    act=_act,
    lifts=_lifts,
    reads=lambda values, size, between: {"ratio": size, "delay": values["delay"] + 0.01 * between},
)  # fmt: skip
