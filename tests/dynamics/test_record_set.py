"""Motions that samples draw: every record as often as another, scaled to its level, and what is refused."""

from collections import Counter

import numpy as np
import pytest
import yaml
from made_records import write_at2

from blockshake.dynamics.intensity import motion_figures, response_spectrum
from blockshake.dynamics.load_motion import load_motion
from blockshake.dynamics.record_set import DrawnMotions, is_record_set, read_records, record_files
from blockshake.errors import InputError
from blockshake.own_files.check import check

CASE = {"baseline": "auto", "scale": 1.0}


def write_motion(path, amplitude, frequency=1.0):
    time = np.arange(0.0, 2.0, 0.01)
    values = amplitude * np.sin(2.0 * np.pi * frequency * time)
    rows = [f"{t:.2f},{a:.6f}" for t, a in zip(time, values, strict=True)]
    path.write_text("\n".join(["time_s,acceleration_x", *rows]))


@pytest.fixture
def folder(tmp_path):
    path = tmp_path / "records"
    path.mkdir()
    for place in range(3):
        write_motion(path / f"record-{place}.csv", 1.0 + place, 1.0 + 0.5 * place)
    for name in (".hidden", "record-0.csv-metadata.json", "record-1.VT2", "readme.md"):
        (path / name).write_text("no motion")
    return path


def drawn(motion, **keys):
    return DrawnMotions.of(CASE | {"motion": str(motion)} | keys)


def test_a_folder_is_a_set_and_a_motion_is_none(folder):
    assert [record.name for record in read_records(folder)] == [f"record-{place}.csv" for place in range(3)]
    assert is_record_set(folder)
    assert not is_record_set(folder / "record-0.csv")
    assert not is_record_set("alkion")
    assert [path.name for path in record_files("alkion")] == ["alkion.yaml"]


def test_first_samples_are_even_over_levels_and_records(folder):
    """For any first samples no level comes twice more than another, and none has a record twice before it has all."""
    levels = [0.5, 1.0]
    every = drawn(folder, intensity={"levels": levels})
    records = [every.draw(sample, 1) for sample in range(12)]
    for count in range(1, 13):
        at = Counter(record.level for record in records[:count])
        assert max(at.values()) - min(at[level] for level in levels) <= 1
    pairs = Counter((record.name, record.level) for record in records[:6])
    assert len(pairs) == 6
    assert set(Counter((record.name, record.level) for record in records).values()) == {2}


def test_draws_depend_on_the_seed_and_not_on_the_order_of_the_samples(folder):
    first, again = drawn(folder), drawn(folder)
    samples = range(30)
    names = [first.draw(sample, 1).name for sample in samples]
    assert names == [again.draw(sample, 1).name for sample in reversed(samples)][::-1]
    assert names != [first.draw(sample, 2).name for sample in samples]


@pytest.mark.parametrize(
    ("intensity", "measure"),
    [
        ({"measure": "pga"}, lambda motion: motion_figures(motion)["peak_acceleration"]),
        ({"measure": "pgv"}, lambda motion: motion_figures(motion)["peak_velocity"]),
        ({"measure": "sa", "period": 0.5}, lambda motion: response_spectrum(motion, [0.5])[0]),
    ],
)
def test_a_record_comes_to_its_level_times_the_scale(folder, intensity, measure):
    of = drawn(folder, intensity=intensity | {"levels": [2.0]}, scale=1.5)
    for sample in range(3):
        assert measure(of.motion(of.draw(sample, 1))) == pytest.approx(3.0, rel=1e-12)


def test_records_stay_as_they_are_without_a_level(folder):
    of = drawn(folder)
    for record in of.records:
        motion = of.motion(record)
        assert np.array_equal(motion.table.coefficients, load_motion(record.path).table.coefficients)


def test_a_table_scales_its_records_or_sets_their_levels(folder):
    table = folder.parent / "set.csv"
    table.write_text("file,scale\nrecords/record-0.csv,2.0\nalkion,0.5\n")
    of = drawn(table)
    assert motion_figures(of.motion(of.records[0]))["peak_acceleration"] == pytest.approx(2.0, rel=1e-6)
    assert record_files(table)[0] == table
    content = (
        "\ufefffile,level\nrecords/record-0.csv,2.5\nrecords/record-0.csv,5\n"  # as spreadsheets write it
    )
    table.write_text(content, encoding="utf-8")
    of = drawn(table, intensity={"measure": "pgv"})
    assert [motion_figures(one)["peak_velocity"] for one in of.strongest()] == pytest.approx([2.5, 5.0])


@pytest.mark.parametrize("separator", [";", "\t"])
def test_a_table_may_have_semicolons_or_tabs_and_decimal_commas(folder, separator):
    table = folder.parent / "set.csv"
    rows = (("file", "level"), ("records/record-0.csv", "2,5"), ("", ""), ("records/record-0.csv", "5"))
    text = "\r\n".join(map(separator.join, rows))
    table.write_bytes(text.encode("utf-8-sig"))
    assert is_record_set(table)
    assert [record.level for record in read_records(table)] == [2.5, 5.0]
    table.write_bytes(text.replace("file", '"file"').encode("utf-16"))
    assert is_record_set(table)
    assert [record.level for record in read_records(table)] == [2.5, 5.0]
    table.write_text(text + separator.join(("\nrecords/record-1.csv", "1.012")))  # thousands, or a slip
    with pytest.raises(InputError, match=r"expected one decimal sign, found '2,5' and '1\.012'"):
        read_records(table)


