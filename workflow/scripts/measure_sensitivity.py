from blockshake.files import write_dataset
from blockshake.log import logging_to
from blockshake.study.sensitivity.sensitivity import sensitivity_of_case

with logging_to(snakemake.log[0]):
    params, input, model = snakemake.params, snakemake.input, snakemake.wildcards.model
    found = sensitivity_of_case(input.batches, input.design, model, params.structure, params.linked)
    write_dataset(snakemake.output[0], found)
