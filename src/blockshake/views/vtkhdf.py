"""A run for ParaView: two VTKHDF files over time, the blocks' surfaces and the joints with their forces."""

import contextlib
import re
from pathlib import Path

import netCDF4
import numpy as np

from blockshake.files import check_output, replacing
from blockshake.geometry.rotations import rotation_matrices
from blockshake.simulation.run_histories import JOINT_HISTORIES

_VERSION = np.array([2, 2], dtype=np.int64)  # of the file format
# of the cells of polygonal data, in the order of their numbers
_KINDS = ("Vertices", "Lines", "Polygons", "Strips")
_INT, _REAL = "i8", "f4"
_FARTHEST = 100.0  # m: coordinates of 32 bits within this are exact to 4 micrometres


def local_origin(run):
    """Place that exports of a run in 32 bits count from, float64 (3,) [m].

    It is the middle of the mass centres at the start, in whole metres, along every axis on which one of them lies more
    than 100 m from the origin; else 0.
    """
    start = run["position"].isel(time=0).to_numpy()
    middle = np.round(0.5 * (start.min(axis=0) + start.max(axis=0)))
    return np.where(np.abs(start).max(axis=0) > _FARTHEST, middle, 0.0)


def write_vtkhdf(path, run, histories, structure):
    """Write the blocks and the joints of a run as VTKHDF, both or none; the files are returned.

    ``run.vtkhdf`` holds the blocks; the joints go to ``run-joints.vtkhdf`` with it, where there are any. ``run`` and
    ``histories`` are from `load_run` and `run_histories`.

    Notes
    -----
    Polygonal data over time, inertial frame, SI. The cells of the first file are the faces of the bodies, each with
    its body's number in the file of the run (``body``), ``velocity`` of the mass centre, ``angular_velocity`` and
    ``drift``. Those of the second are points, one a joint, with ``force`` on the upper body, ``normal_force``,
    ``shear_force``, ``friction_ratio``, ``uplift`` and ``slip``, which are NaN where they are unknown. The
    field data give every body, or joint, its number by its name, in which ``_`` stands for other signs. Points count
    from `local_origin`, which is the attribute ``LocalOrigin`` [m] where it is another than 0.
    """
    base, origin = Path(path), local_origin(run)
    files = {check_output(base): _blocks(run, histories, structure, origin)}
    if histories.sizes["joint"]:
        joints = check_output(base.with_name(f"{base.stem}-joints{base.suffix}"))
        files[joints] = _joints(run, histories, origin)
    with contextlib.ExitStack() as written:
        for file, content in files.items():
            _write(written.enter_context(replacing(file)), run["time"].to_numpy(), origin, *content)
    return list(files)


def _blocks(run, histories, structure, origin):
    """Points over time, kind of cells, their corners, values of the cells over time and of all times, and names."""
    turns = rotation_matrices(run["orientation"])
    position = run["position"].to_numpy() - origin
    places, cells, owners, count = [], [], [], 0
    for body in range(position.shape[1]):
        solid = structure.solid(body)
        corners = np.einsum("tij,vj->tvi", turns[:, body], solid.vertices) + position[:, body, None]
        faces = solid.triangles if solid.polyhedron is None else solid.polyhedron.faces
        places.append(corners.astype(_REAL))
        cells += [np.asarray(face) + count for face in faces]
        owners += [body] * len(faces)
        count += corners.shape[1]
    values = {
        "velocity": run["velocity"].to_numpy()[:, owners],
        "angular_velocity": run["angular_velocity"].to_numpy()[:, owners],
        "drift": histories["drift"].to_numpy()[:, owners],
    }
    names = structure.body_names
    return np.concatenate(places, axis=1), "Polygons", cells, values, {"body": np.array(owners)}, names


def _joints(run, histories, origin):
    values = {"force": run["joint_force"].to_numpy()}
    values |= {name: histories[name].to_numpy() for name in JOINT_HISTORIES}
    cells = [np.array([joint]) for joint in range(histories.sizes["joint"])]
    names = histories["joint"].values.tolist()
    return histories["joint_position"].to_numpy() - origin, "Vertices", cells, values, {}, names


def _write(path, times, origin, points, kind, cells, values, steady, names):
    """One file: the points move, the cells stay; see the VTKHDF file format, polygonal data and temporal data."""
    n_times, n_points, _ = points.shape
    with netCDF4.Dataset(path, "w", format="NETCDF4") as file:
        root = file.createGroup("VTKHDF")
        root.setncatts(
            {"Version": _VERSION, "Type": "PolyData"} | ({"LocalOrigin": origin} if origin.any() else {})
        )
        steps = root.createGroup("Steps")
        steps.setncattr("NSteps", np.int64(n_times))
        zero = np.zeros(n_times, dtype=np.int64)
        _put(file, root, "NumberOfPoints", np.array([n_points]))
        _put(file, root, "Points", points.reshape(-1, 3).astype(_REAL))
        for name in _KINDS:
            mine = cells if name == kind else []
            group = root.createGroup(name)
            corners = np.concatenate(mine) if mine else np.empty(0, dtype=np.int64)
            _put(file, group, "NumberOfCells", np.array([len(mine)]))
            _put(file, group, "NumberOfConnectivityIds", np.array([len(corners)]))
            _put(file, group, "Offsets", np.cumsum([0, *(len(cell) for cell in mine)]))
            _put(file, group, "Connectivity", corners)
        _put(file, steps, "Values", times)
        _put(file, steps, "PartOffsets", zero)
        _put(file, steps, "NumberOfParts", np.ones(n_times, dtype=np.int64))
        _put(file, steps, "PointOffsets", n_points * np.arange(n_times))
        for name in ("CellOffsets", "ConnectivityIdOffsets"):
            _put(file, steps, name, np.zeros((n_times, len(_KINDS)), dtype=np.int64))
        data, offsets = root.createGroup("CellData"), steps.createGroup("CellDataOffsets")
        for name, array in values.items():
            _put(file, data, name, array.reshape(-1, *array.shape[2:]).astype(_REAL))
            _put(file, offsets, name, len(cells) * np.arange(n_times))
        for name, array in steady.items():
            _put(file, data, name, array)
            _put(file, offsets, name, zero)
        data, offsets = root.createGroup("FieldData"), steps.createGroup("FieldDataOffsets")
        for number, name in enumerate(names):  # numbers, as VTK reads no texts that netCDF's library writes
            plain = re.sub(r"[^\w -]", "_", name).strip() or "_"
            plain += f" ({number})" if plain in data.variables else ""
            _put(file, data, plain, np.array([number]))
            _put(file, offsets, plain, zero)


def _put(file, group, name, array):
    """A variable of a group; dimensions stand at the top, where no reader takes them for data."""
    dims = []
    for length in array.shape:
        dims.append(f"n{length}")
        if dims[-1] not in file.dimensions:
            file.createDimension(dims[-1], length or None)
    kind = _REAL if array.dtype == np.float32 else ("f8" if array.dtype.kind == "f" else _INT)
    packed = {"compression": "zlib", "complevel": 2} if array.size > 64 else {}
    group.createVariable(name, kind, dims, fill_value=False, **packed)[:] = array
