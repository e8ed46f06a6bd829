"""Whether a run's energy audit closes."""

import numpy as np

from blockshake.dynamics.system import ELASTIC, FRICTION_LOSS, INPUT, KINETIC, POTENTIAL


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
    held = energy[:, KINETIC:FRICTION_LOSS].sum(axis=1)
    return held + energy[:, FRICTION_LOSS:INPUT].sum(axis=1) - energy[:, INPUT] - held[0]


def energy_residual(energy):
    """Energy that the audit does not explain, relative to the energy in play.

    Parameters
    ----------
    energy : float64 array, shape (n_times, 7)
        `ENERGY_TERMS` [J].

    Returns
    -------
    float
        Largest magnitude of `unexplained_energy` over the largest of the work done on the bodies, their kinetic and
        their elastic energy and a millionth of their potential energy [1].
    """
    energy = energy[np.isfinite(energy).all(axis=1)]
    if not len(energy):
        return float("nan")
    missing = unexplained_energy(energy)
    least = 1e-6 * np.abs(energy[:, POTENTIAL]).max()
    in_play = max(np.abs(energy[:, INPUT]).max(), energy[:, KINETIC].max(), energy[:, ELASTIC].max(), least)
    return float(np.abs(missing).max() / in_play) if in_play > 0.0 else 0.0
