"""The table pitches about its transverse axis as it accelerates: an oscillator driven by the acceleration."""

from functools import cache

import numpy as np
import scipy
from scipy.interpolate import CubicSpline

from blockshake.dynamics.motion import CHANNELS
from blockshake.effects.effect import DesignMatrix, Effect, EffectParameter
from blockshake.effects.places import nowhere
from blockshake.errors import InputError

_FEWEST_ROWS = 0.31  # of a period; the pitch then errs by less than 1 %
_DAMPING = 0.05  # of critical; tables are lightly damped
_PITCH = CHANNELS.index("pitch_y")
_FREQUENCIES = np.geomspace(5.0, 30.0, 60)  # Hz, closer than the width of the resonance
_DAMPINGS = (_DAMPING, 0.2, 1.0)  # of critical: the last two real poles
_RATIO = _FREQUENCIES[1] / _FREQUENCIES[0]
_SCALE = 6e-4  # rad s2/m


def _turns(slab):
    """Rotations of the slab by every frequency and damping; see `Effect`."""
    variants = []
    for damping in _DAMPINGS:
        for frequency in _FREQUENCIES:
            turn = _response(slab.acceleration, slab.step, frequency, damping)[slab.at]
            values = {"frequency": float(frequency), "damping": damping}
            variants.append(DesignMatrix(values, turn[:, None], (_SCALE,), False))
    return variants


@cache
def _filter(step, frequency, damping):
    """Coefficients of the oscillator for an input that is straight between uniform times."""
    omega = 2.0 * np.pi * frequency
    system = [omega**2], [1.0, 2.0 * damping * omega, omega**2]
    numerator, denominator, _ = scipy.signal.cont2discrete(system, step, method="foh")
    return numerator[0], denominator


def _response(acceleration, step, frequency, damping=_DAMPING):
    """Rotation by 1 rad s2/m of a history of acceleration at uniform times, straight between them, from rest."""
    return scipy.signal.lfilter(*_filter(round(step, 9), float(frequency), damping), acceleration)


def _act(experiment, values, place):
    breaks = experiment.motion.table.breaks
    step = np.diff(breaks).min()
    if values["frequency"] * np.diff(breaks).max() > _FEWEST_ROWS:
        raise InputError(
            experiment.motion.name,
            "time_s",
            f"expected rows closer than {_FEWEST_ROWS / values['frequency']:.3g} s for "
            f"a table that pitches at {values['frequency']:.3g} Hz",
        )
    times = step * np.arange(int(np.ceil((breaks[-1] - breaks[0]) / step)) + 1)
    acceleration = experiment.motion.evaluate(breaks[0] + times, derivative=2)[:, 0]
    response = _response(acceleration, step, values["frequency"])
    pitch = values["coefficient"] * np.interp(breaks, breaks[0] + times, response)
    return experiment.with_motion(_PITCH, CubicSpline(breaks, pitch).c[::-1].T)


EFFECT = Effect(
    name="table-pitch",
    title="pitch of the table",
    acts="input",
    equation="pitch'' + 2 zeta w pitch' + w^2 pitch = w^2 c a_x, zeta = 0.05, about y through the slab's centre",
    source="single-degree-of-freedom oscillator; pitch of shake tables under overturning: Conte and Trombetti (2000)",
    parameters=(
        EffectParameter("coefficient", "rad s2/m", "static pitch by acceleration", 0.0, -1.5e-3, 1.5e-3, 6e-4),
        EffectParameter("frequency", "Hz", "of the table's pitching", 15.0, 5.0, 30.0, 15.0),
    ),
    confused_with=("joint-compliance",),
    distinguished_by="vertical displacement of two markers on the slab, apart along x",
    places=nowhere,
    act=_act,
    turns=_turns,
    reads=lambda values, size, between: {"coefficient": size, "frequency": values["frequency"] * _RATIO**between},
)  # fmt: skip
