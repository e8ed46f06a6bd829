from blockshake.files import write_dataset
from blockshake.log import logging_to
from blockshake.study.comparison.comparison import compare_case
from blockshake.study.ensembles.levels import levels_of

with logging_to(snakemake.log[0]):
    input, params = snakemake.input, snakemake.params
    batches = {model: input[f"batches {model}"] for model in params.models}
    replicates = {model: input.get(f"replicate {model}") for model in params.models}
    levels = levels_of(params.case, params.seed, params.size)
    found = compare_case(batches, replicates, params.measured, input.base, levels)
    write_dataset(snakemake.output[0], found)
