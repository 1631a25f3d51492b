"""What the map store kept, held against what it acknowledged."""

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from typing import Any

from shared.messages.maps import MapReply, MapRequest
from shared.queries import RefusedError
from shared.topics import MAP
from shared.wire import encode
from tests.faults.writers import OWN, Link, Transaction, content

ANSWER_S = 60.0
PAGE = 1000


@dataclass
class Verdict:
    """Of one map; `wrong` says in words what is not as it must be."""

    acknowledged: int = 0
    unacknowledged: int = 0
    found_committed: int = 0
    lost: int = 0
    wrong: list[str] = field(default_factory=list)


@dataclass(frozen=True)
class Kept:
    """All of one map as clients read it; the history by revision."""

    graph: MapReply
    features: dict[int, bytes]
    history: dict[int, dict[str, Any]]

    def nodes_of(self, transaction: Transaction) -> list[bool]:
        """Which of its nodes and edges are there."""
        there = {node.node_id for node in self.graph.nodes}
        joined = {(edge.a, edge.b) for edge in self.graph.edges}
        return [n in there for n in transaction.nodes] + [e in joined for e in transaction.edges]


def judge(link: Link, name: str, transactions: list[Transaction]) -> Verdict:
    """Read the map and compare it with what its writers did."""
    tried = [each for each in transactions if not each.acknowledged]
    verdict = Verdict(len(transactions) - len(tried), len(tried))
    try:
        kept = _read(link, name)
    except RefusedError as error:
        verdict.lost = verdict.acknowledged
        verdict.wrong.append(f"cannot be read: {error}")
        return verdict
    verdict.wrong += _wrong_in_history(kept)
    committed = _committed(kept, transactions, own=name == link.named(OWN))
    verdict.found_committed = sum(not each.acknowledged for each in committed)
    if len(committed) != kept.graph.revision:
        verdict.wrong.append(f"{kept.graph.revision} revisions, {len(committed)} transactions")
    lost = list(_lost(kept, committed, standing=_standing(committed)))
    verdict.lost = len(lost)
    verdict.wrong += lost
    known = {node for each in committed for node in each.nodes}
    strange = [node.node_id for node in kept.graph.nodes if node.node_id not in known]
    halves = [
        each
        for each in tried
        if not each.undo and len(set(kept.nodes_of(each))) > 1 and each not in committed
    ]
    verdict.wrong += [f"half of {each} is there" for each in halves]
    verdict.wrong += [f"nodes {strange} belong to nothing that was committed"] if strange else []
    return verdict


def _committed(kept: Kept, transactions: list[Transaction], own: bool) -> list[Transaction]:
    """What stands in the history: acknowledged, or seen there by its writer, or there as a whole."""
    known = [each for each in transactions if each.revision is not None]
    if own:
        return known
    free = {number: entry["author"] for number, entry in kept.history.items()}
    for each in known:
        free.pop(each.revision or 0, None)
    for each in transactions:  # a writer's transactions are in its order, so are the revisions left over
        if each.revision is None and all(kept.nodes_of(each)):
            left = [number for number, author in free.items() if author == each.author]
            if left:
                known.append(replace(each, revision=min(left)))
                del free[min(left)]
    return known


def _standing(committed: list[Transaction]) -> set[int]:
    """Revisions of additions that no undo took back."""
    stack: list[int] = []
    for each in sorted(committed, key=lambda each: each.revision or 0):
        if each.undo:
            stack.pop()
        else:
            stack.append(each.revision or 0)
    return set(stack)


def _lost(kept: Kept, committed: list[Transaction], standing: set[int]) -> Iterator[str]:
    """Transactions that are not there as they were written."""
    for each in committed:
        revision = each.revision or 0
        entry = kept.history.get(revision)
        if entry is None or entry["author"] != each.author or (entry["undoes"] is not None) != each.undo:
            yield f"revision {revision}: {each} expected, got {entry}"
        elif not each.undo and any(found != (revision in standing) for found in kept.nodes_of(each)[:2]):
            wanted = "there" if revision in standing else "gone"
            yield f"revision {revision}: nodes {each.nodes} must be {wanted}"
        elif revision in standing and not all(kept.nodes_of(each)):
            yield f"revision {revision}: an edge of {each.edges} is missing"
        elif revision in standing and any(kept.features.get(n) != _expected(n) for n in each.nodes):
            yield f"revision {revision}: features of {each.nodes} are not those written"


def _wrong_in_history(kept: Kept) -> Iterator[str]:
    newest, numbers = kept.graph.revision, sorted(kept.history)
    if numbers != list(range(1, newest + 1)):
        yield f"revisions 1 to {newest} expected, got {len(numbers)} up to {max(numbers, default=0)}"
    for number, entry in kept.history.items():
        if entry["summary"].startswith("unreadable"):
            yield f"revision {number} is {entry['summary']}"


def _read(link: Link, name: str) -> Kept:
    graph = link.bus.ask(MAP, MapRequest(action="read"), ANSWER_S, map=name)
    answer = link.bus.ask(MAP, MapRequest(action="read_features"), ANSWER_S, map=name)
    history: dict[int, dict[str, Any]] = {}
    before = graph.revision + 1
    while before > 1:
        page = link.rest.get(
            f"/maps/{name}/revisions", params={"before": before, "limit": PAGE}, timeout=ANSWER_S
        )
        history |= {entry["revision"]: entry for entry in page.raise_for_status().json()}
        before -= PAGE
    return Kept(graph, {each.node_id: encode(each.features) for each in answer.features}, history)


def _expected(number: int) -> bytes:
    return encode(content(number).features.model_copy(update={"thumbnail": b""}))
