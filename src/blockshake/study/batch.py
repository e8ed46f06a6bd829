"""Samples simulated one after the other, each kept at once, so that a killed batch resumes."""

from pathlib import Path

import xarray as xr

from blockshake.dynamics.load_motion import load_motion
from blockshake.files import content_digest, write_dataset
from blockshake.geometry.structure import load_structure
from blockshake.study.simulation import simulate


def sample_parameters(row, structure, linked):
    """Parameters of one sample that this structure has.

    Parameters
    ----------
    row : pandas.Series
        Sampled values by dotted name, stiffness among them.
    structure : str or path
        What it has no material or pair for is left out: configuration 1 has no steel.
    linked : dict of str to str
        Parameters that take the sampled value of another.

    Returns
    -------
    dict of str to float
    """
    values = {str(name): float(value) for name, value in row.items()}
    values |= {name: values[source] for name, source in linked.items() if source in values}
    file = load_structure(structure).file
    pairs = {tuple(sorted(entry.pair)) for entry in file.friction}
    return {name: value for name, value in values.items() if _has(name.split("."), file.materials, pairs)}


def _has(parts, materials, pairs):
    if parts[0] == "materials":
        return parts[1] in materials
    if parts[0] == "friction":
        return tuple(sorted(parts[1:])) in pairs
    return True


def simulate_samples(case, model, time_step, output_rate, rows, linked, store, source, progress):
    """Runs of some samples of a case, taken from the store where they are there.

    Parameters
    ----------
    case : Case
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
    motion = load_motion(case.motion, case.scale)
    structure = load_structure(case.structure)
    runs = []
    for sample, row in rows.iterrows():
        parameters = sample_parameters(row, case.structure, linked)
        key = content_digest(
            source, model, structure.file.model_dump(), motion.table.breaks.tobytes(), motion.table.coefficients.tobytes(),
            case.duration, output_rate, time_step, parameters,
        )  # fmt: skip
        path = Path(store) / f"{key}.nc"
        if path.exists():
            run, how = xr.load_dataset(path), "kept"
        else:
            run = simulate(
                case.structure, motion, model, parameters,
                time_step=time_step, duration=case.duration, output_rate=output_rate, accelerometers=False,
            )  # fmt: skip
            write_dataset(path, run)
            how = "simulated"
        progress(f"{case.name} {model} sample {sample}: {run.attrs['status']} ({how}) {run.attrs['reason']}".rstrip())
        runs.append(run)
    return runs
