"""deploy/FAULTS.md: thirty rows, each with a guarantee and with tests that exist."""

import ast
import re
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).resolve().parents[2]
TABLE = REPOSITORY / "deploy/FAULTS.md"
CASES = range(1, 31)
TEST = re.compile(r"`(tests/[\w/]+\.py)::(test_\w+)`")


def rows() -> dict[int, list[str]]:
    """Cells by the number of the case."""
    lines = re.findall(r"^\| (\d+) \|(.*)\|$", TABLE.read_text(encoding="utf-8"), re.MULTILINE)
    return {int(number): [cell.strip() for cell in rest.split("|")] for number, rest in lines}


def functions_of(path: Path) -> set[str]:
    """Names of the test functions of a file."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    kinds = ast.FunctionDef | ast.AsyncFunctionDef
    return {node.name for node in ast.walk(tree) if isinstance(node, kinds) and node.name.startswith("test_")}


def test_there_is_one_row_for_each_of_the_thirty_cases():
    assert sorted(rows()) == list(CASES)


@pytest.mark.parametrize("case", CASES)
def test_a_row_says_what_is_guaranteed_and_names_tests_that_exist(case: int):
    _, guaranteed, named, _ = rows()[case]
    assert guaranteed
    tests = TEST.findall(named)
    assert tests, f"case {case} names no test"
    for path, name in tests:
        assert name in functions_of(REPOSITORY / path), f"case {case}: no {name} in {path}"


def test_what_an_attack_found_names_tests_that_exist():
    named = TEST.findall(TABLE.read_text(encoding="utf-8").partition("## Found by attack")[2])
    assert len(named) > 15
    for path, name in named:
        assert name in functions_of(REPOSITORY / path), f"no {name} in {path}"
