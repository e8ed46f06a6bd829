"""The statistical rival: what the nominal model missed in the open tests, carried on to another one without a name."""

import numpy as np
from scipy.special import ndtri

from blockshake.diagnosis.nominal.ensemble import NOMINAL


def members_with_discrepancy(test, opened, motions, peaks):
    """Nominal members of a sealed test with a draw of the discrepancy each.

    Parameters
    ----------
    test : JudgedTest
        Sealed.
    opened : list of JudgedTest
        Open ones.
    motions : dict of str to str
        By test, the name of its motion.
    peaks : dict of str to float
        By test, the peak acceleration that was commanded [m/s2].

    Returns
    -------
    float64 array, shape (n_members, n_times, n_cells)

    Notes
    -----
    Measured = model + discrepancy + noise (Kennedy and O'Hagan 2001, J. R. Stat. Soc. B 63), with a discrepancy that
    grows with the intensity and is known of the same motion alone: its mean is what the nominal mean missed under this
    motion, over the peak acceleration, mean over those open tests, instant by instant; under a motion that no open
    test had it is nothing. Its spread is what this rule misses in the open tests, each predicted from the others, root
    mean square over tests and times by cell. Members are the medians of as many strata of the normal law, in an order
    of their own by cell.
    """
    time, names = test.measured["time"].to_numpy(), list(test.measured["cell"].values)
    missed = {one.name: _missed(one, names, time) / peaks[one.name] for one in opened}

    def carried(name):
        same = [miss for other, miss in missed.items() if other != name and motions[other] == motions[name]]
        same = np.array(same).reshape(-1, len(time), len(names))
        return np.nansum(same, axis=0) / np.maximum(np.isfinite(same).sum(axis=0), 1)

    errors = np.array([miss - carried(name) for name, miss in missed.items()])
    known = np.isfinite(errors).sum(axis=(0, 1))
    spread = np.sqrt(np.nansum(errors**2, axis=(0, 1)) / np.maximum(known, 1))
    members = test.members[NOMINAL].to_numpy()
    strata = ndtri((np.arange(len(members)) + 0.5) / len(members))
    orders = [np.random.default_rng([len(members), *name.encode()]).permutation(strata) for name in names]
    drawn = np.array(orders).T[:, None] * spread
    return members + peaks[test.name] * (carried(test.name) + drawn)


def _missed(test, names, time):
    """Measured less nominal mean until the horizon, at other times and cells, NaN where it is not known."""
    left = test.measured - test.members[NOMINAL].mean("run")
    left = left.copy(data=test.until_horizon(left.to_numpy()))
    return left.reindex(cell=names).interp(time=time).to_numpy()
