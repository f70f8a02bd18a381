"""Classes of anomalies that are known and not mended yet, by method; a class that no longer happens is taken out."""

LOG = "log out of order"  # the end of a chattering sequence is logged before earlier events of other contacts
HANG, SLOW = "hang", "slow"  # contacts that alternate at one instant
NO_STATES = "no states between"  # at() of unfinished runs; last states lost far from t = 0
MISSED = "tolerance missed"
OTHER_TIME = "other: shifted in time"

OPEN: dict[str, frozenset[str]] = {
    "event-driven": frozenset({LOG, "negative impulse", "penetration"}),
    "event-driven-loose": frozenset({LOG, MISSED, "negative impulse", "penetration"}),
    "located": frozenset({LOG}),
    "located-4": frozenset({LOG}),
    "located-exact": frozenset({LOG}),
    "located-tolerance": frozenset({LOG, HANG, SLOW, MISSED, "wrong span"}),
    "located-4-tolerance": frozenset(
        {LOG, HANG, SLOW, NO_STATES, MISSED, "wrong span", "impulse while open", OTHER_TIME}
    ),
    "moreau": frozenset(),
    "moreau-tolerance": frozenset({LOG, HANG, MISSED}),
}
