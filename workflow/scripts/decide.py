from blockshake.diagnosis.answer.decision import freeze, write_decision
from blockshake.diagnosis.steps import decide
from blockshake.files import write_dataset, write_json
from blockshake.log import logging_to

with logging_to(snakemake.log[0]):
    measured = decide(snakemake.params.folder, snakemake.params.without, snakemake.input)
    write_json(snakemake.output.parity, measured.parity.as_json())
    write_dataset(snakemake.output.evidence, measured.evidence)
    write_decision(snakemake.output.decision, measured.decision)
    freeze(snakemake.output.frozen, snakemake.output.decision, measured.decision.tests)
