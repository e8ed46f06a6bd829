"""A campaign diagnosed by the checkout's workflow: what `blockshake diagnose` and `blockshake.diagnose` start."""

import contextlib
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

from blockshake.errors import INTERRUPTED, InputError
from blockshake.files import HOME, PACKAGE, check_output
from blockshake.working_folder import hold, this_command

_ALWAYS_MADE = ("verdict.json", "decision.json", "parity.json", "evidence.nc")
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


def diagnose(campaign, output, effort="standard", cores=None):
    """Show what simulations of measured tests get wrong, name the cause, extend the model and measure the gain.

    Simulates by the workflow's rules, in ``results`` of the checkout or, of an installed package, of the current
    folder: a run that was stopped goes on where it was, and a second campaign of the same structure and motions finds
    their ensembles there.

    Parameters
    ----------
    campaign : str or path
        Folder.
    output : str or path
        Folder for the verdict, the report and the figures' data; made if need be, written when all is done.
    effort : str
        ``quick``, ``standard`` or ``deep``.
    cores : int, optional
        All by default.

    Returns
    -------
    Verdict

    Raises
    ------
    InputError
        A campaign that cannot be diagnosed, a number of cores below 1, or another command works in the folder of the
        results.
    WorkflowError
        A job failed: the workflow's last lines are the reason, the job and the path of its log.
    """
    from blockshake.diagnosis.nominal.plan import plan_diagnosis, result_name
    from blockshake.diagnosis.verdict.verdict import load_verdict

    if cores is not None and (not isinstance(cores, int) or cores < 1):
        raise InputError("diagnose", "cores", f"expected a whole number from 1, not {cores!r}")
    plan = plan_diagnosis(campaign, effort)
    work = working_place()
    os.close(hold(work))  # the workflow holds it again
    check_output(Path(output) / "verdict.json")
    command = diagnosis_command(campaign, effort, os.cpu_count() if cores is None else cores)
    path = os.pathsep.join([str(Path(sys.executable).parent), os.environ.get("PATH", "")])
    exit_code = run_workflow(command, {**os.environ, **this_command(), "PATH": path})
    if exit_code:
        raise WorkflowError(exit_code)
    name, output = result_name(campaign), Path(output)
    results = work / "results" / "diagnosis" / name
    verdict = load_verdict(results / "verdict.json")
    copied = {file: results / file for file in _ALWAYS_MADE}
    copied |= {f"report.{kind}": work / "reports" / f"diagnosis-{name}.{kind}" for kind in ("html", "pdf")}
    output.mkdir(parents=True, exist_ok=True)
    for file, made in {"misfit.nc": bool(plan.tests), "gain.nc": verdict.gain is not None}.items():
        (output / file).unlink(missing_ok=True)  # of an earlier diagnosis
        copied |= {file: results / file} if made else {}
    for file, path in copied.items():
        shutil.copyfile(path, output / file)
    return verdict


def run_workflow(command, environment):
    """Exit code of a workflow, whose output is the progress and whose last lines are the outcome, after Ctrl-C too."""
    with subprocess.Popen(command, env=environment) as workflow:
        try:
            return workflow.wait()
        except KeyboardInterrupt:  # which the workflow got as well
            with contextlib.suppress(subprocess.TimeoutExpired):
                workflow.wait(_GRACE)
            workflow.kill()
            return INTERRUPTED


def working_place():
    """Folder of the results: the checkout or, of an installed package, the current one."""
    return Path.cwd() if HOME.is_relative_to(PACKAGE) else HOME


def diagnosis_command(campaign, effort, cores):
    """Command that starts the workflow of a campaign's diagnosis, as a list of its words.

    The folder is given in a list, because Snakemake takes the quotes off a single text.
    """
    folders = json.dumps([str(Path(campaign).resolve())], ensure_ascii=False)
    return [
        sys.executable, "-m", "snakemake", "diagnose", "--cores", str(cores),
        "--snakefile", str(HOME / "Snakefile"), "--directory", str(working_place()),
        "--configfile", str(HOME / "config" / "diagnosis.yaml"),
        "--config", f"campaigns={folders}", f"effort={effort}",
    ]  # fmt: skip
