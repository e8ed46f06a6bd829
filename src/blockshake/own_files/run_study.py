"""A study run by the workflow in any folder: what `blockshake study` starts."""

import copy
import os
import time
from collections.abc import Callable
from pathlib import Path

import yaml

from blockshake.errors import InputError
from blockshake.files import AnyPath, check_output, load_yaml, write_text
from blockshake.own_files.run_workflow import Listener, cores_of, run_workflow, workflow_command
from blockshake.pages.answer_lines import answer_lines
from blockshake.pages.wording import count_words, time_words
from blockshake.study.config import load_config
from blockshake.study.ensembles.batch import CALIBRATION, REPLICATE, SAMPLES
from blockshake.study.growth import grow, reached
from blockshake.study.planned_runs import LINE, planned_runs
from blockshake.working_folder import hold

_IDLE = "Nothing to be done"
_SO_FAR = "report so far: "
_FILES = ("structure", "motion")


def run_study(
    file: AnyPath,
    output: AnyPath | None = None,
    cores: int | None = None,
    case: str | None = None,
    say: Callable[[str], object] = print,
) -> list[Path]:
    """Run a study, or go on with it, and make its report.

    Parameters
    ----------
    file : str or path
        The study, YAML. Paths in it count from the current folder.
    output : str or path, optional
        Folder in which ``results``, ``reports`` and ``logs`` are made, with a copy of the study from there; the current
        folder by default.
    cores : int, optional
        All by default.
    case : str, optional
        Name of the one case that is run and reported.
    say : callable
        Gets lines of progress.

    Returns
    -------
    list of Path
        The report as HTML and PDF, and the folder of the results.

    Raises
    ------
    InputError
        A study that cannot be run, a case or a number of cores that is none, or another command works in the folder.
    WorkflowError
        A job failed: the lines before say why.

    Examples
    --------
    >>> import blockshake
    >>> report, *_ = blockshake.run_study("my-study.yaml", cores=2, say=str)
    >>> report.name
    'my-study.html'
    """
    config, cores, begin = load_config(file), cores_of("study", cores), time.monotonic()
    names = [one.name for one in config.cases]
    if case is not None and case not in names:
        raise InputError(file, "case", f"expected one of {', '.join(names)}, not '{case}'")
    folder, path = Path(output or ".").resolve(), Path(file).resolve()
    elsewhere = folder != Path.cwd()
    if elsewhere:
        path = check_output(folder / f"{config.name}.yaml")
        folder.mkdir(parents=True, exist_ok=True)
    os.close(hold(folder))  # the workflow holds it again
    if elsewhere:
        moved = yaml.safe_dump(_seen_from(folder, load_yaml(file)), sort_keys=False, allow_unicode=True)
        write_text(path, moved)
    report = folder / "reports" / "-".join(filter(None, (config.name, case)))
    target, results = f"reports/{report.name}.html" if case else "all", folder / "results"
    progress = _Progress(reached(config, results), cores, case, folder, say)
    say(
        f"{config.name}: {progress.total} runs of {', '.join(config.models)}, on {count_words(cores, 'core')}, in "
        f"{folder}"
    )
    if kept := progress.total - progress.runs_left():
        say(f"{kept} of them are there from before, and run again only where their input changed")
    if not any((folder / "results" / "kernels").glob("*")):
        say("models that are new to this machine are compiled first: half a minute to one minute each")
    grown = config.ensemble.until is None
    while not grown:
        run_workflow(workflow_command(cores, folder, path, f"results/{config.name}/responses.csv"), progress)
        words, grown = grow(config, results)
        say(f"{config.name}: {words}")
        progress = _Progress(reached(config, results), cores, case, folder, say)
    run_workflow(workflow_command(cores, folder, path, target), progress)
    shown = [report.with_suffix(".html"), report.with_suffix(".pdf"), folder / "results" / config.name]
    shown = [Path(os.path.relpath(one)) for one in shown]
    done = "nothing was due" if progress.idle else f"done in {time_words(time.monotonic() - begin)}"
    for line in answer_lines(shown[0]):
        say(line)
    say(f"{config.name}: {done}; {shown[0]}, {shown[1]}, {shown[2]}/")
    return shown


