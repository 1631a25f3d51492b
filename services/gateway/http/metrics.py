"""Counts for Prometheus, one registry per gateway so that nothing is global."""

from collections.abc import Callable, Iterable, Mapping

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
        self.frames = self._counter("frames", "Frames seen", "robot")
        self.robots_ignored = self._counter("robots_ignored", "Messages of robots beyond the limit")
        self.uploads = self._counter("uploads_accepted", "Goal pictures accepted", "format")
        self.refused = self._counter("uploads_refused", "Goal pictures refused", "reason")
        self.missions = self._counter("missions", "Mission requests", "action", "outcome")
        self.problems = self._counter("problems", "Answers other than success", "code", "status")
        self.requests = self._counter("http_requests", "HTTP requests", "method", "route", "status")
        self.sockets_refused = self._counter("sockets_refused", "WebSockets refused", "reason")
        self.sockets_dropped = self._counter("sockets_dropped", "WebSockets closed by the gateway", "reason")
        self.records_lost = self._counter("mission_records_lost", "Ended missions that were not written down")
        self.sockets = self._gauge("sockets", "WebSockets open")
        self.runs_broken = self._gauge(
            "runs_broken", "Records of runs that could not be read when last listed"
        )
        self.asked = Histogram(
            "ask_seconds",
            "Time of questions on the bus",
            ["question"],
            namespace=NAMESPACE,
            registry=self._registry,
        )

    def text(self) -> bytes:
        """All counts in Prometheus's text format."""
        return generate_latest(self._registry)

    def _gauge(self, name: str, help_text: str) -> Gauge:
        return Gauge(name, help_text, namespace=NAMESPACE, registry=self._registry)

    def _counter(self, name: str, help_text: str, *labels: str) -> Counter:
        return Counter(name, help_text, labels, namespace=NAMESPACE, registry=self._registry)
