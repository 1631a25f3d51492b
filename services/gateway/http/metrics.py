"""Counts for Prometheus, one registry per gateway so that nothing is global."""

from collections.abc import Callable, Iterable, Mapping
from functools import partial

from prometheus_client import CollectorRegistry, Counter, Gauge, Histogram, generate_latest
from prometheus_client.metrics_core import CounterMetricFamily, Metric
from prometheus_client.registry import Collector

NAMESPACE = "topnav_gateway"


class BusCounts(Collector):
    """Shows the bus's own counters: malformed messages, overflowing queues."""

    def __init__(self, snapshot: Callable[[], Mapping[str, int]]) -> None:
        self._snapshot = snapshot

    def collect(self) -> Iterable[Metric]:
        """Read the counters when somebody looks."""
        family = CounterMetricFamily(
            f"{NAMESPACE}_bus_faults", "Bus messages refused, by reason", labels=["reason"]
        )
        counts = {"malformed": 0, "overflow": 0, **self._snapshot()}
        for reason, count in sorted(counts.items()):
            family.add_metric([reason], count)
        yield family


class Metrics:
    """Everything the gateway counts."""

    def __init__(self, bus_counts: Callable[[], Mapping[str, int]]) -> None:
        self._registry = CollectorRegistry()
        self._registry.register(BusCounts(bus_counts))
        counter = partial(Counter, namespace=NAMESPACE, registry=self._registry)
        gauge = partial(Gauge, namespace=NAMESPACE, registry=self._registry)
        histogram = partial(Histogram, namespace=NAMESPACE, registry=self._registry)
        self.frames = counter("frames", "Frames seen", ["robot"])
        self.robots_ignored = counter("robots_ignored", "Messages of robots beyond the limit")
        self.uploads = counter("uploads_accepted", "Goal pictures accepted", ["format"])
        self.refused = counter("uploads_refused", "Goal pictures refused", ["reason"])
        self.missions = counter("missions", "Mission requests", ["action", "outcome"])
        self.problems = counter("problems", "Answers other than success", ["code", "status"])
        self.requests = counter("http_requests", "HTTP requests", ["method", "route", "status"])
        self.sockets_refused = counter("sockets_refused", "WebSockets refused", ["reason"])
        self.sockets_dropped = counter("sockets_dropped", "WebSockets closed by the gateway", ["reason"])
        self.records_lost = counter("mission_records_lost", "Ended missions that were not written down")
        self.sockets = gauge("sockets", "WebSockets open")
        self.runs_broken = gauge("runs_broken", "Records of runs that could not be read when last listed")
        self.asked = histogram("ask_seconds", "Time of questions on the bus", ["question"])

    def text(self) -> bytes:
        """All counts in Prometheus's text format."""
        return generate_latest(self._registry)
