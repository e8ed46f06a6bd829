"""The command line: exit 0 done, 2 bad input (one line), 3 numerical failure, 130 interrupted, 141 unread, 1 a bug."""

import argparse
import errno
import logging
import os
import select
import sys
import time
from pathlib import Path

from blockshake import __version__
from blockshake.errors import BAD_INPUT, INTERRUPTED, Argument, InputError
from blockshake.files import check_output, parse_yaml, write_json
from blockshake.own_files.commands import add_baseline, add_data_commands, pairs_of
from blockshake.own_files.run_workflow import WorkflowError
from blockshake.simulation.models import MODELS

NUMERICAL_FAILURE = 3
_IN_A_FOLDER = (
    "Works in results, reports and logs of the current folder{}, alone: a second study or diagnosis there states it "
    "and "
    "ends, one in another folder runs with it. What was stopped goes on where it was."
)
# of arguments that have another name
_OPTIONS = {
    "parameters": "--set",
    "channels": "--column",
    "columns": "--column",
    "components": "--component",
    "options": "options",
}
UNREAD = 141  # whoever reads the output has gone, as after `blockshake parameters | head -1`


class _Once(argparse.Action):
    """An option that stands once: of two values the last would win without a word."""

    stands = False

    def __call__(self, parser, options, values, option=None):
        if option and self.stands:
            parser.error(f"expected {option} once")
        self.stands = True
        setattr(options, self.dest, values)


class _Parser(argparse.ArgumentParser):
    """Argument errors as one line and exit 2, like all bad input; numbers without Python's ``1_000``."""

    def __init__(self, *arguments, **named):
        super().__init__(*arguments, **named)
        self.register("action", None, _Once)
        for kind in (float, int):
            self.register("type", kind, lambda text, kind=kind: kind(text.replace("_", "no digit")))

    def error(self, message):
        raise InputError("arguments" if self.prog == "blockshake" else self.prog, "", message)


def main(arguments=None):
    """Run one command; the exit code is returned."""
    if hasattr(sys.stdout, "reconfigure"):  # a terminal that knows few signs gets the others as escapes
        sys.stdout.reconfigure(errors="backslashreplace")
    try:
        try:
            return _run(arguments)
        finally:
            print(end="", flush=True)
    except OSError as error:  # of the output; errors of files are caught where they are written
        unread = not (_is_read(1) and _is_read(2))
        if not unread and error.errno != errno.ENOSPC:
            raise
        if not unread:
            print("blockshake: output: expected room to write to; the disk is full", file=sys.stderr)
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
        return UNREAD if unread else BAD_INPUT


def _run(arguments):
    try:
        options = _parser().parse_args(arguments)
        return options.run(options) or 0
    except InputError as error:
        print(f"blockshake: {_with_option(error)}", file=sys.stderr)
        return BAD_INPUT
    except WorkflowError as stopped:
        return stopped.exit_code
    except KeyboardInterrupt as interrupt:
        print(f"blockshake: {str(interrupt) or 'interrupted'}", file=sys.stderr)
        return INTERRUPTED


def _with_option(error):
    """An error, which names a command's option where the function's names an argument, or a key that options make."""
    if not isinstance(error.where, Argument):
        return error
    name, key = error.where, error.key
    if name in ("options", "layout") and key:
        name, _, key = key.partition(".")
        inner = {
            "layout": key,
            "tests": key.rpartition(".")[2],
            "time": "time_unit" if key == "unit" else "time",
        }
        name, key = inner.get(name, name), key if name == "columns" else ""
    return InputError(_OPTIONS.get(name, f"--{name.replace('_', '-')}"), key, error.expected)


def _is_read(stream):
    """Whether a pipe of this process has a reader, or is none."""
    state = select.poll()
    state.register(stream, select.POLLOUT)
    return not any(event & select.POLLERR for _, event in state.poll(0))


