from blockshake.diagnosis.steps import simulate_nominal
from blockshake.files import write_dataset
from blockshake.log import logging_to

with logging_to(snakemake.log[0]) as say:
    wanted, params = snakemake.wildcards, snakemake.params
    runs = simulate_nominal(
        *(wanted.ensemble, wanted.solver, snakemake.config),
        *(params.shared, params.store, params.source, say),
    )
    write_dataset(snakemake.output[0], runs)
