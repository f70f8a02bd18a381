"""Classes of anomalies that are known and not mended yet, by method."""

OPEN: dict[str, frozenset[str]] = {}
