from blockshake.files import write_dataset
from blockshake.log import logging_to
from blockshake.study.fragility.fragility import fragility_of_case

with logging_to(snakemake.log[0]):
    write_dataset(snakemake.output[0], fragility_of_case(snakemake.input))
