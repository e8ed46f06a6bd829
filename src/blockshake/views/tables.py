"""A run as tidy tables: one CSV a kind of thing that is observed, one row a time and a thing, units in the names."""

import contextlib
from pathlib import Path

import numpy as np
import pandas as pd

from blockshake.files import check_output, replacing

_UNITS = {"1": "", "m": "_m", "m s-1": "_m_s", "m s-2": "_m_s2", "rad s-1": "_rad_s", "N": "_N", "J": "_J"}


def write_tables(path, run, histories):
    """Write the tables of a run next to each other, all or none; the files are returned.

    ``run.csv`` gives ``run-bodies.csv``, ``run-joints.csv``, ``run-markers.csv``, ``run-energy.csv``,
    ``run-accelerometers.csv`` and ``run-transducers.csv``, those without a row left out. ``run`` and ``histories`` are
    from `load_run` and `run_histories`.
    """
    base = Path(path)
    tables = {
        check_output(base.with_name(f"{base.stem}-{name}{base.suffix}")): table
        for name, table in _tables(run, histories)
        if len(table)
    }
    with contextlib.ExitStack() as written:
        for file, table in tables.items():
            table.to_csv(written.enter_context(replacing(file)), index=False, lineterminator="\n")
    return list(tables)


def _tables(run, histories):
    """Names and tables; digits are those of the file, and NaN is an empty cell."""
    bodies = ("position", "orientation", "velocity", "angular_velocity")
    yield "bodies", _table("body", [*(run[name] for name in bodies), histories["drift"]])
    states = ("normal_force", "shear_force", "friction_ratio", "uplift", "slip", "joint_position")
    yield (
        "joints",
        _table("joint", [run["joint_force"], *(histories[name] for name in states)], ("lower", "upper")),
    )
    yield "markers", _table("marker", [run["marker_displacement"]], ("marker_body",))
    energy = {f"{term}_J": run["energy"].sel(term=term).to_numpy() for term in run["term"].values}
    yield "energy", pd.DataFrame({"time_s": run["time"], **energy, "residual_J": histories["residual"]})
    if "accelerometer" in run:
        reached = run["accelerometer"].dropna("time_acc", how="all").rename(time_acc="time")
        yield "accelerometers", _table("channel", [reached.rename("acceleration")])
    if "transducer_displacement" in run:
        reached = run["transducer_displacement"].dropna("time_acc", how="all").rename(time_acc="time")
        yield "transducers", _table("transducer", [reached.rename("displacement")])


def _table(thing, variables, also=()):
    """One row a time and a thing, one column a component of a variable."""
    first = variables[0]
    times, names = first["time"].to_numpy(), first[thing].values
    columns = {"time_s": np.repeat(times, len(names)), thing: np.tile(names, len(times))}
    columns |= {name: np.tile(first[name].values, len(times)) for name in also}
    for variable in variables:
        unit = _UNITS[variable.attrs["units"]]
        inner = [name for name in variable.dims if name not in ("time", thing)]
        values = variable.transpose("time", thing, *inner).to_numpy().reshape(len(times) * len(names), -1)
        parts = [f"_{part}" for part in variable[inner[0]].values] if inner else [""]
        columns |= {f"{variable.name}{part}{unit}": values[:, column] for column, part in enumerate(parts)}
    return pd.DataFrame(columns)
