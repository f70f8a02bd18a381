"""What a fresh process pays, call by call; prints seconds as JSON. Started by `first_use`."""

import importlib.util
import json
import sys
import time

CLOCK = time.perf_counter


def main() -> None:
    """Import, then each kind of run twice; the argument is a file like `user_scene.py`."""
    seconds = {}
    begin = CLOCK()
    import lcpstep  # noqa: F401

    seconds["import lcpstep"] = CLOCK() - begin
    from lagrangian import scenes
    from lcpstep import EventDriven, Moreau, simulate

    spec = importlib.util.spec_from_file_location("a_users_scene", sys.argv[1])
    user = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(user)
    for name, make in {
        "cam": scenes.cam_follower,
        "linear": user.linear,
        "nonlinear": user.nonlinear,
    }.items():
        scene = make(t_end=0.1)
        for method in (Moreau(h=1e-4), EventDriven()):
            for call in ("first", "second"):
                begin = CLOCK()
                simulate(scene, method)
                seconds[f"{type(method).__name__}, {name}, {call}"] = CLOCK() - begin
    print(json.dumps(seconds))


if __name__ == "__main__":
    main()
