from pathlib import Path

from blockshake.files import write_text
from blockshake.log import logging_to
from blockshake.study.limit_states.response_table import response_table

with logging_to(snakemake.log[0]):
    path = Path(snakemake.output[0])
    table = response_table(snakemake.params.study, path.parent)
    write_text(path, table.to_csv(index=False, lineterminator="\n"))
