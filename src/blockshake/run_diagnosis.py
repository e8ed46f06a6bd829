"""A campaign diagnosed by the checkout's workflow: what `blockshake diagnose` and `blockshake.diagnose` start."""

import json
import os
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from blockshake.files import HOME, AnyPath, check_output
from blockshake.own_files.run_workflow import Listener, cores_of, run_workflow, workflow_command
from blockshake.pages.wording import count_words
from blockshake.working_folder import hold

if TYPE_CHECKING:
    from blockshake.diagnosis.verdict.verdict import Verdict

_ALWAYS_MADE = ("verdict.json", "decision.json", "parity.json", "evidence.nc")


def diagnose(
    campaign: AnyPath,
    output: AnyPath,
    effort: str = "standard",
    cores: int | None = None,
    say: Callable[[str], object] = print,
) -> "Verdict":
    """Show what simulations of measured tests get wrong, name the cause, extend the model and measure its skill.

    Simulates by the workflow's rules, in ``results`` of the current folder: a run that was stopped goes on where it
    was, and a second campaign of the same structure and motions finds their ensembles there. One study or diagnosis at
    a time works in a folder.

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
    say : callable
        Gets lines of progress.

    Returns
    -------
    Verdict

    Raises
    ------
    InputError
        A campaign that cannot be diagnosed, a number of cores below 1, or another command works in the current
        folder.
    WorkflowError
        A job failed: the workflow's last lines are the reason, the job and the path of its log.

    Examples
    --------
    >>> import blockshake
    >>> verdict = blockshake.diagnose("my-tests", "my-diagnosis", effort="quick", say=str)
    >>> verdict.decision in ("none", "named", "ambiguous", "combination", "unknown")
    True
    """
    from blockshake.diagnosis.nominal.plan import plan_diagnosis, result_name
    from blockshake.diagnosis.verdict.verdict import load_verdict

    cores = cores_of("diagnose", cores)
    plan = plan_diagnosis(campaign, effort)
    work = Path.cwd()
    os.close(hold(work))  # the workflow holds it again
    check_output(Path(output) / "verdict.json")
    name, output = result_name(campaign), Path(output)
    say(f"{name}: diagnosis at effort {effort}, on {count_words(cores, 'core')}, in {work}")
    run_workflow(diagnosis_command(campaign, effort, cores), Listener(name, say))
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


def diagnosis_command(campaign, effort, cores):
    """Command that starts the workflow of a campaign's diagnosis, as a list of its words.

    The folder is given in a list, because Snakemake takes the quotes off a single text.
    """
    folders = json.dumps([str(Path(campaign).resolve())], ensure_ascii=False)
    settings = ("diagnose", "--config", f"campaigns={folders}", f"effort={effort}")
    return workflow_command(cores, Path.cwd(), HOME / "config" / "diagnosis.yaml", *settings)
