from blockshake.files import write_dataset
from blockshake.log import logging_to
from blockshake.study.stiffness.definitions import compare_definitions

with logging_to(snakemake.log[0]):
    of = snakemake.params
    write_dataset(snakemake.output[0], compare_definitions(of.case, of.time_step, of.store, of.source))