def _parser():
    parser = _Parser(prog="blockshake", description="Stacked blocks on a shake table.")
    parser.add_argument("--version", action="version", version=f"blockshake {__version__}")
    commands = parser.add_subparsers(title="commands", required=True, metavar="COMMAND", parser_class=_Parser)

    def add(name, run, words, more=None):
        command = commands.add_parser(name, help=words, description=more)
        command.set_defaults(run=run)
        return command

    steps = ", ".join(f"{model.time_step:g} for {name}" for name, model in MODELS.items())
    command = add("simulate", _simulate, "one structure under one motion, to a run file")
    command.add_argument("--structure", required=True, metavar="NAME|FILE")
    command.add_argument("--motion", required=True, metavar="NAME|FILE")
    command.add_argument("--scale", type=float, default=1.0, help="multiplies the motion (default 1)")
    add_baseline(command)
    command.add_argument(
        "--duration", type=float, metavar="S", help="cuts or extends (default: the motion's)"
    )
    command.add_argument(
        "--model",
        dest="models",
        action="append",
        required=True,
        help=f"{' or '.join(MODELS)}; repeatable: RUN-MODEL.nc of each",
    )
    _add_settings(command)
    command.add_argument("--time-step", type=float, metavar="S", help=f"default {steps}")
    command.add_argument("--output-rate", type=float, metavar="HZ", help="default: the optical system's")
    command.add_argument("--output", required=True, metavar="RUN.nc")

    command = add("plot", _plot, "drift, joint forces, uplift and energy of a run, as a picture")
    _add_run(command)
    command.add_argument("--output", metavar="FILE", help=".png, .pdf or .svg (default RUN.png)")

    command = add("animate", _animate, "the blocks of a run in motion, as GIF or MP4")
    _add_run(command)
    command.add_argument("--output", metavar="FILE", help=".gif, or .mp4 with ffmpeg (default RUN.gif)")
    command.add_argument("--view", default="front", metavar="front|side|3d", help="default front")
    command.add_argument(
        "--magnification",
        type=float,
        default=1.0,
        metavar="N",
        help="of the motion against the base (default 1)",
    )
    command.add_argument(
        "--speed", type=float, default=1.0, metavar="N", help="1 is real time (default), 0.1 ten times slower"
    )

    words = "a run as CSV tables, for ParaView, or as glTF with motion; a finished study as a research object"
    command = add("export", _export, words)
    _add_run(command, "|STUDY.yaml")
    command.add_argument(
        "--ro-crate",
        action="store_true",
        help="of a study whose results are in the current folder: a Workflow Run RO-Crate, with all files and digests",
    )
    command.add_argument(
        "--output", required=True, metavar="FILE|DIR", help=".csv, .vtkhdf or .glb: the suffix is the format"
    )

    command = add("sample", _sample, "a Latin hypercube of Table 2, to a CSV")
    command.add_argument("--size", type=int, default=50)
    command.add_argument("--seed", type=int, default=1)
    command.add_argument(
        "--correlation", metavar="FILE", help="square CSV, names in the header and first column"
    )
    command.add_argument("--output", required=True, metavar="DESIGN.csv")

    command = add("calibrate-stiffness", _calibrate_stiffness, "contact stiffness from wave speed, to a JSON")
    command.add_argument("--structure", required=True, metavar="NAME|FILE", help="whose blocks are tested")
    _add_settings(command)
    command.add_argument("--output", required=True, metavar="STIFFNESS.json")

    add_data_commands(add)

    command = add(
        "generate-campaign", _generate_campaign, "synthetic tests on a virtual shake table, to a folder"
    )
    command.add_argument("settings", metavar="SETTINGS.yaml", help="such as config/virtual-campaign.yaml")
    command.add_argument("--structure", required=True, metavar="NAME|FILE")
    command.add_argument("--output", required=True, metavar="DIR", help="of the campaign")
    command.add_argument(
        "--truth", required=True, metavar="DIR", help="of what is true, outside the campaign"
    )

    command = add(
        "study",
        _study,
        "samples, envelopes and the report of a study; goes on where it was stopped",
        _IN_A_FOLDER.format(" or of that of --output"),
    )
    command.add_argument("file", metavar="STUDY.yaml", help="`blockshake new study` writes one")
    command.add_argument(
        "--output", metavar="DIR", help="of results, reports and logs (default: the current folder)"
    )
    command.add_argument("--case", metavar="NAME", help="one case of the study, with a report of its own")
    command.add_argument("--cores", type=int, metavar="N", help="default: all")

    command = add(
        "diagnose",
        _diagnose,
        "what simulations of measured tests get wrong, the cause, and what naming it gains",
        _IN_A_FOLDER.format(""),
    )
    command.add_argument("campaign", metavar="CAMPAIGN_DIR")
    command.add_argument("--output", required=True, metavar="DIR", help="of the verdict and the report")
    command.add_argument("--effort", default="standard", metavar="quick|standard|deep")
    command.add_argument("--cores", type=int, metavar="N", help="default: all")

    command = add(
        "plan-campaign",
        _plan_campaign,
        "which causes motions and sensors would tell apart, and what one test more adds",
    )
    command.add_argument("structure", metavar="STRUCTURE")
    command.add_argument(
        "--motions",
        nargs="+",
        required=True,
        metavar="NAME|FILE[@SCALE]",
        help="a test each, such as alkion@2.5",
    )
    command.add_argument("--sensors", metavar="SENSORS.yaml", help="default: those of the structure file")
    command.add_argument("--duration", type=float, metavar="S", help="of every test (default: its motion's)")
    command.add_argument("--output", required=True, metavar="DIR", help="of plan.json and plan.html")

    command = add("extend-study", _extend_study, "a study in which the cause of a verdict is a variable")
    command.add_argument("verdict", metavar="VERDICT.json", help="of `blockshake diagnose`")
    command.add_argument("study", metavar="STUDY.yaml", help="an ordinary study of what was tested")
    command.add_argument("--output", required=True, metavar="EXTENDED.yaml")

    command = add("check", _check, "say what is wrong with structure, motion or study files")
    command.add_argument("files", nargs="+", metavar="FILE")
    command.add_argument("--picture", metavar="PICTURE", help="of one structure: .png, .pdf or .svg")
    add_baseline(command)

    command = add(
        "estimate", _estimate, "how long a study or a diagnosis takes here, by trying its simulations"
    )
    command.add_argument("file", metavar="STUDY.yaml|CAMPAIGN")
    command.add_argument("--cores", type=int, default=os.cpu_count())
    command.add_argument(
        "--effort", default="standard", metavar="quick|standard|deep", help="of a campaign's diagnosis"
    )

    command = add("parameters", _parameters, "every parameter with unit, default and source")
    command.add_argument(
        "--structure", metavar="NAME|FILE", help="whose names to list (default configuration-1)"
    )
    return parser


