from blockshake.files import write_dataset
from blockshake.log import logging_to
from blockshake.study.sensitivity.sensitivity import sensitivity_of_case

with logging_to(snakemake.log[0]):
    of, given, model = snakemake.params, snakemake.input, snakemake.wildcards.model
    found = sensitivity_of_case(given.batches, given.design, model, of.structure, of.linked)
    write_dataset(snakemake.output[0], found)
