"""Content, gaps and contradictions of a campaign, in lines for a reader."""

import numpy as np

from blockshake.geometry.schema import AXES
from blockshake.geometry.structure import load_structure
from blockshake.geometry.structure_file import point_remarks
from blockshake.measurement.campaigns.campaign import load_campaign, load_test
from blockshake.measurement.campaigns.commanded_motion import (
    another_record_remarks,
    check_followed,
    command_target,
    commanded_motion,
    driven_axis_remarks,
    follow,
    followed_remarks,
    length_remarks,
)
from blockshake.measurement.campaigns.faulty_readings import faulty_lines
from blockshake.measurement.campaigns.initial_poses import initial_pose_lines
from blockshake.measurement.checks.against_slab import carried_remarks, clock_remarks
from blockshake.measurement.checks.block_channels import gravity_remarks, reversed_remarks
from blockshake.measurement.checks.exchanged import exchange_remarks
from blockshake.measurement.checks.quiet_noise import (
    accelerometer_noise,
    accelerometer_remarks,
    check_unit,
    displacement_remarks,
    marker_noise,
    rounding_noise,
)
from blockshake.measurement.motion.fall import find_fall
from blockshake.measurement.sensors.accelerometers import shaken_channels
from blockshake.measurement.sensors.found_noise import found_noise, noise_remarks
from blockshake.measurement.sensors.markers import (
    directions_read,
    marker_bodies,
    mean_read,
    on_driven,
    slab_displacement,
    unread_directions,
)
from blockshake.measurement.sensors.transducers import transducer_names

_QUIET = 0.5  # s at most that are taken as the quiet start
_QUIET_PART = 0.02  # of the commanded peak displacement: the record is quiet until the command reaches it
_AT_START = 10  # readings whose mean is the start
_SILENT = 10  # readings in a row that all are gaps
# of two columns with noise: one minus their correlation, and how far from 1 their ratio is
_MULTIPLE, _RATIO = 1e-9, 0.01
_START = 10.0  # times the noise, within which displacements start: the first reading's own is in all others


def campaign_lines(folder):
    """List of the lines that say what is in a campaign's folder, and then every inconsistency.

    Raises
    ------
    InputError
        A test that cannot be read; a slab that moves along another axis, backwards or in another unit than commanded;
        an accelerometer that reads in g.
    """
    campaign = load_campaign(folder)
    return campaign.kind.check(campaign)


def shaken_lines(campaign):
    """Lines of a campaign with base motion and readings, see `campaign_lines`."""
    structure = load_structure(campaign.structure)
    lines = [
        f"campaign {campaign.name} on {campaign.structure}: {campaign.counted}; stated noise of markers "
        f"{1e3 * campaign.sensors.marker_noise:g} mm, of accelerometers {campaign.sensors.accelerometer_noise:g} m/s2"
    ]
    if structure.file.displacement_transducers:
        lines[0] += f", of displacement transducers {1e3 * campaign.sensors.transducer_noise:g} mm"
    remarks, read, named, first = [f"  {remark}" for remark in point_remarks(structure)], {}, set(), {}
    tests = {}
    for entry in campaign.tests.values():
        test = tests[entry.name] = load_test(campaign, entry.name)
        kinds = [kind for kind in ("marker", "channel", "transducer") if kind in test.coords]
        read[entry.name] = [str(name) for kind in kinds for name in test[kind].values]
        named |= {(entry.name, fault.sensor) for fault in test.attrs["faulty"]}
        same = first.setdefault(test["marker_displacement"].to_numpy().tobytes(), entry.name)
        remarks += [f"  {entry.name}: has the readings of {same}"] if same != entry.name else []
        described = _Described(campaign, structure, entry, test)
        lines.append(f"  {entry.name} ({entry.role}): {', '.join(described.facts)}")
        remarks += [f"  {entry.name}: {remark}" for remark in described.remarks]
        fall = find_fall(test, structure, campaign.sensors) if entry.role != "sealed" else None
        if fall:
            fell = fall.time - float(test["time"][0])
            remarks.append(
                f"  {entry.name}: {fall.body} falls at {fell:.2f} s; a diagnosis reads the test until then"
            )
    if tests:
        found = found_noise(tests, structure, campaign.sensors)
        remarks += [f"  {remark}" for remark in noise_remarks(found, campaign.sensors)]
    seen = dict.fromkeys(name for names in read.values() for name in names)
    for test, names in read.items():
        lost = [name for name in seen if name not in names and (test, name) not in named]
        remarks += [f"  {test}: no readings of {', '.join(lost)}, which other tests have"] if lost else []
    unread = [f"marker {marker.name}" for marker in structure.file.markers if marker.name not in seen]
    unread += [f"displacement transducer {name}" for name in transducer_names(structure) if name not in seen]
    remarks += [f"  {name} of the structure is in no test" for name in unread]
    if all(entry.role == "sealed" for entry in campaign.tests.values()):
        remarks.append("  all tests are sealed: a diagnosis has none to read")
    return lines + (["remarks:", *remarks] if remarks else ["no inconsistency found"])


