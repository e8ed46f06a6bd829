from blockshake.diagnosis.steps import simulate_outcomes
from blockshake.files import write_dataset
from blockshake.log import logging_to
from blockshake.store import Store

with logging_to(snakemake.log[0]) as say:
    of, wanted = snakemake.params, snakemake.wildcards
    store = Store(of.store, of.source, say)
    write_dataset(
        snakemake.output[0], simulate_outcomes(of.folder, of.effort, int(wanted.number), wanted.solver, store)
    )
