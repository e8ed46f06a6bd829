from blockshake.files import write_dataset
from blockshake.log import logging_to
from blockshake.study.ensembles.case_input import measured_input

with logging_to(snakemake.log[0]):
    write_dataset(snakemake.output[0], measured_input(snakemake.params.case, snakemake.params.measured))
