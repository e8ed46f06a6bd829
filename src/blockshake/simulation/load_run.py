"""Reading a run file back: its Dataset, checked, and the structure that it holds."""

import json
from pathlib import Path

import numpy as np
import xarray as xr

from blockshake.dynamics.system import ENERGY_TERMS
from blockshake.errors import InputError
from blockshake.files import AnyPath
from blockshake.geometry.schema import AXES, QUATERNION
from blockshake.geometry.structure import Structure, build_structure
from blockshake.interrupts import delayed_interrupts
from blockshake.simulation.run_dataset import RUN_HISTORIES, joint_names
from blockshake.tables.damaged_hdf5 import DAMAGE, has_endless_heap

_JOINTS = ("lower", "upper")
_ATTRIBUTES = ("structure_file", "structure", "motion", "motion_scale", "motion_synthetic", "model")
_ORDERS = {"axis": AXES, "quaternion": QUATERNION, "term": ENERGY_TERMS}


# a run file, or what `simulate` returns
RunSource = AnyPath | xr.Dataset


def load_run(source: RunSource, meshes: AnyPath | None = None) -> tuple[xr.Dataset, Structure]:
    """Run of `simulate`, until the time that it reached, with its structure.

    Parameters
    ----------
    source : str, path or xarray.Dataset
        A run file, or its content.
    meshes : str or path, optional
        Folder of the structure's meshes; by default that of the run file, or the current one.

    Returns
    -------
    run : xarray.Dataset
        Without the times after an abort.
    structure : Structure
        With the parameters of the run.

    Raises
    ------
    InputError
        The file is missing, truncated or no run file, or a mesh of the structure is not found.
    """
    path = Path("run") if isinstance(source, xr.Dataset) else source
    run = source if isinstance(source, xr.Dataset) else _read(source)
    known = {name: tuple(dims.split()) for name, (dims, _, _) in RUN_HISTORIES.items()}
    for name, dims in {**known, **dict.fromkeys(_JOINTS, ("joint",))}.items():
        if name not in run.variables or run[name].dims != dims:
            raise InputError(path, name, f"expected a run file of blockshake simulate, with {name}{dims}")
    for name in ("time", *RUN_HISTORIES):
        if name not in run.variables or run[name].dtype.kind != "f":
            raise InputError(path, name, "expected numbers")
    for name in _ATTRIBUTES:
        if name not in run.attrs:
            raise InputError(path, name, "expected a run file of blockshake simulate, with this attribute")
    for name, (_, unit, _) in RUN_HISTORIES.items():
        if run[name].attrs.get("units") != unit:
            raise InputError(path, f"{name}.units", f"expected {unit}")
    structure = _structure_of(run, path, Path(path).parent if meshes is None else Path(meshes))
    markers = [marker.name for marker in structure.file.markers]
    for name, order in {**_ORDERS, "body": structure.body_names, "marker": markers}.items():
        if name not in run.coords or run[name].values.tolist() != list(order):
            raise InputError(path, name, f"expected {', '.join(order)}")
    for name in _JOINTS:
        if not set(run[name].values.tolist()) <= set(structure.body_names):
            wrong = f"expected bodies of the structure: {', '.join(structure.body_names)}"
            raise InputError(path, name, wrong)
    if not (np.isfinite(run["time"]).all() and (np.diff(run["time"]) > 0.0).all()):
        raise InputError(path, "time", "expected times that increase")
    reached = np.isfinite(run["position"].to_numpy()).all(axis=(1, 2))
    if not reached.any():
        raise InputError(path, "position", "expected at least one time that the run reached")
    joints = joint_names(run["lower"].values, run["upper"].values)  # a file of before has none
    run = run.isel(time=np.flatnonzero(reached)).assign_coords(joint=joints)
    return run, structure


def _read(path):
    if not Path(path).is_file():
        raise InputError(path, "", "expected a run file of blockshake simulate; there is no such file")
    try:
        if has_endless_heap(Path(path)):
            raise ValueError("it is damaged")
        with delayed_interrupts():
            return xr.load_dataset(path, engine="netcdf4", decode_times=False)
    except DAMAGE as error:
        reason = getattr(error, "strerror", None) or error
        raise InputError(path, "", f"expected a readable netCDF file; {reason}") from None


def _structure_of(run, path, folder):
    try:
        mapping = json.loads(run.attrs["structure_file"])
    except (json.JSONDecodeError, TypeError):
        raise InputError(path, "structure_file", "expected a structure as JSON") from None
    return build_structure(mapping, str(path), folder)
