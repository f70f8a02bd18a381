"""`lcpstep explore`: a scene on a local page, with sliders and a basin to click into."""

from __future__ import annotations

import argparse
import importlib.util
import webbrowser
from collections.abc import Mapping
from typing import Any

from lagrangian import Scene
from lcpstep.cli.common import DONE, arguments_of, made_scene, scene_arguments, scene_with_contacts
from lcpstep.errors import LcpStepError

METHODS = ("located", "event-driven", "moreau")
PORTS = 65535


def add(commands: Any) -> None:
    """Arguments of the command."""
    p = commands.add_parser(
        "explore",
        help="a scene on a local page: sliders, time series, state space, impacts, basins",
        description="Opens a page in the browser, served from this machine to this machine alone: sliders for the "
        "scene's parameters, positions and velocities over time, state space, impacts, and, for one coordinate under "
        "periodic forcing, basins of attraction. A click into state space or basins starts a motion there. Ctrl-C "
        'ends it. Needs Bokeh: pip install "lcpstep[explore]".',
        epilog="Example: lcpstep explore cam-follower --set rpm=660",
    )
    scene_arguments(p)
    p.add_argument("--method", choices=METHODS, default="located", help="to begin with (located)")
    p.add_argument("--port", type=int, default=5006, help="of the page's address (5006)")
    p.add_argument("--no-browser", action="store_true", help="print the address only")
    p.set_defaults(run=run_explore)


def run_explore(options: argparse.Namespace) -> int:
    """`lcpstep explore`."""
    scene = scene_with_contacts(options)
    if not 0 < options.port <= PORTS:
        raise ValueError(f"--port: expected a number from 1 to {PORTS}, got {options.port}")
    if importlib.util.find_spec("bokeh") is None:
        raise LcpStepError('explore needs Bokeh, which is not installed: pip install "lcpstep[explore]"')
    from lcpstep.explore.server import HOST, server
    from lcpstep.explore.session import Session

    values = arguments_of(options, scene)

    def make(changed: Mapping[str, Any], t_end: float | None) -> Scene:
        return made_scene(options.scene, {**values, **changed}, t_end)

    def session() -> Session:
        return Session(make, t_end=options.t_end, method=options.method)

    page = server(session, values, scene.name, options.port)
    address = f"http://{HOST}:{options.port}/"
    page.start()
    print(f"{address} shows {scene.name}; Ctrl-C ends it", flush=True)
    if not options.no_browser:
        page.io_loop.add_callback(webbrowser.open, address)
    page.io_loop.start()
    return DONE
