from blockshake.diagnosis.library import library
from blockshake.diagnosis.plan import plan_of_library
from blockshake.files import write_dataset
from blockshake.log import logging_to

with logging_to(snakemake.log[0]) as say:
    plan, test = plan_of_library(
        snakemake.wildcards.library,
        snakemake.config["diagnosed"],
        snakemake.config["diagnosis_effort"],
        snakemake.params.source,
    )
    features, histories = library(
        plan.tests[test],
        snakemake.wildcards.solver,
        plan.candidates,
        plan.effort.nominal_draws,
        plan.own_draws,
        snakemake.params.store,
        snakemake.params.source,
        say,
    )
    write_dataset(snakemake.output.histories, histories)
    write_dataset(snakemake.output.features, features)
