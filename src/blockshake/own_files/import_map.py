"""The map of an import: which column of which file is which reading, in which unit."""

from pathlib import Path
from typing import Annotated, Literal

from pydantic import BeforeValidator, Field, model_validator

from blockshake.files import load_yaml, shipped_names
from blockshake.measurement.campaigns.campaign import CommandedTest, Sensors
from blockshake.paths import file_below
from blockshake.tables.table_file import TableLayout
from blockshake.validation import Finite, NotNegative, Positive, Strict, validated


class NamedColumn(Strict):
    """A column of a file."""

    column: str = Field(description="its name in the header, or its number where there is none")
    unit: str | None = Field(None, description="by default that of all columns of its kind")


class RowTimes(Strict):
    """Times of the rows: a column, or frames at a rate."""

    column: str | None = Field(
        None,
        description="its name or number; of several of one name each reading has the last one before it; with a rate "
        "it holds frame numbers, and may be left out",
    )
    unit: str | None = Field(None, description="s by default")
    rate: Positive | None = Field(None, description="frames a second [Hz]")

    @model_validator(mode="after")
    def _known(self):
        if self.rate is not None and self.unit is not None:
            raise ValueError("expected a unit or a rate, not both")
        if self.rate is None and self.column is None:
            raise ValueError("expected a column of times, or the rate of the frames")
        return self


class Reading(NamedColumn):
    """A column of readings."""

    reversed: bool = Field(False, description="positive readings are along the negative axis")
    time: str | None = Field(None, description="column of its times, where it has one of its own")
    recorder: bool = Field(
        False,
        description="stands in the file accelerometers, though a marker: read at the times of the others, in between",
    )


def _entry(given):
    """An entry from a column's name alone."""
    return {"column": str(given)} if isinstance(given, (str, int)) else given


TimeEntry = Annotated[RowTimes, BeforeValidator(_entry, json_schema_input_type=RowTimes | str | int)]
ReadingEntry = Annotated[Reading, BeforeValidator(_entry, json_schema_input_type=Reading | str | int)]


class Recorder(Strict):
    """How the files accelerometers of the tests are written, as far as they differ from the others."""

    layout: TableLayout | None = Field(None, description="by default that of the others, as are all")
    time: TimeEntry | None = Field(None, description="as of the others")
    displacement_unit: str | None = Field(None, description="of transducers, and of markers in these files")


class ImportedTest(CommandedTest):
    """One test, as in ``campaign.yaml``; its files are those to be imported."""

    file: str = Field(description="text file or workbook, FILE#SHEET of one with several sheets")
    accelerometers: str | None = Field(
        None,
        description="the same of accelerometers and displacement transducers, where they are in another file or sheet",
    )
    accelerometers_offset: Finite = Field(
        0.0,
        description="added to the times of the file accelerometers, whose clock may have another zero [s]",
    )

    @model_validator(mode="after")
    def _offset_of_a_file(self):
        if self.accelerometers_offset and self.accelerometers is None:
            raise ValueError("accelerometers_offset: expected a file accelerometers with it")
        return self


class ImportMap(Strict):
    """The whole map."""

    name: str = Field(description="of the campaign")
    structure: str = Field(description="shipped name or file")
    sensors: Sensors = Field(Sensors(), description="standard deviations of the readings")
    layout: TableLayout = Field(TableLayout(), description="how the files are written")
    time: TimeEntry = Field(description="a column's name, or an entry; in s by default")
    accelerometers: Recorder = Field(
        Recorder(), description="how the files accelerometers are written, where otherwise"
    )
    displacement_unit: str = Field(description="m, cm, mm or um")
    acceleration_unit: str | None = Field(
        None, description="m/s2, cm/s2 or g; needed where there are channels"
    )
    rotation_unit: Literal["rad", "mrad", "deg"] = Field("rad", description="of angles of filmed bodies")
    quaternion: Literal["body-to-world", "world-to-body"] = Field(
        "body-to-world", description="what quaternions of filmed bodies turn"
    )
    columns: dict[str, ReadingEntry] = Field(
        min_length=1,
        description="by MARKER.x and the like, accelerometer channel or displacement transducer: a column's name, or "
        "an entry; of a filmed body by BODY.x and the like, BODY.angle_y, or BODY.qw to BODY.qz",
    )
    rest: NotNegative = Field(
        0.0,
        description="length of the quiet start whose mean reading displacements count from; 0: they do already [s]",
    )
    fill_gaps: bool = Field(False, description="rows that the clock lacks become gaps of all readings")
    tests: tuple[ImportedTest, ...] = Field(min_length=1)


def load_map(path):
    """`ImportMap` from a YAML file; the files that it names lie below its folder.

    Raises
    ------
    InputError
        Not YAML, an unknown or missing key, a path that leads out of the folder.
    """
    import_map = validated(ImportMap, load_yaml(path), path)
    folder = Path(path).parent

    def below(name, key, kind=None):
        if kind is not None and name in shipped_names(kind):
            return name
        file_below(folder, name.partition("#")[0], path, key)  # of a workbook; its sheet is no path
        return str(file_below(folder, name, path, key))

    tests = []
    for test in import_map.tests:
        key, accelerometers = f"tests.{test.name}", test.accelerometers
        changes = {
            "file": below(test.file, f"{key}.file"),
            "motion": None if test.motion is None else below(test.motion, f"{key}.motion", "motions"),
            "accelerometers": None
            if accelerometers is None
            else below(accelerometers, f"{key}.accelerometers"),
        }
        tests.append(test.model_copy(update=changes))
    structure = below(import_map.structure, "structure", "structures")
    return import_map.model_copy(update={"tests": tuple(tests), "structure": structure})
