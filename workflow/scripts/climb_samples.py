from blockshake.files import write_dataset
from blockshake.log import logging_to
from blockshake.store import Store
from blockshake.study.config import Ladder
from blockshake.study.ensembles.batch import CaseRuns, batch_rows
from blockshake.study.fragility.climb import climb_samples

with logging_to(snakemake.log[0]) as say:
    of, given = snakemake.params, snakemake.input
    rows, store = batch_rows(snakemake.wildcards.batch, given), Store(of.store, of.source, say)
    climbed = climb_samples(CaseRuns(**of.runs), rows, Ladder(**of.ladder), store, of.seed)
    write_dataset(snakemake.output[0], climbed)
