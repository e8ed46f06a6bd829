from blockshake.diagnosis.steps import measure_gain
from blockshake.files import write_dataset, write_json
from blockshake.log import logging_to

with logging_to(snakemake.log[0]):
    found = measure_gain(snakemake.params.folder, snakemake.params.effort, snakemake.input)
    write_dataset(snakemake.output.gain, found.scores)
    write_json(snakemake.output.summary, found.summary.model_dump(mode="json"))
