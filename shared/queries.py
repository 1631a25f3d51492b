"""Questions over the bus: a service answers in its own loop, an asker gets a reply or a typed error."""

import logging
import math
import threading
import time
from collections import deque
from collections.abc import Callable
from typing import Any, Generic, TypeVar

import zenoh

from shared.inbox import Counters, queue_bytes
from shared.messages.base import Message
from shared.topics import Query
from shared.transport.keys import NAME
from shared.wire import WireError, decode, encode

Q = TypeVar("Q", bound=Message)
R = TypeVar("R", bound=Message)
log = logging.getLogger(__name__)

MAX_WAITING = 256
"""Questions of one kind that may wait; chosen: more are asked by nobody who waits for the answer."""
MEETING_S = 1.5
"""Two peers that were just started have met by then; chosen: a few times what gossip takes."""
MEETING_PERIOD_S = 0.1
"""Between two tries meanwhile; chosen."""
MEANWHILE_S = 0.5
"""How often an asker that waits has something else to do; chosen: twice within what planners repeat."""
PATIENCE_DIGITS = 9
"""Of an attachment that says for how many milliseconds an answer is waited for: eleven days; chosen."""
CODED = "text/plain;"
"""Zenoh encoding of a refusal: after it stands its code, "" in older services."""


class QueryError(RuntimeError):
    """A question that got no reply of the expected kind."""


class AbsentError(QueryError):
    """Nobody answers this key."""


class TimedOutError(QueryError):
    """Somebody is there but did not answer in time."""


class RefusedError(QueryError):
    """The service answered with an error; the text is its own.

    Attributes:
        code: what kind of reason it is, for programs: one of `REASONS`, or "" where the service gave none.
    """

    def __init__(self, text: str, code: str = "") -> None:
        super().__init__(text)
        self.code = code

    @property
    def may_be_missing(self) -> bool:
        """Whether what was asked about may not be there; services from before codes give none."""
        return self.code in ("missing", "")


REASONS = {
    "missing": "what the question is about is not there",
    "conflict": "it is there already, or has changed since it was read",
    "invalid": "the question can never be answered as it stands",
    "corrupt": "what is stored is damaged",
    "storage-full": "nothing can be written, reads go on",
    "passing": "it is about a moment that is gone or not there yet; ask about the newest",
    "unavailable": "what the service depends on does not answer; the same question may succeed later",
    "forbidden": "a rule of the map is against it",
    "busy": "too many questions wait, or something has to be done first; the same one may succeed later",
}
"""Codes of refusals; services may add some, so an asker must bear with ones it does not know."""


class Request(Generic[Q, R]):
    """One question waiting for its answer. Answer it exactly once."""

    def __init__(self, query: zenoh.Query, message: Q, name: str) -> None:
        self._query, self.message, self.name = query, message, name

    def reply(self, answer: R) -> None:
        """Send the answer."""
        with self._query as query:
            query.reply(query.key_expr, encode(answer))

    def refuse(self, reason: str, code: str = "") -> None:
        """Send an error the asker raises as RefusedError, with one of `REASONS` as its code."""
        _reply_error(self._query, reason, code)

    def leave(self) -> None:
        """Say nothing: the asker gets the answer of whoever else is asked."""
        with self._query:
            pass


