"""Tables of what was judged: how runs ended, by method and class of scene, and what was found.

A report carries its counts in a comment at its end, so that those of several portions can be joined (`page`).
"""

from __future__ import annotations

import json
from collections import Counter, defaultdict
from collections.abc import Iterable
from typing import Any

import numpy as np

from benchmarks.judge.pool import Answer
from benchmarks.judge.runs import DOUBT, WAYS, silent

GOOD = ("DONE", DOUBT, "refused")
SHORT = 0.5  # by which an order seen may fall short of that of the method
COUNTS, END = "<!-- counts ", " -->"


class Tally:
    """Counts of endings and findings."""

    def __init__(self) -> None:
        self.scenes = 0
        self.ended: Counter[tuple[str, str, str]] = Counter()  # method, class of scene, ending
        self.found: Counter[tuple[str, str]] = Counter()  # method, kind
        self.orders: dict[str, list[float]] = defaultdict(list)  # seen, by method
        self.classes: dict[tuple[str, str], Counter[str]] = defaultdict(Counter)
        self.asked: list[tuple[int, int, int]] = []  # seed, first number of a scene, one beyond the last

    def add(self, answer: Answer) -> None:
        """One scene more; a kind counts once for each method on it."""
        self.scenes += 1
        family = answer.scene.family
        for method, ending in answer.endings.items():
            self.ended[method, family, ending] += 1
        for method, order in answer.orders.items():
            self.orders[method].append(order)
        for method, kind in {(x.method, x.kind) for x in answer.findings}:
            self.found[method, kind] += 1
            self.classes[method, kind][family] += 1

    def counts(self) -> dict[str, Any]:
        """Everything as lists, for `join`."""
        return {
            "scenes": self.scenes,
            "asked": self.asked,
            "ended": [[*key, n] for key, n in self.ended.items()],
            "classes": [[*key, family, n] for key, x in self.classes.items() for family, n in x.items()],
            "orders": {method: [round(x, 3) for x in seen] for method, seen in self.orders.items()},
        }

    def join(self, counts: dict[str, Any]) -> None:
        """Add the counts of other scenes."""
        self.scenes += counts["scenes"]
        self.asked += [tuple(x) for x in counts["asked"]]
        for method, family, ending, n in counts["ended"]:
            self.ended[method, family, ending] += n
        for method, kind, family, n in counts["classes"]:
            self.found[method, kind] += n
            self.classes[method, kind][family] += n
        for method, seen in counts["orders"].items():
            self.orders[method] += seen

    @property
    def methods(self) -> list[str]:
        """Methods that have run, in their usual order."""
        return [x for x in WAYS if any(method == x for method, _, _ in self.ended)]

    def count(self, method: str, family: str | None = None, ending: str | None = None) -> int:
        """Runs of a method, of one class of scene or of one ending."""
        return sum(
            n
            for (m, f, e), n in self.ended.items()
            if m == method and family in (None, f) and ending in (None, e)
        )


def table(head: Iterable[str], rows: Iterable[Iterable[object]]) -> str:
    """A table in Markdown."""
    lines = [list(map(str, head))]
    lines += [["---"] * len(lines[0])]
    lines += [list(map(str, row)) for row in rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def endings(t: Tally) -> str:
    """By method: how its runs ended."""
    found, told = Counter[str](), Counter[str]()
    for (method, kind), n in t.found.items():
        (found if silent(kind) else told)[method] += n
    early = sorted({e for _, _, e in t.ended if e not in GOOD})
    rows = [
        [m, t.count(m), *(t.count(m, None, e) for e in (*GOOD, *early)), found[m], told[m]] for m in t.methods
    ]
    return table(["method", "runs", *GOOD, *early, "anomalies in silence", "said"], rows)


def by_class(t: Tally) -> str:
    """By class of scene and method: runs that went to the end, of those that were not refused."""
    families = sorted({f for _, f, _ in t.ended})

    def cell(method: str, family: str) -> str:
        asked = t.count(method, family) - t.count(method, family, "refused")
        return f"{t.count(method, family, 'DONE')}/{asked}" if asked else ""

    return table(["scenes", *t.methods], ([f, *(cell(m, f) for m in t.methods)] for f in families))


def anomalies(t: Tally) -> str:
    """By kind and method: in how many scenes, and in which classes most."""
    rows = [
        [kind, method, n, ", ".join(f"{f} {k}" for f, k in t.classes[method, kind].most_common(4))]
        for (method, kind), n in sorted(t.found.items(), key=lambda x: (x[0][1], x[0][0]))
    ]
    return table(["anomaly", "method", "scenes", "mostly in"], rows) if rows else "No anomaly."


def orders(t: Tally) -> str:
    """By method of steps of one size: the order of its error at the first looks at which that is clear."""
    rows = []
    for m in (m for m in t.methods if t.orders[m]):
        seen = np.array(t.orders[m])
        low, middle, high = np.percentile(seen, [10, 50, 90])
        less = int(np.sum(seen < WAYS[m].order - SHORT))
        rows.append([m, len(seen), f"{middle:.2f}", f"{low:.2f} to {high:.2f}", less])
    head = ["order seen", "runs", "median", "eight of ten", f"less than the method's by {SHORT}"]
    return table(head, rows) if rows else "No order was seen."


def report(t: Tally) -> str:
    """All tables."""
    return "\n\n".join([f"{t.scenes} scenes.", endings(t), by_class(t), orders(t), anomalies(t)])


def saved(t: Tally) -> str:
    """All tables, and the counts that they are made of."""
    return f"{report(t)}\n\n{COUNTS}{json.dumps(t.counts(), separators=(',', ':'))}{END}\n"


def joined(reports: Iterable[str]) -> Tally:
    """What several reports, as `saved` makes them, say together."""
    t = Tally()
    for text in reports:
        if COUNTS not in text:
            raise ValueError("a report without counts; expected what --report has written")
        t.join(json.loads(text.split(COUNTS)[1].split(END)[0]))
    return t
