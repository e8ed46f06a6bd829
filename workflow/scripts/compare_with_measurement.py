from blockshake.files import write_dataset
from blockshake.log import logging_to
from blockshake.study.ensembles.coverage import coverage_of_case

with logging_to(snakemake.log[0]):
    given = snakemake.input
    compared = coverage_of_case(snakemake.params.measured, given.base, given.batches)
    write_dataset(snakemake.output[0], compared)
