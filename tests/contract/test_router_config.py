"""deploy/zenoh/router.json5 and the router of the Compose file are the same."""

import zenoh

from shared.bus_config import router_config


def test_the_file_for_a_stock_router_says_what_ours_does(repository):
    file = zenoh.Config.from_file(str(repository / "deploy/zenoh/router.json5"))
    ours = router_config("tcp/127.0.0.1:7447")
    assert str(file) == str(ours)
