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
    """Write a run in another program's format, atomically; a remark states where places count from, if not from 0.

    Parameters
    ----------
    run : str, path or xarray.Dataset
        A run file, or what `simulate` returns.
    output : str or path
        The suffix is the format: ``.csv``, ``.vtkhdf`` of ParaView or ``.glb`` of glTF.
    meshes : str or path, optional
        Folder of the structure's meshes; by default that of the run file, or the current one.

    Returns
    -------
    list of Path
        The files, some of them with ``output``.

    Raises
    ------
    InputError
        No run, a mesh that is not found, another suffix, a file that cannot be written.

    Examples
    --------
    >>> import blockshake
    >>> run = blockshake.simulate("my.yaml", "alkion", "nscd-rigid", duration=0.2)
    >>> [path.name for path in blockshake.export(run, "run.csv")]
    ['run-bodies.csv', 'run-joints.csv', 'run-markers.csv', 'run-energy.csv']
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
