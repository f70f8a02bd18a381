"""How much of the ready scenes' event-driven runs is certified: `python -m benchmarks.audit.catalogue`."""

from __future__ import annotations

from lagrangian import Scene, scenes
from lcpstep import EventDriven, simulate
from lcpstep.audit import Audit, audit


def audits() -> dict[str, Audit]:
    """The audit of every scene of the catalogue, by its name."""
    made = {name: entry.make() for name, entry in scenes.CATALOGUE.items()}
    return {name: audit(simulate(x, EventDriven())) for name, x in made.items() if isinstance(x, Scene)}


def main() -> None:
    """Print a table of scenes that are not certified as a whole, and the sum of all."""
    found = audits()
    print("| scene | flights | certified | share of the span | why not |")
    print("|---|---|---|---|---|")
    for name, x in found.items():
        why = "; ".join(sorted({w.why for w in x.windows}))
        if x.share < 1.0 - 1e-12 or x.certified < x.flights:
            print(f"| `{name}` | {x.flights} | {x.certified} | {100.0 * x.share:.4g} % | {why} |")
    flights, certified = (sum(getattr(x, key) for x in found.values()) for key in ("flights", "certified"))
    print(f"| all {len(found)} | {flights} | {certified} ({100.0 * certified / flights:.5g} %) | | |")


if __name__ == "__main__":
    main()
