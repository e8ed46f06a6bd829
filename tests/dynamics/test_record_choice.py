"""Records chosen to a target spectrum: mean, scatter, scales, events, components; and levels in other units."""

import numpy as np
import pytest

from blockshake.dynamics.describe_motion import describe_motions
from blockshake.dynamics.intensity import motion_figures, response_spectrum
from blockshake.dynamics.motion import ground_motion
from blockshake.dynamics.record_choice import TargetSpectrum, choose, event_of, mean_and_scatter
from blockshake.dynamics.record_set import DrawnMotions, Intensity, SetRecord, read_records, record_files
from blockshake.errors import InputError
from blockshake.study.report.motion_figure import plot_spectra

PERIODS = (0.1, 0.2, 0.5, 1.0, 2.0)
TIME = np.arange(0.0, 8.0, 0.02)
COUNT = 8


def made_up(number):
    """A motion whose frequencies and strength are its own."""
    draw = np.random.default_rng(number)
    waves = draw.normal(0.0, 1.0, (12, 1)) * np.sin(
        2.0 * np.pi * draw.uniform(0.4, 12.0, (12, 1)) * TIME + draw.uniform(0.0, 6.0, (12, 1))
    )
    return np.exp(draw.normal(0.0, 0.4)) * waves.sum(axis=0) * np.sin(np.pi * TIME / TIME[-1]) ** 2


RECORDS = [SetRecord(f"r{number}", f"r{number}", event=f"event {number // 2}") for number in range(40)]
MOTIONS = [ground_motion(f"r{number}", TIME, {"x": made_up(number)}, "acceleration") for number in range(40)]
SPECTRA = np.log([response_spectrum(motion, PERIODS) for motion in MOTIONS])
TARGET = TargetSpectrum(
    count=COUNT,
    periods=PERIODS,
    median=tuple(np.exp(SPECTRA.mean(axis=0)).tolist()),
    deviation=tuple(SPECTRA.std(axis=0, ddof=1).tolist()),
)


def misfit(mean, scatter, target=TARGET):
    return float((mean**2 + (scatter - np.array(target.deviation or 0.0)) ** 2).sum())


def chosen_motions(records):
    return [MOTIONS[int(record.name[1:])].scaled(record.scale) for record in records]


def test_the_mean_and_the_scatter_are_nearer_to_the_target_than_those_of_any_random_choice():
    chosen = choose(TARGET, RECORDS, MOTIONS, "folder")
    assert len(chosen) == COUNT
    mean, scatter = mean_and_scatter(TARGET, chosen_motions(chosen))
    assert np.abs(mean).max() < 0.1  # as is usual in practice
    assert np.abs(scatter - TARGET.deviation).max() < 0.1
    draw, best = np.random.default_rng(1), np.inf
    for _ in range(2000):
        rows = SPECTRA[draw.choice(40, COUNT, replace=False)] - np.log(TARGET.median)
        best = min(best, misfit(rows.mean(axis=0), rows.std(axis=0, ddof=1)))
    assert misfit(mean, scatter) < 0.5 * best


def test_of_an_event_there_is_one_record_and_no_scale_is_larger_than_allowed():
    chosen = choose(TARGET, RECORDS, MOTIONS, "folder")
    assert len({record.event for record in chosen}) == COUNT
    tight = TARGET.model_copy(update={"largest_scale": 1.3})
    scales = np.array([record.scale for record in choose(tight, RECORDS, MOTIONS, "folder")])
    assert (scales <= 1.3).all()
    assert (scales >= 1.0 / 1.3).all()
    with pytest.raises(InputError, match=r"folder: expected at least 8 events .* larger scale, not 7"):
        choose(TARGET, RECORDS[:14], MOTIONS[:14], "folder")


def test_without_a_deviation_the_scatter_is_the_smallest():
    narrow = TARGET.model_copy(update={"deviation": ()})
    _, without = mean_and_scatter(TARGET, chosen_motions(choose(narrow, RECORDS, MOTIONS, "f")))
    _, scatter = mean_and_scatter(TARGET, chosen_motions(choose(TARGET, RECORDS, MOTIONS, "f")))
    assert np.mean(without) < 0.7 * np.mean(scatter)


def test_a_choice_for_levels_is_one_of_shapes_alone():
    """Twice as strong records give the same choice, whatever the scale that they would need."""
    stronger = [motion.scaled(50.0) for motion in MOTIONS]
    names = [record.name for record in choose(TARGET, RECORDS, MOTIONS, "f", at_level=True)]
    assert names == [record.name for record in choose(TARGET, RECORDS, stronger, "f", at_level=True)]


