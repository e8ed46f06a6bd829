import json
from pathlib import Path

import xarray as xr

from blockshake.diagnosis.conclusion import conclude
from blockshake.diagnosis.finding import Finding
from blockshake.diagnosis.misfit import where
from blockshake.diagnosis.verdict import Gain, write_verdict
from blockshake.log import logging_to

with logging_to(snakemake.log[0]):
    parity, decision, gain = (
        json.loads(Path(snakemake.input[name]).read_text()) for name in ("parity", "decision", "gain")
    )
    verdict = conclude(
        decision,
        [Finding.from_json(values) for values in parity["findings"]],
        where(xr.load_dataset(snakemake.input.misfit)),
        gain["runs"],
        gain["caveats"],
        snakemake.params.effort,
        Gain(**gain["gain"]) if gain["gain"] else None,
    )
    write_verdict(snakemake.output[0], verdict)
