from blockshake.diagnosis.steps import extend_model
from blockshake.files import write_dataset
from blockshake.log import logging_to
from blockshake.store import Store

with logging_to(snakemake.log[0]) as say:
    params, store = snakemake.params, Store(snakemake.params.store, snakemake.params.source, say)
    runs = extend_model(params.folder, params.effort, snakemake.wildcards.solver, snakemake.input, store)
    write_dataset(snakemake.output[0], runs)
