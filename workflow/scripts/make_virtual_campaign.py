from blockshake.files import write_dataset, write_json, write_text
from blockshake.log import logging_to
from blockshake.study.virtual_campaign import campaign_yaml, simulate_virtual_test

with logging_to(snakemake.log[0]):
    test, truth = simulate_virtual_test(snakemake.params.case, snakemake.params.linked)
    write_dataset(snakemake.output.test, test, decimals=6)
    write_text(snakemake.output.campaign, campaign_yaml(snakemake.params.case))
    write_json(snakemake.output.truth, truth)
