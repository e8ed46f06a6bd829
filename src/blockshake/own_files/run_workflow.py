"""The workflow as a process of its own, in any folder: what `blockshake study` and `blockshake diagnose` start."""

import contextlib
import os
import re
import subprocess
import sys
import time
from pathlib import Path

from blockshake.errors import INTERRUPTED, InputError
from blockshake.files import HOME
from blockshake.working_folder import this_command

_GRACE = 15.0  # s; for a workflow that is interrupted to end
_STEPS = re.compile(r"^(\d+) of (\d+) steps \((\d+)%\) done$")
_END = re.compile(r"^(Not finished\.|blockshake: )")
_PERIOD = 5.0  # s, at least, between two lines of progress
_LAST = 15  # lines of a workflow that ends without a word of its own


class WorkflowError(RuntimeError):
    """The workflow did not end well; its last lines say why.

    Parameters
    ----------
    exit_code : int
        Its own: 2 for bad input, 130 for Ctrl-C, else 1.
    """

    def __init__(self, exit_code):
        self.exit_code = exit_code
        super().__init__("the workflow stopped: its last lines say why")


def cores_of(command, cores):
    """Number of cores that a command takes: all by default; an `InputError` where the number requested is none."""
    if cores is not None and (not isinstance(cores, int) or cores < 1):
        raise InputError(command, "cores", f"expected a whole number from 1, not {cores!r}")
    return os.cpu_count() if cores is None else cores


def workflow_command(cores, folder, configfile, *arguments):
    """Command that starts the workflow in a folder, as a list of its words; ``arguments``: targets and options."""
    return [
        sys.executable, "-m", "snakemake", *arguments[:1], "--cores", str(cores),
        "--snakefile", str(HOME / "Snakefile"), "--directory", str(folder), "--configfile", str(configfile),
        *arguments[1:],
    ]  # fmt: skip


class Listener:
    """Gets the lines of a workflow: tells how far it is, and shows its errors.

    Parameters
    ----------
    name : str
        Name of the study or the campaign.
    say : callable
        Gets lines of progress.
    """

    def __init__(self, name, say):
        self.name, self._say, self._said = name, say, time.monotonic()
        self._ending, self._last = False, []

    def __call__(self, line):
        """Take a line of the workflow's output."""
        self._last = [*self._last[1 - _LAST :], line]
        self._ending = self._ending or bool(_END.match(line))
        if self._ending:
            sys.stderr.write(f"{line}\n")
        elif (found := _STEPS.match(line)) and self.is_due():
            self.count(found[1], found[2])

    def count(self, done, total):
        """Tell how many jobs are done."""
        self.say(f"{self.name}: {done} of {total} jobs")

    def is_due(self):
        """Whether the last line of progress is some seconds old."""
        return time.monotonic() - self._said > _PERIOD

    def say(self, words):
        """Tell a line of progress."""
        self._said = time.monotonic()
        self._say(words)

    def explain(self, exit_code):
        """Show why a workflow ended badly, where its own lines do not."""
        if exit_code == INTERRUPTED:
            self.say(
                f"{self.name}: interrupted; what is finished is kept, and the same command goes on from it"
            )
        elif not self._ending:
            sys.stderr.write("\n".join([*self._last, ""]))


def run_workflow(command, listener):
    """Run a workflow, whose last lines are the outcome, after Ctrl-C too.

    Parameters
    ----------
    command : list of str
        From `workflow_command`. The workflow ends with this process.
    listener : Listener
        Gets every line of its output.

    Raises
    ------
    WorkflowError
    """
    path = os.pathsep.join([str(Path(sys.executable).parent), os.environ.get("PATH", "")])
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.STDOUT}
    environment = {**os.environ, **this_command(), "PATH": path}
    with subprocess.Popen(command, env=environment, text=True, errors="replace", **pipes) as workflow:
        try:
            for line in workflow.stdout:
                listener(line.rstrip("\n"))
            exit_code = workflow.wait()
        except KeyboardInterrupt:  # which the workflow got as well
            with contextlib.suppress(subprocess.TimeoutExpired):
                workflow.wait(_GRACE)
            workflow.kill()
            exit_code = INTERRUPTED
    if exit_code:
        listener.explain(exit_code)
        raise WorkflowError(exit_code)
