"""A new node is read once its frame and one beside it are there, in whichever order they come."""

from services.signs.new_nodes import WAITING_MAX, NewNodes
from shared.messages.maps import Node
from shared.messages.sensors import Frame


def frame(seq, stamp_ns=None):
    stamp_ns = 100 * seq if stamp_ns is None else stamp_ns
    return Frame(
        seq=seq, stamp_ns=stamp_ns, robot="r1", encoding="bgr8", width_px=2, height_px=1, data=bytes(6)
    )


def node(seq, stamp_ns=None):
    return Node(node_id=seq, frame_seq=seq, stamp_ns=100 * seq if stamp_ns is None else stamp_ns)


def with_frames(*numbers, kept=12):
    new = NewNodes(kept)
    for number in numbers:
        new.add_frame(frame(number))
    return new


def taken(new):
    return [(one.node_id, one.frame.seq, one.beside.seq) for one in new.take()]


def test_the_other_frame_is_one_from_before_as_far_as_the_robot_moved_little():
    new = with_frames(*range(20))
    new.add_node("flat", node(15))
    assert taken(new) == [(15, 15, 12)]
    assert taken(new) == []


def test_the_first_node_of_a_map_waits_for_the_next_frame():
    new = with_frames(0)
    new.add_node("flat", node(0))
    assert taken(new) == []
    new.add_frame(frame(0))  # sent again: the same picture confirms nothing
    assert taken(new) == []
    new.add_frame(frame(1))
    assert taken(new) == [(0, 0, 1)]


def test_a_node_may_come_before_its_frame():
    new = with_frames(1, 2)
    new.add_node("flat", node(3))
    assert taken(new) == []
    new.add_frame(frame(3))
    assert taken(new) == [(3, 3, 1)]


def test_a_node_whose_frame_is_gone_or_of_another_robot_is_forgotten():
    new = with_frames(*range(30), kept=4)
    new.add_node("flat", node(20))
    new.add_node("flat", node(28, stamp_ns=2801))
    assert taken(new) == []
    new.add_frame(frame(20, stamp_ns=2000))
    new.add_frame(frame(28, stamp_ns=2801))
    assert taken(new) == []


def test_nodes_that_nobody_has_a_frame_of_do_not_gather():
    new = with_frames(1)
    for number in range(3, 3 + 2 * WAITING_MAX):
        new.add_node("flat", node(number))
    for number in range(2, 5):
        new.add_frame(frame(number))
    assert taken(new) == []
