from blockshake.diagnosis.inference.decision import write_result
from blockshake.diagnosis.steps import measure_gain
from blockshake.files import write_dataset
from blockshake.log import logging_to

with logging_to(snakemake.log[0]):
    found = measure_gain(snakemake.params.folder, snakemake.input)
    write_dataset(snakemake.output.gain, found.scores)
    write_dataset(snakemake.output.consequences, found.consequences)
    write_result(snakemake.output.summary, found.summary)
