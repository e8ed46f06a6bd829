"""Samples simulated one after the other, each kept at once, so that a killed batch resumes."""

from dataclasses import dataclass
from typing import NamedTuple

import pandas as pd

from blockshake.dynamics.motion import GroundMotion
from blockshake.errors import InputError
from blockshake.geometry.structure import Structure
from blockshake.measurement.sensors.markers import driven_marker
from blockshake.simulation.models import solver_of
from blockshake.simulation.run_histories import joint_figures
from blockshake.simulation.simulate import simulate
from blockshake.store import Unit, load_made
from blockshake.study.ensembles.case_input import structure_of_case
from blockshake.study.ensembles.ensemble import DECIMALS, as_sample, run_alone
from blockshake.study.sampling.sample_parameters import used_columns, used_parameters
from blockshake.study.sampling.sample_table import load_design

SAMPLES, REPLICATE, CALIBRATION, FRAGILITY = "samples", "replicate", "calibration", "fragility"
"""Parts of a study, by which its runs are counted."""
HALF_STEP = "half-step"  # batch of the replicate: the first sample at half the time step


def part_of(batch):
    """Part of a study that a batch is counted in: `REPLICATE` or `SAMPLES`."""
    return REPLICATE if batch == HALF_STEP else SAMPLES


def part_name(part, case, model):
    """Name of the runs of a case by a model in one part of a study, as lines on them begin."""
    return f"{part} of {case}, {model}"


class CaseRuns(NamedTuple):
    """How a case is simulated by a model."""

    case: dict  # its entries of the configuration: ``structure``, ``duration`` [s] and those of its motion
    model: str  # of the study: its solver's name, words may follow
    # the model's: ``time_step`` [s], and optionally ``parameters`` of the solver that all samples share, by
    # dotted name
    settings: dict
    linked: dict  # str to str; as in `sample_parameters`
    output_rate: float | None = None  # [Hz]; the usual one where it is None

    def parameters(self, row, structure):
        """Parameters of a sample, whose values are ``row``, that the model has a use for, by dotted name."""
        return self.settings.get("parameters", {}) | used_parameters(row, structure, self.linked, self.model)


def simulate_samples(runs, motions, rows, store, base=None, part=SAMPLES):
    """Runs of samples, simulated where the store has not got them.

    Parameters
    ----------
    runs : CaseRuns
    motions : callable
        From `driving_motions`.
    rows : pandas.DataFrame
        Sampled values, index the sample, contact stiffness included.
    store : Store
    base : xarray.Dataset, path or None
        From `measured_input`, where the case names a measured test: the blocks start where they stood in it.
    part : str
        Part of the study, one of those above.

    Returns
    -------
    list of Path
        Files in the store, in the order of ``rows``, for `samples_of`: the `run_alone` of each, with the run's
        ``status`` and ``reason`` as attributes. Samples whose values differ only where the model has no use for them
        have one file.
    """
    case, model, settings, _, output_rate = runs
    solver = solver_of(model).name
    structure = structure_of_case(case, base)
    finished = []
    for sample, row in rows.iterrows():
        unit = _SampleRun(
            structure, motions(sample, row), solver, runs.parameters(row, structure), settings["time_step"],
            case["duration"], output_rate,
        )  # fmt: skip
        name = part_name(part, case.get("name", structure.file.name), model)
        finished.append(store.dataset(f"{name}: sample {sample}", unit))
    return finished


@dataclass(frozen=True)
class _SampleRun(Unit):
    """The `run_alone` of one run."""

    decimals = DECIMALS
    structure: Structure
    motion: GroundMotion
    solver: str
    parameters: dict
    time_step: float  # [s]
    duration: float  # [s]
    output_rate: float | None  # [Hz]

    def made(self, checkpoint):
        run = simulate(
            self.structure, self.motion, self.solver, self.parameters, time_step=self.time_step,
            duration=self.duration, output_rate=self.output_rate, accelerometers=False, checkpoint=checkpoint,
        )  # fmt: skip
        member = run.drop_dims("joint").merge(joint_figures(run, self.structure))
        alone = run_alone(member, driven_marker(self.structure))
        return alone.assign_attrs(status=run.attrs["status"], reason=run.attrs["reason"])


def samples_of(files, rows):
    """Ensembles of one sample each, for `join_batches`, from the files of `simulate_samples` of these ``rows``."""
    pairs = zip(files, rows.iterrows(), strict=True)
    return [as_sample(load_made(file), int(sample), row) for file, (sample, row) in pairs]


def batch_values(batch, design, structure, linked, model):
    """Sampled values of a batch that a model of a structure has a use for, JSON-like: what its runs follow from.

    ``batch``: first and last sample, such as ``010-019``, or `HALF_STEP`; ``design``: values of all samples.
    """
    first, last = (0, 0) if batch == HALF_STEP else map(int, batch.split("-"))
    if last not in design.index:
        raise InputError("the design", f"sample {last}", f"expected samples 0 to {design.index[-1]}")
    used = design.loc[first:last, used_columns(design, structure, linked, model)]
    return {"first": first, "values": {name: used[name].tolist() for name in used}, "size": len(used)}


def batch_rows(batch, stiffness):
    """The same as a table by sample, columns the dotted names, with its rows of the CSV table ``stiffness``, if any."""
    index = pd.RangeIndex(batch["first"], batch["first"] + batch["size"], name="sample")
    rows = pd.DataFrame(batch["values"], index=index)
    if stiffness:
        rows = rows.join(
            load_design(stiffness)[lambda table: table.columns.difference(rows.columns, sort=False)]
        )
    return rows  # a stiffness that is drawn is not calibrated
