"""The slab's markers, which are the input, held against the motion that was commanded."""

from decimal import Decimal
from os.path import isfile
from typing import NamedTuple

import numpy as np

from blockshake.dynamics.load_motion import load_motion
from blockshake.errors import InputError
from blockshake.files import shipped_names
from blockshake.measurement.campaigns.clocks import command_start
from blockshake.tables.units import UNITS

_FOLLOWED = (0.8, 1.25)  # of the command, by which a table may move without a word
_SEEN = 2.0  # times the slab's noise, that the command's standard deviation must be to be judged
_RELATED = 0.7  # correlation of the slab with the command, beyond which one is the other's motion
_SURE = 0.95  # correlation of velocities, above which no other motion is tried
_BETTER = 0.25  # of the variance that the stated motion leaves, that another may leave
_UNIT = 20.0  # times the command, by which no table moves; centimetres are a hundred times
_PRECISE = 0.05  # of the command, within which a table follows it in another unit
_ONE_AXIS = 3.0  # times the motion along another axis


class Followed(NamedTuple):
    """Regression of the slab's displacement along x, y and z on the command along x.

    ``share`` and ``correlation``: slope and correlation, float64 (3,) [1]; NaN along an axis that is not measured.
    """

    share: np.ndarray
    correlation: np.ndarray


def follow(slab, target, noise):
    """How the slab follows the command, None where that is too small to be seen.

    Parameters
    ----------
    slab : float64 array, shape (n_times, 3)
        Mean displacement of the slab's markers [m]; gaps are NaN, as is an axis that is not measured.
    target : float64 array, shape (n_times,)
        Commanded displacement along x [m].
    noise : float
        Standard deviation of the slab's mean [m].
    """
    measured = np.isfinite(slab).any(axis=0)
    known = np.isfinite(slab[:, measured]).all(axis=1)
    spread = np.std(target[known]) if known.sum() > 2 else 0.0
    if spread <= _SEEN * noise or spread == 0.0:
        return None
    centred = target[known] - target[known].mean()
    moved = slab[known] - slab[known].mean(axis=0)
    common = moved.T @ centred
    size = np.sqrt((moved**2).sum(axis=0) * (centred @ centred))
    correlation = np.divide(common, size, out=np.zeros(3), where=size > 0.0)
    correlation[~measured] = np.nan
    return Followed(common / (centred @ centred), correlation)


def check_followed(followed, path):
    """Refuse a slab that moves as commanded along another axis, backwards, or in another unit: `InputError`."""
    share, correlation = np.nan_to_num(followed.share), np.nan_to_num(followed.correlation)
    other = 1 + int(np.abs(correlation[1:]).argmax())
    if abs(correlation[0]) < _RELATED < abs(correlation[other]) and abs(share[other]) > _FOLLOWED[0] / 2.0:
        wrong = f"expected the table to move along x; what was commanded is along {'xyz'[other]}, axes are swapped"
        raise InputError(path, "axis", wrong)
    if abs(correlation[0]) > _RELATED and abs(share[0]) > _UNIT:
        wrong = f"expected metres; the table moves by {abs(share[0]):.3g} times what was commanded"
        raise InputError(path, "marker_displacement", "; ".join([wrong, *_unit_words(abs(share[0]))]))
    if correlation[0] < -_RELATED:
        wrong = f"expected the table to move along x as commanded; it moves by {share[0]:.2f} of it, x is reversed"
        raise InputError(path, "axis", wrong)


def followed_remarks(followed, role):
    """Remarks on a slab that moves otherwise, or by another size, than commanded; of a sealed test no size."""
    if followed.correlation[0] < _RELATED:
        others = "another motion, another start or another time scale"
        return [f"the table does not follow the commanded motion: {others}"]
    share = followed.share[0]
    if words := _unit_words(share):
        return words
    if role != "sealed" and not _FOLLOWED[0] < share < _FOLLOWED[1]:
        return [f"the table moved by {share:.2f} of what was commanded"]
    return []


