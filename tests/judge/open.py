"""Classes of anomalies that are known and not mended yet, by method; a class that no longer happens is taken out."""

HANG, SLOW = "hang", "slow"  # contacts that alternate at one instant; by a tolerance, a loop in plain Python
LAW = "law of impact"  # collapses that are settled while one of several contacts is still fast
NO_STATES = "no states between"  # at() of unfinished runs; last states lost far from t = 0
IN_TWO, OTHER_END = "other: span in two parts", "other: another end"
MISSED = "tolerance missed"
OTHER_EVENTS = (
    "other events: another end"  # several contacts struck at once, where the law of impact leaves a choice
)
OTHER_KEEP, OTHER_TIME = "other: keep=times", "other: shifted in time"

OPEN: dict[str, frozenset[str]] = {
    "event-driven": frozenset({"penetration"}),
    "event-driven-loose": frozenset({MISSED, "penetration"}),
    "located": frozenset({HANG, SLOW, "penetration", "impulse while open", IN_TWO}),
    "located-4": frozenset(
        {HANG, SLOW, NO_STATES, "penetration", "impulse while open", IN_TWO, OTHER_KEEP, OTHER_TIME}
    ),
    "located-exact": frozenset({HANG, SLOW, NO_STATES, IN_TWO}),
    "located-tolerance": frozenset({HANG, SLOW, LAW}),
    "located-4-tolerance": frozenset({LAW}),
    "moreau": frozenset({NO_STATES}),
    "moreau-tolerance": frozenset({OTHER_EVENTS}),
}
