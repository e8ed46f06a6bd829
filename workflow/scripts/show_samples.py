from blockshake.files import write_dataset
from blockshake.log import logging_to
from blockshake.study.ensembles.batch import DECIMALS
from blockshake.study.ensembles.ensemble import join_batches
from blockshake.study.ensembles.shown_samples import shown_samples

with logging_to(snakemake.log[0]):
    write_dataset(snakemake.output[0], shown_samples(join_batches(snakemake.input.batches)), DECIMALS)
