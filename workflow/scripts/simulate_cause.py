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
    (candidate,) = (one for one in plan.candidates if one.key == snakemake.wildcards.candidate)
    draws = plan.own_draws + snakemake.params.further_draws
    # nominal draws and the first with the candidate are in the store
    features, _ = library(
        plan.tests[test],
        snakemake.wildcards.solver,
        [candidate],
        draws,
        draws,
        snakemake.params.store,
        snakemake.params.source,
        say,
    )
    write_dataset(snakemake.output[0], features)
