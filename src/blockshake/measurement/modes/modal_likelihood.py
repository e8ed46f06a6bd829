"""How likely a base-excited response is, given the poles of its modes.

A linear structure on a moving base answers, in a record of finite length, with

    Y = [d0 + d1 s + d2 s^2 + sum_k (a_k + b_k s) / (s^2 + 2 z_k w_k s + w_k^2)] U
        + t0 + t1 / s + t2 s + sum_k (e_k + f_k s) / (s^2 + 2 z_k w_k s + w_k^2) + noise,    s = 2 pi i f,    (1)

U and Y the discrete Fourier transforms of the base's motion and of one channel. The first sum are the modes, with
real coefficients and no constraint, so damping need not be proportional; d0 to d2 are what is rigid or stiffer
than the band (static gain, lag, compliance). The second line are the states at the record's two ends, which share
the modes' poles: with it there is no leakage, no window and no bias of the damping (R. Pintelon and J. Schoukens
2012, System Identification: A Frequency Domain Approach, 2nd ed., Wiley, on arbitrary excitations).

For given poles (1) is linear in the rest, which is eliminated (G. H. Golub and V. Pereyra 1973, SIAM J. Numer.
Anal. 10, 413-432). The error of the base's own reading would bias the response where the base's spectrum falls to
it; its known variance v is taken out of the normal equations: |U|^2 - v for |U|^2, conj(U) Y - v c for conj(U) Y,
with c v its covariance with the channel's error.
"""

from dataclasses import dataclass, replace

import numpy as np
from scipy.ndimage import uniform_filter1d

from blockshake.measurement.modes.frequency_response import local_response

SMOOTH = 25  # bins over which the noise's level is constant
_RIDGE = 1e-13  # of the normal equations, whose diagonal is one


@dataclass(frozen=True)
class Part:
    """One instrument's spectra, its channels turned so that their noise is independent and of one size."""

    s: np.ndarray  # i f over the highest f
    base: np.ndarray
    response: np.ndarray
    base_variance: float
    shared: np.ndarray
    level: np.ndarray  # of the noise, by bin
    least: float  # level of the floor
    back: np.ndarray  # from turned channels to channels


def whitened(read, floor, highest):
    """Part of an instrument's spectra, frequencies over the highest [Hz], noise no less than the floor's."""
    local = local_response(read)
    size = np.trace(local.noise, axis1=1, axis2=2) + read.response.shape[1] * floor**2
    noise = (local.noise / size[:, None, None]).mean(axis=0)
    noise += floor**2 * np.mean(1.0 / size) * np.eye(len(noise))
    values, vectors = np.linalg.eigh(noise)
    turn = vectors / np.sqrt(values)
    return Part(
        s=1j * read.frequency / highest,
        base=read.base,
        response=read.response @ turn,
        base_variance=read.base_variance,
        shared=read.shared @ turn,
        level=np.exp(np.interp(read.frequency, local.frequency, np.log(size))),
        least=floor**2 * np.mean(1.0 / values),
        back=(vectors * np.sqrt(values)).T,
    )


def reweighted(part, poles):
    """With the noise's level from what these modes leave, smoothed over a few bins."""
    remaining = (np.abs(left(part, poles)) ** 2).mean(axis=1)
    smooth = uniform_filter1d(remaining, SMOOTH, mode="nearest")
    return replace(part, level=np.maximum(smooth, part.least))


def _terms(part, poles):
    """Right-hand side of (1) by coefficient, U left out: of the response, of the ends; (n_bins, n_terms) each."""
    s = part.s[:, None]
    frequency, damping = np.exp(poles).T
    resonances = 1.0 / (s**2 + 2.0 * damping * frequency * s + frequency**2)
    modes = np.hstack([resonances, s * resonances])
    return np.hstack([s**0, s, s**2, modes]), np.hstack([s**0, s, 1.0 / s, modes])