def _add_settings(command):
    command.add_argument(
        "--set", dest="settings", action="append", default=[], metavar="KEY=VALUE",
        help="a parameter by dotted name, repeatable; `blockshake parameters` lists them",
    )  # fmt: skip


def _add_run(command, more=""):
    command.add_argument("file", metavar=f"RUN.nc{more}", help="from `blockshake simulate`")
    command.add_argument(
        "--meshes", metavar="DIR", help="of the structure's mesh files (default: the run file's folder)"
    )


def _settings(options):
    given = pairs_of(options.settings, "--set", "KEY=VALUE")
    return {key: parse_yaml(value, f"--set {key}") for key, value in given.items()}


def _simulate(options):
    check_output(options.output)
    if Path(options.output).suffix != ".nc":
        raise InputError("--output", options.output, "expected a netCDF file, RUN.nc")
    import xarray as xr

    from blockshake.dynamics.load_motion import load_motion, provenance
    from blockshake.dynamics.system import FINISHED
    from blockshake.geometry.structure import load_structure
    from blockshake.simulation.ending import ending
    from blockshake.simulation.models import model_of, part_parameters
    from blockshake.simulation.simulate import simulate_to_file
    from blockshake.study.remarks import motion_remarks, unused_settings, unusual_values

    _show_progress()
    structure, settings = load_structure(options.structure), _settings(options)
    path, models = Path(options.output), {one: model_of(one) for one in options.models}
    outputs = {one: path.with_stem(f"{path.stem}-{one}") for one in models}
    if len(models) == 1:
        outputs = dict.fromkeys(models, options.output)
    log = logging.getLogger("blockshake")
    changed = structure.with_parameters(part_parameters(settings)[0])
    for remark in [*unusual_values(changed), *unused_settings(settings, models)]:
        log.info("remark: %s", remark)
    motion = load_motion(options.motion, options.scale, options.baseline)
    for remark in motion_remarks(motion):
        log.info("remark: %s", remark)
    if not motion.attributes["synthetic"]:
        log.info("%s", provenance(motion.attributes))
    code = 0
    for model, output in outputs.items():
        begin = time.monotonic()
        if Path(output).exists():
            log.info("%s is there and will be replaced", output)
        simulate_to_file(
            output,
            structure,
            motion,
            model,
            settings,
            options.time_step,
            options.duration,
            options.output_rate,
        )
        with xr.open_dataset(output, decode_times=False) as run:
            (answer, *lines), status, reason = (
                ending(run, structure),
                run.attrs["status"],
                run.attrs["reason"],
            )
        took = f"computed in {time.monotonic() - begin:.3g} s"
        print(f"{output}: {answer}; {took}", *lines, sep="\n  ", flush=True)
        if status not in FINISHED:
            print(f"blockshake: {status}: {reason}", file=sys.stderr)
            code = NUMERICAL_FAILURE
    return code


