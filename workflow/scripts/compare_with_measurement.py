from blockshake.files import write_dataset
from blockshake.log import logging_to
from blockshake.measurement.campaign import load_campaign, load_test
from blockshake.study.coverage import coverage
from blockshake.study.ensemble import join_batches

with logging_to(snakemake.log[0]):
    measured = snakemake.params.measured
    campaign = load_campaign(measured["campaign"])
    compared = coverage(
        load_test(campaign, measured["test"]),
        join_batches(snakemake.input.batches),
        campaign.sensors.marker_noise,
    )
    write_dataset(snakemake.output[0], compared)
