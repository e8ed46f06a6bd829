"""A long run part by part, as its run file takes it, while the rest of it is on disk."""

import dataclasses

import netCDF4
import numpy as np

from blockshake.dynamics.system import Rows
from blockshake.files import replacing
from blockshake.measurement.sensors.accelerometers import (
    SKIP,
    accelerometer_channels,
    reading_times,
    readings_of,
    specific_forces,
)
from blockshake.measurement.sensors.transducers import transducer_lengths, transducer_names
from blockshake.simulation.energy_residual import energy_extremes, residual_of
from blockshake.simulation.run_dataset import add_readings, run_dataset

_AT_HAND = 2**12  # rows beyond the end of a run that are written at a time
_CHUNK = 2**12  # times that are compressed together
_CACHE = 2**22  # bytes of a variable that wait for more to be compressed with


def reduced(structure, rows, coarse, fine):
    """Parts of a run file that some rows of a run give, tuples of arrays by name.

    Parameters
    ----------
    structure : Structure
    rows : Rows
    coarse, fine : float64 arrays
        Times of the histories, and of the states that accelerometers are read from; empty without them [s].

    Returns
    -------
    dict
        ``rows``: fields of `Rows` at coarse times. ``energy``: `energy_extremes`. ``ends``: orientation, velocity and
        angular velocity at the first and the last fine time. ``force-K``: `specific_forces` of channel K between fine
        times. ``lengths``: `transducer_lengths` at the times of the readings.
    """
    kept = rows.at(_rows_at(rows.time, coarse))
    parts = {"rows": tuple(vars(kept).values()), "energy": (energy_extremes(rows.energy),)}
    if not fine.size:
        return parts
    states = rows.at(_rows_at(rows.time, fine))
    motion = states.orientation, states.velocity, states.angular_velocity
    forces = specific_forces(structure, *motion)
    ends = tuple(np.concatenate([part[:1], part[-1:]]) for part in motion)
    read = rows.at(_rows_at(rows.time, fine[::SKIP]))
    lengths = transducer_lengths(structure, read.position, read.orientation)
    forces = {f"force-{k}": (column,) for k, column in enumerate(forces.T)}
    return parts | forces | {"ends": ends, "lengths": (lengths,)}


def _rows_at(times, wanted):
    """Numbers of the rows at those of the wanted times that these rows span."""
    begin, end = np.searchsorted(wanted, times[0]), np.searchsorted(wanted, times[-1], "right")
    return np.searchsorted(times, wanted[begin:end])


class RunParts:
    """The parts of a run in their order: those kept on disk, and the rows that the solver ended with.

    ``structure``, ``coarse`` and ``fine`` as of `reduced`, ``trajectory`` the last rows, and ``kept`` a `KeptRows`;
    None where the last rows are all.
    """

    def __init__(self, structure, coarse, fine, trajectory, kept=None):
        self.structure, self._coarse, self._fine, self._kept = structure, coarse, fine, kept
        self.channels, self.transducers = accelerometer_channels(structure), transducer_names(structure)
        self._joints = trajectory.joints
        self._last = reduced(structure, trajectory, coarse, fine)

    def _read(self, *names):
        if self._kept is not None:
            yield from self._kept.read(*names)
        yield self._last

    def energy_residual(self):
        """`residual_of` the whole run."""
        return residual_of([part["energy"][0] for part in self._read("energy")])

    def row_at(self, time):
        """The last row not after a time [s], `Rows` of one."""
        found = None
        for part in self._read("rows"):
            rows = Rows(*part["rows"])
            before = int(np.searchsorted(rows.time, time, "right"))
            found = rows.at(slice(before - 1, before)) if before else found
            if before < len(rows.time):
                return found
        return found

    def histories(self):
        """Yield the Datasets of `run_dataset`, which follow each other in time, the first of them without a time."""
        start, done = None, 0
        for part in self._read("rows"):
            rows = self._with_all_joints(Rows(*part["rows"]))
            if start is None:
                start = rows.position[:1], rows.orientation[:1]
                yield run_dataset(self.structure, rows.at(slice(0)), start)
            done += len(rows.time)
            yield run_dataset(self.structure, rows, start)
        for begin in range(done, len(self._coarse), _AT_HAND):
            lost = _lost(rows, self._coarse[begin : begin + _AT_HAND])
            yield run_dataset(self.structure, lost, start)

    def _with_all_joints(self, rows):
        """Rows with all joints of the run; one that was not touched yet carried nothing."""
        columns = {pair: column for column, pair in enumerate(map(tuple, self._joints.tolist()))}
        force = np.zeros((len(rows.time), len(columns), 3))
        force[:, [columns[pair] for pair in map(tuple, rows.joints.tolist())]] = rows.joint_force
        return dataclasses.replace(rows, joints=self._joints, joint_force=force)

    def reading_times(self):
        """Times of the readings of accelerometers and transducers [s]; empty without any."""
        return reading_times(self._fine) if self._fine.size else self._fine

    def readings(self):
        """Yield the readings of every channel, float64 (n_readings,) [m/s2]: the low-pass wants a whole record."""
        for channel in range(len(self.channels)):
            forces = np.concatenate([np.empty(0), *self._forces(channel)])
            yield readings_of(forces[:, None], self.reading_times())[:, 0]

    def lengthenings(self):
        """Yield the readings of all transducers since the start, which follow each other in time [m]."""
        start, done = None, 0
        for part in self._read("lengths"):
            (lengths,) = part["lengths"]
            if len(lengths):
                start = lengths[:1] if start is None else start
                done += len(lengths)
                yield lengths - start
        yield np.full((len(self.reading_times()) - done, len(self.transducers)), np.nan)

    def _forces(self, channel):
        """Yield the specific forces of a channel in each part [m/s2], and between two parts those across their ends."""
        name, before = f"force-{channel}", None
        for part in self._read("ends", name):
            ends = part["ends"]
            if not len(ends[0]):
                continue
            if before is not None:
                across = [np.stack([old[-1], new[0]]) for old, new in zip(before, ends, strict=True)]
                yield specific_forces(self.structure, *across)[:, channel]
            yield part[name][0]
            before = ends


