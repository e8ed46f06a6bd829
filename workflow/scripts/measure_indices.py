from blockshake.files import write_dataset
from blockshake.log import logging_to
from blockshake.study.ensembles.levels import levels_of
from blockshake.study.sensitivity.indices import indices_of_case

with logging_to(snakemake.log[0]):
    input, params = snakemake.input, snakemake.params
    levels, limits = levels_of(params.case, params.seed, params.size), next(iter(input.limits), None)
    found = indices_of_case(input.samples, input.sensitivity, limits, params.seed, levels)
    write_dataset(snakemake.output[0], found)
