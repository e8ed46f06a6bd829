"""What a campaign holds, lacks and contradicts, in lines for a reader."""

import numpy as np

from blockshake.dynamics.load_motion import load_motion
from blockshake.errors import InputError
from blockshake.geometry.structure import load_structure
from blockshake.measurement.campaign import load_campaign, load_test
from blockshake.measurement.markers import marker_bodies

_QUIET = 0.5  # s at most that are taken as the quiet start
_QUIET_PART = 0.02  # of the commanded peak displacement: the record is quiet until the command reaches it
_NOISE_FACTOR = 2.0  # between the noise found and the noise stated
_FOLLOWED = (0.8, 1.25)  # of the commanded peak that a table may reach without a word
_UNIT = 100.0  # a peak so many times the commanded one is another unit


def campaign_lines(folder):
    """Lines that say what is there, and then every inconsistency.

    Parameters
    ----------
    folder : str or path

    Returns
    -------
    list of str

    Raises
    ------
    InputError
        What cannot be read, or is no displacement in metres along the axis that was commanded.
    """
    campaign = load_campaign(folder)
    structure = load_structure(campaign.structure)
    lines = [
        f"campaign {campaign.name} on {campaign.structure}: {len(campaign.tests)} tests; stated noise of markers "
        f"{campaign.sensors.marker_noise:g} m, of accelerometers {campaign.sensors.accelerometer_noise:g} m/s2"
    ]
    remarks = []
    for entry in campaign.tests.values():
        test = load_test(campaign, entry.name)
        commanded = _commanded(campaign, entry)
        facts, found = _describe(test, entry, structure, commanded, campaign)
        lines.append(f"  {entry.name} ({entry.role}): {facts}")
        remarks += [f"  {entry.name}: {remark}" for remark in found]
    for marker in structure.file.markers:
        if all(marker.name not in load_test(campaign, name)["marker"].values for name in campaign.tests):
            remarks.append(f"  marker {marker.name} of the structure is in no test")
    return lines + (["remarks:", *remarks] if remarks else ["no inconsistency found"])


def _commanded(campaign, entry):
    """The motion that was commanded, None where the campaign names one that is not at hand."""
    own = campaign.folder / entry.motion
    try:
        return load_motion(own if own.is_file() else entry.motion, entry.scale)
    except InputError:
        return None


def _describe(test, entry, structure, commanded, campaign):
    """Facts of a test in one line, and its inconsistencies."""
    path = campaign.folder / campaign.tests[entry.name].file
    time = test["time"].to_numpy()
    displacement = test["marker_displacement"]
    rate = 1.0 / np.median(np.diff(time))
    gaps = float(displacement.isnull().mean())
    facts = [
        f"{time[-1] - time[0]:.4g} s at {rate:.4g} Hz",
        f"{test.sizes['marker']} markers on {len(set(marker_bodies(structure, test['marker'].values)))} bodies",
        f"{100.0 * gaps:.2g} % gaps",
    ]
    remarks = []
    if "accelerometer" in test:
        steps = np.diff(test["time_acc"].to_numpy())
        facts.append(f"{test.sizes['channel']} accelerometer channels at {1.0 / np.median(steps):.4g} Hz")
    else:
        facts.append("no accelerometers")
    if np.ptp(np.diff(time)) > 0.01 * np.median(np.diff(time)):
        remarks.append("the marker times are not even")
    if commanded is None:
        remarks.append(f"the commanded motion {entry.motion} is not at hand")
        quiet = time <= time[0] + _QUIET
    else:
        target = commanded.evaluate(time - time[0])[:, 0]
        target = target - target[0]
        peak = np.abs(target).max()
        if entry.role != "sealed":  # of which shape and noise may be read, no more
            slab = _slab_displacement(test, structure)
            _check_slab(slab, peak, path)
            ratio = float(np.nanmax(np.abs(slab[:, 0])) / peak)
            facts.append(f"table reached {100.0 * ratio:.3g} % of the commanded peak of {1e3 * peak:.3g} mm")
            if not _FOLLOWED[0] < ratio < _FOLLOWED[1]:
                remarks.append(f"the table's peak is {ratio:.2f} of the commanded one")
        moving = np.abs(target) > _QUIET_PART * peak
        quiet = (time <= time[0] + _QUIET) & (time < time[np.argmax(moving)])
    noise = _noise(displacement.to_numpy()[quiet])
    if np.isfinite(noise):
        facts.append(
            f"marker noise {1e3 * noise:.3g} mm in the quiet {1e3 * (time[quiet][-1] - time[0]):.3g} ms"
        )
        stated = campaign.sensors.marker_noise
        if not stated / _NOISE_FACTOR < noise < stated * _NOISE_FACTOR:
            remarks.append(f"marker noise found {1e3 * noise:.3g} mm, stated {1e3 * stated:.3g} mm")
    return ", ".join(facts), remarks


def _slab_displacement(test, structure):
    """Mean over the driven body's markers, shape (n_times, 3) [m]."""
    driven = {body.name for body in structure.file.bodies if body.driven}
    bodies = marker_bodies(structure, test["marker"].values)
    own = [body in driven for body in bodies]
    return test["marker_displacement"].to_numpy()[:, own].mean(axis=1)


def _check_slab(slab, peak, path):
    """Refuse what cannot be the commanded motion along x, in metres."""
    reached = np.nanmax(np.abs(slab), axis=0)
    if reached[0] > _UNIT * peak:
        raise InputError(
            path, "marker_displacement",
            f"expected metres; the table's {reached[0]:.3g} against {peak:.3g} m commanded looks like millimetres",
        )  # fmt: skip
    if reached[0] < 0.1 * peak and reached[1:].max() > 0.5 * peak:
        axis = "yz"[int(reached[1:].argmax())]
        raise InputError(
            path, "axis",
            f"expected the table to move along x; it moves by {reached[1:].max():.3g} m along {axis}, axes are swapped",
        )  # fmt: skip


def _noise(readings):
    """Standard deviation of a reading from the differences of neighbours, which no slow motion enters [m]."""
    if len(readings) < 10:
        return np.nan
    return float(np.sqrt(np.nanmean(np.diff(readings, axis=0) ** 2) / 2.0))
