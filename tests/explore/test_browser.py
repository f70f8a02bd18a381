"""The page in a browser: sliders move the motion, clicks start one, Ctrl-C ends the server."""

import re
import shutil
import signal
import socket
import subprocess
import sys
import time

import pytest

from tests.commands import run
from tests.processes import environment

BROWSER, DRIVER = shutil.which("chromium") or shutil.which("google-chrome"), shutil.which("chromedriver")
NAME = "Bokeh.documents[0].get_model_by_name(arguments[0])"
# Places of a point of a figure's data on the screen, by Bokeh's own axes
PLACE = """
const view = Bokeh.index.find_one_by_id(Bokeh.documents[0].get_model_by_name(arguments[0]).id)
const box = view.canvas_view.el.getBoundingClientRect()
const frame = view.frame
return [box.x + frame.x_scale.compute(arguments[1]), box.y + frame.y_scale.compute(arguments[2])]
"""


def free_port():
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


def until(what, seconds=30.0):
    """The first true answer; an assertion where there is none."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if answer := what():
            return answer
        time.sleep(0.1)
    raise AssertionError("nothing came of it in time")


@pytest.fixture
def page(tmp_path):
    """A scene's page in a headless browser, and the process that serves it."""
    pytest.importorskip("bokeh")
    webdriver = pytest.importorskip("selenium.webdriver")
    if BROWSER is None or DRIVER is None:
        pytest.skip("no chromium with its chromedriver on this machine")
    opened = []

    def opener(*words):
        port = free_port()
        command = [
            sys.executable,
            "-m",
            "lcpstep.cli",
            "explore",
            *words,
            "--port",
            str(port),
            "--no-browser",
        ]
        server = subprocess.Popen(
            command, env=environment(), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
        )
        options = webdriver.ChromeOptions()
        options.binary_location = BROWSER
        for word in ("--headless=new", "--no-sandbox", "--disable-gpu", "--window-size=1400,1150"):
            options.add_argument(word)
        opened.append(server)
        assert str(port) in server.stdout.readline()
        driver = webdriver.Chrome(options=options, service=webdriver.ChromeService(DRIVER))
        opened.append(driver)
        driver.get(f"http://127.0.0.1:{port}/")
        until(lambda: driver.execute_script("return window.Bokeh && Bokeh.documents.length && !!Bokeh.index"))
        return driver, server

    yield opener
    for one in reversed(opened):
        one.quit() if hasattr(one, "quit") else one.kill()


def begin(driver):
    """Where the motion begins, by what the page draws."""
    return driver.execute_script(
        f"const d = {NAME}.renderers[0].data_source.data; return [d.q[0], d.v[0]]", "plane"
    )


def click(driver, figure, x, y):
    """Click a point of a figure, in its own units."""
    from selenium.webdriver import ActionChains

    right, down = driver.execute_script(PLACE, figure, x, y)
    body = driver.find_element("tag name", "body").rect
    chain = ActionChains(driver)
    chain.w3c_actions.pointer_action.move_to_location(round(right), round(down))
    assert 0 <= right <= body["width"]
    chain.click().perform()


def text(driver, name):
    return driver.execute_script(f"return {NAME}.text", name)


@pytest.mark.slow
def test_a_visitor_moves_a_slider_and_starts_motions_by_clicks(page, tmp_path):
    driver, server = page("impact-oscillator", "--t-end", "60")
    until(lambda: "impacts" in text(driver, "message"))
    first = begin(driver)

    click(driver, "plane", *(target := [first[0] - 0.2, first[1] + 0.3]))
    until(lambda: begin(driver) != first)
    assert begin(driver) == pytest.approx(target, abs=0.05)

    impacts = re.search(r"(\d+) impacts", text(driver, "message"))[0]
    driver.execute_script(f"const s = {NAME}; s.value = s.end / 10; s.value_throttled = s.end / 10", "omega")
    until(lambda: impacts not in text(driver, "message"))

    next(b for b in buttons(driver) if "basins" in b.text).click()
    until(lambda: "computing" not in text(driver, "attractors") and "O(" in text(driver, "attractors"))
    pixels = driver.execute_script(f"return {NAME}.renderers[0].data_source.data.image[0].length", "basin")
    assert pixels == 200 * 200

    second = begin(driver)
    click(driver, "basin", *(target := [second[0] + 0.3, second[1] - 0.2]))
    until(lambda: begin(driver) != second)
    assert begin(driver) == pytest.approx(target, abs=0.05)
    assert [line for line in driver.get_log("browser") if line["level"] == "SEVERE"] == []

    server.send_signal(signal.SIGINT)
    assert server.wait(3.0) == 130
    assert "Traceback" not in server.stderr.read()


def buttons(driver):
    """All buttons of the page, which Bokeh keeps in shadow trees."""
    return driver.execute_script(
        "const found = [], look = (root) => root.querySelectorAll('*').forEach((e) => {"
        "if (e.tagName === 'BUTTON') found.push(e); if (e.shadowRoot) look(e.shadowRoot) });"
        "look(document); return found"
    )


@pytest.mark.slow
def test_a_scene_of_many_coordinates_has_no_basin_and_names_its_curves(page):
    driver, _ = page("newtons-cradle")
    until(lambda: "impacts" in text(driver, "message"))
    assert driver.execute_script(f"return {NAME}", "basin") is None
    names = driver.execute_script(f"return {NAME}.renderers[0].data_source.data.name", "position")
    assert len(names) == len(set(names)) > 1


def test_bad_input_is_named_before_the_server_starts(capsys):
    for words, said in (
        (["nothing-known"], "unknown scene"),
        (["stick-slip-oscillator"], "has modes and no contacts"),
        (["bouncing-ball", "--set", "restitution=2"], "restitution"),
        (["bouncing-ball", "--set", "mess=2"], "unknown parameter"),
        (["bouncing-ball", "--port", "70000"], "--port: expected a number from 1 to 65535, got 70000"),
    ):
        status, _, errors = run(capsys, "explore", *words, "--no-browser")
        assert status == 2
        assert said in errors
        assert errors.count("\n") == 1


@pytest.mark.slow
def test_a_port_that_is_taken_is_named(capsys):
    pytest.importorskip("bokeh")
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        s.listen()
        port = s.getsockname()[1]
        status, _, errors = run(capsys, "explore", "bouncing-ball", "--port", port, "--no-browser")
    assert status == 2
    assert f"--port: {port} is taken" in errors