def _show_progress():
    logging.basicConfig(format="blockshake: %(message)s")
    logging.getLogger("blockshake").setLevel(logging.INFO)


def _plot(options):
    from blockshake.views.figure import plot

    output = options.output or Path(options.file).with_suffix(".png")
    plot(options.file, output, options.meshes)
    print(output)


def _animate(options):
    from blockshake.views.animation import animate

    _show_progress()
    output = options.output or Path(options.file).with_suffix(".gif")
    given = options.view, options.magnification, options.speed, options.meshes
    print(animate(options.file, output, *given))


def _export(options):
    if options.ro_crate:
        from blockshake.own_files.study_crate import export_study

        if options.meshes:
            raise InputError("--meshes", options.meshes, "expected a run, not `--ro-crate` of a study")
        print(export_study(options.file, options.output))
        return
    from blockshake.views.export import export

    _show_progress()
    print(*export(options.file, options.output, options.meshes), sep="\n")


def _sample(options):
    check_output(options.output)
    from blockshake.study.sampling.latin_hypercube import draw_samples
    from blockshake.study.sampling.sample_table import write_design

    design = draw_samples(options.size, options.seed, correlation=options.correlation)
    write_design(options.output, design.values)
    print(f"{options.output}: {len(design.values)} samples; rms correlation error {design.rms_error:.2e}")


def _calibrate_stiffness(options):
    check_output(options.output)
    from blockshake.study.stiffness.wave_speed import calibrate_stiffness

    calibrated = calibrate_stiffness(options.structure, _settings(options))
    write_json(options.output, calibrated)
    stiffness = ", ".join(f"{kind} {calibrated[f'{kind}_stiffness']:.3g}" for kind in ("normal", "shear"))
    print(f"{options.output}: stiffness {stiffness} N/m3")


