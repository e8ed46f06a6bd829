"""Correlation control by simulated annealing: values stay, their pairing changes.

Vorechovsky and Novak (2009): a Latin hypercube design keeps the values of every column; two entries
of one column change places, and the change is kept if the norm of the correlation error falls, or
by chance if it rises, less and less often as the temperature falls.
"""

import numpy as np

from blockshake.jit import kernel

# found by trial on 50 x 9; slower cooling and hotter starts gave the same error for the same time
_LEVELS = 120
_COOLING = 0.94
_TRIALS_PER_VALUE = 24
_FEWEST_TRIALS, _MOST_TRIALS = 2_000, 40_000
# far above the last digits of an exponential, which differ between processors, and far below what a swap changes
_GRID = 2.0**-30


def arrange(columns, target, seed, effort):
    """Order of the values in every column that brings the correlation close to a target.

    Parameters
    ----------
    columns : float64 array, shape (n_samples, n_variables)
        What correlates: values (Pearson) or ranks (Spearman), any order within a column.
    target : float64 array, shape (n_variables, n_variables)
        Correlation matrix, positive definite.
    seed : int or list of int
        Seed of every random choice here; PCG64's raw stream, which NumPy keeps fixed.
    effort : int
        Rounds of annealing. Each starts from the best order so far and only a better one
        replaces it, so that more effort never gives a larger error.

    Returns
    -------
    order : int64 array, shape (n_samples, n_variables)
        Row of ``columns`` that goes to each place; a permutation in every column, the same on any processor.
    """
    n_samples, n_variables = columns.shape
    standard = np.rint((columns - columns.mean(axis=0)) / columns.std(axis=0) / _GRID) * _GRID
    streams = np.random.SeedSequence(seed).spawn(effort + 1)
    order = _first_order(standard, target, streams[0])
    if n_variables == 1:
        return order
    n_trials = int(np.clip(_TRIALS_PER_VALUE * n_samples * n_variables, _FEWEST_TRIALS, _MOST_TRIALS))
    best, least = order.copy(), np.inf
    for stream in streams[1:]:
        bits = np.random.PCG64(stream)
        order[:] = best
        scores = np.ascontiguousarray(np.take_along_axis(standard, order, axis=0))
        # a third of the typical change of the error by one swap: leaves a local minimum, keeps the start
        temperature = 0.3 / (n_samples * np.sqrt(n_variables))
        for _ in range(_LEVELS):
            trials = _draw_trials(bits, n_trials, n_samples, n_variables)
            found = anneal_level(target, *trials, temperature, least, scores, order, best)
            least = min(least, found)
            temperature *= _COOLING
    return best


def _first_order(standard, target, stream):
    """Order by the ranks of correlated normal scores, near the target within chance.

    The scores come in random order, so that the start is random but for the correlation.
    """
    n_samples, n_variables = standard.shape
    raw = np.random.PCG64(stream).random_raw(n_samples * n_variables).reshape(n_samples, n_variables)
    shuffled = np.take_along_axis(np.sort(standard, axis=0), np.argsort(raw, axis=0, kind="stable"), axis=0)
    # Iman and Conover (1982): ranks of scores that correlate as the target does
    wanted = shuffled @ np.linalg.cholesky(target).T
    ranks = np.argsort(np.argsort(wanted, axis=0, kind="stable"), axis=0, kind="stable")
    return np.take_along_axis(np.argsort(standard, axis=0, kind="stable"), ranks, axis=0)


def _draw_trials(bits, n_trials, n_samples, n_variables):
    """Columns, rows, other rows (int64) and chances in (0, 1) of a level's trial swaps."""
    raw = bits.random_raw(3 * n_trials).reshape(3, n_trials)
    column = (raw[0] >> np.uint64(32)) % np.uint64(n_variables)
    first = (raw[0] & np.uint64(0xFFFFFFFF)) % np.uint64(n_samples)
    second = (first + np.uint64(1) + raw[1] % np.uint64(n_samples - 1)) % np.uint64(n_samples)
    chance = ((raw[2] >> np.uint64(11)) + 0.5) * 2.0**-53
    return column.astype(np.int64), first.astype(np.int64), second.astype(np.int64), chance


@kernel
def anneal_level(target, column, first, second, chance, temperature, least, scores, order, best):
    """Try a list of swaps at one temperature.

    Parameters
    ----------
    target : float64 array, shape (n_variables, n_variables)
    column, first, second : int64 arrays, shape (n_trials,)
        Entries ``first`` and ``second`` of ``column`` change places; they differ.
    chance : float64 array, shape (n_trials,)
        In (0, 1); a rise of the error by ``d`` is kept if below ``exp(-d / temperature)``.
    temperature : float
        In units of the error [1].
    least : float
        Smallest error known so far.
    scores : float64 array, shape (n_samples, n_variables)
        Standardised columns as placed now; changed in place.
    order : int64 array, shape (n_samples, n_variables)
        What stands where; changed in place with ``scores``.
    best : int64 array, shape (n_samples, n_variables)
        Overwritten with the best order met here if its error is below ``least``.

    Returns
    -------
    float
        Smallest error met here, or ``least``.

    Notes
    -----
    A swap changes the correlation of its column with each other one by one product, so that a trial
    costs the number of variables, not of samples. The way back from the last order to the best
    one is kept as a trail of swaps, each its own inverse.
    """
    n_samples, n_variables = scores.shape
    n_pairs = 0.5 * n_variables * (n_variables - 1)
    # anew at every level, so that rounding does not pile up
    error = np.zeros((n_variables, n_variables))
    for row in range(n_samples):
        for i in range(n_variables):
            for j in range(i):
                error[i, j] += scores[row, i] * scores[row, j]
    squares = 0.0
    for i in range(n_variables):
        for j in range(i):
            error[i, j] = error[i, j] / n_samples - target[i, j]
            error[j, i] = error[i, j]
            squares += error[i, j] * error[i, j]
    least_squares = least * least * n_pairs
    improved = squares < least_squares
    if improved:
        least_squares = squares
    # swaps since the best order: undone at the end instead of a copy at every improvement
    trail = np.empty(column.size, dtype=np.int64)
    n_trail = 0

    for trial in range(column.size):
        j, a, b = column[trial], first[trial], second[trial]
        step = (scores[b, j] - scores[a, j]) / n_samples
        change = 0.0
        for i in range(n_variables):
            if i != j:
                d = step * (scores[a, i] - scores[b, i])
                change += d * (2.0 * error[i, j] + d)
        after = max(squares + change, 0.0)
        if change > 0.0:
            rise = np.sqrt(after / n_pairs) - np.sqrt(squares / n_pairs)
            if chance[trial] >= np.exp(-rise / temperature):
                continue
        for i in range(n_variables):
            if i != j:
                error[i, j] += step * (scores[a, i] - scores[b, i])
                error[j, i] = error[i, j]
        scores[a, j], scores[b, j] = scores[b, j], scores[a, j]
        order[a, j], order[b, j] = order[b, j], order[a, j]
        squares = after
        trail[n_trail] = trial
        n_trail += 1
        if squares < least_squares:
            least_squares = squares
            improved = True
            n_trail = 0

    if not improved:
        return least
    best[:] = order
    while n_trail > 0:
        n_trail -= 1
        trial = trail[n_trail]
        j, a, b = column[trial], first[trial], second[trial]
        best[a, j], best[b, j] = best[b, j], best[a, j]
    return np.sqrt(least_squares / n_pairs)
