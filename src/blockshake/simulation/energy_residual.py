"""Whether a run's energy audit closes."""

import numpy as np

from blockshake.dynamics.system import ELASTIC, FRICTION_LOSS, INPUT, KINETIC, POTENTIAL

# Entries of `energy_extremes`: energy held at the first time; least and largest of what is held and dissipated less
# the input; largest input, kinetic, elastic and potential energy, magnitudes [J]
_START, _LEAST, _MOST, _INPUT, _KINETIC, _ELASTIC, _POTENTIAL = range(7)


def unexplained_energy(energy):
    """Energy that the audit does not explain, over time.

    Parameters
    ----------
    energy : float64 array, shape (n_times, 7)
        `ENERGY_TERMS` [J].

    Returns
    -------
    float64 array, shape (n_times,)
        ``kinetic + potential + elastic + dissipated - input - initial`` [J], zero at the first time.
    """
    held, balance = _balance(energy)
    return balance - held[0]


def _balance(energy):
    """Energy that is held, and that with what was dissipated less the input, over time [J]."""
    held = energy[:, KINETIC:FRICTION_LOSS].sum(axis=1)
    return held, held + energy[:, FRICTION_LOSS:INPUT].sum(axis=1) - energy[:, INPUT]


def energy_residual(energy):
    """`residual_of` a run from its energy over time, float64 array, shape (n_times, 7), `ENERGY_TERMS` [J]."""
    return residual_of([energy_extremes(energy)])


def energy_extremes(energy):
    """All that `residual_of` needs of a part of a run, float64 array, shape (7,); NaN where nothing is finite."""
    energy = energy[np.isfinite(energy).all(axis=1)]
    if not len(energy):
        return np.full(7, np.nan)
    held, balance = _balance(energy)
    least, most = balance.min(), balance.max()
    largest = np.abs(energy[:, INPUT]).max(), energy[:, KINETIC].max(), energy[:, ELASTIC].max()
    return np.array([held[0], least, most, *largest, np.abs(energy[:, POTENTIAL]).max()])


def residual_of(extremes):
    """Energy that the audit of a run does not explain, relative to the energy in play.

    Largest magnitude of `unexplained_energy` over the largest of the work done on the bodies, their kinetic and their
    elastic energy and a millionth of their potential energy [1]. ``extremes``: `energy_extremes` of the run's parts, in
    their order.
    """
    known = np.array(extremes)
    known = known[np.isfinite(known).all(axis=1)]
    if not len(known):
        return float("nan")
    start, largest = known[0, _START], known.max(axis=0)
    missing = max(abs(known[:, _LEAST].min() - start), abs(largest[_MOST] - start))
    in_play = max(largest[_INPUT], largest[_KINETIC], largest[_ELASTIC], 1e-6 * largest[_POTENTIAL])
    return float(missing / in_play) if in_play > 0.0 else 0.0
