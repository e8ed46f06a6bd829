"""A run file written part by part."""

import netCDF4
import numpy as np

from blockshake.files import replacing
from blockshake.simulation.run_dataset import add_accelerometers, add_transducers

_CHUNK = 2**12  # times that are compressed together
_CACHE = 2**22  # bytes of a variable that wait for more to be compressed with


def write_run(path, parts, attributes):
    """Write a run file, whole or not at all.

    Parameters
    ----------
    path : str or path
    parts : RunParts
    attributes : dict
        Of the file.

    Raises
    ------
    InputError
        The file cannot be written.
    """
    pieces, times = parts.histories(), parts.reading_times()
    empty = next(pieces).assign_attrs(attributes)
    if parts.channels:
        add_accelerometers(empty, parts.structure, times[:0], np.empty((0, len(parts.channels))))
    if parts.transducers:
        add_transducers(empty, parts.structure, times[:0], np.empty((0, len(parts.transducers))))
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
