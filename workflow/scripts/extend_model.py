from blockshake.diagnosis.steps import extend_model
from blockshake.files import write_dataset
from blockshake.log import logging_to

with logging_to(snakemake.log[0]) as say:
    of, solver = snakemake.params, snakemake.wildcards.solver
    runs = extend_model(of.folder, of.effort, solver, snakemake.input, of.store, of.source, say)
    write_dataset(snakemake.output[0], runs)
