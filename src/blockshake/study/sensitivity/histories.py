"""Histories as outputs of a sensitivity study: whole, and window by window."""

import numpy as np

from blockshake.dynamics.system import Status
from blockshake.study.ensembles.ensemble import relative_to_slab

WINDOW = 1.0  # s; about a cycle of rocking: shorter ones show the phase within it
_KEPT = 1.0 - 1e-9  # of a history's variance, by the components that stand for it


def completed_histories(counted, markers, slab):
    """Displacement along x relative to the slab's marker of completed samples, (n_samples, n_markers, n_times) [m].

    ``counted`` from `counted_samples`; NaN for samples that did not complete.
    """
    completed = counted["status"].values == Status.COMPLETED
    along = relative_to_slab(counted["marker_displacement"].sel(axis="x", drop=True), slab)
    along = along.sel(marker=markers).transpose("sample", "marker", "time").to_numpy()
    return np.where(completed[:, None, None], along, np.nan)


def window_bounds(times):
    """First and last sample of each window of a second, and its middle.

    Parameters
    ----------
    times : float64 array, shape (n_times,)
        [s], from 0, evenly spaced.

    Returns
    -------
    edges : int64 array, shape (n_windows + 1,)
    middle : float64 array, shape (n_windows,)
        [s]; a rest shorter than half a window belongs to the last one.
    """
    count = max(1, int(np.floor((times[-1] - times[0]) / WINDOW + 0.5)))
    starts = np.searchsorted(times, times[0] + WINDOW * np.arange(count) - 1e-9)
    edges = np.append(starts, len(times))
    last = np.append(times[starts[1:]], times[-1])
    return edges, 0.5 * (times[starts] + last)


def principal_components(histories):
    """Histories in coordinates that keep the distances between samples.

    Parameters
    ----------
    histories : float64 array, shape (n_samples, n_outputs, n_times)
        [m]; samples with NaN are unknown.

    Returns
    -------
    float64 array, shape (n_samples, n_outputs, n_components)
        [m], root mean square over the times, so that the variance summed over the components is the mean over the times
        of the variance over the samples; NaN where unknown. A variance over classes then costs no more than of a few
        numbers.
    """
    known = np.isfinite(histories).all(axis=(1, 2))
    pieces = []
    for output in range(histories.shape[1] if known.any() else 0):
        curves = histories[known, output]
        left, singular, _ = np.linalg.svd(curves - curves.mean(axis=0), full_matrices=False)
        energy = np.cumsum(singular**2)
        needed = 1 + int(np.searchsorted(energy, _KEPT * energy[-1]))
        pieces.append((left * singular)[:, :needed] / np.sqrt(histories.shape[2]))
    most = max((piece.shape[1] for piece in pieces), default=1)
    components = np.full((len(histories), histories.shape[1], most), np.nan)
    components[known] = 0.0
    for output, piece in enumerate(pieces):
        components[known, output, : piece.shape[1]] = piece
    return components