class _Described:
    """Facts and inconsistencies of one test; of a sealed one shape, noise and the input alone."""

    def __init__(self, campaign, structure, entry, test):
        self.sensors, self.structure, self.entry, self.test = campaign.sensors, structure, entry, test
        self.campaign = campaign
        self.path = campaign.folder / entry.file
        self.time = test["time"].to_numpy()
        self.readings = test["marker_displacement"].to_numpy()
        self.on_slab = on_driven(structure, test["marker"].values)
        self.slab = slab_displacement(test, structure)
        self.slab_noise = self.sensors.marker_noise / np.sqrt(self.on_slab.sum())
        self.facts, self.remarks = [], faulty_lines(test) + initial_pose_lines(test)
        commanded = commanded_motion(campaign, entry)
        self.target = None if commanded is None else command_target(test, self.slab, commanded)
        self._describe_shape()
        self._hold_input(commanded)
        self._hold_noise(self._quiet_end())
        if entry.role != "sealed":
            self._hold_answer()

    def _describe_shape(self):
        time, test = self.time, self.test
        rate = 1.0 / np.median(np.diff(time))
        bodies = set(marker_bodies(self.structure, test["marker"].values))
        self.facts += [
            f"{time[-1] - time[0]:.4g} s at {rate:.4g} Hz",
            f"{test.sizes['marker']} markers on {len(bodies)} bodies",
            f"{100.0 * np.isnan(self.readings[:, directions_read(self.readings)]).mean():.2g} % gaps",
        ]
        unread = unread_directions(test)
        if unread:
            self.facts.append(_unread_words(unread, test.sizes["marker"]))
        if "accelerometer" in test:
            rate_acc = 1.0 / np.median(np.diff(test["time_acc"]))
            self.facts.append(f"{test.sizes['channel']} accelerometer channels at {rate_acc:.4g} Hz")
        else:
            self.facts.append("no accelerometers")
        if "transducer_displacement" in test:
            read, rate_acc = test["transducer_displacement"], 1.0 / np.median(np.diff(test["time_acc"]))
            self.facts.append(
                f"{read.sizes['transducer']} displacement transducers at {rate_acc:.4g} Hz with "
                f"{100.0 * float(read.isnull().mean()):.2g} % gaps"
            )
        if np.ptp(np.diff(time)) > 0.01 * np.median(np.diff(time)):
            self.remarks.append("the marker times are not even")
        for name, mine in (("slab", self.on_slab), ("block", ~self.on_slab)):
            self.remarks += _silence(
                f"marker of a {name}", time - time[0], self.readings[:, mine].reshape(len(time), -1)
            )
        if "accelerometer" in test:
            read = test["accelerometer"].transpose("time_acc", "channel").to_numpy()
            self.remarks += _silence("accelerometer", test["time_acc"].to_numpy() - time[0], read)

    def _quiet_end(self):
        """Time before which nothing moves, by the command or, where that is not at hand, by habit [s]."""
        latest = self.time[0] + _QUIET
        if self.target is None:
            return latest
        target = np.abs(self.target)
        moving = target > max(_QUIET_PART * target.max(), self.sensors.marker_noise)
        return min(latest, self.time[np.argmax(moving)]) if moving.any() else latest

    def _hold_noise(self, quiet_end):
        """Noise of every channel against what is stated, and where displacements start."""
        names, stated = self.test["marker"].values, self.sensors.marker_noise
        quiet = self.time < quiet_end
        changing = marker_noise(self.readings[quiet])
        noise = np.maximum(changing, rounding_noise(self.readings))
        if np.isfinite(noise).any():
            check_unit(names, noise, stated, self.path)
            usual = np.sqrt(np.nanmean(noise**2))
            self.facts.append(
                f"marker noise {1e3 * usual:.3g} mm in the quiet {1e3 * (quiet_end - self.time[0]):.3g} ms"
            )
            self.remarks += displacement_remarks("marker", names, noise, stated)
            columns = [f"{name}.{axis}" for name in names for axis in AXES]
            read = self.readings.reshape(len(self.readings), -1)
            self.remarks += multiples(columns, read) if np.nanmax(changing) > 0.0 else []
            self._hold_start(quiet)
        else:
            self.facts.append("no quiet start to find the noise in")
        if "time_acc" not in self.test.coords:
            return
        quiet = (self.test["time_acc"] >= self.time[0]) & (self.test["time_acc"] < quiet_end)
        if "transducer_displacement" in self.test:
            read = self.test["transducer_displacement"].transpose("time_acc", "transducer")
            names, stated = read["transducer"].values, self.sensors.transducer_noise
            values = read.to_numpy()[..., None]
            noise = np.maximum(marker_noise(values[quiet.to_numpy()]), rounding_noise(values))
            check_unit(names, noise, stated, self.path)
            self.remarks += displacement_remarks("displacement transducer", names, noise, stated)
            self.remarks += multiples(names, read.to_numpy())
        if "accelerometer" in self.test:
            fast, whole = accelerometer_noise(self.test["accelerometer"].to_numpy()[quiet.to_numpy()])
            if np.isfinite(fast).any():
                self.facts.append(f"accelerometer noise {np.nanmedian(fast):.3g} m/s2")
            self.remarks += accelerometer_remarks(
                self.test["channel"].values, fast, whole, self.sensors.accelerometer_noise
            )
            self.remarks += gravity_remarks(self.test, self.structure, quiet_end)
            read = self.test["accelerometer"].transpose("time_acc", "channel").to_numpy()
            self.remarks += multiples(self.test["channel"].values, read) if (fast > 0.0).all() else []

    def _hold_start(self, quiet):
        start = np.abs(mean_read(self.readings[quiet][:_AT_START].swapaxes(0, 1)))
        start = np.where(np.isfinite(start), start, 0.0).max(axis=1)
        far = int(start.argmax())
        if start[far] > _START * self.sensors.marker_noise:
            self.remarks.append(
                f"{self.test['marker'].values[far]} starts {1e3 * start[far]:.3g} mm off: displacements count from "
                "the first reading"
            )

    def _hold_input(self, commanded):
        """The slab's markers against the command."""
        if commanded is None:
            self.remarks.append(
                f"the commanded motion {self.entry.motion} is not at hand, without which there is no diagnosis"
            )
            self.remarks += driven_axis_remarks(self.slab)
            return
        self.remarks += length_remarks(self.time, commanded)
        self.remarks += another_record_remarks(self.test, self.slab, self.campaign, self.entry)
        followed = follow(self.slab, self.target, self.slab_noise)
        if followed is None:
            self.facts.append("a command along x too small to be seen")
            return
        check_followed(followed, self.path)
        self.remarks += followed_remarks(followed, self.entry.role)
        if self.entry.role != "sealed":
            self.facts.append(
                f"table moved by {100.0 * followed.share[0]:.3g} % of the command, whose peak is "
                f"{1e3 * np.abs(self.target).max():.3g} mm"
            )

    def _hold_answer(self):
        """Blocks and accelerometers against the slab's markers."""
        names = [str(name) for name in self.test["marker"].values[~self.on_slab]]
        self.remarks += carried_remarks(
            self.time, self.readings[:, ~self.on_slab], names, self.slab, self.sensors.marker_noise
        )
        self.remarks += exchange_remarks(self.test, self.structure, self.sensors, self.target)
        late = self.test.attrs.get("recorder_late")
        if late is not None:
            change = "subtracted from" if late > 0.0 else "added to"
            self.remarks.append(
                f"{abs(late):.3g} s were {change} the accelerometers' times, by the slab's motion"
            )
        channels, lag = shaken_channels(self.test, self.structure), 0.0
        if channels:
            readings = self.test["accelerometer"].to_numpy()
            readings = readings[:, np.isin(self.test["channel"], channels)].mean(axis=1)
            time_acc, slab = self.test["time_acc"].to_numpy(), self.slab[:, 0]
            lag, remarks = clock_remarks(
                self.time, slab, time_acc, readings, self.slab_noise, self.path, late is not None
            )
            self.remarks += remarks
        if "accelerometer" in self.test and lag is not None:
            self.remarks += reversed_remarks(self.test, self.structure, self.sensors.marker_noise, lag)


