"""A film as a piece of a web page: its pictures, a button and a slider, and nothing from elsewhere."""

from __future__ import annotations

import base64
import json
import uuid
from collections.abc import Sequence

TEMPLATE = """<div id="NAME" style="display:inline-block">
<img alt="film of the motion"><br>
<button type="button">pause</button>
<input type="range" min="0" max="LAST" value="0" style="width:75%" aria-label="picture">
<script>
(function () {
  const pictures = PICTURES, root = document.getElementById("NAME");
  const image = root.querySelector("img"), slider = root.querySelector("input");
  const button = root.querySelector("button");
  let at = 0, playing = true;
  function show(k) { at = k; slider.value = k; image.src = "data:image/png;base64," + pictures[k]; }
  slider.oninput = function () { playing = false; button.textContent = "play"; show(Number(slider.value)); };
  button.onclick = function () { playing = !playing; button.textContent = playing ? "pause" : "play"; };
  show(0);
  const timer = setInterval(function () {
    if (!document.contains(root)) { clearInterval(timer); } else if (playing) { show((at + 1) % pictures.length); }
  }, DELAY);
})();
</script></div>"""


def page(pictures: Sequence[bytes], fps: int) -> str:
    """Pictures (PNG) as a film that plays by itself, so many a second."""
    texts = json.dumps([base64.b64encode(picture).decode() for picture in pictures])
    filled = TEMPLATE.replace("NAME", f"film-{uuid.uuid4().hex[:8]}").replace("LAST", str(len(pictures) - 1))
    return filled.replace("DELAY", str(round(1000 / fps))).replace("PICTURES", texts)
