from blockshake.diagnosis.inference.decision import write_result
from blockshake.diagnosis.steps import size_cause
from blockshake.diagnosis.verdict.frozen import freeze
from blockshake.log import logging_to

with logging_to(snakemake.log[0]):
    size, tests = size_cause(snakemake.input, snakemake.params.effects)
    write_result(snakemake.output.posterior, size)
    freeze(snakemake.output.frozen, snakemake.output.posterior, tests)
