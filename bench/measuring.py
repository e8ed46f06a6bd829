"""CPU time of a call, and how a handful of repeats is summed up."""

import time

import numpy as np

STATISTICS = ("median", "lower_quartile", "upper_quartile")


def process_seconds(function, *arguments):
    """CPU time of one call in this process [s]."""
    started = time.process_time()
    function(*arguments)
    return time.process_time() - started


def seconds_between(run, first, last, repeats):
    """CPU time of ``run(last)`` less that of ``run(first)``, each repeat with both [s].

    The set-up, which both have in common, goes out; both must have run once before.
    """
    seconds = []
    for _ in range(repeats):
        before = process_seconds(run, first)
        seconds.append(process_seconds(run, last) - before)
    return np.array(seconds)


def spread(values):
    """Median and quartiles of repeats, and how many there were."""
    quartiles = np.quantile(values, [0.5, 0.25, 0.75])
    return {**dict(zip(STATISTICS, map(float, quartiles), strict=True)), "repeats": len(values)}
