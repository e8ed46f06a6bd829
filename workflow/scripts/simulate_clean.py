from blockshake.diagnosis.steps import simulate_clean
from blockshake.files import write_json
from blockshake.log import logging_to
from blockshake.store import Store

with logging_to(snakemake.log[0]) as say:
    params = snakemake.params
    store = Store(params.store, params.source, say)
    write_json(
        snakemake.output[0], simulate_clean(params.folder, params.effort, snakemake.wildcards.solver, store)
    )
