"""A run in other programs' formats, chosen by the suffix of the file."""

from pathlib import Path

from blockshake.errors import InputError
from blockshake.files import check_output
from blockshake.views.gltf import write_glb
from blockshake.views.tables import write_tables
from blockshake.views.vtkhdf import write_vtkhdf

FORMATS = {".csv": "tables", ".vtkhdf": "ParaView", ".glb": "glTF"}


def check_export(path):
    """Refuse a path that cannot be written, or whose suffix is none of `FORMATS`, with `InputError`."""
    if Path(path).suffix.lower() not in FORMATS:
        known = ", ".join(f"{suffix} ({name})" for suffix, name in FORMATS.items())
        raise InputError(path, "", f"expected one of the suffixes {known}")
    check_output(path)


def export_run(path, run, histories, structure):
    """Write a run in the format of the path's suffix, one of `FORMATS`, atomically; the files are returned.

    ``run``, ``histories`` and ``structure`` are from `load_run` and `run_histories`.
    """
    check_export(path)
    suffix = Path(path).suffix.lower()
    if suffix == ".csv":
        return write_tables(path, run, histories)
    if suffix == ".vtkhdf":
        return write_vtkhdf(path, run, histories, structure)
    write_glb(path, run, structure)
    return [Path(path)]
