from blockshake.diagnosis.inference.calibration import write_cases
from blockshake.diagnosis.steps import calibrate_decision
from blockshake.log import logging_to

with logging_to(snakemake.log[0]) as say:
    write_cases(snakemake.output[0], calibrate_decision(snakemake.input, snakemake.params.effects, say))
