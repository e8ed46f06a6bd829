"""A run in other programs' formats, chosen by the suffix of the file."""

import logging
from pathlib import Path

from blockshake.errors import InputError
from blockshake.files import AnyPath, check_output
from blockshake.simulation.load_run import RunSource, load_run
from blockshake.simulation.run_histories import run_histories
from blockshake.views.gltf import write_glb
from blockshake.views.tables import write_tables
from blockshake.views.vtkhdf import local_origin, write_vtkhdf

_log = logging.getLogger(__name__)
FORMATS = {".csv": "tables", ".vtkhdf": "ParaView", ".glb": "glTF"}


def export(run: RunSource, output: AnyPath, meshes: AnyPath | None = None) -> list[Path]:
    """Write a run in another program's format, one of `FORMATS` by the suffix of ``output``, atomically.

    ``run`` and ``meshes`` are those of `load_run`. The files are returned, some of them beside ``output``; a remark of
    the log says where places count from, if not from 0. Errors are those of `load_run`, another suffix, and a file that
    cannot be written.
    """
    path = check_output(output)
    suffix = path.suffix.lower()
    if suffix not in FORMATS:
        known = ", ".join(f"{suffix} ({name})" for suffix, name in FORMATS.items())
        raise InputError(path, "", f"expected one of the suffixes {known}")
    loaded, structure = load_run(run, meshes)
    origin = local_origin(loaded)
    if origin.any() and suffix != ".csv":
        words = "m, as 32 bits are too coarse so far from the origin"
        _log.info("remark: places count from %s %s", origin.tolist(), words)
    if suffix == ".csv":
        return write_tables(path, loaded, run_histories(loaded, structure))
    if suffix == ".vtkhdf":
        return write_vtkhdf(path, loaded, run_histories(loaded, structure), structure)
    write_glb(path, loaded, structure)
    return [path]
