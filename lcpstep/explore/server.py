"""The page on this machine: Bokeh's server at 127.0.0.1, with all that it shows served from here."""

from __future__ import annotations

import errno
from collections.abc import Callable
from typing import Any

from bokeh.application import Application
from bokeh.application.handlers.function import FunctionHandler
from bokeh.server.server import Server

from lcpstep.explore.page import Page
from lcpstep.explore.session import Session

HOST = "127.0.0.1"


def server(session: Callable[[], Session], parameters: dict[str, Any], title: str, port: int) -> Server:
    """A server that gives every visitor a session of its own; it does not run yet.

    Raises
    ------
    ValueError   the port is taken
    """

    def visited(document: Any) -> None:
        page = Page(session(), parameters, document)
        document.title = f"lcpstep: {title}"
        document.add_root(page.roots)

    try:
        return Server(
            {"/": Application(FunctionHandler(visited))}, port=port, address=HOST, num_procs=1,
            allow_websocket_origin=[f"{name}:{port}" for name in (HOST, "localhost")],
        )  # fmt: skip
    except OSError as error:
        if error.errno != errno.EADDRINUSE:
            raise
        raise ValueError(f"--port: {port} is taken by another program; expected a free one") from error
