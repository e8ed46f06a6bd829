"""Samples simulated one after the other, each kept at once, so that a killed batch resumes."""

from pathlib import Path

import pandas as pd
import xarray as xr

from blockshake.dynamics.load_motion import load_motion
from blockshake.errors import InputError
from blockshake.files import content_digest, write_dataset
from blockshake.geometry.structure import load_structure
from blockshake.study.sample_parameters import sample_parameters
from blockshake.study.sampling import load_design
from blockshake.study.simulation import simulate


def simulate_samples(case, model, time_step, output_rate, rows, linked, store, source, progress):
    """Runs of some samples of a case, taken from the store where they are there.

    Parameters
    ----------
    case : dict
        ``structure``, ``motion``, ``scale`` and ``duration`` [s] of a case of the configuration.
    model : str
    time_step, output_rate : float
        [s], [Hz]
    rows : pandas.DataFrame
        Sampled values, index the sample, stiffness columns included.
    linked : dict of str to str
        As in `sample_parameters`.
    store : str or path
        Folder of finished runs, named by the digest of all that made them. A run goes there
        at once, whole or not at all.
    source : str
        Digest of the sources that compute.
    progress : callable
        Called with a line of text after each sample.

    Returns
    -------
    list of xarray.Dataset
        Run files' content in the order of ``rows``.
    """
    motion = load_motion(case["motion"], case["scale"])
    structure = load_structure(case["structure"])
    runs = []
    for sample, row in rows.iterrows():
        parameters = sample_parameters(row, case["structure"], linked)
        key = content_digest(
            source, model, structure.file.model_dump(), *(part.tobytes() for part in motion.table),
            case["duration"], output_rate, time_step, parameters,
        )  # fmt: skip
        path = Path(store) / f"{key}.nc"
        if path.exists():
            run, how = xr.load_dataset(path), "kept"
        else:
            run = simulate(
                case["structure"], motion, model, parameters,
                time_step=time_step, duration=case["duration"], output_rate=output_rate, accelerometers=False,
            )  # fmt: skip
            write_dataset(path, run)
            how = "simulated"
        outcome = f"{run.attrs['status']} {run.attrs['reason']}".rstrip()
        progress(f"{structure.file.name} {model} sample {sample}, {how}: {outcome}")
        runs.append(run)
    return runs


def batch_rows(batch, design, stiffness):
    """Sampled values of a batch, contact stiffness beside them where the model has any.

    Parameters
    ----------
    batch : str
        First and last sample, such as ``010-019``.
    design : str or path
        CSV table by sample.
    stiffness : str, path or empty
        The same, for a model with contact stiffness.

    Returns
    -------
    pandas.DataFrame
        Index the sample, columns the dotted names.
    """
    first, last = (int(part) for part in batch.split("-"))
    tables = [load_design(path) for path in (design, stiffness) if path]
    rows = pd.concat(tables, axis=1)
    if last not in rows.index:
        raise InputError(str(design), f"sample {last}", f"expected samples 0 to {rows.index[-1]}")
    return rows.loc[first:last]
