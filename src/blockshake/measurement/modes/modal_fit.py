"""Modes that a base-excited response holds: poles of the largest likelihood, one more only where it is significant.

The model and its likelihood are in `modal_likelihood`. Poles are common to all channels and instruments, so that
the search has two unknowns a mode however many channels there are. Modes are added one by one: a scan finds the
pole that explains most of what is left, all poles are refined, and the mode stays if noise would explain as much
with a chance of 1e-3 at the most.

Why this and not subspace identification with a stabilisation diagram: the base's spectrum is known and not white,
the noise is neither, and a diagram always offers poles; a likelihood says how much a further mode explains and
whether chance does as well.
"""

from dataclasses import dataclass

import numpy as np
from scipy.stats import chi2

from blockshake.measurement.modes.modal_likelihood import SMOOTH, left, reweighted, solved, summed, whitened

MOST_MODES = 8
DAMPING = (1e-3, 0.5)  # ratios searched; a pole at the lower end is no mode
HEAVIEST = 0.3  # damping ratio above which a pole is no mode but part of a smooth response
_TRIED = (0.005, 0.015, 0.05, 0.15)  # damping ratios of the scan
_CHANCE = 1e-3  # of one mode from noise alone, over all bins
_SIGMAS = 2.0  # by which a damping must differ from zero
_MOST_STEPS = 60
_SETTLED = 1e-4  # change of the logarithm of the likelihood that ends the search


@dataclass(frozen=True)
class Modes:
    """Poles found, ordered by frequency.

    Attributes
    ----------
    frequency, damping : float64 arrays, shape (n_modes,)
        Undamped natural frequency [Hz], ratio to critical [1].
    frequency_error, damping_error : float64 arrays, shape (n_modes,)
        Standard errors.
    chance : float64 array, shape (n_modes,)
        Natural logarithm of the chance that noise alone explains as much at that pole.
    residues, residue_errors : lists of arrays, shape (n_modes, n_channels)
        Per instrument; complex128, of the response at its poles, up to one factor a mode; float64, their standard
        errors at known poles.
    """

    frequency: np.ndarray
    damping: np.ndarray
    frequency_error: np.ndarray
    damping_error: np.ndarray
    chance: np.ndarray
    residues: list
    residue_errors: list


def fit_modes(instruments, floors):
    """Modes in the spectra of one or more instruments on the same structure.

    Parameters
    ----------
    instruments : list of Spectra
    floors : list of float
        Least standard deviation of a channel's error, per instrument: what is below is no motion.

    Returns
    -------
    Modes
        Possibly none: of the poles only those whose half-power interval lies in the band.
    """
    highest = max(read.frequency[-1] for read in instruments)
    parts = [whitened(read, floor, highest) for read, floor in zip(instruments, floors, strict=True)]
    cells = max(len(part.s) for part in parts)
    poles = np.empty((0, 2))
    while len(poles) < MOST_MODES:
        more = _refined(parts, np.vstack([poles, _strongest(parts, poles)]))
        weighed = [reweighted(part, more) for part in parts]
        more = _refined(weighed, more)
        if _chances(weighed, more).max() > np.log(_CHANCE / cells):
            break
        poles, parts = more, weighed
    return _described(parts, poles, highest)


def _strongest(parts, poles):
    """Pole of a scan that explains most of what the others leave, each by the bins near it."""
    remaining = [left(part, poles) for part in parts]
    low = min(np.abs(part.s[0]) for part in parts)
    best, gain = None, -np.inf
    for damping in _TRIED:
        for frequency in np.exp(np.arange(np.log(low), 0.0, damping)):
            explained = 0.0
            for part, rest in zip(parts, remaining, strict=True):
                reach = max(10.0 * damping * frequency, 8.0 * np.abs(part.s[1] - part.s[0]))
                begin, end = np.searchsorted(part.s.imag, [frequency - reach, frequency + reach])
                s = part.s[begin:end]
                if len(s) < 8:
                    continue
                resonance = part.base[begin:end] / (s**2 + 2.0 * damping * frequency * s + frequency**2)
                terms = np.stack([resonance, s * resonance], axis=1)
                weighed = terms.conj().T / part.level[begin:end]
                right = (weighed @ rest[begin:end]).real
                explained += (right * np.linalg.lstsq((weighed @ terms).real, right, rcond=1e-10)[0]).sum()
            if explained > gain:
                best, gain = (np.log(frequency), np.log(damping)), explained
    return np.array(best)


