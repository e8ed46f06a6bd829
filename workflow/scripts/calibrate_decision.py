from blockshake.diagnosis.inference.calibration import write_cases
from blockshake.diagnosis.steps import calibrate_decision
from blockshake.log import logging_to

with logging_to(snakemake.log[0]) as say:
    of = snakemake.params
    cases = calibrate_decision(snakemake.input, of.effects, of.store, of.source, say)
    write_cases(snakemake.output[0], cases)
