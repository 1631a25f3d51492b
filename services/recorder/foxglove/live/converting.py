"""Samples of the bus to channels of Foxglove, as far as anybody looks."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from services.recorder.backlog import Sample
from services.recorder.channels import name_of, topic_of
from services.recorder.foxglove.forms import as_drawings, as_json, message_of
from shared.inbox import Counters
from shared.wire import WireError

if TYPE_CHECKING:
    from services.recorder.foxglove.drawings import Draw
    from services.recorder.foxglove.live.server import Shown

HAPPENINGS = {"event", "delta"}
"""Topics whose messages are each told once; of all others the last one is how things stand."""

NOT_CONVERTIBLE = (ValueError, ArithmeticError, OSError)
"""What drawings raise: NotDrawableError is a ValueError, and Pillow raises the others on damaged pictures."""


class Converter:
    """Shows samples. What nobody listens to is kept for whoever begins to, and costs nothing before."""

    def __init__(self, shown: "Shown", draws: "Sequence[Draw]", counters: Counters) -> None:
        self._shown, self._draws, self._counters = shown, draws, counters
        self._channels: dict[str, set[str]] = {}
        self._last: dict[str, Sample] = {}

    def show(self, sample: Sample) -> None:
        """Show a sample in all its forms; what is malformed is counted and makes room for the next."""
        found = topic_of(sample.key)
        if found is not None and name_of(found[0]) not in HAPPENINGS:
            self._last[sample.key] = sample
        channels = self._channels.get(sample.key)
        if channels is None or any(self._shown.watched(name) for name in channels):
            self._convert(sample)

    def show_again(self, begun: set[str]) -> None:
        """Show how things stand in channels that somebody has begun to listen to: the next may be long."""
        for key, sample in list(self._last.items()):
            if begun & self._channels.get(key, set()):
                self._convert(sample)

    def _convert(self, sample: Sample) -> None:
        try:
            message = message_of(sample.key, sample.payload)
        except WireError as error:
            self._last.pop(sample.key, None)
            self._counters.count("malformed", f"{sample.key}: {error}")
            return
        forms = [as_json(sample.key, message)]
        try:
            forms += as_drawings(sample.key, message, sample.arrived_ns, self._draws)
        except NOT_CONVERTIBLE as error:
            self._counters.count("undrawable", f"{sample.key}: {error}")
        for form in forms:
            self._shown.put(form, sample.arrived_ns)
        self._channels.setdefault(sample.key, set()).update(form.channel for form in forms)
