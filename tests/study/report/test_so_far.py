"""The page of a study that runs: it is there after one case by one model, grows, and gives way to the report."""

import shutil

import pytest

from blockshake.study.report.so_far import write_so_far


@pytest.fixture
def running(fake, tmp_path):
    """Function that lets a case by a model be done, and the line of the page that is then written."""
    results, html = tmp_path / "results", tmp_path / "fake.html"
    shutil.copytree(fake.results / "inputs", results / "inputs")

    def finish(model, case):
        for kind in ("envelopes", "samples"):
            (results / kind / model).mkdir(parents=True, exist_ok=True)
            shutil.copy(fake.results / kind / model / f"{case}.nc", results / kind / model)
        return write_so_far(fake.study, results, html)

    return finish, html


def test_it_grows_from_one_case_by_one_model(running):
    finish, html = running
    line = finish("ls-dem", "configuration-1")
    assert line == f"report so far: {html}, with configuration-1 by LS-DEM; 7 left"
    first = html.read_text(encoding="utf-8")
    assert "Done: configuration-1 by LS-DEM. Left: 7, each a case by a model." in first
    line = finish("nscd-rigid", "configuration-4")
    assert line.endswith("with configuration-1 by LS-DEM; configuration-4 by NSCD rigid; 6 left")
    # the displacements of one more case
    assert html.read_text(encoding="utf-8").count("<svg") == first.count("<svg") + 1


def test_a_finished_report_stays(running):
    finish, html = running
    html.write_text("<html>the report</html>", encoding="utf-8")
    assert finish("ls-dem", "configuration-1") == ""
    assert html.read_text(encoding="utf-8") == "<html>the report</html>"
