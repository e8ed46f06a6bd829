from blockshake.files import write_dataset
from blockshake.log import logging_to
from blockshake.store import Store
from blockshake.study.config import Ladder
from blockshake.study.ensembles.batch import CaseRuns, batch_rows
from blockshake.study.fragility.climb import climb_samples

with logging_to(snakemake.log[0]) as say:
    params, input = snakemake.params, snakemake.input
    rows, store = batch_rows(params.batch, input.stiffness), Store(params.store, params.source, say)
    climbed = climb_samples(CaseRuns(**params.runs), rows, Ladder(**params.ladder), store, params.seed)
    write_dataset(snakemake.output[0], climbed)