class Requests(Generic[Q, R]):
    """Questions of one kind, taken by the service's loop in the order they came.

    Where the loop falls behind, those that lapse are dropped once nobody waits for the answer any more: an
    asker that asks again would otherwise always wait for the answers to its earlier questions.
    """

    def __init__(self, query: Query[Q, R], wake: threading.Event, counters: Counters) -> None:
        self._query = query
        self._waiting: deque[tuple[zenoh.Query, float]] = deque()
        self._waiting_bytes, self._most_bytes = 0, queue_bytes(query.max_bytes)
        self._wake, self._counters = wake, counters
        self._lock = threading.Lock()

    def push(self, query: zenoh.Query) -> None:
        """Store a question; refuse one that is too long, or when too much waits. Called on Zenoh's thread."""
        length = _length(query)
        if length > self._query.max_bytes:
            self._refuse(query, f"at most {self._query.max_bytes} bytes expected, got {length}")
            return
        with self._lock:
            full = len(self._waiting) >= MAX_WAITING or self._waiting_bytes + length > self._most_bytes
            if not full:
                self._waiting.append((query, self._lapses_s(query)))
                self._waiting_bytes += length
        if full:
            self._counters.count("overflow", f"{self._query.template}: {len(self._waiting)} questions wait")
            _reply_error(query, "busy: too many questions wait, ask again later", "busy")
            return
        self._wake.set()

    def take(self) -> Request[Q, R] | None:
        """Return the oldest question, or None. Malformed ones are refused with the reason and counted."""
        while (query := self._oldest()) is not None:
            name = _variable(self._query.template, str(query.key_expr))
            if not NAME.match(name):  # an asker may send any key expression that meets ours, '**' too
                template, key = self._query.template, str(query.key_expr)
                self._refuse(query, f"one name expected in {template}, got {key[:80]!r}")
                continue
            payload = query.payload.to_bytes() if query.payload is not None else b""
            try:
                message = decode(self._query.request, payload, self._query.max_bytes)
            except WireError as error:
                self._refuse(query, str(error))
                continue
            return Request(query, message, name)
        return None

    def _oldest(self) -> zenoh.Query | None:
        """The question that has waited longest; those whose askers have given up are dropped and counted."""
        while True:
            with self._lock:
                if not self._waiting:
                    return None
                query, until_s = self._waiting.popleft()
                self._waiting_bytes -= _length(query)
            if time.monotonic() < until_s:
                return query
            self._counters.count("lapsed", f"{query.key_expr}: nobody waits for the answer any more")
            with query:
                pass

    def _lapses_s(self, query: zenoh.Query) -> float:
        return time.monotonic() + _patience_s(query) if self._query.lapses else math.inf

    def _refuse(self, query: zenoh.Query, reason: str) -> None:
        self._counters.count("malformed", reason)
        _reply_error(query, f"malformed request: {reason}", "invalid")


def ask(
    session: zenoh.Session,
    query: Query[Q, R],
    key: str,
    request: Q,
    timeout_s: float,
    meanwhile: Callable[[], None] | None = None,
) -> R:
    """Ask and wait for the first answer, calling `meanwhile` now and then.

    Two peers that were just started may not have met yet: an absent service is asked again for a while.

    Raises:
        AbsentError, TimedOutError, RefusedError: see their docstrings.
        WireError: the answer is not the expected message.
    """
    payload = encode(request)
    attachment = str(math.ceil(timeout_s * 1e3)).encode() if query.lapses else None
    patient_until_s = time.monotonic() + min(timeout_s, MEETING_S)
    while True:
        answers: deque[zenoh.Reply] = deque()
        ended = threading.Event()
        # a handler of ours can be waited for in pieces, and outlives a caller whom an exception takes away
        handler: Any = zenoh.handlers.Callback(_keeper(answers, ended), ended.set, indirect=False)
        session.get(key, handler, payload=payload, timeout=timeout_s, attachment=attachment)
        while not ended.wait(MEANWHILE_S):
            if meanwhile is not None:
                meanwhile()
        if answers:
            return _read(query, key, answers[0], timeout_s)
        if time.monotonic() > patient_until_s:
            raise AbsentError(f"{key}: nobody answers; is the service up?")
        time.sleep(MEETING_PERIOD_S)


def _keeper(answers: deque[zenoh.Reply], ended: threading.Event) -> Callable[[zenoh.Reply], None]:
    """Keeps the first answer, on Zenoh's thread."""

    def keep(reply: zenoh.Reply) -> None:
        answers.append(reply)
        ended.set()

    return keep


def _read(query: Query[Q, R], key: str, answer: zenoh.Reply, timeout_s: float) -> R:
    if answer.ok is not None:
        return decode(query.reply, answer.ok.payload.to_bytes(), query.max_bytes)
    assert answer.err is not None
    text, encoding = answer.err.payload.to_bytes().decode(errors="replace"), str(answer.err.encoding)
    if text == "Timeout":
        raise TimedOutError(f"{key}: no answer within {timeout_s} s")
    raise RefusedError(text, encoding.removeprefix(CODED) if encoding.startswith(CODED) else "")


def _reply_error(query: zenoh.Query, reason: str, code: str) -> None:
    with query:
        query.reply_err(reason.encode(), encoding=zenoh.Encoding(CODED + code) if code else None)


def _length(query: zenoh.Query) -> int:
    return len(query.payload) if query.payload is not None else 0


def _patience_s(query: zenoh.Query) -> float:
    """How long the asker waits; forever where it does not say so, or not in plain digits."""
    told = query.attachment
    said = told.to_bytes() if told is not None and len(told) <= PATIENCE_DIGITS else b""
    return int(said) / 1e3 if said.isdigit() else math.inf


def _variable(template: str, key: str) -> str:
    """The part of `key` that stands where `template` has its {name}; "" when the key has another form.

    A template without a variable gives its last part.
    """
    wanted, found = template.split("/"), key.split("/")
    if len(wanted) != len(found):
        return ""
    variables = [index for index, part in enumerate(wanted) if part.startswith("{")]
    return found[variables[0] if variables else -1]
