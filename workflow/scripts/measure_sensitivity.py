from blockshake.files import write_dataset
from blockshake.log import logging_to
from blockshake.study.ensemble import join_batches
from blockshake.study.sample_parameters import sample_parameters
from blockshake.study.sampling import load_design
from blockshake.study.sensitivity import sensitivity, unused_variables

with logging_to(snakemake.log[0]):
    design = load_design(snakemake.input.design)
    given = sample_parameters(design.iloc[0], snakemake.params.structure, snakemake.params.linked)
    variables = list(design.columns)
    controls = unused_variables(variables, snakemake.wildcards.model, given)
    write_dataset(
        snakemake.output[0], sensitivity(join_batches(snakemake.input.batches), variables, controls)
    )
