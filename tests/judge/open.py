"""Classes of anomalies that are known and not mended yet, by method; a class that no longer happens is taken out."""

MISSED = "tolerance missed"
OTHER_EVENTS = (
    "other events: another end"  # several contacts struck at once, where the law of impact leaves a choice
)

OPEN: dict[str, frozenset[str]] = {
    "event-driven": frozenset(),
    "event-driven-loose": frozenset({MISSED}),
    "located": frozenset(),
    "located-4": frozenset(),
    "located-exact": frozenset(),
    "located-tolerance": frozenset(),
    "located-4-tolerance": frozenset(),
    "moreau": frozenset(),
    "moreau-tolerance": frozenset({OTHER_EVENTS}),
}