def _unit_words(share):
    """Words on the unit by which a table that moved by a share of its command would follow it, if one does."""
    power = -round(np.log10(share)) if share > 0.0 else 0
    factor = Decimal(10) ** power
    sizes = UNITS["displacement"].items()
    names = [f"{one}, not {other}" for one, size in sizes for other, less in sizes if size == factor * less]
    if not power or not names or abs(share * float(factor) - 1.0) > _PRECISE:
        return []
    return [f"the table would follow its command with readings {float(factor):g} times as large: is the unit "
            f"{', or '.join(names)}?"]  # fmt: skip


def another_record_remarks(test, slab, campaign, entry):
    """A remark where the slab follows another motion far better than the one that the test names.

    Parameters
    ----------
    test : xarray.Dataset
        From `load_test`.
    slab : float64 array, shape (n_times, 3)
        Mean displacement of the slab's markers [m].
    campaign : Campaign
        Whose other motions, and those that are shipped, are tried at any start and size.
    entry : MeasuredTest
    """
    stated = test.attrs["correlation"]
    if stated > _SURE:
        return []
    found = {}
    listed = {other.motion: other for other in campaign.tests.values()}
    shipped = {name: entry.model_copy(update={"motion": name}) for name in shipped_names("motions")}
    for name, other in (shipped | listed).items():
        motion = None if name == entry.motion else commanded_motion(campaign, other)
        if motion is not None:
            found[name] = command_start(test["time"].to_numpy(), slab[:, 0], motion).correlation
    best = max(found, key=found.get, default=None)
    if best is None or found[best] < _FOLLOWED[0] or 1.0 - found[best] ** 2 > _BETTER * (1.0 - stated**2):
        return []
    return [
        f"the table follows {best} (correlation of velocities {found[best]:.2f}), not {entry.motion} ({stated:.2f}): "
        "another record?"
    ]


def command_target(test, slab, commanded):
    """Commanded displacement along x since the first reading of a test, (n_times,) [m].

    Parameters
    ----------
    test : xarray.Dataset
        A test from `from_command`, whose clock counts from the start of the command where the slab follows along x.
    slab : float64 array, shape (n_times, 3)
        Mean displacement of the slab's markers [m].
    commanded : GroundMotion

    Notes
    -----
    The start of a slab that moves backwards or along another axis is searched for along that axis.
    """
    time, zero = test["time"].to_numpy(), 0.0
    if not test.attrs["follows"]:
        starts = [command_start(time, moved, commanded) for moved in slab.T]
        best = max(starts, key=lambda start: abs(start.correlation))
        zero = best.time if best.related else 0.0
    target = commanded.evaluate(time - zero)[:, 0]
    return target - target[0]


def length_remarks(time, commanded):
    """A remark where the record ends before, or begins after, the strongest acceleration that was commanded."""
    breaks = commanded.table.breaks
    acceleration = np.abs(commanded.evaluate(breaks, 2)[:, 0])
    strongest = breaks[acceleration.argmax()]
    if not acceleration.any() or time[0] < strongest < time[-1]:
        return []
    how = "begins after" if strongest <= time[0] else "ends before"
    return [
        f"the record of {time[-1] - time[0]:.4g} s {how} the strongest shaking, commanded at {strongest:.4g} s"
    ]


def driven_axis_remarks(slab):
    """A remark where the slab of a test whose command is not at hand moves most along another axis than x."""
    spread = np.nanstd(np.where(np.isfinite(slab).any(axis=0), slab, 0.0), axis=0)
    other = 1 + int(spread[1:].argmax())
    if spread[other] > _ONE_AXIS * spread[0]:
        return [f"the table moves along {'xyz'[other]}, not along x"]
    return []


def commanded_motion(campaign, entry):
    """The motion that was commanded in a test, None where the campaign names one that is not at hand."""
    path = campaign.folder / entry.motion
    if not isfile(path) and entry.motion not in shipped_names("motions"):
        return None
    return load_motion(path if isfile(path) else entry.motion, entry.scale, entry.baseline)
