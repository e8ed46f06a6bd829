"""Detection limits: the size from which a cause would be seen, known from the rows before any cause is looked for."""

import numpy as np


def detection_limit(likelihood, columns, scale, needed):
    """Amplitude at which the expected gain of a cause reaches what is needed.

    Parameters
    ----------
    likelihood : Likelihood
        Without a cause.
    columns : list of float64 array, shape (n_rows,)
        By test, per unit of the amplitude.
    scale : float
        Standard deviation of the amplitude's prior.
    needed : float
        Gain that is no chance, the average over places included.

    Returns
    -------
    float
        Infinite where the rows do not tell the amplitude.

    Notes
    -----
    With the standard deviation s of the amplitude, nuisances free, an amplitude a gains
    ``a^2 / (2 s^2) - ln(1 + scale^2 / s^2) / 2`` in the mean.
    """
    whitened = likelihood.whiten([rows[:, None] for rows in columns])
    gram = float(likelihood.normal_equations(whitened)[1][0, 0])
    if not gram > 0.0:
        return np.inf
    return float(np.sqrt((2.0 * needed + np.log1p(gram * scale**2)) / gram))
