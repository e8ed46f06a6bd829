from blockshake.diagnosis.steps import read_measured
from blockshake.files import write_dataset, write_json
from blockshake.log import logging_to

with logging_to(snakemake.log[0]):
    params = snakemake.params
    measured = read_measured(params.folder, params.effort, params.without)
    write_dataset(snakemake.output.readings, measured.readings)
    write_dataset(snakemake.output.forces, measured.forces)
    write_json(snakemake.output.parity, measured.parity.as_json())
