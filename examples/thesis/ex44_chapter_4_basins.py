"""Chapter 4: two motions of one cam, and their basins
===================================================

At 358.5 rpm the follower ends in one of two stable motions: O(1, 2), which strikes twice a turn, or O(3, 8),
eight times in three turns. Every point of the picture is a start; its colour says where it ends. Basins are
found by carrying whole cells on from turn to turn; single starts, followed to their end, say how far to trust
them.

Source: G. Osorio, Complex Behavior in Impacting Systems, Figs 4.10 and 4.11.
"""

from lagrangian import scenes
from lcpstep.analysis.basins import basins
from lcpstep.plot.basins import basins as drawn


def shares(cells: int = 240):
    """The basins over a rectangle of absolute positions and velocities, in so many cells each way."""
    scene = scenes.cam_follower(rpm=358.5, coordinates="absolute")
    return basins(scene, [0.1, -60.0], [1.6, 60.0], (cells, cells), sample=400, jobs=1)


if __name__ == "__main__":
    found = shares()
    for name, share in zip(found["name"].values, found["share"].values, strict=True):
        print(f"{name}: {100.0 * share:.1f} % of all starts")
    drawn(found, "cam-follower at 358.5 rpm: where motions end").savefig("chapter-4-basins.png", dpi=90)
