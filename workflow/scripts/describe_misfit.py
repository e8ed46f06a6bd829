from blockshake.diagnosis.steps import describe_misfit
from blockshake.files import write_dataset
from blockshake.log import logging_to

with logging_to(snakemake.log[0]):
    found = describe_misfit(snakemake.params.folder, snakemake.params.effort, snakemake.input)
    write_dataset(snakemake.output[0], found)
