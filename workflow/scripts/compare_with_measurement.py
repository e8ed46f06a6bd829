from blockshake.files import write_dataset
from blockshake.log import logging_to
from blockshake.study.ensembles.coverage import coverage_of_case

with logging_to(snakemake.log[0]):
    input, params = snakemake.input, snakemake.params
    for model, path in zip(params.models, snakemake.output, strict=True):
        write_dataset(path, coverage_of_case(params.measured, input.base, input[f"batches {model}"]))
