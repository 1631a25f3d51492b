"""What the MCP server may be told."""

import pytest

from services.mcp.settings import McpSettings


def test_over_http_nobody_is_lent_a_token() -> None:
    with pytest.raises(ValueError, match="each program sends its own"):
        McpSettings(transport="http", token="secret of somebody")
    assert McpSettings(token="secret of somebody").transport == "stdio"


@pytest.mark.parametrize("name", ["", "../flat", "a b", "x" * 65])
def test_a_map_has_the_name_of_a_map(name: str) -> None:
    with pytest.raises(ValueError, match="map"):
        McpSettings(map=name)
