from blockshake.files import write_dataset
from blockshake.log import logging_to
from blockshake.study.ensembles.batch import DECIMALS
from blockshake.study.ensembles.shown_samples import shown_of_case

with logging_to(snakemake.log[0]):
    write_dataset(snakemake.output[0], shown_of_case(snakemake.input.batches), DECIMALS)
