"""The motion that drives the models of a case: the measured motion of the slab, or the commanded one."""

from pathlib import Path

import numpy as np
import xarray as xr

from blockshake.dynamics.load_motion import load_motion, scaled
from blockshake.dynamics.record_set import DrawnMotions
from blockshake.errors import InputError
from blockshake.files import content_digest
from blockshake.geometry.structure import load_structure
from blockshake.measurement.campaigns.campaign import load_campaign, load_test
from blockshake.measurement.campaigns.clocks import since
from blockshake.measurement.campaigns.commanded_motion import follow
from blockshake.measurement.campaigns.initial_poses import initial_poses
from blockshake.measurement.motion.measured_base import base_as_motion, draw_base, measure_base
from blockshake.measurement.sensors.markers import driven_marker, unread_directions
from blockshake.quantities import FACTOR, HEADING
from blockshake.store import load_made

MEASURED, COMMANDED = "measured", "commanded"
_UNKNOWN, _GAP = 0.1, 10.0  # of the slab's range and of the usual error: a larger error is that of a gap
_SHORT = 0.05  # s, by which a record may end before the simulated window


def measured_input(case, named):
    """The slab's motion in the test that a case is compared with.

    Parameters
    ----------
    case : dict
        ``structure``, ``motion``, ``scale``, ``baseline``, ``duration`` [s] and ``input`` of a case of the
        configuration.
    named : dict
        Entries ``campaign``, a folder, and ``test``.

    Returns
    -------
    xarray.Dataset
        From `measure_base`, and the attributes ``test``, ``synthetic``, ``gain``, the regression of the slab's
        displacement along x on the command in the simulated window [1], and ``departure``, the root mean square of
        their difference [m]; both NaN where the slab does not follow. ``starting_place`` as the test has it.

    Raises
    ------
    InputError
        A record that ends before the simulated window, or with a gap in which the slab's motion is lost, where it is
        the input.
    """
    campaign = load_campaign(named["campaign"])
    test = load_test(campaign, named["test"])
    command = commanded(case)
    base = measure_base(test, load_structure(campaign.structure), campaign.sensors, command)
    length = base.attrs["end"] - base.attrs["start"]
    if case["input"] == MEASURED:
        check_record(length, case["duration"], named["test"], "duration")
        check_known(base, case["duration"], named["test"])
    base.attrs |= {"test": named["test"], "synthetic": int(test.attrs.get("synthetic", 0))}
    base.attrs |= dict(zip(("gain", "departure"), _against(base, command, case["duration"]), strict=True))
    return base.assign(starting_place=test["starting_place"]) if "starting_place" in test else base


def structure_of_case(case, base):
    """Structure of a case, its blocks where the test stood that it is compared with.

    ``base``: from `measured_input`, or its file; none where the case names no test.
    """
    structure = load_structure(case["structure"])
    return initial_poses(structure, _loaded(base)) if base else structure


def commanded(case):
    """`GroundMotion` that a case commands, from its ``motion``, ``scale`` and ``baseline``."""
    return load_motion(case["motion"], case["scale"], case["baseline"])


def check_record(length, duration, where, key):
    """Refuse a simulated window [s] beyond the record, of some length [s], of the motion that drives it."""
    if length < duration - _SHORT:
        raise InputError(
            where,
            key,
            f"expected at most {length:.4g} s, the record of the slab's motion, or input: {COMMANDED}",
        )


def check_known(base, duration, where):
    """Refuse a window of which the slab's displacement along x is not known, in a gap of its readings."""
    since_start = base["time"] - base.attrs["start"]
    slab = base.sel(channel="x").isel(time=np.flatnonzero((since_start >= 0.0) & (since_start <= duration)))
    error, moved = slab["displacement_error"].to_numpy(), slab["displacement"].to_numpy()
    if not len(error):
        return
    worst = int(error.argmax())
    if error[worst] > max(_UNKNOWN * np.ptp(moved), _GAP * np.median(error)):
        raise InputError(
            where,
            "marker_displacement",
            f"expected readings of the slab along x without a long gap, or input: {COMMANDED}; its displacement is "
            f"known to {1e3 * error[worst]:.3g} mm alone at {float(slab['time'][worst]):.4g} s",
        )


def measured_on_clock(named, base):
    """Readings of the test of `measured_input` with time 0 where the input starts, and the markers' noise [m].

    ``base``: from `measured_input`, or its file. Markers that do not measure x are left out; the attribute
    ``slab_marker`` is the first of a driven body that does.
    """
    campaign = load_campaign(named["campaign"])
    test = load_test(campaign, named["test"])
    unread = {marker for marker, axis in unread_directions(test) if axis == "x"}
    test = test.sel(marker=[name for name in test["marker"].values if name not in unread])
    slab_marker = driven_marker(load_structure(campaign.structure), test["marker"].values)
    test = test.assign_attrs(slab_marker=slab_marker)
    return since(test, _loaded(base).attrs["start"]), campaign.sensors.marker_noise


def as_sampled(motion, row):
    """A motion turned by ``motion.heading`` [rad] and scaled by ``motion.scale`` [1] of a sample, where it has them."""
    turned = motion.turned(float(row.get(HEADING, 0.0)))
    return scaled(turned, float(row.get(FACTOR, 1.0)), motion.name)


def driving_motions(case, base, seed):
    """Function that gives the `GroundMotion` of a sample by its number and, where they change it, its values.

    Parameters
    ----------
    case : dict
        As for `measured_input`.
    base : xarray.Dataset, path or None
        From `measured_input`, or its file; not used where the input is commanded.
    seed : int
        Seed of the design: a sample of another design has another draw of the measured motion, or of the records.

    Notes
    -----
    A draw depends on structure, motion, scale, seed and sample: it is the same for all models and in any order.
    """
    motions = _motions(case, base, seed)
    return lambda sample, row=None: motions(sample) if row is None else as_sampled(motions(sample), row)


def _motions(case, base, seed):
    """Function that gives the motion of a sample by its number, before the sample's values change it."""
    if case.get("intensity"):
        drawn = DrawnMotions.of(case)
        return lambda sample: drawn.motion(drawn.draw(sample, seed))
    if case["input"] == COMMANDED:
        motion = commanded(case)
        return lambda sample: motion
    base = _loaded(base)
    identity = Path(case["structure"]).stem, Path(case["motion"]).stem, case["scale"], seed
    attributes = {"source": f"measured motion of the slab, {base.attrs['test']}", "scale": case["scale"]}
    attributes |= {"synthetic": bool(base.attrs["synthetic"])}

    def drawn(sample):
        digest = content_digest("base", *identity, int(sample))
        moved = draw_base(base, np.random.default_rng(int(digest, 16)))
        return base_as_motion(base, moved, f"{base.attrs['test']}, measured", attributes)

    return drawn


def _loaded(base):
    return base if isinstance(base, xr.Dataset) else load_made(base)


def _against(base, command, duration):
    """Gain and departure of the slab against the command."""
    time = base["time"].to_numpy() - base.attrs["start"]
    inside = (time >= 0.0) & (time <= duration)
    moved = base["displacement"].transpose("time", "channel").to_numpy()[inside, :3]
    commanded = command.evaluate(time[inside])[:, 0]
    followed = follow(moved, commanded, 0.0)
    if followed is None or not base.attrs["follows"]:
        return np.nan, np.nan
    return float(followed.share[0]), float(np.std(moved[:, 0] - commanded))
