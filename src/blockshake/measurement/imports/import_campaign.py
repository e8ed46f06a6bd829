"""Spreadsheets of a laboratory to a campaign's folder, whole or not at all."""

import re
from pathlib import Path

from blockshake.dynamics.load_motion import load_motion
from blockshake.errors import InputError
from blockshake.files import replacing_folder, write_dataset, write_text
from blockshake.geometry.structure import load_structure
from blockshake.measurement.campaigns.campaign_folder import (
    motion_in_folder,
    structure_in_folder,
    write_campaign_file,
)
from blockshake.measurement.campaigns.recorded_test import checked_test
from blockshake.measurement.checks.campaign_check import campaign_lines
from blockshake.measurement.imports.posed_table import posed_table
from blockshake.measurement.imports.read_readings import read_readings


def import_campaign(asked, folder, where):
    """Make the folder of a campaign from tables.

    Parameters
    ----------
    asked : ImportMap
    folder : str or path
        That is not there yet, or empty.
    where : str
        Map that an error names.

    Returns
    -------
    list of str
        What `campaign_lines` says of the campaign.

    Raises
    ------
    InputError
        A folder with content; faults of the map, of a table, or of the readings as `read_test` and `campaign_lines`
        find them. Then nothing is left.
    """
    folder = Path(folder)
    with replacing_folder(folder) as made:
        try:
            _fill(asked, made, where)
            lines = campaign_lines(made)
        except InputError as error:
            raise InputError(error.where.replace(str(made), str(folder)), error.key, error.expected) from None
    return [line.replace(str(made), str(folder)) for line in lines]


def _fill(asked, folder, where):
    """Write all files of the campaign."""
    structure = load_structure(asked.structure)
    tests, motions = [], {}
    for test in asked.tests:
        name = re.sub(r"[^\w.-]+", "-", test.name)
        if test.motion is None:
            write_text(folder / f"{name}.csv", posed_table(test, asked, structure, where))
            tests.append({**test.model_dump(exclude={"motion", "scale"}), "file": f"{name}.csv"})
            continue
        load_motion(test.motion, test.scale, test.baseline)
        if motions.setdefault(Path(test.motion).name, test.motion) != test.motion:
            raise InputError(
                where, f"tests.{test.name}.motion", "expected motions in files of different names"
            )
        readings = checked_test(read_readings(test, asked, structure, where), structure, test.file)
        readings.attrs = {
            "Conventions": "CF-1.11",
            "title": f"measured test {test.name}",
            "source": Path(test.file).name,
        }
        write_dataset(folder / f"{name}.nc", readings)
        motion = motion_in_folder(test.motion, folder)
        tests.append({**test.model_dump(), "file": f"{name}.nc", "motion": motion})
    header = f"# imported from {', '.join(dict.fromkeys(Path(test.file).name for test in asked.tests))}\n"
    inside = structure_in_folder(asked.structure, structure, folder)
    write_campaign_file(folder, header, asked.name, inside, asked.sensors.model_dump(), tests)
