"""A robot for programs that speak the Model Context Protocol: tools over the gateway, never the bus."""