def _refined(parts, poles):
    """Poles of the largest likelihood near these, by Levenberg and Marquardt's damped Gauss-Newton steps."""
    low = min(np.log(np.abs(part.s[0])) for part in parts)
    lower, upper = np.array([low, np.log(DAMPING[0])]), np.array([0.0, np.log(DAMPING[1])])
    poles, strength = np.clip(poles, lower, upper), 1e-3
    misfit, gradient, curvature, _ = summed(parts, poles)
    for _ in range(_MOST_STEPS):
        free = ~(((poles <= lower) & (gradient > 0.0)) | ((poles >= upper) & (gradient < 0.0))).ravel()
        matrix = curvature + strength * np.diag(np.maximum(np.diagonal(curvature), 1e-300))
        step = np.zeros(poles.size)
        step[free] = -np.linalg.lstsq(matrix[np.ix_(free, free)], gradient.ravel()[free], rcond=None)[0]
        longest = np.stack([np.exp(poles[:, 1]), np.ones(len(poles))], axis=1)
        step = np.clip(step.reshape(-1, 2), -longest, longest)
        tried = np.clip(poles + step, lower, upper)
        found = summed(parts, tried)
        if found[0] <= misfit:
            gain, poles, (misfit, gradient, curvature, _) = misfit - found[0], tried, found
            strength *= 0.2
            if gain < _SETTLED:
                break
        else:
            strength *= 10.0
            if strength > 1e6:
                break
    return poles


def _chances(parts, poles):
    """Logarithm of the chance, for each mode, that noise is explained as well by its response to the base.

    Near a sharp mode the error of the base's reading is amplified in the direction of its shape alone, beyond the
    noise that the weights know: the gain is taken over the largest variance of any direction near the pole.
    """
    n_modes = len(poles)
    gain, freedom = np.zeros(n_modes), 2
    for part in parts:
        found, inverse, terms = solved(part, poles)
        rest = (part.response - terms @ found) / np.sqrt(part.level)[:, None]
        freedom += 2 * part.response.shape[1]
        for mode, (frequency, damping) in enumerate(np.exp(poles)):
            reach = 3.0 * damping * frequency + SMOOTH * np.abs(part.s[1] - part.s[0])
            near = rest[np.abs(part.s.imag - frequency) < reach]
            if not len(near):
                continue
            own = [3 + mode, 3 + n_modes + mode]
            known = np.linalg.pinv(inverse[np.ix_(own, own)], hermitian=True)
            explained = (found[own] * (known @ found[own])).sum()
            spread = np.linalg.eigvalsh((near.conj().T @ near).real / len(near))[-1]
            gain[mode] += explained / max(spread, 1.0)
    return chi2.logsf(2.0 * gain, freedom)


def _described(parts, poles, highest):
    chances = _chances(parts, poles) if len(poles) else np.empty(0)
    frequency, damping = np.exp(poles).T
    covariance = _covariance(parts, poles)
    spread = np.sqrt(np.maximum(np.diagonal(covariance), 0.0)).reshape(-1, 2)
    order = np.argsort(frequency)
    low = min(np.abs(part.s[0]) for part in parts)
    inside = (frequency * (1.0 - damping) > low) & (frequency * (1.0 + damping) < 1.0)
    inside &= (damping > 1.01 * DAMPING[0]) & (damping < HEAVIEST) & (_SIGMAS * spread[:, 1] < 1.0)
    order = order[inside[order]]
    residues, errors = [], []
    for part in parts:
        found, inverse, _ = solved(part, poles)
        n_modes = len(poles)
        of_part, error_of_part = [], []
        for mode in order:
            own = np.array([3 + mode, 3 + n_modes + mode])
            pole = frequency[mode] * (-damping[mode] + 1j * np.sqrt(1.0 - damping[mode] ** 2))
            combine = np.array([1.0, pole])
            of_part.append((combine @ found[own]) @ part.back)
            variance = 0.25 * (combine.conj() @ inverse[np.ix_(own, own)] @ combine).real
            error_of_part.append(np.sqrt(variance * (part.back**2).sum(axis=0)))
        n_channels = part.response.shape[1]
        residues.append(np.array(of_part, dtype=complex).reshape(-1, n_channels))
        errors.append(np.array(error_of_part, dtype=float).reshape(-1, n_channels))
    return Modes(
        frequency=highest * frequency[order],
        damping=damping[order],
        frequency_error=highest * (frequency * spread[:, 0])[order],
        damping_error=(damping * spread[:, 1])[order],
        chance=chances[order],
        residues=residues,
        residue_errors=errors,
    )


def _covariance(parts, poles):
    """Of the logarithms of frequency and damping, in turn: the sandwich of curvature and scatter."""
    if not len(poles):
        return np.empty((0, 0))
    _, _, curvature, scatter = summed(parts, poles)
    inverse = np.linalg.pinv(curvature, hermitian=True)
    return inverse @ scatter @ inverse
