"""Odds of causes whose forms are no more than nearly true."""

import numpy as np

ODDS = float(np.log(20.0))  # within which causes are not told apart
COARSENING = 0.05  # share of what it explains that the form of a cause may leave unexplained
FORM = 0.1  # of a size, by which a cause of another form than the registry's has another one


def coarsened(difference, gain):
    """Logarithm of the odds of two causes whose scores differ, the better one gaining ``gain``.

    The likelihood is raised to ``1 / (1 + delta gain / ln 20)``: a form may leave a share delta of what it explains
    (Miller and Dunson 2019, coarsened posteriors).
    """
    return difference / (1.0 + COARSENING * max(gain, 0.0) / ODDS)
