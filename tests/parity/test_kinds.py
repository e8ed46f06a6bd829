"""Every kind of sensor fault has a row in the registry and a row in the docs."""

import pytest

from blockshake.files import PACKAGE
from blockshake.parity.kinds.registry import KINDS

PAGE = (PACKAGE.parents[1] / "docs" / "theory" / "parity.md").read_text(encoding="utf-8")


@pytest.mark.parametrize("kind", KINDS.values(), ids=KINDS)
def test_a_kind_is_in_the_docs_with_its_effect_and_equation(kind):
    assert f"| `{kind.quantity}` | `{kind.effect}` | {kind.equation} |" in PAGE


def test_the_docs_list_the_kinds_in_the_order_in_which_they_are_taken_out():
    rows = [PAGE.index(f"| `{quantity}` |") for quantity in KINDS]
    assert rows == sorted(rows)
