from blockshake.diagnosis.steps import simulate_cause
from blockshake.files import write_dataset
from blockshake.log import logging_to

with logging_to(snakemake.log[0]) as say:
    of, params = snakemake.wildcards, snakemake.params
    features = simulate_cause(
        *(of.library, of.solver, of.candidate, params.further_draws),
        *(snakemake.config, params.shared, params.store, params.source, say),
    )
    write_dataset(snakemake.output[0], features)
