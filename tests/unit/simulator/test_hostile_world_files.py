"""World files of strangers: whatever they hold, they load or end in a WorldFileError, and soon."""

import copy
import inspect
import time

import pytest
import yaml
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from simulator.furniture.catalogue import FURNITURE
from simulator.world.world_file import WorldFileError, load_world
from tests.yaml_bomb import BOMB

LEAVES = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(),
    st.floats(),
    st.text(max_size=8),
    st.sampled_from(
        [-1, 0, 1e300, 10**30, "", "sofa", "mesh", "../../etc/passwd", "plaster", 1e-300, [], {}]
    ),
)
VALUES = st.recursive(
    LEAVES,
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=5), inner, max_size=3),
    max_leaves=6,
)


def places(data, at=()):
    """Every path into nested data."""
    yield at
    items = data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ()
    for key, value in items:
        yield from places(value, (*at, key))


def with_value(data, path, value):
    if not path:
        return value
    changed = copy.deepcopy(data)
    target = changed
    for key in path[:-1]:
        target = target[key]
    target[path[-1]] = value
    return changed


def load(folder, data):
    file = folder / "w.yaml"
    file.write_text(data if isinstance(data, str) else yaml.dump(data), encoding="utf-8")
    return load_world(str(file))


def survives(folder, data):
    """Load; what is not accepted must be a WorldFileError that names the file and fits on a screen."""
    try:
        load(folder, data)
    except WorldFileError as error:
        fault = str(error)
    else:
        return
    assert "w.yaml" in fault
    assert len(fault) < 4000


LIMITED = settings(
    max_examples=120,
    deadline=None,
    derandomize=True,
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow],
)


@LIMITED
@given(st.data())
def test_a_wrong_value_anywhere_is_refused_by_name(tmp_path, room_data, data):
    path = data.draw(st.sampled_from(list(places(room_data))))
    survives(tmp_path, with_value(room_data, path, data.draw(VALUES)))


@LIMITED
@given(st.data())
def test_a_wrong_value_in_groups_and_their_copies_is_refused_by_name(tmp_path, room_data, data):
    group = [{"name": "seat", "kind": "pouf", "at_m": [1, 1], "options": {"radius_m": 0.2}}]
    changed = {"seat": {"seed": 2, "options": {"height_m": 0.3}}}
    copies = [{"group": "corner", "name": "a", "at_m": [2, 2], "yaw_deg": 90, "changed": changed}]
    whole = {"groups": {"corner": group}, "placed": copies}
    path = data.draw(st.sampled_from(list(places(whole))))
    survives(tmp_path, {**room_data, **with_value(whole, path, data.draw(VALUES))} if path else room_data)


@LIMITED
@given(st.data())
def test_any_furniture_with_any_options_is_built_or_refused(tmp_path, room_data, data):
    kind = data.draw(st.sampled_from(sorted(FURNITURE)))
    known = FURNITURE[kind].options()
    names = st.sampled_from(known) if known else st.text(max_size=4)
    item = {"kind": kind, "at_m": [3, 2], "options": data.draw(st.dictionaries(names, VALUES, max_size=3))}
    survives(tmp_path, with_value(room_data, ("furniture",), [item]))


def fitting(default):
    """Values of an option's type, however foolish."""
    if isinstance(default, bool) or default is inspect.Parameter.empty or default is None:
        return st.none() | st.booleans()
    if isinstance(default, int):
        return st.integers(-2, 40) | st.just(1000)
    if isinstance(default, float):
        return st.sampled_from([0.0, 1e-9, 0.01, 0.3, 1.0, 7.0, 300.0, 1000.0, -0.5])
    if isinstance(default, tuple):
        return st.lists(st.integers(-1, 256), min_size=len(default), max_size=len(default))
    return st.just(default)


@LIMITED
@given(st.data())
def test_foolish_sizes_and_counts_are_built_or_refused(tmp_path, room_data, data):
    kind = data.draw(st.sampled_from(sorted(FURNITURE)))
    known = inspect.signature(FURNITURE[kind].function).parameters
    choice = {name: fitting(known[name].default) for name in FURNITURE[kind].options()}
    options = data.draw(st.fixed_dictionaries({}, optional=choice))
    survives(
        tmp_path, with_value(room_data, ("furniture",), [{"kind": kind, "at_m": [3, 2], "options": options}])
    )


@LIMITED
@given(st.binary(max_size=120))
def test_any_bytes_are_refused(tmp_path, content):
    (tmp_path / "w.yaml").write_bytes(content)
    with pytest.raises(WorldFileError, match=r"w\.yaml"):
        load_world(str(tmp_path / "w.yaml"))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        pytest.param(BOMB, "at most 200000 values", id="references that multiply"),
        pytest.param("a: &a [*a]", "refers to what it is a part of", id="a reference to itself"),
        pytest.param("[" * 100_000, "deep|valid YAML", id="deep nesting"),
        pytest.param("name: a\nname: b", "line 2: 'name' is there twice", id="a key twice"),
        pytest.param("a: 2026-99-99", "a value cannot be read", id="no date"),
        pytest.param("a: !!python/object/apply:os.getcwd []", "not valid YAML", id="code"),
        pytest.param("{[1]: 2}", "not valid YAML|mapping", id="a list as key"),
        pytest.param("a: '\u0000'", "not valid YAML", id="a character that YAML forbids"),
        pytest.param("---\na: 1\n---\nb: 2", "not valid YAML", id="two documents"),
        pytest.param("x" * 2_100_000, "at most 2000000 bytes", id="too long"),
    ],
)  # fmt: skip
def test_traps_of_yaml_are_refused_within_a_second(tmp_path, text, message):
    began_s = time.thread_time()
    with pytest.raises(WorldFileError, match=message):
        load(tmp_path, text)
    assert time.thread_time() - began_s < 2.0


@pytest.mark.parametrize(
    ("path", "value", "message"),
    [
        (("rooms", 0, "x_m"), [0, 400], "at most 250 m wide"),
        (("rooms", 0, "x_m"), [0, 1e9], "less than or equal to 500"),
        (("wall_height_m",), 1e6, "wall_height_m"),
        (("rooms", 0, "floor", "tile_m"), 1e-9, "tile_m"),
        (("furniture",), [{"kind": "rug", "at_m": [1, 1]}] * 3001, "furniture.*at most 3000"),
        (("furniture", 0, "options"), {"length_m": float("nan")}, "length_m: must be a number within"),
        (("furniture", 0, "options"), {"length_m": 1e12}, r"within \+-1000"),
        (("furniture", 0, "options"), {"length_m": -3.0}, "length_m: must be a length of 0 to 100 m"),
        (("furniture", 0, "options"), {"colour": [1, 2, 3, 4]}, "colour"),
        (("furniture", 0, "seed"), -1, "seed"),
        (("furniture", 0, "seed"), 2**70, "seed"),
    ],
)  # fmt: skip
def test_what_no_world_needs_is_refused_by_name(tmp_path, room_data, path, value, message):
    with pytest.raises(WorldFileError, match=message):
        load(tmp_path, with_value(room_data, path, value))


def test_references_and_merges_that_are_harmless_work(tmp_path, room_data):
    text = yaml.dump(room_data)  # PyYAML writes the shared paint as a reference
    assert "&id" in text
    assert load(tmp_path, text).rooms[0].walls == load(tmp_path, text).rooms[0].floor
