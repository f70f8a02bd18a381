"""What accuracy costs
===================

Error over CPU time and over the step: a study of three methods on an oscillator that strikes a stop. Orders are
fitted with their uncertainty: one, two and four. Times are those of the machine on which this page was made.

Source of the form: E. Hairer, G. Wanner, Solving Ordinary Differential Equations II (Springer 1996), IV.10.
"""

from lcpstep.analysis.work_precision import Study

from lagrangian import scenes
from lcpstep import Located, Moreau, study
from lcpstep.plot.work_precision import work_precision


def small_study() -> Study:
    """Four steps for each method; each the mean over some nearby ones."""
    methods = [Moreau(), Located(), Located(order=4)]
    return study(scenes.impact_oscillator(t_end=10.0), methods, h=[3e-2, 1e-2, 3e-3, 1e-3])


def orders(found: Study) -> list[float]:
    """Fitted orders of the error of the position."""
    return [found.order(name, "sup_position").value for name in found.methods]


if __name__ == "__main__":
    found = small_study()
    print("orders of the position:", {name: str(found.order(name, "sup_position")) for name in found.methods})
    work_precision(found, ["sup_position", "impact_time"]).savefig("work-precision.png", dpi=80)
