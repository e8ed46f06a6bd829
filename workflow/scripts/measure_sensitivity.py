from blockshake.files import write_dataset
from blockshake.log import logging_to
from blockshake.study.ensembles.levels import levels_of
from blockshake.study.sensitivity.sensitivity import sensitivity_of_case

with logging_to(snakemake.log[0]):
    params, input, model = snakemake.params, snakemake.input, snakemake.wildcards.model
    levels = levels_of(params.case, params.seed, params.size)
    structure = params.case["structure"]
    found = sensitivity_of_case(input.batches, input.design, model, structure, params.linked, levels)
    write_dataset(snakemake.output[0], found)
