from blockshake.files import write_json
from blockshake.log import logging_to
from blockshake.study.calibration.calibration import calibrate

with logging_to(snakemake.log[0]):
    write_json(snakemake.output[0], calibrate(snakemake.input, snakemake.params.study))
