"""Where a merge stands: carried on by the thread that merges, looked at and cancelled by others."""

import threading
from typing import Literal

from pydantic import BaseModel

State = Literal["matching", "writing", "done", "refused", "failed"]


class MergeAnswer(BaseModel):
    """Where a merge stands, as REST tells it.

    Attributes:
        map: the map that grows.
        other: the map whose nodes it gets; it stays as it is.
        state: matching may be cancelled; done, refused (nothing was written) and failed are ends.
        matched: nodes of `other` compared so far.
        nodes: nodes of `other`.
        edges: edges of `other`.
        cross_edges: edges between the two maps, 0 until they are chosen.
        reason: why it was refused or failed.
    """

    map: str
    other: str
    state: State = "matching"
    matched: int = 0
    nodes: int
    edges: int
    cross_edges: int = 0
    reason: str = ""


class CancelledError(Exception):
    """The merge has been ended by somebody else."""


class Progress:
    """Safe from any thread; `answer` is always a consistent one."""

    def __init__(self, answer: MergeAnswer) -> None:
        self.answer = answer
        self._lock = threading.Lock()

    @property
    def running(self) -> bool:
        """Whether the merge may still change something."""
        return self.answer.state in ("matching", "writing")

    def advance(self, **changes: object) -> None:
        """Note what was done; CancelledError when it is to go no further."""
        with self._lock:
            if not self.running:
                raise CancelledError
            self.answer = self.answer.model_copy(update=changes)

    def end(self, state: State, reason: str = "") -> None:
        """Note how it ended, if it has not ended yet."""
        with self._lock:
            if self.running:
                self.answer = self.answer.model_copy(update={"state": state, "reason": reason})

    def cancel(self) -> bool:
        """End it while it is matching; False when it is being written. One that has ended stays as it is."""
        with self._lock:
            if self.answer.state == "matching":
                ended = {"state": "refused", "reason": "cancelled: nothing was written"}
                self.answer = self.answer.model_copy(update=ended)
            return self.answer.state != "writing"
