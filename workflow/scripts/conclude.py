import json
from pathlib import Path

import xarray as xr

from blockshake.diagnosis.conclusion import conclude
from blockshake.diagnosis.finding import Finding
from blockshake.diagnosis.misfit import where
from blockshake.diagnosis.plan import plan_diagnosis
from blockshake.diagnosis.verdict import Gain, write_verdict
from blockshake.log import logging_to

with logging_to(snakemake.log[0]):
    parity, decision = (
        json.loads(Path(snakemake.input[name]).read_text()) for name in ("parity", "decision")
    )
    size = json.loads(Path(snakemake.input.posterior[0]).read_text()) if snakemake.input.posterior else None
    measured = json.loads(Path(snakemake.input.gain).read_text()) if snakemake.input.get("gain") else None
    plan = plan_diagnosis(snakemake.params.folder, snakemake.params.effort)
    verdict = conclude(
        decision,
        [Finding.from_json(values) for values in parity["findings"]],
        parity["channels"],
        where(xr.load_dataset(snakemake.input.misfit)),
        plan.runs + (plan.further_runs if size else 0) + (measured["runs"] if measured else 0),
        measured["caveats"] if measured else plan.caveats([*decision["causes"], *parity["findings"]]),
        snakemake.params.effort,
        size,
        Gain(**measured["gain"]) if measured and measured["gain"] else None,
    )
    write_verdict(snakemake.output[0], verdict)