def solved(part, poles):
    """Coefficients of one instrument (n_terms, n_channels), the inverse of their normal matrix, the terms."""
    driven, ends = _terms(part, poles)
    terms = np.hstack([driven * part.base[:, None], ends])
    weighed = terms.conj().T / part.level
    matrix, right = (weighed @ terms).real, (weighed @ part.response).real
    lost = part.base_variance * (driven.conj().T / part.level)
    n = driven.shape[1]
    matrix[:n, :n] -= (lost @ driven).real
    right[:n] -= np.outer(lost.real.sum(axis=1), part.shared)
    scale = 1.0 / np.sqrt(np.maximum(np.diagonal(matrix), 1e-300))
    matrix = matrix * scale[:, None] * scale + _RIDGE * np.eye(len(scale))
    inverse = np.linalg.pinv(matrix, rcond=1e-14, hermitian=True) * scale[:, None] * scale
    return inverse @ right, inverse, terms


def left(part, poles):
    """Part of the response that (1) does not explain, (n_bins, n_channels)."""
    found, _, terms = solved(part, poles)
    return part.response - terms @ found


def _slopes(part, poles):
    """Misfit of one instrument, its scores by bin and its curvature over the logarithms of the poles.

    Returns
    -------
    misfit : float
        Minus the logarithm of the likelihood, up to a constant, the coefficients at their best.
    gradient : float64 array, shape (2 n_modes,)
        Over frequency and damping in turn.
    curvature : float64 array, shape (2 n_modes, 2 n_modes)
        Expected second derivatives (Gauss-Newton), coefficients eliminated.
    scatter : float64 array, shape (2 n_modes, 2 n_modes)
        Covariance of the gradient at the true poles, the base's reading error included.
    """
    found, inverse, terms = solved(part, poles)
    driven, _ = _terms(part, poles)
    n, n_modes, variance = driven.shape[1], len(poles), part.base_variance
    remaining = part.response - terms @ found
    excess = driven @ found[:n] - part.shared
    misfit = ((np.abs(remaining) ** 2 - variance * np.abs(excess) ** 2).sum(axis=1) / part.level).sum()
    s = part.s
    moves, gains = [], []
    for mode, (frequency, damping) in enumerate(np.exp(poles)):
        rows = np.array([3 + mode, 3 + n_modes + mode])
        linear = np.stack([np.ones_like(s), s], axis=1)
        gain, end = linear @ found[rows], linear @ found[n + rows]
        middle = 2.0 * damping * frequency * s
        over = (s**2 + middle + frequency**2) ** 2
        for change in (middle + 2.0 * frequency**2, middle):
            factor = (-change / over)[:, None]
            gains.append(factor * gain)
            moves.append(factor * (gain * part.base[:, None] + end))
    weighed = terms.conj().T / part.level
    lost = variance * driven.conj().T / part.level
    shadows = []
    for move, gain in zip(moves, gains, strict=True):
        seen = (weighed @ move).real
        seen[:n] -= (lost @ gain).real
        shadow = inverse @ seen
        move -= terms @ shadow
        gain -= driven @ shadow[:n]
        shadows.append((move, gain))
    gradient, curvature, pulled = np.empty(2 * n_modes), np.empty((2 * n_modes, 2 * n_modes)), []
    for i, (move, gain) in enumerate(shadows):
        slope = (remaining.conj() * move + variance * excess.conj() * gain).real.sum(axis=1)
        gradient[i] = -2.0 * (slope / part.level).sum()
        pulled.append((excess.conj() * move).sum(axis=1) / part.level)
        for j, (other, other_gain) in enumerate(shadows[: i + 1]):
            both = (move.conj() * other - variance * gain.conj() * other_gain).real.sum(axis=1) / part.level
            curvature[i, j] = curvature[j, i] = 2.0 * both.sum()
    pulled = np.array(pulled)
    return misfit, gradient, curvature, curvature + 2.0 * variance * (pulled @ pulled.conj().T).real


def summed(parts, poles):
    """Misfit, gradient (n_modes, 2), curvature and scatter, as `_slopes`, of all instruments."""
    totals = [sum(terms) for terms in zip(*(_slopes(part, poles) for part in parts), strict=True)]
    return totals[0], totals[1].reshape(-1, 2), *totals[2:]
