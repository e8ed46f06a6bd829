"""A study run by the workflow in any folder: what `blockshake study` starts."""

import copy
import os
import re
import time
from collections.abc import Callable
from pathlib import Path

import yaml

from blockshake.errors import InputError
from blockshake.files import AnyPath, check_output, load_yaml, write_text
from blockshake.own_files.run_workflow import Listener, cores_of, run_workflow, workflow_command
from blockshake.pages.answer_lines import answer_lines
from blockshake.pages.wording import count_words, model_label
from blockshake.study.config import load_config
from blockshake.study.growth import grow, reached
from blockshake.working_folder import hold

_SAMPLE = re.compile(r"^(\S+) (\S+) sample (\d+), (kept|simulated): .*?(?:; took ([\d.e+]+) s)?$")
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
    done = "nothing was due" if progress.idle else f"done in {_minutes(time.monotonic() - begin)}"
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
    """Follows a workflow, and reports how far every case is and how long the rest takes.

    The time left is that of the samples that are not done, by the mean cost of the samples of the same case and model,
    else of the model per second simulated. Where a model has no sample yet, the rest takes longer than is said. Samples
    whose batch a command before has finished are done.
    """

    def __init__(self, config, cores, only, folder, say):
        super().__init__(config.name, say)
        self.cores = cores
        cases = [case for case in config.cases if only in (None, case.name)]
        self.durations = {case.name: case.duration for case in cases}
        self.wanted = {
            (case.name, model): config.samples(model, case.name) for case in cases for model in config.models
        }
        runs = folder / "results" / config.name / "runs"
        self.done = {
            (case, model): _finished(runs / model / case) & set(range(wanted))
            for (case, model), wanted in self.wanted.items()
        }
        self.costs, self.kept = {pair: [] for pair in self.wanted}, 0  # runs that the store had
        self.total, self.idle = sum(self.wanted.values()), False

    def __call__(self, line):
        super().__call__(line)
        self.idle = self.idle or line.startswith(_IDLE)
        if found := _SAMPLE.match(line):
            pair = found[1], found[2]
            if pair in self.done:
                self.kept += found[4] == "kept" and int(found[3]) not in self.done[pair]
                self.done[pair].add(int(found[3]))
                self.costs[pair] += [float(found[5])] if found[5] else []
                self._tell(pair)
        elif line.startswith(_SO_FAR):
            self.say(line)

    def count(self, done, total):
        if not self.runs_left():
            self.say(f"all runs are done; {done} of {total} jobs")

    def runs_left(self):
        return self.total - sum(map(len, self.done.values()))

    def _tell(self, pair):
        count, wanted = len(self.done[pair]), self.wanted[pair]
        if count == wanted or self.is_due():
            share = f"{self.total - self.runs_left()} of {self.total} runs"
            share += f", {self.kept} of them from the store" if self.kept else ""
            label = model_label(pair[1])
            self.say(f"{pair[0]}, {label}: {count} of {wanted} samples; {share}; {self._left()}")

    def _left(self):
        """Time that the samples left will take, in words."""
        seconds, unknown = 0.0, False
        for (case, model), count in self.wanted.items():
            left = count - len(self.done[case, model])
            if left <= 0:
                continue
            own = self.costs[case, model]
            rates = own or [
                cost * self.durations[case] / self.durations[other]
                for (other, name), costs in self.costs.items()
                if name == model
                for cost in costs
            ]
            unknown = unknown or not rates
            seconds += left * sum(rates) / max(len(rates), 1)
        if not self.runs_left():
            return "all runs are done, and the jobs after them are left"
        if seconds == 0.0:
            return "the time left is not known yet"
        words = _minutes(max(seconds / self.cores, 1.0))
        return f"{'more than' if unknown else 'about'} {words} left"


def _finished(folder):
    """Samples of the batches in a folder, whose names are such as ``010-019.nc``."""
    batches = (path.stem.split("-") for path in folder.glob("[0-9]*-*.nc"))
    return {sample for first, last in batches for sample in range(int(first), int(last) + 1)}


def _minutes(seconds):
    return f"{seconds:.0f} s" if seconds < 90.0 else f"{seconds / 60.0:.0f} min"
