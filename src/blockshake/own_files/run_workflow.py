"""The workflow as a process of its own, in any folder: what `blockshake study` and `blockshake diagnose` start."""

import contextlib
import os
import subprocess
import sys
from pathlib import Path

from blockshake.errors import INTERRUPTED, InputError
from blockshake.files import HOME
from blockshake.working_folder import this_command

_GRACE = 15.0  # s; for a workflow that is interrupted to end


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


def run_workflow(command, hear=None):
    """Run a workflow, whose last lines are the outcome, after Ctrl-C too.

    Parameters
    ----------
    command : list of str
        From `workflow_command`. The workflow ends with this process.
    hear : callable, optional
        Gets every line of its output, which is shown as it is by default.

    Raises
    ------
    WorkflowError
    """
    path = os.pathsep.join([str(Path(sys.executable).parent), os.environ.get("PATH", "")])
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.STDOUT} if hear else {}
    environment = {**os.environ, **this_command(), "PATH": path}
    with subprocess.Popen(command, env=environment, text=True, errors="replace", **pipes) as workflow:
        try:
            for line in workflow.stdout or ():
                hear(line.rstrip("\n"))
            exit_code = workflow.wait()
        except KeyboardInterrupt:  # which the workflow got as well
            with contextlib.suppress(subprocess.TimeoutExpired):
                workflow.wait(_GRACE)
            workflow.kill()
            exit_code = INTERRUPTED
    if exit_code:
        raise WorkflowError(exit_code)