def _seen_from(folder, study):
    """The mapping of a study with paths that count from another folder than the current one."""

    def moved(name):
        return os.path.relpath(name, folder) if isinstance(name, str) and Path(name).exists() else name

    study = copy.deepcopy(study)
    study.pop("structure", None)  # cases name the file that holds it
    for case in study["cases"]:
        case |= {key: moved(case[key]) for key in _FILES}
        case.setdefault("name", Path(case["structure"]).stem)
        if case.get("measured"):
            case["measured"]["campaign"] = moved(case["measured"]["campaign"])
    named = [(study["ensemble"], key) for key in ("correlation", "table")]
    named += [(one, "file") for one in (study["ensemble"].get("distributions") or {}).values()]
    for mapping, key in named:
        if mapping.get(key):
            mapping[key] = moved(mapping[key])
    if (study.get("diagnosis") or {}).get("campaigns"):
        study["diagnosis"]["campaigns"] = list(map(moved, study["diagnosis"]["campaigns"]))
    return study


class _Progress(Listener):
    """Follows a workflow, and reports how far every part of the study is and how long the runs left take.

    Parts and runs are those that `blockshake estimate` lists. The time left is that of the runs that are not done, by
    the mean cost of those of the same part, else of the model per second simulated. Where a model has no run yet, the
    rest takes longer than is said. Runs whose file a command before has finished are done.
    """

    def __init__(self, config, cores, only, folder, say):
        super().__init__(config.name, say)
        self.cores = cores
        cases = [case for case in config.cases if only in (None, case.name)]
        planned = [
            one for case in cases for model in config.models for one in planned_runs(config, model, case)
        ]
        # no report of a case alone has the calibration, which is one of all
        self.parts = {one.name: one for one in planned if only is None or one.part != CALIBRATION}
        results = folder / "results" / config.name
        self.done = {name: _finished(results, part) & set(part.lines) for name, part in self.parts.items()}
        durations = {case.name: case.duration for case in cases}
        # seconds of motion behind a line
        self.simulated = {
            name: part.motions * durations[part.case] / len(part.lines) for name, part in self.parts.items()
        }
        self.costs, self.kept = {name: [] for name in self.parts}, 0  # runs that the store had
        self.total, self.idle = sum(part.count for part in self.parts.values()), False

    def __call__(self, line):
        super().__call__(line)
        self.idle = self.idle or line.startswith(_IDLE)
        if (found := LINE.match(line)) and found[1] in self.parts:
            name = found[1]
            self.kept += found[3].startswith("kept") and found[2] not in self.done[name]
            self.done[name].add(found[2])
            self.costs[name] += [float(found[4])] if found[4] else []
            self._tell(name)
        elif line.startswith(_SO_FAR):
            self.say(line)

    def count(self, done, total):
        if not self.runs_left():
            self.say(f"all runs are done; {done} of {total} jobs")

    def runs_left(self):
        return self.total - sum(
            part.count * len(self.done[name]) // len(part.lines) for name, part in self.parts.items()
        )

    def _tell(self, name):
        count, wanted = len(self.done[name]), len(self.parts[name].lines)
        if count == wanted or self.is_due():
            share = f"{self.total - self.runs_left()} of {self.total} runs"
            share += f", {self.kept} of them from the store" if self.kept else ""
            self.say(f"{name}: {count} of {wanted}; {share}; {self._left()}")

    def _left(self):
        """Time that the runs left will take, in words."""
        seconds, unknown = 0.0, False
        for name, part in self.parts.items():
            left = len(part.lines) - len(self.done[name])
            if not left:
                continue
            rates = self.costs[name] or [
                cost * self.simulated[name] / self.simulated[other]
                for other, costs in self.costs.items()
                if self.parts[other].model == part.model
                for cost in costs
            ]
            unknown = unknown or not rates
            seconds += left * sum(rates) / max(len(rates), 1)
        if not self.runs_left():
            return "all runs are done, and the jobs after them are left"
        if seconds == 0.0:
            return "the time of the runs left is not known yet"
        words = time_words(seconds / self.cores)
        return f"{'more than' if unknown else 'about'} {words} for the runs left"


def _finished(results, part):
    """Lines of the runs of a `PlannedRuns` whose files are in the folder of a study's results."""
    runs = results / "runs" / part.model / part.case
    whole = {
        REPLICATE: runs / "half-step.nc",
        CALIBRATION: results / "open-tests" / part.model / f"{part.case}.nc",
    }
    if part.part in whole:
        return set(part.lines) if whole[part.part].exists() else set()
    batches = (runs if part.part == SAMPLES else results / "climbs" / part.case).glob("[0-9]*-*.nc")
    ends = (path.stem.split("-") for path in batches)
    return {f"sample {number}" for first, last in ends for number in range(int(first), int(last) + 1)}
