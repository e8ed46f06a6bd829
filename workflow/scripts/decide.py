import json
from pathlib import Path

import xarray as xr

from blockshake.diagnosis.calibration import cases_from_json
from blockshake.diagnosis.candidates import candidates
from blockshake.diagnosis.conclusion import decision_as_json
from blockshake.diagnosis.deciding_features import deciding_features
from blockshake.diagnosis.decision import decide
from blockshake.diagnosis.frozen import freeze
from blockshake.diagnosis.library_scores import load_tables, score_library
from blockshake.diagnosis.measured_readings import reading_of, tamed_readings
from blockshake.diagnosis.misfit import misfit
from blockshake.files import write_dataset, write_json
from blockshake.geometry.structure import load_structure
from blockshake.log import logging_to
from blockshake.measurement.campaign import load_campaign

with logging_to(snakemake.log[0]):
    campaign = load_campaign(snakemake.params.folder)
    measured = xr.load_dataset(snakemake.input.readings)
    names = [str(name) for name in measured["test"].values]
    readings = [reading_of(measured, name) for name in names]
    library, scales = score_library(load_tables(snakemake.input.libraries), snakemake.params.effects)
    features = tamed_readings(scales, measured)
    cases = cases_from_json(json.loads(Path(snakemake.input.calibration).read_text()))
    decision, scores = decide(library, features, cases)
    best = decision.places[(decision.causes or list(decision.places))[0]]
    ensembles = load_tables(snakemake.input.histories)
    write_dataset(
        snakemake.output.misfit,
        misfit(measured, {name: list(one.values()) for name, one in zip(names, ensembles, strict=True)}),
    )
    write_dataset(
        snakemake.output.evidence,
        deciding_features(library, scales, readings, names, best, scores.size[best], scores.model[best]),
    )
    everywhere = candidates(load_structure(campaign.structure))
    write_json(snakemake.output.decision, decision_as_json(decision, scores, everywhere, cases))
    freeze(snakemake.output.frozen, snakemake.output.decision, names)
