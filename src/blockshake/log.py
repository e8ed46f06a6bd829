"""The log of a job: what it says, warns and dies of, in a file, and its progress on the terminal too."""

import contextlib
import logging
import os
import re
import sys
import traceback
from importlib.metadata import version
from pathlib import Path
from typing import NamedTuple

from blockshake.errors import INTERRUPTED, InputError
from blockshake.working_folder import end_with_command

_VERSIONS = ("numpy", "numba", "scipy", "xarray")
_COST = re.compile(r"^Took ([\d.]+) s, ([\d.]+) CPU s\.$", re.MULTILINE)


class Cost(NamedTuple):
    """Cost of a job, without its imports [s]."""

    wall_time: float
    cpu_time: float


@contextlib.contextmanager
def logging_to(path):
    """Write the block's log to a file.

    Yields a function that says one line of progress, in the log and on the terminal. Python warnings and logging go to
    the log; so does the traceback of an error, which is raised on, but for bad input: that ends the job with one line.
    The last line is what the block cost, see `read_cost`. The job ends with the command that started it.
    """
    end_with_command()
    before = os.times()
    Path(path).parent.mkdir(parents=True, exist_ok=True)
    with open(path, "w", encoding="utf-8", buffering=1) as log:
        handler = logging.StreamHandler(log)
        handler.setFormatter(logging.Formatter("%(asctime)s %(levelname)s %(message)s"))
        root = logging.getLogger()
        root.addHandler(handler)
        logging.getLogger("blockshake").setLevel(logging.INFO)
        logging.captureWarnings(True)
        versions = " ".join(f"{name} {version(name)}" for name in _VERSIONS)
        log.write(f"python {sys.version.split()[0]} {versions}\n")

        def say(line):
            log.write(line + "\n")
            sys.stdout.write(line + "\n")
            sys.stdout.flush()

        try:
            yield say
        except InputError as error:
            log.write(traceback.format_exc())
            sys.exit(f"blockshake: {error}")
        except KeyboardInterrupt:
            log.write(traceback.format_exc())
            sys.exit(INTERRUPTED)
        except BaseException:
            log.write(traceback.format_exc())
            raise
        finally:
            root.removeHandler(handler)
            log.write(_cost_since(before))


def read_cost(path):
    """`Cost` in the log of a job; None where the job was killed or has no log.

    The CPU time is that of the job's process and of the programs that the process started and waited for. Snakemake's
    own benchmarks look every 30 s at a job of more than 15 s, and lose the CPU time after the last look.
    """
    try:
        found = _COST.findall(Path(path).read_text(encoding="utf-8"))
    except FileNotFoundError:
        return None
    return Cost(*map(float, found[-1])) if found else None


def _cost_since(before):
    now = os.times()
    return f"Took {now.elapsed - before.elapsed:.2f} s, {sum(now[:4]) - sum(before[:4]):.2f} CPU s.\n"
