"""Files of runs keep CF-1.11 where it can be checked without a table of names: names, units, missing values."""

import re

import netCDF4
import pytest

from blockshake import simulate
from blockshake.files import write_dataset

NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*")  # section 2.3


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    path = tmp_path_factory.mktemp("cf") / "run.nc"
    write_dataset(path, simulate("configuration-1", "basso-tirreno", "nscd-rigid", duration=0.2))
    with netCDF4.Dataset(path) as dataset:
        yield dataset


def test_names_are_letters_digits_and_underscores(run):
    names = [*run.ncattrs(), *run.variables, *run.dimensions]
    names += [
        name for variable in run.variables.values() for name in variable.ncattrs() if name != "_FillValue"
    ]
    assert [name for name in names if not NAME.fullmatch(name)] == []


def test_coordinates_have_no_missing_values_and_clocks_a_unit_and_words(run):
    for name in run.dimensions.keys() & run.variables.keys():
        assert "_FillValue" not in run[name].ncattrs(), name
    for name in ("time", "time_acc"):
        assert run[name].units == "s"
        assert run[name].long_name


def test_every_number_has_a_unit_and_words(run):
    for name, variable in run.variables.items():
        if name not in run.dimensions and variable.dtype != str:
            assert {"units", "long_name"} <= set(variable.ncattrs()), name
    assert run.Conventions == "CF-1.11"