def _lost(like, times):
    """Rows at times that a run did not reach, of the shapes of others."""
    fields = {
        name: np.full((len(times), *part.shape[1:]), np.nan)
        for name, part in vars(like).items()
        if name not in ("time", "joints")
    }
    return Rows(time=times, joints=like.joints, **fields)


def write_run(path, parts, attributes):
    """Write `RunParts` into a run file with its attributes, whole or not at all.

    Raises
    ------
    InputError
        The file cannot be written.
    """
    pieces, times = parts.histories(), parts.reading_times()
    empty = next(pieces).assign_attrs(attributes)
    for name, sensors in (("accelerometer", parts.channels), ("transducer_displacement", parts.transducers)):
        if sensors:
            add_readings(empty, name, times[:0], np.empty((0, len(sensors))), sensors)
    grows = [name for name in ("time", "time_acc") if name in empty.dims]
    encoding = _encoding(empty, grows)
    with replacing(path) as temporary:
        empty.to_netcdf(
            temporary, engine="netcdf4", format="NETCDF4", encoding=encoding, unlimited_dims=grows
        )
        with netCDF4.Dataset(temporary, "a") as file:
            file.set_auto_maskandscale(False)
            for name in encoding:
                file[name].set_var_chunk_cache(size=_CACHE)
            done = 0
            for piece in pieces:
                _append(file, piece, done)
                done += piece.sizes["time"]
            if times.size:
                file["time_acc"][: len(times)] = times
                for channel, readings in enumerate(parts.readings()):
                    file["accelerometer"][: len(times), channel] = readings
            if parts.transducers:
                done = 0
                for lengthened in parts.lengthenings():
                    file["transducer_displacement"][done : done + len(lengthened)] = lengthened
                    done += len(lengthened)


def _encoding(empty, grows):
    """Compression of the variables that grow; a channel of the accelerometers is written, and so compressed, alone."""
    encoding = {}
    for name, variable in empty.variables.items():
        if not set(grows) & set(variable.dims) or 0 in variable.shape[1:]:
            continue
        others = (1,) if name == "accelerometer" else variable.shape[1:]
        encoding[name] = {"zlib": True, "complevel": 2, "shuffle": True, "chunksizes": (_CHUNK, *others)}
    return encoding


def _append(file, piece, done):
    """Write the histories of a piece behind the ``done`` times that are there."""
    for name, variable in piece.variables.items():
        if "time" in variable.dims:
            file[name][done : done + piece.sizes["time"]] = variable.to_numpy()
