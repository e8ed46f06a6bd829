"""The log of a job: messages, warnings and errors; and the end of the command whose job failed."""

import contextlib
import logging
import os
import re
import signal
import sys
import threading
import time
import traceback
from importlib.metadata import version
from pathlib import Path
from typing import NamedTuple

from blockshake.errors import BAD_INPUT, INTERRUPTED, InputError, one_line
from blockshake.working_folder import end_with_command, interrupt_jobs

_VERSIONS = ("numpy", "numba", "scipy", "xarray")
_REASON = re.compile(r"^Ended with exit code (\d+): (.*)$", re.MULTILINE)
_JOB_FAILED = "job_error"  # Snakemake's event
_GRACE = 10.0  # s; for running jobs to keep their checkpoints
_SHOWN = 5  # failed jobs in the last lines
_UNKNOWN = "the job ended without a word, as one does that is killed or whose modules cannot be imported"


class Reason(NamedTuple):
    """Reason for which a job failed, in one line, and its exit code."""

    exit_code: int
    words: str


@contextlib.contextmanager
def logging_to(path):
    """Write the block's log to a file.

    Yields a function that prints one line of progress, in the log and on the terminal. Python warnings and logging go
    to the log; so does the traceback of an error, which is raised on, but for bad input: that ends the job with one
    line and exit code 2. The last lines are the reason of a failure, see `read_reason`, and what the block cost in
    time and CPU time [s]. The job ends with the command that started it.
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

        def failed(exit_code, words):
            log.write(f"{traceback.format_exc()}Ended with exit code {exit_code}: {one_line(words)}\n")

        try:
            yield say
        except InputError as error:
            failed(BAD_INPUT, str(error))
            sys.stderr.write(f"blockshake: {error}\n")
            sys.exit(BAD_INPUT)
        except KeyboardInterrupt:
            failed(INTERRUPTED, "interrupted")
            sys.exit(INTERRUPTED)
        except BaseException as error:
            failed(1, f"{type(error).__name__}: {error}")
            raise
        finally:
            root.removeHandler(handler)
            now = os.times()
            cost = sum(now[:4]) - sum(before[:4])
            log.write(f"Took {now.elapsed - before.elapsed:.2f} s, {cost:.2f} CPU s.\n")


def read_reason(path):
    """`Reason` in the log of a job that failed; None where the job did not, was killed or has no log."""
    try:
        found = _REASON.findall(Path(path).read_text(encoding="utf-8"))
    except FileNotFoundError:
        return None
    return Reason(int(found[-1][0]), found[-1][1]) if found else None


class Failures(logging.Filter):
    """Failed jobs of a workflow, noted as Snakemake logs them; the last lines of the command say what failed and why.

    The first failure interrupts all other jobs and the command, since the target cannot be made any more. Otherwise
    hours would pass before anybody reads the reason.
    """

    def __init__(self):
        super().__init__()
        self.failed, self.stopping, self.interrupted = {}, False, False

    def watch(self, logger, keep_going, retries):
        """Note the failures in Snakemake's logger, and the user's Ctrl-C, from now on.

        Parameters
        ----------
        logger : logging.Logger
        keep_going : bool
            The user wants the jobs that do not need the failed one.
        retries : int
            How often a job that was killed is started again. Other failures would come again.
        """
        self.keep_going, self.retries, self.started = keep_going, retries, time.time()
        logger.addFilter(self)
        if callable(handler := signal.getsignal(signal.SIGINT)):

            def note(number, frame):
                self.interrupted = not self.stopping
                handler(number, frame)

            signal.signal(signal.SIGINT, note)

    def filter(self, record):
        """Note a failure; every record passes."""
        if getattr(getattr(record, "event", None), "value", None) == _JOB_FAILED and not self.interrupted:
            self._note(record)
        return True

    def end(self):
        """End this process: the reasons, the jobs and their logs are the last lines, and the exit code is theirs.

        The code is 2 where any input was bad, 130 where the user interrupted, and else 1.
        """
        lines = ["Not finished. All that is finished is kept, and the same command goes on."]
        for (rule, outputs, log), reason in list(self.failed.items())[:_SHOWN]:
            lines += [f"blockshake: {reason.words}", f"  job: {rule}, which makes {outputs}"]
            lines += [f"  log: {log}"] if log else []
        if len(self.failed) > _SHOWN:
            lines.append(f"blockshake: and {len(self.failed) - _SHOWN} more jobs failed")
        if not self.failed:
            lines.append(f"blockshake: {'interrupted' if self.interrupted else 'stopped before its end'}")
        sys.stdout.flush()
        sys.stderr.write("\n".join(lines) + "\n")
        sys.stderr.flush()
        codes = {reason.exit_code for reason in self.failed.values()}
        os._exit(BAD_INPUT if BAD_INPUT in codes else INTERRUPTED if self.interrupted else 1)

    def _note(self, record):
        log = next(iter(record.log), None)
        fresh = log is not None and os.path.exists(log) and os.path.getmtime(log) >= self.started
        reason = read_reason(log) if fresh else None
        if self.stopping and (reason is None or reason.exit_code == INTERRUPTED):
            return
        if reason is None and self.retries and not self.keep_going:
            return
        self.failed[record.rule_name, ", ".join(record.output), log] = reason or Reason(1, _UNKNOWN)
        if not (self.keep_going or self.stopping):
            self.stopping = True
            late = threading.Timer(_GRACE, self.end)
            late.daemon = True
            late.start()
            interrupt_jobs()
            os.kill(os.getpid(), signal.SIGINT)
