from blockshake.log import logging_to
from blockshake.study.convergence import study_convergence
from blockshake.study.convergence_settings import Convergence
from blockshake.study.convergence_table import write_convergence

with logging_to(snakemake.log[0]) as say:
    write_convergence(
        snakemake.output[0], study_convergence(Convergence(**snakemake.params.convergence), say)
    )
