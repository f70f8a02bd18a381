"""Classes of anomalies that are known and not mended yet, by method; a class that no longer happens is taken out."""

LOG = "log out of order"  # the end of a chattering sequence is logged before earlier events of other contacts
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
    "event-driven": frozenset({LOG, "negative impulse", "penetration"}),
    "event-driven-loose": frozenset({LOG, MISSED, "negative impulse", "penetration"}),
    "located": frozenset({LOG, HANG, SLOW, "penetration", "impulse while open", IN_TWO}),
    "located-4": frozenset(
        {LOG, HANG, SLOW, NO_STATES, "penetration", "impulse while open", IN_TWO, OTHER_KEEP, OTHER_TIME}
    ),
    "located-exact": frozenset({LOG, HANG, SLOW, NO_STATES, IN_TWO}),
    "located-tolerance": frozenset({LOG, HANG, SLOW, LAW}),
    "located-4-tolerance": frozenset({LOG, LAW}),
    "moreau": frozenset({NO_STATES}),
    "moreau-tolerance": frozenset({OTHER_EVENTS}),
}
