"""Known vulnerabilities of the packages in requirements.lock, by pip-audit: `make audit`.

Exit code 1 for a vulnerability, or for a package that the index of advisories does not know though it knows others. An
index that knows none, or that cannot be reached, has no advisories to give: that is said, and is no failure.
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

COMMAND = (
    "-m",
    "pip_audit",
    "--disable-pip",
    "--require-hashes",
    "-r",
    "requirements.lock",
    "-f",
    "json",
    "-o",
)


def judge(dependencies):
    """Exit code and lines of a report of pip-audit."""
    skipped = [one for one in dependencies if "skip_reason" in one]
    lines = [
        f"{one['name']} {one['version']}: {found['id']}, mended in {', '.join(found['fix_versions']) or 'none'}"
        for one in dependencies
        for found in one.get("vulns", ())
    ]
    if not lines and len(skipped) == len(dependencies):
        return 0, [f"audit SKIPPED: the index gives no advisories for any of {len(skipped)} packages"]
    lines += [one["skip_reason"] for one in skipped]
    said = (
        f"{len(dependencies) - len(skipped)} of {len(dependencies)} packages audited, {len(lines)} complaints"
    )
    return int(bool(lines)), [*lines, f"audit: {said}"]


def main():
    """Audit the lock, print the outcome, and give the exit code."""
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder, "report.json")
        answer = subprocess.run(
            [sys.executable, *COMMAND, report], capture_output=True, text=True, check=False
        )
        if report.exists():
            code, lines = judge(json.loads(report.read_text())["dependencies"])
        elif "Could not connect" in answer.stderr:
            code, lines = 0, ["audit SKIPPED: the index of advisories cannot be reached"]
        else:
            code, lines = 1, [answer.stderr]
    sys.stdout.write("\n".join(lines) + "\n")
    return code


if __name__ == "__main__":
    sys.exit(main())
