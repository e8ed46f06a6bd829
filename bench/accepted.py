"""The last accepted figures: their table in docs/results/bench.md, and what the tests hold new code against."""

from datetime import UTC, datetime
from pathlib import Path

from blockshake.files import load_json, write_json, write_text

PAGE = Path(__file__).parents[1] / "docs" / "results" / "bench.md"
COUNTS = Path(__file__).with_name("accepted.json")
LARGEST_LOSS = 1.3  # operations over the accepted ones


def accept(result, table):
    """Put the table of a whole bench on its page, and the operations of its kernel with those of other processors."""
    put("make bench", f"```\n{table}```\n")
    known = load_json(COUNTS) if COUNTS.exists() else {}
    own = {result["machine"]["instruction_set"]: total_operations(result["arithmetic"])}
    write_json(COUNTS, dict(sorted({**known, **own}.items())))


def put(command, figures):
    """Put figures that a command measured on its page, with the date, in place of those from before."""
    begin, end = (f"<!-- {command}: {word} -->" for word in ("begin", "end"))
    before, _, rest = PAGE.read_text(encoding="utf-8").partition(begin + "\n")
    _, _, after = rest.partition(end)
    write_text(PAGE, f"{before}{begin}\nMeasured {datetime.now(UTC):%Y-%m-%d}.\n\n{figures}{end}{after}")


def accepted_operations(instruction_set):
    """Operations of the contact kernel's loops on a processor, as accepted last; None where they never were."""
    return load_json(COUNTS).get(instruction_set)


def total_operations(arithmetic):
    """Operations for a node, sum over the innermost loops of the contact kernel."""
    return sum(loop["operations_per_node"] for loop in arithmetic["loops"])
