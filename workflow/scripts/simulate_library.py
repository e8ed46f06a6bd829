from blockshake.diagnosis.steps import simulate_library
from blockshake.files import write_dataset
from blockshake.log import logging_to

with logging_to(snakemake.log[0]) as say:
    wanted, params = snakemake.wildcards, snakemake.params
    features, histories = simulate_library(
        *(wanted.library, wanted.solver, snakemake.config),
        *(params.shared, params.store, params.source, say),
    )
    write_dataset(snakemake.output.histories, histories)
    write_dataset(snakemake.output.features, features)
