import xarray as xr

from blockshake.diagnosis.null_model import MODELS
from blockshake.diagnosis.plan import plan_of_library
from blockshake.diagnosis.predictability import predictability_of
from blockshake.files import write_dataset
from blockshake.log import logging_to

with logging_to(snakemake.log[0]) as say:
    plan, test = plan_of_library(
        snakemake.wildcards.library,
        snakemake.config["diagnosed"],
        snakemake.config["diagnosis_effort"],
        snakemake.params.library,
    )
    nominal = {one.attrs["model"]: one for one in map(xr.load_dataset, snakemake.input.histories)}
    found = predictability_of(plan.tests[test], MODELS, plan.effort.twins, nominal, say)
    write_dataset(snakemake.output[0], found)
