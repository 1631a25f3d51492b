"""The gateway: HTTP, WebSocket and the web page in front of the bus."""