def _generate_campaign(options):
    from blockshake.sources import module_sources, source_digest
    from blockshake.virtual.generate import generate_campaign
    from blockshake.virtual.settings import load_settings

    settings = load_settings(options.settings, options.structure)
    for folder in (options.output, options.truth):
        check_output(f"{folder}/campaign.yaml")
    if Path(options.truth).resolve().is_relative_to(Path(options.output).resolve()):
        raise InputError("--truth", options.truth, "expected a folder outside the campaign's")
    source = source_digest(*module_sources("virtual/generate.py", *MODELS))
    generate_campaign(settings, options.structure, options.output, options.truth, source, print)
    print(f"{options.output}: a synthetic campaign; its truth: {options.truth}")


def _study(options):
    from blockshake.own_files.check import check
    from blockshake.own_files.run_study import run_study

    _say(f"{options.file}: {check(options.file)}")
    run_study(options.file, options.output, options.cores, options.case, _say)


def _say(line):
    print(line, flush=True)


def _diagnose(options):
    from blockshake.pages.answer_lines import answer_lines
    from blockshake.run_diagnosis import diagnose

    diagnose(options.campaign, options.output, options.effort, options.cores, _say)
    report = f"{options.output}/report.html"
    print(*answer_lines(report), report, sep="\n")


def _plan_campaign(options):
    from blockshake.diagnosis.planning.page import addition_rows, matrix_rows
    from blockshake.diagnosis.planning.plan_campaign import plan_campaign

    _show_progress()
    plan = plan_campaign(
        options.structure, options.motions, options.output, options.sensors, options.duration
    )
    for rows in (matrix_rows(plan.effects), [("",)], addition_rows(plan.additions)):
        _print_table(rows)
    print(f"{options.output}/plan.html")


def _extend_study(options):
    from blockshake.diagnosis.gain.extended_study import extend_study

    print("\n".join(extend_study(options.verdict, options.study, options.output)))


def _check(options):
    from blockshake.own_files.check import check

    if options.picture:
        _draw_structure(options.files, options.picture)
    wrong = 0
    for file in options.files:
        try:
            print(f"{file}: {check(file, options.baseline)}", flush=True)
        except InputError as error:
            print(f"blockshake: {error}", file=sys.stderr)
            wrong += 1
    if wrong and len(options.files) > 1:
        verb = "is" if wrong == 1 else "are"
        print(f"blockshake: {wrong} of {len(options.files)} files {verb} wrong", file=sys.stderr)
    return BAD_INPUT if wrong else 0


def _draw_structure(files, picture):
    from blockshake.geometry.structure import load_structure
    from blockshake.pages.drawing import check_picture, save_picture
    from blockshake.pages.scene.structure_picture import plot_understood

    check_picture(picture)
    if len(files) != 1:
        raise InputError("--picture", "", f"expected one structure, not {len(files)} files")
    save_picture(picture, plot_understood, load_structure(files[0]))


def _estimate(options):
    from blockshake.cost.diagnosis_cost import campaign_cost
    from blockshake.cost.study_cost import study_cost
    from blockshake.pages.wording import count_words, time_words

    if options.cores < 1:
        raise InputError("--cores", "", f"expected a whole number from 1, not {options.cores}")
    if Path(options.file).is_dir():
        parts = campaign_cost(options.file, options.effort)
    else:
        parts = study_cost(options.file)
    rows = [(part.name, str(part.count), time_words(part.seconds)) for part in parts]
    _print_table([("part", "runs", "CPU time"), *rows])
    seconds = sum(part.seconds for part in parts)
    print(
        f"{options.file}: about {time_words(seconds)} of CPU time on this machine, "
        f"{time_words(seconds / options.cores)} on {count_words(options.cores, 'core')}, if nothing of it is made yet"
    )


def _parameters(options):
    from blockshake.simulation.parameter_table import parameter_table

    rows = [("name", "unit", "default", "meaning", "source"), *parameter_table(options.structure)]
    _print_table(rows)


def _print_table(rows):
    """Print rows of text in columns."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    for row in rows:
        print("  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip())
