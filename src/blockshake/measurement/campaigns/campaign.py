"""Campaigns of measured tests: the list of tests and their marker readings."""

from dataclasses import dataclass
from os.path import isfile  # false, not an error, for a name that no file can have
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, Field, model_validator

from blockshake.dynamics.baseline import AUTO, Baseline
from blockshake.errors import InputError
from blockshake.files import AnyPath, load_yaml, shipped_names
from blockshake.geometry.structure import load_structure
from blockshake.measurement.campaigns.clocks import from_command, on_one_clock
from blockshake.measurement.campaigns.commanded_motion import commanded_motion
from blockshake.measurement.campaigns.kinds import CampaignKind, kind_of
from blockshake.measurement.campaigns.recorded_test import read_test
from blockshake.measurement.sensors.instruments import Sensors
from blockshake.paths import check_plain, file_below
from blockshake.tables.numbers import plain_number
from blockshake.tables.shown import Shown
from blockshake.tables.table_file import csv_records
from blockshake.validation import Finite, Strict, validated


def _not_zero(value):
    if value == 0.0:
        raise ValueError("expected a number other than 0")
    return value


Scale = Annotated[Finite, AfterValidator(_not_zero)]


def _no_default(schema: dict[str, Any]) -> None:
    """Take the default out of a key's schema: it holds without a motion, where nothing reads the key."""
    schema.pop("default")


class CommandedTest(Strict):
    """The command of one test, and the use that may be made of it."""

    name: str = Field(description="unique in the campaign")
    motion: str | None = Field(
        None,
        description="commanded motion: a shipped name, or a file in the folder; none of a body that is filmed over a "
        "ground at rest",
    )
    scale: Scale = Field(
        1.0,
        description="multiplies the motion; needed where there is one; not 0 [1]",
        json_schema_extra=_no_default,
    )
    baseline: Baseline = AUTO
    role: Literal["fit", "select", "sealed"] = Field(
        description="what the test may be used for: to fit, to choose between models, or to judge a frozen one"
    )

    @model_validator(mode="after")
    def _scaled(self):
        if self.motion is not None and "scale" not in self.model_fields_set:
            raise ValueError("missing key: scale of the motion")
        return self


class MeasuredTest(CommandedTest):
    """One test of the list, and where it was recorded or how it ended."""

    file: str | None = Field(
        None, description="readings: a CSV or netCDF file in the folder; needed but with an outcome"
    )
    outcome: Literal["fell", "stood"] | None = Field(
        None, description="all that is known of a test without readings: whether the body fell"
    )

    @model_validator(mode="after")
    def _known(self):
        if (self.file is None) == (self.outcome is None):
            raise ValueError("expected either file, with readings, or outcome")
        if self.outcome is not None and self.motion is None:
            raise ValueError("missing key: motion, of a test with an outcome")
        return self


class CampaignFile(Strict):
    """The file ``campaign.yaml``."""

    name: str = Field(description="of the campaign, for reports")
    structure: str = Field(description="shipped name, or a file in the folder")
    sensors: Sensors = Sensors()
    tests: Annotated[tuple[MeasuredTest, ...], Field(min_length=1)] = Field(
        description="the list, or a CSV table in the folder with these keys as its columns"
    )


@dataclass(frozen=True, repr=False)
class Campaign(Shown):
    """A checked campaign."""

    folder: Path
    # name, structure: ``structure`` is a shipped name or the path of a file
    name: str
    structure: str
    sensors: Sensors
    tests: dict[str, MeasuredTest]  # by name
    table: Path | None = None  # the CSV table that lists them, where one does

    def _words(self):
        return f"{self.name}: {self.counted} of {self.structure}"

    def _rows(self):
        keys = ("name", "motion", "scale", "role", "file", "outcome")
        return [keys, *([getattr(test, key) or "" for key in keys] for test in self.tests.values())]

    @property
    def kind(self) -> CampaignKind:
        """Base motion, no base motion, or outcomes alone: how the campaign is checked and diagnosed."""
        return kind_of(self.tests.values())

    @property
    def counted(self) -> str:
        """Number of tests in words."""
        return "1 test" if len(self.tests) == 1 else f"{len(self.tests)} tests"

    @property
    def open(self) -> dict[str, MeasuredTest]:
        """Tests that are not sealed, by name."""
        return {name: test for name, test in self.tests.items() if test.role != "sealed"}

    @property
    def sealed(self) -> dict[str, MeasuredTest]:
        """Sealed tests, by name."""
        return {name: test for name, test in self.tests.items() if test.role == "sealed"}


