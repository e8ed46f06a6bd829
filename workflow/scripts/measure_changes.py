from blockshake.files import write_dataset
from blockshake.log import logging_to
from blockshake.study.extension.changes import change_of_case

with logging_to(snakemake.log[0]):
    given, of = snakemake.input, snakemake.params
    batches = {model: (given[f"{model} without"], given[f"{model} with"]) for model in of.models}
    found = change_of_case(batches, of.climber, given.get("fragility", []), of.measured, given.base)
    write_dataset(snakemake.output[0], found)
