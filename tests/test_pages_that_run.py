"""Pages whose commands run from top to bottom, in an empty folder."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
BLOCK = re.compile(r"^```(sh|python)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
MADE = {
    "a-study": ("wall.png", "run.png", "reports/wall.html", "reports/wall.pdf"),
    "a-measured-test": ("my-tests/campaign.yaml", "my-diagnosis/report.html", "my-diagnosis/report.pdf"),
}


def program(page):
    """Commands of a page as one shell script; Python's blocks go to the interpreter."""
    blocks = BLOCK.findall(page.read_text(encoding="utf-8"))
    assert {kind for kind, _ in blocks} == {"sh", "python"}
    return "\n".join(text if kind == "sh" else f"python - <<'END'\n{text}END" for kind, text in blocks)


@pytest.mark.parametrize("name", MADE)
def test_a_page_runs_from_top_to_bottom(name, tmp_path):
    folders = os.pathsep.join((str(Path(sys.executable).parent), os.environ["PATH"]))
    script = f"set -e\n{program(ROOT / 'docs' / 'guide' / f'{name}.md')}"
    done = subprocess.run(
        ["bash", "-c", script], cwd=tmp_path, env=os.environ | {"PATH": folders}, capture_output=True, text=True
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
    assert [path for path in MADE[name] if not (tmp_path / path).is_file()] == []
