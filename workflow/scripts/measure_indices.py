from blockshake.files import write_dataset
from blockshake.log import logging_to
from blockshake.study.sensitivity.indices import indices_of_case

with logging_to(snakemake.log[0]):
    input = snakemake.input
    found = indices_of_case(
        input.samples, input.sensitivity, next(iter(input.limits), None), snakemake.params.seed
    )
    write_dataset(snakemake.output[0], found)
