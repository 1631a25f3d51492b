"""How pytest-xdist distributes the tests: by file, and by stack where files share one."""

from typing import Any

from xdist.scheduler import LoadScopeScheduling

ONE_STACK = "tests/e2e/one_stack"
"""Tests that share a running stack: one worker runs all of them."""


class ByStackAndFile(LoadScopeScheduling):
    """One worker takes a file, or all files of the shared stack."""

    def _split_scope(self, nodeid: str) -> str:
        return ONE_STACK if nodeid.startswith(f"{ONE_STACK}/") else nodeid.partition("::")[0]

    def remove_node(self, node: Any) -> str | None:
        """Queue again only what a worker that died left undone.

        Files that it had finished give the others nothing to do, and who has nothing to do asks for nothing:
        the run never ended.
        """
        units = self.assigned_work[node]
        self.assigned_work[node] = {name: unit for name, unit in units.items() if not all(unit.values())}
        return super().remove_node(node)
