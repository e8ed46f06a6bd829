"""Campaigns and imports with mutations are read or refused in one line; nothing outside their folder is touched."""

from pathlib import Path

import pytest
import yaml
from contract import BAD_INPUT, run_command, scratch
from good_campaign import CAMPAIGN, CHANNELS, IMPORT, MARKERS, READINGS, files, netcdf, workbook
from hypothesis import given
from hypothesis import strategies as st
from mutations import FEW, MANY, mutated_bytes, mutated_datasets, mutated_mappings, mutated_texts, mutations

pytestmark = pytest.mark.slow  # a limit of CPU time, which kernels that are compiled first would break

CLASSIC = "NETCDF3_64BIT"


def _text(mapping):
    return yaml.safe_dump(mapping, allow_unicode=True)


def _safely(write):
    """Netcdf bytes of a Dataset, or none where the format itself has no place for the change."""

    def written(dataset):
        try:
            return write(dataset)
        except (TypeError, ValueError, KeyError, RuntimeError, AttributeError):
            return b""

    return written


CHANGES = {
    "list": st.builds(
        lambda text: {"campaign.yaml": text},
        st.one_of(mutated_mappings(CAMPAIGN).map(_text), mutated_texts(_text(CAMPAIGN))),
    ),
    "csv": st.one_of(
        st.builds(lambda text: {"t1.csv": text}, mutated_texts(MARKERS)),
        st.builds(lambda content: {"t1.csv": content}, mutated_bytes(MARKERS.encode())),
        st.builds(lambda text: {"t1-acc.csv": text}, mutated_texts(CHANNELS)),
    ),
    "netcdf": st.one_of(
        st.builds(lambda content: {"t2.nc": content}, mutated_datasets(READINGS).map(_safely(netcdf))),
        st.builds(lambda content: {"t2.nc": content}, mutated_bytes(netcdf(READINGS))),
    ),
    "classic netcdf": st.builds(lambda content: {"t2.nc": content}, mutated_bytes(netcdf(READINGS, CLASSIC))),
}
IMPORTS = {
    "map": st.builds(
        lambda text: {"map.yaml": text},
        st.one_of(mutated_mappings(IMPORT).map(_text), mutated_texts(_text(IMPORT))),
    ),
    "table": st.builds(lambda text: {"t1.csv": text}, mutated_texts(MARKERS)),
    "workbook": st.builds(
        lambda content: {"t1.xlsx": content, "map.yaml": _text(BY_WORKBOOK)}, mutated_bytes(workbook())
    ),
}
BY_WORKBOOK = IMPORT | {
    "columns": {"s.x": "s.x", "m.x": "m.x"},
    "tests": [{"name": "t", "file": "t1.xlsx", "motion": "m.csv", "scale": 1.0, "role": "fit"}],
}


def _filled(folder, contents):
    for name, content in contents.items():
        content = content.encode("utf-8", "surrogatepass") if isinstance(content, str) else content
        (folder / name).write_bytes(content)


def checked(changed):
    """Exit code of the check of a campaign with some files changed; the folder is left as it is."""
    with scratch() as above:
        folder = Path(above, "in it")
        folder.mkdir()
        Path(above, "secret.txt").write_text("secret")
        _filled(folder, files(**changed))
        before = sorted(Path(above).rglob("*"))
        code = run_command(["check", folder], above, [f"{above}/secret.txt", "/etc/passwd"])[0]
        assert sorted(Path(above).rglob("*")) == before
        return code


def imported(changed):
    """Exit code of an import with some files changed; it makes its folder or nothing."""
    with scratch() as above:
        folder = Path(above, "in it")
        folder.mkdir()
        Path(above, "secret.txt").write_text("secret")
        _filled(folder, files(**{"map.yaml": _text(IMPORT)}) | changed)
        before = sorted(Path(above).rglob("*"))
        code = run_command(
            ["import-campaign", folder / "map.yaml", "--output", f"{above}/out"],
            above,
            [f"{above}/secret.txt", "/etc/passwd"],
        )[0]
        made = [path for path in sorted(Path(above).rglob("*")) if path not in before]
        assert bool(made) == (code == 0)
        assert all(path.is_relative_to(Path(above, "out")) for path in made)
        return code


def test_good_campaigns_are_read():
    assert checked({}) == 0
    assert checked({"t2.nc": netcdf(READINGS, CLASSIC)}) == 0
    assert imported({}) == 0
    assert imported({"t1.xlsx": workbook(), "map.yaml": _text(BY_WORKBOOK)}) == 0


@pytest.mark.parametrize("kind", CHANGES)
@mutations(FEW)
@given(st.data())
def test_mutated_campaigns(kind, data):
    assert checked(data.draw(CHANGES[kind])) in (0, BAD_INPUT)


@pytest.mark.parametrize("kind", IMPORTS)
@mutations(FEW)
@given(st.data())
def test_mutated_imports(kind, data):
    assert imported(data.draw(IMPORTS[kind])) in (0, BAD_INPUT)


@pytest.mark.slow
@pytest.mark.parametrize("kind", CHANGES)
@mutations(MANY)
@given(st.data())
def test_many_mutated_campaigns(kind, data):
    assert checked(data.draw(CHANGES[kind])) in (0, BAD_INPUT)


@pytest.mark.slow
@pytest.mark.parametrize("kind", IMPORTS)
@mutations(MANY)
@given(st.data())
def test_many_mutated_imports(kind, data):
    assert imported(data.draw(IMPORTS[kind])) in (0, BAD_INPUT)


def test_an_encoding_that_is_none_is_refused():
    good = netcdf(READINGS.assign_attrs(x="y"), CLASSIC)
    odd = good.replace(b"utf-8", b"xtf-8")
    assert odd != good
    assert checked({"t2.nc": odd}) == BAD_INPUT
