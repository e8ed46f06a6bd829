from blockshake.log import logging_to
from blockshake.study.convergence.convergence import study_convergence
from blockshake.study.convergence.settings import Convergence
from blockshake.study.convergence.table import write_convergence

with logging_to(snakemake.log[0]) as say:
    of = snakemake.params
    found = study_convergence(Convergence(**of.convergence), of.store, of.source, say)
    write_convergence(snakemake.output[0], found)
