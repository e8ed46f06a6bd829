"""The house has floors: a module imports from its own floor or from one below, never from one above."""

import ast
import pkgutil

import pytest

from blockshake.files import PACKAGE
from blockshake.measurement.campaigns.kinds import KINDS, Late

# From the ground up; what stands on one line knows nothing of its neighbours.
FLOORS = [
    ["caches", "errors", "interrupts"],
    ["files", "paths", "quantities", "working_folder"],
    ["validation", "log", "sources", "store"],
    ["tables", "statistics"],
    ["jit"],
    ["geometry"],
    ["dynamics"],
    ["solvers", "measurement"],
    ["simulation", "parity", "forces"],
    ["effects", "pages"],
    ["study", "views"],
    ["diagnosis", "virtual"],
    ["own_files"],
    ["run_diagnosis"],
    ["cost"],
    ["cli"],
]
ROOMS_OF_DIAGNOSIS = [
    ["evidence"],
    ["outside"],
    ["answer"],
    ["nominal", "wording"],
    ["misfit", "planning"],
    ["verdict"],
    ["gain"],
    ["outcomes"],
    ["report", "steps"],
]
ROOMS_OF_STUDY = [
    ["remarks", "sampling"],
    ["ensembles", "stiffness"],
    ["comparison", "fragility", "sensitivity"],
    ["calibration", "extension", "limit_states"],
    ["config_checks"],
    ["analyses"],
    ["config"],
    ["growth", "planned_runs"],
    ["report"],
]
MOST_MODULES = 15
MOST_LINES = 59_281  # of the package with its templates: it only falls


def place(name, floors):
    """Floor of a room, or none where it is no room of these floors."""
    return next((number for number, rooms in enumerate(floors) if name in rooms), None)


def arrows():
    """Every import as the parts of the importing and of the imported module's name."""
    for path in sorted(PACKAGE.rglob("*.py")):
        own = path.relative_to(PACKAGE).with_suffix("").parts
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("blockshake."):
                yield own, tuple(node.module.split(".")[1:])


def upward(floors, depth, inside=()):
    """Arrows that point up, or across a floor, between the rooms at a depth of the modules' names."""
    found = set()
    for own, other in arrows():
        if own[:depth] != inside or other[:depth] != inside or len(own) <= depth or len(other) <= depth:
            continue
        here, there = place(own[depth], floors), place(other[depth], floors)
        if own[depth] != other[depth] and here is not None and (there is None or there >= here):
            found.add((".".join(own), ".".join(other)))
    return sorted(found)


def test_every_room_has_a_floor():
    rooms = {path.relative_to(PACKAGE).with_suffix("").parts[0] for path in PACKAGE.rglob("*.py")}
    assert rooms - {"__init__", "__main__"} == {room for floor in FLOORS for room in floor}


def test_no_module_imports_from_a_floor_above():
    # source digests follow the two tables whose rows name modules
    allowed = {("sources", "simulation.models"), ("sources", "measurement.campaigns.kinds")}
    assert set(upward(FLOORS, 0)) - allowed == set()


@pytest.mark.parametrize(("inside", "floors"), [("diagnosis", ROOMS_OF_DIAGNOSIS), ("study", ROOMS_OF_STUDY)])
def test_rooms_inside_a_room_have_floors_too(inside, floors):
    assert upward(floors, 1, (inside,)) == []
    rooms = {path.stem for path in (PACKAGE / inside).iterdir()} - {"__init__", "__pycache__"}
    assert rooms == {room for floor in floors for room in floor}


def test_rooms_of_the_diagnosis_have_few_arrows():
    pairs = {
        (own[1], other[1])
        for own, other in arrows()
        if own[0] == other[0] == "diagnosis" and len(own) > 2 and len(other) > 2 and own[1] != other[1]
    }
    assert len(pairs) <= 34


def test_every_function_of_the_kinds_of_campaigns_is_there():
    for kind in KINDS:
        for name in (one for one in kind if isinstance(one, Late)):
            assert callable(pkgutil.resolve_name(":".join(name)))


def test_free_flight_is_named_in_the_table_of_kinds_alone():
    named = [
        path for path in PACKAGE.rglob("*.py") if "blockshake_flight" in path.read_text(encoding="utf-8")
    ]
    assert named == [PACKAGE / "measurement" / "campaigns" / "kinds.py"]


def test_no_folder_holds_more_than_fifteen_modules():
    for folder in {path.parent for path in PACKAGE.parent.rglob("*.py")}:
        modules = [path for path in folder.glob("*.py") if path.stem != "__init__"]
        assert len(modules) <= MOST_MODULES, folder


def test_the_package_keeps_to_its_budget_of_lines():
    files = [path for path in PACKAGE.rglob("*") if path.is_file() and path.suffix != ".pyc"]
    assert sum(len(path.read_text(encoding="utf-8").splitlines()) for path in files) <= MOST_LINES


def shows(own):
    """Whether a module only shows results: a page's part, a section, a figure, a report."""
    words = own[-1].split("_")
    return own[0] == "pages" or "figures" in own or words[-1] in ("section", "sections", "figure", "report")


def test_pages_and_sections_compute_nothing():
    """No statistics, no solver and no random numbers: `scipy.spatial` alone, by which solids are drawn."""
    computing = []
    for path in sorted(PACKAGE.rglob("*.py")):
        own = path.relative_to(PACKAGE).with_suffix("").parts
        if not shows(own):
            continue
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
            names += [node.module or ""] if isinstance(node, ast.ImportFrom) else []
            names += (
                [f"numpy.{node.attr}"] if isinstance(node, ast.Attribute) and node.attr == "random" else []
            )
            computing += [
                ("/".join(own), name)
                for name in names
                if name.startswith(
                    ("scipy", "numpy.random", "random", "blockshake.solvers", "blockshake.jit")
                )
                and not name.startswith("scipy.spatial")
            ]
    assert computing == []
