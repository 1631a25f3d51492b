"""The files in deploy/zenoh and the routers of the Compose file are the same."""

import zenoh

from shared.transport.router_config import router_config
from shared.transport.router_file import router_config_of_the_file, router_file


def test_the_file_for_a_stock_router_says_what_ours_does(repository):
    file = zenoh.Config.from_file(str(repository / "deploy/zenoh/router.json5"))
    ours = router_config("tcp/127.0.0.1:7447")
    assert str(file) == str(ours)


def test_the_secured_file_for_a_stock_router_says_what_ours_does(repository):
    path = repository / "deploy/zenoh/router-secure.json5"
    assert path.read_text(encoding="utf-8") == router_file(), "run 'python -m shared.transport.router_file'"
    assert str(zenoh.Config.from_file(str(path))) == str(router_config_of_the_file())
