"""Error bars of any statistic from replicated designs: the same hypercube drawn again and again, independently."""

import numpy as np

from blockshake.errors import InputError
from blockshake.study.sampling.latin_hypercube import draw_samples


def replicate_seed(seed, replicate):
    """Seed of one of several independent designs: of who it is, not of the order in which it is drawn.

    ``seed`` of the study's design; ``replicate`` from 1, the study's own design being none.
    """
    return int(np.random.SeedSequence([seed, replicate]).generate_state(1)[0])


def replicated_designs(count, size, seed, **options):
    """Independent designs of the same variables.

    Parameters
    ----------
    count : int
        At least 2.
    size, seed, **options
        As for `draw_samples`.

    Returns
    -------
    list of SampleDesign, length count

    Raises
    ------
    InputError
        Fewer than two, or as `draw_samples`.
    """
    if count < 2:
        raise InputError("replicated designs", "count", f"expected at least 2, not {count}")
    return [draw_samples(size, replicate_seed(seed, place), **options) for place in range(1, count + 1)]


def replicate_error(statistics):
    """Standard errors of one design's statistic and of the mean of all.

    Parameters
    ----------
    statistics : float64 array, shape (n_replicates, ...)
        The same statistic of each design's ensemble.

    Returns
    -------
    mean : float64 array
    of_one : float64 array
        Standard deviation of one design's statistic; itself known to 1 / sqrt(2 (n_replicates - 1)).
    of_mean : float64 array
        Standard error of their mean.

    Raises
    ------
    InputError
        Fewer than two replicates.

    Notes
    -----
    The bootstrap treats the samples of one design as independent and overstates the error of what follows few
    variables steadily, because a hypercube fixes each one's distribution (Stein 1987, Technometrics 29, 143).
    Replicates need no such assumption, and cost a whole ensemble each.
    """
    statistics = np.asarray(statistics, dtype=float)
    if len(statistics) < 2:
        raise InputError("replicated designs", "statistics", f"expected at least two, not {len(statistics)}")
    of_one = statistics.std(axis=0, ddof=1)
    return statistics.mean(axis=0), of_one, of_one / np.sqrt(len(statistics))