@pytest.mark.parametrize(
    ("content", "said"),
    [
        ("file,factor\na.csv,1\n", "factor: expected the columns file and"),
        ("file,scale,level\na.csv,1,1\n", "expected one of scale and level"),
        ("file,scale\nrecords/record-0.csv\n", "row 1: expected 2 cells, not 1"),
        ("file,scale\nrecords/record-0.csv,0\n", "row 1, scale: expected a number above 0, not '0'"),
        ("file\nrecords/record-9.csv\n", "row 1, file: expected a file below"),
        ("file\n", "expected at least one record"),
    ],
)
def test_a_wrong_table_is_refused(folder, content, said):
    table = folder.parent / "set.csv"
    table.write_text(content)
    with pytest.raises(InputError, match=said):
        read_records(table)


def test_a_level_of_the_case_beside_those_of_a_table_is_refused(folder):
    table = folder.parent / "set.csv"
    table.write_text("file,level\nrecords/record-0.csv,2.5\n")
    with pytest.raises(InputError, match=r"no level with intensity\.levels"):
        drawn(table, intensity={"levels": [1.0]})


def test_a_motion_that_is_not_along_x_has_no_level(tmp_path):
    (tmp_path / "up.csv").write_text("time_s,acceleration_z\n0,0\n1,1\n2,0\n")
    of = drawn(tmp_path / "up.csv", intensity={"levels": [1.0]})
    with pytest.raises(InputError, match="expected a motion along x"):
        of.motion(of.draw(0, 1))


def test_a_vertical_component_is_not_drawn_as_a_horizontal_one(folder):
    head = "PEER STRONG MOTION DATABASE RECORD\nImperial Valley, 10/15/79, El Centro, UP\n"
    sizes = "ACCELERATION TIME HISTORY IN UNITS OF G\nNPTS= 4, DT= .010 SEC\n"
    (folder / "up.AT2").write_text(f"{head}{sizes} 0.0 0.1 -0.1 0.0\n")
    with pytest.raises(InputError, match=r"up\.AT2: x: expected a horizontal component, found 'UP'"):
        list(drawn(folder).strongest())


def test_records_of_one_set_begin_at_one_time_whatever_their_format(folder):
    """An AT2 that does not end at rest starts behind a zero pad of 30 s; the CSV with it rests as long."""
    time = 0.01 * np.arange(1000)
    write_at2(folder / "offset.AT2", 0.5 + np.sin(2.0 * np.pi * time), 0.01)
    motions = list(drawn(folder).strongest())
    assert [one.attributes["record_start"] for one in motions] == [30.0] * 4
    for motion, record in zip(motions, read_records(folder), strict=True):
        if record.name.endswith(".csv"):
            own = load_motion(record.path)
            at = np.linspace(0.0, own.duration, 50)
            np.testing.assert_allclose(motion.evaluate(30.0 + at, 2), own.evaluate(at, 2), atol=1e-9)
            assert not motion.evaluate(np.linspace(0.0, 29.9, 50), 2).any()
    said = check(str(folder)).splitlines()
    assert [line.partition(":")[0] for line in said if "a motion of" in line] == [
        "offset.AT2", "record-0.csv", "record-1.csv", "record-2.csv",
    ]  # fmt: skip
    # without it nothing is moved
    (folder / "offset.AT2").unlink()
    for motion, record in zip(drawn(folder).strongest(), read_records(folder), strict=True):
        np.testing.assert_array_equal(motion.table.breaks, load_motion(record.path).table.breaks)


@pytest.mark.parametrize("scale", [1.0, 2.5])
def test_the_peak_that_check_prints_is_that_of_the_motion_as_used(scale, folder, tmp_path):
    """Scaled, and corrected: not that of the file."""
    time = 0.01 * np.arange(1000)
    path = write_at2(tmp_path / "offset.AT2", 0.5 + np.sin(2.0 * np.pi * time), 0.01)
    study = {
        "name": "s", "description": "d", "models": {"nscd-rigid": {"time_step": 1e-3}},
        "cases": [
            {"name": name, "structure": "configuration-1", "motion": str(motion), "scale": scale, "duration": 31.0}
            for name, motion in (("one", path), ("set", folder))
        ],
        "ensemble": {"size": 10, "seed": 1},
    }  # fmt: skip
    (tmp_path / "study.yaml").write_text(yaml.safe_dump(study))
    said = check(tmp_path / "study.yaml")
    used = motion_figures(load_motion(path, scale))["peak_acceleration"]
    assert f"one: offset.AT2, PGA as used {used:.3g} m/s2 along x" in said
    strongest = 3.0 * scale * np.sin(2.0 * np.pi * 2.0 * 0.12)  # of a sine of 2 Hz at steps of 10 ms
    assert f"set: 3 records, PGA as used {scale:.3g} to {strongest:.3g} m/s2 along x" in said
    assert abs(used / scale - 1.5) > 0.1  # m/s2, of the file