@pytest.mark.parametrize(
    ("told", "event"),
    [
        (
            {"event": "Imperial Valley-06, 10/15/1979, El Centro Array #5, 140"},
            "imperial valley-06, 10/15/1979",
        ),
        ({"event": "1995/01/16 20:46:00"}, "1995/01/16 20:46:00"),
        ({"event_id": "IT-1980-0012", "event": "IRPINIA"}, "IT-1980-0012"),
        ({}, "a.csv"),
    ],
)
def test_the_event_is_what_the_header_says(told, event):
    motion = ground_motion("a", TIME, {"x": TIME}, "acceleration", told)
    assert event_of(SetRecord("a.csv", "a.csv"), motion) == event
    assert event_of(SetRecord("a.csv", "a.csv", event="mine"), motion) == "mine"


def write(path, *columns):
    names = ["time_s", *(f"acceleration_{axis}" for axis, _ in columns)]
    rows = np.column_stack([TIME, *(values for _, values in columns)])
    np.savetxt(path, rows, "%.6f", ",", header=",".join(names), comments="")


@pytest.fixture
def folder(tmp_path):
    path = tmp_path / "records"
    path.mkdir()
    for number in range(12):
        write(path / f"r{number:02}.csv", ("x", made_up(number)), ("y", made_up(number + 100)))
    return path


SPECTRUM = {
    "count": 4,
    "periods": [0.2, 0.5, 1.0],
    "median": [0.5, 0.4, 0.2],
    "unit": "g",
    "deviation": [0.3] * 3,
}


def drawn(motion, **intensity):
    return DrawnMotions.of({"motion": str(motion), "baseline": "auto", "scale": 1.0, "intensity": intensity})


def test_samples_draw_the_chosen_records_with_their_scales_and_all_components(folder):
    chosen = drawn(folder, spectrum=SPECTRUM)
    records = [chosen.draw(sample, 1) for sample in range(4)]
    assert sorted(record.name for record in records) == sorted(record.name for record in chosen.records)
    assert len(record_files(folder)) == 12
    for record in records:
        moved, own = chosen.motion(record), np.abs(made_up(int(record.name[1:3]) + 100)).max()
        peak = motion_figures(moved, "y")["peak_acceleration"]
        assert peak == pytest.approx(record.scale * own, rel=1e-4)


def test_the_picture_shows_the_target_beside_the_chosen_records(folder):
    asked = Intensity(spectrum=SPECTRUM).model_dump(mode="json")
    described = describe_motions(str(folder), "auto", asked)
    median = 9.80665 * np.array(SPECTRUM["median"])
    np.testing.assert_allclose(described["aim"].sel(bound=1), median, rtol=1e-12)
    np.testing.assert_allclose(described["aim"].sel(bound=2), median * np.exp(0.3), rtol=1e-12)
    assert described.attrs["records"] == 4
    np.testing.assert_allclose(described["chosen"].sel(bound=1), median, rtol=0.3)
    labels = plot_spectra([described]).legends[0].get_texts()
    assert {"target, median and scatter", "records chosen, median and scatter"} <= {
        one.get_text() for one in labels
    }


def test_a_table_names_events_and_files_of_other_components(folder):
    for name in ("ns", "up"):
        write(folder / f"{name}.csv", ("x", made_up(5)))
    table = folder.parent / "set.csv"
    table.write_text("file,event,y\nrecords/r00.csv,A,\nrecords/r01.csv,A,records/ns.csv\n")
    first, second = read_records(table)
    assert (first.event, first.components) == ("A", ())
    assert second.components == (("y", str(folder / "ns.csv")),)
    assert record_files(table)[-1] == folder / "ns.csv"
    table.write_text("file,y\nrecords/r00.csv,records/none.csv\n")
    with pytest.raises(InputError, match="row 1, y: expected a file below"):
        read_records(table)


@pytest.mark.parametrize(
    ("given", "levels"),
    [
        ({"levels": [0.1, 0.4], "unit": "g"}, [0.980665, 3.92266]),
        ({"levels": [50, 100], "unit": "cm/s2"}, [0.5, 1.0]),
        ({"levels": [10.0], "unit": "cm/s", "measure": "pgv"}, [0.1]),
        ({"levels": [2.0]}, [2.0]),
    ],
)
def test_levels_may_be_in_g(given, levels):
    asked = Intensity(**given)
    assert asked.levels == pytest.approx(levels)
    assert Intensity(**asked.model_dump(mode="json")) == asked


@pytest.mark.parametrize(
    ("intensity", "words"),
    [
        ({"levels": [0.1], "unit": "g", "measure": "pgv"}, "expected a unit of velocity"),
        ({"levels": [0.1], "unit": "furlong"}, "expected a unit of acceleration"),
        (
            {"spectrum": SPECTRUM | {"median": [1.0, 2.0]}},
            "expected a median, and a deviation if any, for each period",
        ),
        ({"spectrum": SPECTRUM | {"count": 1}}, "greater than or equal to 2"),
        ({"spectrum": SPECTRUM | {"largest_scale": 0.5}}, "greater than or equal to 1"),
        ({"spectrum": SPECTRUM | {"unit": "m"}}, "unit"),
    ],
)
def test_a_wrong_intensity_is_refused(intensity, words):
    with pytest.raises((InputError, ValueError), match=words):
        Intensity(**intensity)
