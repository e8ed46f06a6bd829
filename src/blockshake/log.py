"""The log of a job: what it says, warns and dies of, in a file, and its progress on the terminal too."""

import contextlib
import logging
import sys
import traceback
from importlib.metadata import version
from pathlib import Path

from blockshake.errors import INTERRUPTED, InputError
from blockshake.working_folder import end_with_command

_VERSIONS = ("numpy", "numba", "scipy", "xarray")


@contextlib.contextmanager
def logging_to(path):
    """Write the block's log to a file.

    Yields a function that says one line of progress, in the log and on the terminal. Python warnings and logging go to
    the log; so does the traceback of an error, which is raised on, but for bad input: that ends the job with one line.
    The job ends with the command that started it.
    """
    end_with_command()
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
