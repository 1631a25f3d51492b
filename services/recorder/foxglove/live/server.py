"""The WebSocket server of the foxglove-sdk and the channels that it serves. Needs the extra `foxglove`."""

import logging
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import foxglove
from foxglove import Channel, Context, Schema
from foxglove.websocket import ChannelView, Client, ServerListener

from services.recorder.channels import RecordingError
from services.recorder.foxglove.forms import Form
from services.recorder.foxglove.live.settings import LiveSettings

log = logging.getLogger(__name__)

NAME = "topnav"
MESSAGES_PER_CLIENT = 64
"""That wait for a slow client before its oldest are dropped; chosen: a few seconds of frames, some 10 MB."""


class Shown:
    """Channels by name. Clients hear what is put while they listen, each as fast as it reads."""

    def __init__(self, context: Context) -> None:
        self._context = context
        self._channels: dict[str, Channel] = {}

    def known(self, name: str) -> bool:
        """Whether clients can ask for a channel."""
        return name in self._channels

    def watched(self, name: str) -> bool:
        """Whether a client listens to a channel now."""
        channel = self._channels.get(name)
        return channel is not None and channel.has_sinks()

    def put(self, form: Form, stamp_ns: int) -> None:
        """Show a message to those who listen; the first of a channel tells all clients that it is there."""
        channel = self._channels.get(form.channel)
        if channel is None:
            told = form.schema()
            schema = Schema(name=told.name, encoding=told.encoding, data=told.definition)
            channel = Channel(
                form.channel, schema=schema, message_encoding=told.message_encoding, context=self._context
            )
            self._channels[form.channel] = channel
        channel.log(form.data, log_time=stamp_ns)


class Subscriptions(ServerListener):
    """Channels that clients have begun to listen to; written on the server's threads."""

    def __init__(self, wake: Callable[[], None]) -> None:
        self._wake, self._lock = wake, threading.Lock()
        self._begun: set[str] = set()

    def on_subscribe(self, client: Client, channel: ChannelView) -> None:
        """A client begins to listen."""
        with self._lock:
            self._begun.add(channel.topic)
        log.info("client %d listens to %s", client.id, channel.topic)
        self._wake()

    def take(self) -> set[str]:
        """Those since the last call."""
        with self._lock:
            taken, self._begun = self._begun, set()
        return taken


@contextmanager
def serving(settings: LiveSettings, subscriptions: Subscriptions) -> Iterator[Shown]:
    """Listen for clients until the block ends.

    Raises:
        RecordingError: the port is taken, or there is no such address.
    """
    context = Context()
    try:
        server = foxglove.start_server(
            name=NAME,
            host=settings.host,
            port=settings.port,
            context=context,
            server_listener=subscriptions,
            message_backlog_size=MESSAGES_PER_CLIENT,
        )
    except RuntimeError as error:
        raise RecordingError(f"no live view at {settings.host}:{settings.port}: {error}") from error
    log.info("Foxglove connects to ws://%s:%d", settings.host, server.port)
    try:
        yield Shown(context)
    finally:
        server.stop()
