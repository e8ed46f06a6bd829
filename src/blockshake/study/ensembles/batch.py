"""Samples simulated one after the other, each kept at once, so that a killed batch resumes."""

from pathlib import Path

import pandas as pd
import xarray as xr

from blockshake.errors import InputError
from blockshake.files import content_digest
from blockshake.geometry.structure import load_structure
from blockshake.interrupts import delayed_interrupts
from blockshake.measurement.sensors.markers import driven_marker
from blockshake.simulation.joint_figures import joint_figures
from blockshake.simulation.simulate import simulate
from blockshake.simulation.structure_digest import structure_digest
from blockshake.store import keep_dataset, kept
from blockshake.study.ensembles.ensemble import gather_ensemble
from blockshake.study.sampling.latin_hypercube import load_design
from blockshake.study.sampling.sample_parameters import sample_parameters

# digits kept in histories: 0.1 um, a thousandth of a marker's noise, and of a quaternion as much at a block's length
DECIMALS = {"m": 7, "1": 8}


def simulate_samples(case, motions, model, settings, output_rate, rows, linked, store, source, progress):
    """Ensembles of one sample each, simulated where the store has not got them.

    Parameters
    ----------
    case : dict
        ``structure`` and ``duration`` [s] of a case of the configuration.
    motions : callable
        From `driving_motions`.
    model : str
    settings : dict
        The model's: ``time_step`` [s], and optionally ``parameters`` of the solver that all samples share, by
        dotted name.
    output_rate : float
        [Hz]
    rows : pandas.DataFrame
        Sampled values, index the sample, contact stiffness included.
    linked : dict of str to str
        As in `sample_parameters`.
    store : str or path
        Folder of finished samples, named by the digest of all that made them. A sample goes there
        at once, whole or not at all; one that was cut short goes on from its checkpoint there.
    source : str
        Digest of the sources that compute.
    progress : callable
        Called with a line of text after each sample.

    Returns
    -------
    list of Path
        Files in the store, in the order of ``rows``: what `gather_ensemble` keeps of a run.
    """
    structure = load_structure(case["structure"])
    finished = []
    for sample, row in rows.iterrows():
        motion = motions(sample)
        parameters = settings.get("parameters", {}) | sample_parameters(row, structure, linked)
        key = content_digest(
            source, model, structure_digest(structure), *(part.tobytes() for part in motion.table),
            case["duration"], output_rate, settings["time_step"], parameters, int(sample), row.to_dict(),
        )  # fmt: skip
        path = Path(store) / f"{key}.nc"
        if kept(path):
            how, outcome = "kept", sample_outcome(path)
        else:
            run = simulate(
                structure, motion, model, parameters,
                time_step=settings["time_step"], duration=case["duration"], output_rate=output_rate,
                accelerometers=False, checkpoint=path.with_suffix(".checkpoint"),
            )  # fmt: skip
            member = run.drop_dims("joint").merge(joint_figures(run, structure))
            keep_dataset(path, gather_ensemble([member], [sample], rows, driven_marker(structure)), DECIMALS)
            how, outcome = "simulated", f"{run.attrs['status']} {run.attrs['reason']}".rstrip()
        progress(f"{structure.file.name} {model} sample {sample}, {how}: {outcome}")
        finished.append(path)
    return finished


def sample_outcome(path):
    """Status and reason of a stored sample, as one line."""
    with delayed_interrupts(), xr.open_dataset(path) as kept:
        return f"{kept['status'].item()} {kept['reason'].item()}".rstrip()


def batch_rows(batch, design, stiffness):
    """Sampled values of a batch, columns the dotted names, contact stiffness beside them where the model has any.

    ``batch``: first and last sample, such as ``010-019``; ``design`` and ``stiffness``: CSV tables by sample, the
    latter empty without contact stiffness.
    """
    first, last = (int(part) for part in batch.split("-"))
    tables = [load_design(path) for path in (design, stiffness) if path]
    rows = pd.concat(tables, axis=1)
    if last not in rows.index:
        raise InputError(str(design), f"sample {last}", f"expected samples 0 to {rows.index[-1]}")
    return rows.loc[first:last]
