"""The viewer in Firefox, where it is installed: drawn, played, painted, and nothing on the console."""

import asyncio
import shutil

import pytest
from firefox import firefox
from viewer_pages import NODES, PLACE, document, mapped

from viz.viewer.page import render

FIREFOX = shutil.which("firefox") or shutil.which("firefox-esr")
pytestmark = [
    pytest.mark.nightly,
    pytest.mark.skipif(
        FIREFOX is None or shutil.which("xvfb-run") is None,
        reason="needs Firefox and a screen: apt-get install -y firefox-esr xvfb xauth",
    ),
]
DRAWN = """new Promise((done, failed) => {
  const fault = document.getElementById("fault");
  const look = () => window.viewer && viewer.frames > 0 ? done(true)
    : fault.hidden ? setTimeout(look, 100) : failed(fault.textContent);
  look();
})"""
TOLD = """new Promise((done) => {  // what the first picture does without
  const look = () => $("layer").options[3].disabled ? setTimeout(look, 100) : done(true);
  look();
})"""
COLOURS = """(() => {  // how many colours the machine has on the screen
  const gl = viewer.gl, [w, h] = [gl.drawingBufferWidth, gl.drawingBufferHeight], out = new Uint8Array(4 * w * h);
  gl.readPixels(0, 0, w, h, gl.RGBA, gl.UNSIGNED_BYTE, out);
  const seen = new Set();
  for (let i = 0; i < out.length; i += 4) seen.add(out[i] + 256 * out[i + 1] + 65536 * out[i + 2]);
  return seen.size;
})()"""


def test_firefox_draws_it_without_complaint(tmp_path):
    page, profile = tmp_path / "viewer.html", tmp_path / "profile"
    profile.mkdir()
    (profile / "user.js").write_text('user_pref("webgl.force-enabled", true);')  # a computer without a graphics card
    page.write_text(render(document("motor", NODES, [mapped()], PLACE)), encoding="utf-8")

    async def walk():
        async with firefox(FIREFOX, profile) as tab:
            await tab.open(page.as_uri())
            assert await tab.evaluate(DRAWN)
            assert await tab.evaluate(COLOURS) > 100
            assert "at 60 min" in await tab.evaluate("$('title').textContent")
            assert await tab.evaluate("viewer.pick($('gl').clientWidth * 0.45, $('gl').clientHeight * 0.5).name")
            await tab.evaluate("viewer.move(0)")
            assert await tab.evaluate(TOLD)
            await tab.evaluate("$('layer').value = '3'; $('layer').onchange()")
            assert await tab.evaluate("$('unit').textContent") == "K"
            assert "at 0 min" in await tab.evaluate("$('title').textContent")
            return tab.said

    assert asyncio.run(walk()) == []
