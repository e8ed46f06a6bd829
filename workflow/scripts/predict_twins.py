from blockshake.diagnosis.steps import predict_twins
from blockshake.files import write_dataset
from blockshake.log import logging_to

with logging_to(snakemake.log[0]) as say:
    library, histories = snakemake.wildcards.library, snakemake.input.histories
    horizon = predict_twins(library, histories, snakemake.config, snakemake.params.shared, say)
    write_dataset(snakemake.output[0], horizon)
