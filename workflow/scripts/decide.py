from blockshake.diagnosis.inference.decision import write_result
from blockshake.diagnosis.steps import decide
from blockshake.diagnosis.verdict.frozen import freeze
from blockshake.files import write_dataset
from blockshake.log import logging_to

with logging_to(snakemake.log[0]):
    decided = decide(snakemake.params.folder, snakemake.params.effects, snakemake.input)
    write_dataset(snakemake.output.misfit, decided.misfit)
    write_dataset(snakemake.output.evidence, decided.evidence)
    write_result(snakemake.output.decision, decided.decision)
    freeze(snakemake.output.frozen, snakemake.output.decision, decided.tests)
