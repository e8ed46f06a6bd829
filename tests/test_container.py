"""The container: it takes what an installation takes, and can be built where there is a Docker daemon."""

import re
import shutil
import subprocess
import tomllib

import pytest
from test_wheel import COPIED

from blockshake.files import PACKAGE

ROOT = PACKAGE.parents[1]
LINES = (ROOT / "Dockerfile").read_text(encoding="utf-8").splitlines()


def test_the_container_copies_what_an_installation_takes():
    copied = {name for line in LINES if line.startswith("COPY ") for name in line.split()[1:-1]}
    assert copied == {*COPIED, "requirements.lock"}
    ignored = (ROOT / ".dockerignore").read_text(encoding="utf-8").splitlines()
    assert ignored[0] == "*"
    assert {line[1:] for line in ignored if line.startswith("!")} == copied


def test_the_container_has_a_python_that_the_lock_holds_for():
    (version,) = re.findall(r"^FROM python:(3\.\d+)-slim$", "\n".join(LINES), flags=re.MULTILINE)
    least = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["requires-python"]
    assert int(least.removeprefix(">=3.")) <= int(version.removeprefix("3.")) <= 13  # the Makefile's `lock`


def test_the_container_is_built_and_runs():
    docker = shutil.which("docker")
    if docker is None or subprocess.run([docker, "info"], capture_output=True, check=False).returncode:
        pytest.skip("no Docker daemon: the container was not built")
    built = subprocess.run([docker, "build", "--quiet", ROOT], capture_output=True, text=True, check=True)
    command = [docker, "run", "--rm", built.stdout.strip(), "check", "configuration-1"]
    assert "3 blocks" in subprocess.run(command, capture_output=True, text=True, check=True).stdout
