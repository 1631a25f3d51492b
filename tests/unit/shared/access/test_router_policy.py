"""The rules of the router: made from the table, nothing allowed by wildcard that the table does not name."""

import pytest

from shared import topics
from shared.access.router_policy import IN, OUT, access_control, permissions
from shared.access.rules import Role


def keys(role: Role, flow: str, kind: str, robot: str = "r1") -> set[str]:
    """Keys on which this kind of message may pass."""
    return {k for p in permissions(role, robot) if p.flow == flow and kind in p.kinds for k in p.keys}


def test_a_drive_service_commands_its_own_robot_only():
    assert keys(Role.DRIVE, IN, "put", "r2") == {
        "topnav/r2/velocity",
        "topnav/r2/stopped",
    }
    assert keys(Role.DRIVE, OUT, "put", "r2") == {
        "topnav/r2/heading",
        "topnav/r2/manual",
        "topnav/r2/odometry",
        "topnav/r2/ranges",
        "topnav/r2/standing",
    }


def test_what_may_not_be_subscribed_to_is_not_delivered_either():
    for role in Role:
        assert keys(role, IN, "declare_subscriber") == keys(role, OUT, "put")


def test_a_viewer_puts_asks_and_answers_nothing_but_what_recovers_lost_deltas():
    recovery = {"topnav/maps/*/delta/@adv/**"}
    for kind in ("put", "delete", "declare_queryable", "reply"):
        assert keys(Role.VIEWER, IN, kind) == set()
    assert keys(Role.VIEWER, IN, "query") == recovery
    assert keys(Role.VIEWER, IN, "liveliness_token") == {"topnav/alive/viewer/*"}


def test_recovered_topics_have_their_cache_below_their_own_key():
    assert topics.MAP_DELTA.key(map="*") + "/@adv/**" in keys(Role.MAP_STORE, IN, "declare_queryable")
    assert topics.MAP_DELTA.key(map="*") in keys(Role.MAP_STORE, IN, "reply")
    assert topics.MAP_DELTA.key(map="*") + "/@adv/**" not in keys(Role.PLANNER, IN, "put")


def test_nobody_claims_to_be_another_service():
    for role in Role:
        mine = {k for k in keys(role, IN, "liveliness_token") if k.startswith("topnav/alive/")}
        service = "ros" if role is Role.ROBOT else role.value
        assert mine <= {f"topnav/alive/{service}/*", "topnav/alive/robot/r1/*"}
    assert "topnav/alive/robot/r1/*" not in keys(Role.DRIVE, IN, "liveliness_token")


def test_no_rule_reaches_beyond_one_stream():
    for rule in access_control(["r1", "r2"])["rules"]:
        assert rule["permission"] == "allow"
        for key in rule["key_exprs"]:
            assert key.startswith("topnav/")
            assert "**" not in key.removesuffix("/@adv/**"), key


def test_everybody_is_denied_by_default_and_known_by_one_common_name():
    section = access_control(["r1", "r2"])
    assert section["enabled"] is True
    assert section["default_permission"] == "deny"
    names = [name for subject in section["subjects"] for name in subject["cert_common_names"]]
    assert len(names) == len(set(names))
    assert {"drive.r1", "drive.r2", "map_store", "viewer"} <= set(names)
    assert "drive" not in names


def test_a_router_without_robots_or_with_a_bad_name_is_refused():
    with pytest.raises(ValueError, match="at least one robot"):
        access_control([])
    with pytest.raises(ValueError, match="a robot's name must match"):
        access_control(["r1", "*"])
