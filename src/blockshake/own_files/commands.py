"""Commands by which own data come in: import-campaign, convert-motion, new, keys and schema."""

import json
from pathlib import Path
from textwrap import fill

from blockshake.errors import Argument, InputError
from blockshake.files import write_text

KINDS = ("structure", "study", "campaign")
_DRAFT = "https://json-schema.org/draft/2020-12/schema"


def add_data_commands(add):
    """Add the commands to the parser's, by a function of a command's name, what it runs and its help."""
    command = add(
        "convert-motion", _convert_motion, "a record or a table of another format, to the project's CSV"
    )
    command.add_argument("file", metavar="FILE", help="a record, or a table (then with --unit)")
    _add_options(command, ("--unit UNIT", "of a table: m/s2, cm/s2, g, m/s, m, mm, ...; never guessed"))
    command.add_argument(
        "--column", action="append", default=[], metavar="AXIS=COLUMN",
        help="such as x=EW, or x=-EW reversed, repeatable; of a record with several channels x=NUMBER or x=NAME; with "
        "--step y=values: all values in order",
    )  # fmt: skip
    command.add_argument(
        "--component", action="append", default=[], metavar="AXIS=FILE",
        help="another component in a file of its own and the same form, such as y=NS.AT2, or y=-NS.AT2 reversed",
    )  # fmt: skip
    _add_options(
        command, ("--step S", "between rows without times; without --column all values in order are x")
    )
    _add_layout(command)
    add_baseline(command)
    command.add_argument("--output", required=True, metavar="MOTION.csv")

    words = "measured tests in spreadsheets or CSV files, to a campaign's folder"
    command = add("import-campaign", _import_campaign, words)
    command.add_argument(
        "sources", nargs="+", metavar="MAP.yaml|FILE", help="a map, or one table a test; FILE.xlsx#SHEET"
    )
    command.add_argument("--output", required=True, metavar="DIR")
    _add_options(
        command,
        ("--structure NAME|FILE", "that was tested"),
        ("--motion NAME|FILE", "that was commanded"),
        ("--scale SCALE", "of that motion (default 1)"),
        ("--baseline auto|none|HZ", "of that motion (default auto)"),
        ("--role ROLE", "fit, select or sealed (default fit)"),
        ("--displacement-unit UNIT", "m, cm, mm or um"),
        ("--acceleration-unit UNIT", "m/s2, cm/s2 or g"),
        ("--rest S", "quiet start, whose mean displacements count from"),
    )
    command.add_argument(
        "--column", action="append", default=[], metavar="READING=COLUMN",
        help="such as block-1-face.x=LVDT3, slab-acc-x=A1 or wire-1=W1, repeatable",
    )  # fmt: skip
    command.add_argument("--fill-gaps", action="store_true", help="rows that the clock lacks become gaps")
    _add_layout(command)

    command = add("new", _new, "a commented template to start an own file from")
    command.add_argument("kind", choices=KINDS)
    command.add_argument(
        "path", metavar="PATH", help="file to write, or folder of a campaign; never overwritten"
    )

    command = add("keys", _keys, "every key of a file with its kind, unit, default and meaning")
    command.add_argument("kind", choices=(*KINDS, "import"))

    command = add("schema", _schema, "JSON schema of a file, for editors")
    command.add_argument("kind", choices=(*KINDS, "import"))
    command.add_argument("--output", metavar="SCHEMA.json", help="default: printed")


def add_baseline(command):
    """Add the option that states what is done to the baseline of a motion."""
    command.add_argument(
        "--baseline", default="auto", metavar="auto|none|HZ",
        help="auto (default) corrects a record that does not end at rest, none nothing, and a corner frequency any "
        "motion of even accelerations",
    )  # fmt: skip


def _add_options(command, *options):
    for option, words in options:
        name, value = option.split()
        command.add_argument(name, metavar=value, help=words, type=int if value == "LINE" else str)


def _add_layout(command):
    _add_options(
        command,
        ("--time COLUMN", "of the times (default time_s)"),
        ("--time-unit UNIT", "s (default), ms or min"),
        ("--separator CHARACTER", "between cells (default: as the header shows)"),
        ("--decimal SIGN", "decimal sign, . (default) or ,"),
        ("--header LINES", "of the columns' names, such as 1 (default) or 4,6,7"),
        ("--data LINE", "first one of numbers (default: below the names)"),
    )


_LAYOUT = ("separator", "decimal", "header", "data")
_MADE = Argument("options")  # that make a mapping, whose keys the command line names as options


def _given(options, names):
    """Options that were given, by name."""
    return {name: getattr(options, name) for name in names if getattr(options, name) is not None}


