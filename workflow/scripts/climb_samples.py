from blockshake.files import write_dataset
from blockshake.log import logging_to
from blockshake.study.config import Ladder
from blockshake.study.ensembles.batch import batch_rows
from blockshake.study.fragility.climb import climb_samples

with logging_to(snakemake.log[0]) as say:
    of, given = snakemake.params, snakemake.input
    rows = batch_rows(snakemake.wildcards.batch, given.design, given.stiffness)
    climb = of.case, of.model, of.settings, rows, of.linked, Ladder(**of.ladder), of.store, of.source
    write_dataset(snakemake.output[0], climb_samples(*climb, say))
