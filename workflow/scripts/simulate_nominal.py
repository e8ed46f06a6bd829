from blockshake.diagnosis.steps import simulate_nominal
from blockshake.files import write_dataset
from blockshake.log import logging_to
from blockshake.store import Store

with logging_to(snakemake.log[0]) as say:
    params, wildcards = snakemake.params, snakemake.wildcards
    store = Store(params.store, params.source, say)
    runs = simulate_nominal(params.folder, params.effort, int(wildcards.number), wildcards.solver, store)
    write_dataset(snakemake.output[0], runs)
