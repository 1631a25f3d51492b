"""Commands about one robot: its camera, driving by hand, the emergency stop, whether it is well."""
