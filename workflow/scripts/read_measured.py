from blockshake.diagnosis.measured_readings import measured_readings
from blockshake.diagnosis.parity import campaign_parity
from blockshake.diagnosis.plan import EFFORTS, open_tests
from blockshake.files import write_dataset, write_json
from blockshake.log import logging_to
from blockshake.measurement.campaign import load_campaign

with logging_to(snakemake.log[0]):
    campaign = load_campaign(snakemake.params.folder)
    names = open_tests(campaign, EFFORTS[snakemake.params.effort])
    parity = campaign_parity(campaign, names, snakemake.params.without)
    write_dataset(snakemake.output.readings, measured_readings(campaign, names, parity.findings))
    write_json(snakemake.output.parity, parity.as_json())
