"""The table moves vertically in proportion to its horizontal motion, earlier or later."""

from scipy.interpolate import CubicSpline

from blockshake.dynamics.motion import CHANNELS
from blockshake.effects.effect import Effect, EffectParameter, Signature
from blockshake.effects.places import nowhere

_VERTICAL = CHANNELS.index("z")


def _act(experiment, values, place):
    breaks = experiment.motion.table.breaks
    delayed = experiment.motion.evaluate(breaks - values["delay"])[:, 0]
    vertical = values["ratio"] * (delayed - delayed[0])
    return experiment.with_motion(_VERTICAL, CubicSpline(breaks, vertical).c[::-1].T)


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
    signature=Signature("quiet", "one-sided", "slab"),
    confused_with=("impact-restitution",),
    told_apart_by="vertical accelerometer on the slab",
    places=nowhere,
    act=_act,
)  # fmt: skip
