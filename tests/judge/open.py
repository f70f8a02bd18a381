"""Classes of anomalies that are known and not mended yet, by method; a class that no longer happens is taken out."""

HANG, SLOW = "hang", "slow"  # by a tolerance, a loop in plain Python
LAW = "law of impact"  # collapses that are settled while one of several contacts is still fast
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
    "located-tolerance": frozenset({HANG, SLOW, LAW}),
    "located-4-tolerance": frozenset({LAW}),
    "moreau": frozenset(),
    "moreau-tolerance": frozenset({OTHER_EVENTS}),
}
