"""The loop of the live view: what the bus says goes to whoever looks; nobody on the bus waits for that."""

import threading
from functools import partial

from services.recorder.channels import name_of, topics_named
from services.recorder.foxglove.forms import load_drawings
from services.recorder.foxglove.live.converting import Converter
from services.recorder.foxglove.live.newest import Newest
from services.recorder.foxglove.live.settings import LiveSettings
from shared.bus import Bus
from shared.topics import TOPICS

PERIOD_S = 0.5
"""Chosen: the bus wakes the loop for whatever it carries; this is for a stop that comes meanwhile."""


def serve(bus: Bus, settings: LiveSettings, stop: threading.Event) -> None:
    """Show until `stop` is set.

    Raises:
        RecordingError: the foxglove-sdk is missing, or the port is taken.
    """
    draw = load_drawings()  # says what to install before the next lines fail
    from services.recorder.foxglove.live.maps import MapScenes
    from services.recorder.foxglove.live.server import Subscriptions, serving

    without = topics_named(settings.without)
    newest, subscriptions = Newest(bus.wake, bus.counters), Subscriptions(bus.wake.set)
    with serving(settings, subscriptions) as shown, MapScenes(bus, shown) as maps:
        converter = Converter(shown, [draw], bus.counters)
        for topic in TOPICS:
            if name_of(topic) not in without:
                bus.tap(topic, partial(newest.push, topic))
        bus.announce("foxglove")
        while not stop.is_set():
            bus.wait(PERIOD_S)
            maps.check()
            if begun := subscriptions.take():
                converter.show_again(begun)
                maps.show_again(begun)
            for sample in newest.take_all():
                converter.show(sample)
