import xarray as xr

from blockshake.diagnosis.campaign_gain import campaign_gain
from blockshake.diagnosis.frozen import check_frozen
from blockshake.diagnosis.gain import gain_of_verdict
from blockshake.diagnosis.library_scores import load_tables
from blockshake.diagnosis.measured_readings import measured_readings
from blockshake.diagnosis.parity import check_parity
from blockshake.diagnosis.plan import sealed_tests
from blockshake.files import write_dataset, write_json
from blockshake.geometry.structure import load_structure
from blockshake.log import logging_to
from blockshake.measurement.campaign import load_campaign, load_test

with logging_to(snakemake.log[0]):
    check_frozen(snakemake.input.frozen, snakemake.input.decision)
    campaign = load_campaign(snakemake.params.folder)
    names = sealed_tests(campaign)
    sealed = {name: load_test(campaign, name) for name in names}
    findings = check_parity(sealed, load_structure(campaign.structure), campaign.sensors).findings
    runs = {one.attrs["model"]: one for one in map(xr.load_dataset, snakemake.input.extended)}
    gain, consequences = campaign_gain(
        campaign,
        xr.load_dataset(snakemake.input.readings),
        load_tables(snakemake.input.libraries),
        measured_readings(campaign, names, findings),
        runs,
    )
    of_verdict, caveats = gain_of_verdict(gain)
    write_dataset(snakemake.output.consequences, consequences)
    write_dataset(snakemake.output.gain, gain)
    write_json(
        snakemake.output.summary,
        {
            "gain": of_verdict.model_dump(),
            "caveats": caveats,
            "runs": sum(one.sizes["run"] for one in runs.values()),
        },
    )
