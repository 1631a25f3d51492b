"""The mission's view of other services: map store, feature service and the rights of way of a fleet."""
