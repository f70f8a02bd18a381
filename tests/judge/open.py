"""Classes of anomalies that are known and not mended yet, by method; a class that no longer happens is taken out."""

HANG, SLOW = "hang", "slow"  # contacts that alternate at one instant
NO_STATES = "no states between"  # at() of unfinished runs; last states lost far from t = 0
IN_TWO, OTHER_END = "other: span in two parts", "other: another end"
MISSED = "tolerance missed"
OTHER_KEEP, OTHER_TIME = "other: keep=times", "other: shifted in time"

OPEN: dict[str, frozenset[str]] = {
    "event-driven": frozenset({"penetration"}),
    "event-driven-loose": frozenset({MISSED, "penetration"}),
    "located": frozenset({HANG, SLOW, "penetration", "impulse while open", IN_TWO}),
    "located-4": frozenset(
        {HANG, SLOW, NO_STATES, "penetration", "impulse while open", IN_TWO, OTHER_KEEP, OTHER_TIME}
    ),
    "located-exact": frozenset({HANG, SLOW, NO_STATES, IN_TWO}),
    "located-tolerance": frozenset({HANG, SLOW, MISSED, "wrong span"}),
    "located-4-tolerance": frozenset(
        {HANG, SLOW, NO_STATES, MISSED, "wrong span", "impulse while open", OTHER_TIME}
    ),
    "moreau": frozenset({NO_STATES}),
    "moreau-tolerance": frozenset({HANG, MISSED}),
}
