from blockshake.files import write_json
from blockshake.log import logging_to
from blockshake.study.correlation_target import load_correlation
from blockshake.study.distributions import load_distributions
from blockshake.study.sampling import draw_samples, write_design

with logging_to(snakemake.log[0]):
    ensemble = snakemake.params.ensemble
    correlation = ensemble.get("correlation")
    design = draw_samples(
        size=ensemble["size"],
        seed=ensemble["seed"],
        distributions=load_distributions(ensemble.get("distributions"), "ensemble"),
        correlation=load_correlation(correlation) if correlation else None,
    )
    write_design(snakemake.output.design, design.values)
    write_json(snakemake.output.summary, design.summary())
