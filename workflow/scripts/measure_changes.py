from blockshake.files import write_dataset
from blockshake.log import logging_to
from blockshake.study.extension.changes import change_of_case

with logging_to(snakemake.log[0]):
    input, params = snakemake.input, snakemake.params
    batches = {model: (input[f"{model} without"], input[f"{model} with"]) for model in params.models}
    found = change_of_case(batches, params.climber, input.get("fragility", []), params.measured, input.base)
    write_dataset(snakemake.output[0], found)