def load_campaign(folder: AnyPath) -> Campaign:
    """Campaign of a folder, its test files found but not yet read.

    Parameters
    ----------
    folder : str or path
        With a ``campaign.yaml``.

    Returns
    -------
    Campaign

    Raises
    ------
    InputError
        Missing folder or file, unknown key, a test named twice, a file outside of the folder, a path with braces.

    Examples
    --------
    >>> import blockshake
    >>> campaign = blockshake.load_campaign("my-tests")
    >>> [name for name, test in campaign.tests.items() if test.role == "sealed"]
    ['alkion-275', 'basso-tirreno-275']
    """
    folder = Path(folder)
    path = folder / "campaign.yaml"
    mapping, table = load_yaml(path), None
    if isinstance(mapping.get("tests"), str):
        table = file_below(folder, mapping["tests"], path, "tests")
        mapping["tests"] = _listed(folder, mapping["tests"], path)
    file = validated(CampaignFile, mapping, path)
    tests = {test.name: test for test in file.tests}
    if len(tests) < len(file.tests):
        raise InputError(path, "tests", "expected every test's name once")
    check_plain(folder, path, "")
    moved = [test.name for test in file.tests if test.motion is not None]
    if moved and len(moved) < len(tests):
        still = next(name for name in tests if name not in moved)
        raise InputError(path, f"tests.{still}.motion", f"missing key; {moved[0]} has one")
    known = [test.name for test in file.tests if test.outcome is None]
    if known and len(known) < len(tests):
        other = next(name for name in tests if name not in known)
        raise InputError(path, f"tests.{other}.file", f"missing key; {known[0]} has one")
    for test in file.tests:
        for key in ("file", "motion"):
            if getattr(test, key) is not None:
                check_plain(getattr(test, key), path, f"tests.{test.name}.{key}")
        if known and not isfile(file_below(folder, test.file, path, f"tests.{test.name}.file")):
            wrong = f"expected a file in {folder}; it has no {test.file}"
            raise InputError(path, f"tests.{test.name}.file", wrong)
        if moved:
            file_below(folder, test.motion, path, f"tests.{test.name}.motion")
    check_plain(file.structure, path, "structure")
    structure = file_below(folder, file.structure, path, "structure")
    if not isfile(structure) and file.structure not in shipped_names("structures"):
        shipped = ", ".join(shipped_names("structures"))
        raise InputError(path, "structure", f"expected a file in {folder} or one of {shipped}")
    return Campaign(
        folder,
        file.name,
        str(structure) if isfile(structure) else file.structure,
        file.sensors,
        tests,
        table,
    )


def _listed(folder, name, path):
    """Tests of a CSV table, a mapping each; empty cells are left out."""
    check_plain(name, path, "tests")
    if not isfile(folder / name):
        raise InputError(path, "tests", f"expected a list, or a CSV table in {folder}; it has no {name}")
    rows = csv_records(folder / name)
    missing = [key for key in ("name", "role") if rows and key not in rows[0]]
    if missing or not rows:
        wrong = f"has no {' and no '.join(missing)}" if missing else "has no row"
        wrong = f"expected a row a test and the columns name and role; the table {wrong}"
        raise InputError(folder / name, "", wrong)
    return [
        {
            key: float(cell) if key == "scale" and plain_number(cell) else cell
            for key, cell in row.items()
            if cell
        }
        for row in rows
    ]


def load_test(campaign, name, structure=None):
    """Readings of one test, checked against the campaign's structure as by `read_test`, times as of `from_command`.

    ``structure`` is the campaign's, where it is loaded already.
    """
    entry, structure = campaign.tests[name], load_structure(structure or campaign.structure)
    if entry.file is None:
        raise InputError(campaign.folder / "campaign.yaml", f"tests.{name}.file", "missing key: readings")
    test = on_one_clock(read_test(campaign.folder / entry.file, structure), structure)
    return from_command(test, structure, commanded_motion(campaign, entry))
