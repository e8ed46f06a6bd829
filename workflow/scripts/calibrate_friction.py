from blockshake.files import source_digest, write_json
from blockshake.log import logging_to
from blockshake.measurement.campaign import load_campaign, load_test
from blockshake.sources import batch_sources
from blockshake.study.distributions import load_distributions
from blockshake.study.friction_search import calibrate_friction, friction_summary
from blockshake.study.friction_settings import FrictionSearch

with logging_to(snakemake.log[0]) as say:
    params = snakemake.params
    search = FrictionSearch(**params.search).model_dump()
    campaign = load_campaign(params.measured["campaign"])
    measured = load_test(campaign, params.measured["test"])
    found, beside = calibrate_friction(
        params.case,
        {
            "model": search["model"],
            **params.models[search["model"]],
            "output_rate": params.output_rate,
            "tower": snakemake.input.tower,
        },
        {
            "distributions": load_distributions(params.ensemble.get("distributions"), "ensemble"),
            "seed": params.ensemble["seed"],
            "linked": params.ensemble.get("linked", {}),
        },
        search,
        measured,
        campaign.sensors.marker_noise,
        params.store,
        source_digest(*batch_sources(search["model"])),
        say,
    )
    write_json(snakemake.output[0], friction_summary(found, beside, search, measured))