def multiples(columns, readings):
    """Remarks on readings (n_times, n_columns) that are another's multiple, noise and all; ``columns``: their names."""
    values = readings - readings.mean(axis=0)
    size = np.sqrt((values**2).sum(axis=0))
    whole = np.flatnonzero(size > 0.0)  # without gaps too
    units = values[:, whole] / size[whole]
    first, second = np.nonzero(np.triu(np.abs(units.T @ units) > 1.0 - _MULTIPLE, k=1))
    remarks = []
    for one, other in zip(whole[first], whole[second], strict=True):
        ratio = float(values[:, other] @ values[:, one] / size[one] ** 2)
        if abs(ratio - 1.0) > _RATIO:
            remarks.append(f"{columns[other]} is {columns[one]} times {ratio:.4g}: one column mapped twice?")
    return remarks


def _silence(name, time, readings):
    """Remark on the longest gap of all readings (n_times, n_readings) of an instrument at once.

    ``time`` (n_times,) counts from the first reading of the markers, as in all remarks [s].
    """
    read = np.flatnonzero(np.isfinite(readings).any(axis=1))
    rows = np.diff(read)
    if not len(rows) or rows.max() <= _SILENT:
        return []
    last = read[int(rows.argmax())]
    gap = time[last + rows.max()] - time[last]
    return [f"no {name} reads anything for {gap:.3g} s after {time[last]:.4g} s, the longest such gap"]


def _unread_words(unread, n_markers):
    """Directions that are not measured, by markers in words."""
    by_axes = {}
    for marker in dict.fromkeys(marker for marker, _ in unread):
        axes = " and ".join(axis for other, axis in unread if other == marker)
        by_axes.setdefault(axes, []).append(marker)
    words = [
        f"{axes} of {'all markers' if len(names) == n_markers else ', '.join(names)}"
        for axes, names in by_axes.items()
    ]
    return f"not measured: {'; '.join(words)}"