def pairs_of(entries, option, form):
    """Values by key of the entries ``KEY=VALUE`` of an option; ``form``: how an error shows them."""
    pairs = {}
    for entry in entries:
        key, _, value = entry.partition("=")
        if not key or not value:
            raise InputError(option, entry, f"expected {form}")
        if key in pairs:
            raise InputError(option, entry, f"expected {key} once")
        pairs[key] = value
    return pairs


def _convert_motion(options):
    from blockshake.own_files.convert_motion import convert_motion
    from blockshake.study.remarks import motion_line, motion_remarks

    columns = pairs_of(options.column, "--column", "READING=COLUMN")
    components = pairs_of(options.component, "--component", "AXIS=FILE")
    table = _given(options, ("unit", "time", "time_unit", "step")) | {"layout": _given(options, _LAYOUT)}
    motion = convert_motion(options.file, options.output, options.baseline, columns, components, **table)
    print(f"{options.output}: {motion_line(motion)}")
    for remark in motion_remarks(motion):
        print(f"  remark: {remark}")


def _import_campaign(options):
    from blockshake.own_files.import_campaign import make_campaign
    from blockshake.own_files.import_map import load_map

    given = _given(
        options, ("structure", "motion", "scale", "baseline", "role", "displacement_unit", "acceleration_unit", "rest",
                  "time", "time_unit", *_LAYOUT),
    )  # fmt: skip
    columns, where = pairs_of(options.column, "--column", "READING=COLUMN"), options.sources[0]
    if Path(where).suffix in (".yaml", ".yml"):
        more = [*given, *["column"] * bool(columns), *["fill_gaps"] * options.fill_gaps]
        if len(options.sources) > 1 or more:
            wrong = "expected the map alone; its keys say all that options say"
            raise InputError(*((Argument(more[0]), where) if more else (where, "")), wrong)
        import_map = load_map(where)
    else:
        import_map, where = _map_of_options(options, given, columns), _MADE
    print("\n".join(make_campaign(import_map, options.output, where)))
    count = len(import_map.tests)
    print(f"{options.output}: {'1 test' if count == 1 else f'{count} tests'} imported")


def _map_of_options(options, given, columns):
    """`ImportMap` of a call without a map."""
    from blockshake.files import parse_yaml
    from blockshake.own_files.import_map import ImportMap
    from blockshake.validation import validated

    for name in ("structure", "motion", "displacement_unit"):
        if name not in given:
            option = f"--{name.replace('_', '-')}"
            raise InputError(option, "", "expected, or a map MAP.yaml as the only source")
    given |= {name: parse_yaml(given[name], f"--{name}") for name in ("scale", "rest") if name in given}

    def chosen(*names):
        return {name: given[name] for name in names if name in given}

    of_all = {"scale": 1.0, "role": "fit"} | chosen("motion", "scale", "role", "baseline")
    mapping = {
        "name": Path(options.output).name,
        "layout": _given(options, _LAYOUT),
        "time": {"column": given.get("time", "time_s"), "unit": given.get("time_unit", "s")},
        "columns": columns,
        "fill_gaps": options.fill_gaps,
        "tests": [
            {"name": Path(source.replace("#", "-")).stem, "file": source, **of_all}
            for source in options.sources
        ],
        **chosen("structure", "displacement_unit", "acceleration_unit", "rest"),
    }
    return validated(ImportMap, mapping, _MADE)


def _new(options):
    from blockshake.own_files.templates import write_template

    print("\n".join(write_template(options.kind, options.path)))


def _keys(options):
    from blockshake.own_files.keys import key_rows

    for key, value, unit, default, meaning in key_rows(options.kind):
        given = "needed" if default == "needed" else f"default {default}"
        print(f"{key}: {value}{f' [{unit}]' if unit else ''}, {given}")
        print(fill(meaning, 100, initial_indent="    ", subsequent_indent="    "))


def _schema(options):
    text = json.dumps(file_schema(options.kind), indent=2)
    if options.output:
        write_text(options.output, text + "\n")
        print(options.output)
    else:
        print(text)


def file_schema(kind):
    """JSON schema of a kind of file, for editors that complete and check YAML: types, limits and meaning of every key.

    ``kind``: ``structure``, ``study``, ``campaign`` or ``import`` (the map of an import). Rules between keys, such as a
    friction for every pair of materials, are those of ``blockshake check`` alone.
    """
    from blockshake.geometry.schema import StructureFile
    from blockshake.measurement.campaigns.campaign import CampaignFile
    from blockshake.own_files.import_map import ImportMap
    from blockshake.study.config import StudyConfig

    schemas = {
        "structure": StructureFile,
        "study": StudyConfig,
        "campaign": CampaignFile,
        "import": ImportMap,
    }
    return {"$schema": _DRAFT, **schemas[kind].model_json_schema()}
