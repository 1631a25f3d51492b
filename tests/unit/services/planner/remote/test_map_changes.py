"""What a planner hears of its map: of one at a time, and of the past no more than it needs."""

from services.planner.remote.map_changes import MapChanges
from shared.messages.maps import MapDelta


class Inbox:
    """What waits."""

    def __init__(self) -> None:
        self.waiting: list[MapDelta] = []

    def take_all(self):
        taken, self.waiting = self.waiting, []
        return taken

    def wait(self, _timeout_s):
        """The first that waits."""
        return self.waiting.pop(0) if self.waiting else None


class Bus:
    """Has an inbox for each map that is followed."""

    def __init__(self) -> None:
        self.inboxes: dict[str, Inbox] = {}

    def subscribe(self, _topic, _wake, **names):
        return self.inboxes.setdefault(names["map"], Inbox())

    def unsubscribe(self, inbox):
        self.inboxes = {name: one for name, one in self.inboxes.items() if one is not inbox}


def delta(revision: int, *, reset: bool = False, renamed_to: str = "") -> MapDelta:
    return MapDelta(map="flat", revision=revision, reset=reset, renamed_to=renamed_to)


def followed(*waiting: MapDelta) -> tuple[MapChanges, Bus]:
    bus = Bus()
    changes = MapChanges(bus)
    changes.follow("flat")
    bus.inboxes["flat"].waiting = list(waiting)
    return changes, bus


def test_nothing_is_heard_before_a_map_is_followed_and_then_of_one():
    assert MapChanges(Bus()).take_all() == []
    assert MapChanges(Bus()).wait(0.0) == []
    changes, bus = followed(delta(1))
    changes.follow("loft")
    assert list(bus.inboxes) == ["loft"]
    assert changes.take_all() == []


def test_what_a_reset_makes_old_is_left_out_but_for_names():
    renamed = delta(2, reset=True, renamed_to="attic")
    changes, _ = followed(delta(1), renamed, delta(0, reset=True), delta(1), delta(5, reset=True), delta(6))
    assert changes.take_all() == [renamed, delta(5, reset=True), delta(6)]
    assert changes.take_all() == []


def test_what_is_put_back_comes_first_and_ends_a_wait():
    changes, bus = followed(delta(1), delta(2))
    changes.put_back(changes.take_all()[1:])
    bus.inboxes["flat"].waiting = [delta(3)]
    assert changes.wait(0.0) == [delta(2), delta(3)]
    bus.inboxes["flat"].waiting = [delta(4), delta(5)]
    assert changes.wait(0.0) == [delta(4), delta(5)]
    assert changes.wait(0.0) == []
