from blockshake.files import write_dataset
from blockshake.log import logging_to
from blockshake.study.fragility.cloud import cloud_of_case

with logging_to(snakemake.log[0]):
    params, samples = snakemake.params, snakemake.input.samples
    write_dataset(snakemake.output[0], cloud_of_case(samples, params.case, params.seed, params.largest_drift))
