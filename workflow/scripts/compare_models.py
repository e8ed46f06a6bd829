from blockshake.files import write_dataset
from blockshake.log import logging_to
from blockshake.study.comparison.comparison import compare_case

with logging_to(snakemake.log[0]):
    given, of = snakemake.input, snakemake.params
    batches = {model: given[f"batches {model}"] for model in of.models}
    twins = {model: given.get(f"twin {model}") for model in of.models}
    found = compare_case(batches, twins, of.measured, given.base)
    write_dataset(snakemake.output[0], found)
