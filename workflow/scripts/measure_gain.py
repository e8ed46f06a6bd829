import json
from pathlib import Path

import xarray as xr

from blockshake.diagnosis.campaign_gain import campaign_gain
from blockshake.diagnosis.finding import Finding
from blockshake.diagnosis.frozen import check_frozen
from blockshake.diagnosis.gain import gain_of_verdict
from blockshake.diagnosis.library_scores import load_tables
from blockshake.diagnosis.measured_readings import measured_readings
from blockshake.diagnosis.parity import check_parity
from blockshake.diagnosis.plan import sealed_tests
from blockshake.diagnosis.sensor_gain import gaining, sensor_gain
from blockshake.files import write_dataset, write_json
from blockshake.geometry.structure import load_structure
from blockshake.log import logging_to
from blockshake.measurement.campaign import load_campaign, load_test

with logging_to(snakemake.log[0]):
    check_frozen(snakemake.input.frozen, snakemake.input.decision)
    if snakemake.input.posterior:
        size, frozen_size = snakemake.input.posterior
        check_frozen(frozen_size, size)
    campaign = load_campaign(snakemake.params.folder)
    structure, names = load_structure(campaign.structure), sealed_tests(campaign)
    sealed = {name: load_test(campaign, name) for name in names}
    readings = xr.load_dataset(snakemake.input.readings)
    runs = {one.attrs["model"]: one for one in map(xr.load_dataset, snakemake.input.extended)}
    if runs:
        findings = check_parity(sealed, structure, campaign.sensors).findings
        gain, consequences = campaign_gain(
            campaign,
            readings,
            load_tables(snakemake.input.libraries),
            measured_readings(campaign, names, findings, float(next(iter(runs.values()))["time"][-1])),
            runs,
        )
        of_verdict, caveats = gain_of_verdict(gain)
    else:
        known = json.loads(Path(snakemake.input.parity).read_text())["findings"]
        finding = gaining([Finding.from_json(values) for values in known], structure)
        opened = {str(name): load_test(campaign, str(name)) for name in readings["test"].values}
        of_verdict, gain, caveats = sensor_gain(finding, opened, sealed, structure, campaign.sensors)
        consequences = xr.Dataset()
    write_dataset(snakemake.output.gain, gain)
    write_dataset(snakemake.output.consequences, consequences)
    write_json(
        snakemake.output.summary,
        {
            "gain": of_verdict.model_dump() if of_verdict else None,
            "caveats": caveats,
            "runs": sum(one.sizes["run"] for one in runs.values()),
        },
    )
