"""Suites of rounds: every world, several profiles, in parallel, on this machine or on a cluster."""
