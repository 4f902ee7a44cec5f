"""The report: one file, nothing loaded from elsewhere, carrying the numbers it was given."""

import re
from html import unescape
from html.parser import HTMLParser

import pytest
from fictional import HISTORY, comparison, documents
from PIL import Image
from viewer_pages import NODES, PLACE, document as viewer_document, recorded

from extras.workbench.tabs import report_policy
from viz.pages.report import Report, render, write_report
from viz.pages.words import verdict
from viz.viewer.page import render as viewer_page


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    folder = tmp_path_factory.mktemp("report")
    Image.new("RGB", (64, 40), "#123456").save(folder / "field.png")
    compare, diagnose = documents()
    value = {"name": "h.flange.right.outer", "value": 1.134, "unit": "1", "ci95": [1.021, 1.257], "prior": None}
    report = Report(
        "road <test>",
        "A fictional motor.",
        compare,
        diagnose,
        HISTORY,
        [{**value, "identified": False}],
        [comparison()],
        {"Field after an hour": folder / "field.png"},
        ["Losses as rated."],
        ["thermoscope show report CASE"],
        "today",
    )
    return write_report(report, folder / "report.html").read_text(encoding="utf-8")


class Loads(HTMLParser):
    """Collects everything a browser would fetch."""

    def __init__(self):
        super().__init__()
        self.found = []

    def handle_starttag(self, tag, attributes):
        self.found += [v for k, v in attributes if k in ("src", "href", "xlink:href", "srcset", "data", "poster") and v]
        assert tag not in ("script", "link", "iframe", "object", "embed")


class Silent(HTMLParser):
    """Counts pictures, and collects those without an alternative text of their own or of the figure they are in."""

    def __init__(self):
        super().__init__()
        self.inside, self.pictures, self.silent = [], 0, []

    def handle_starttag(self, tag, attributes):
        a = dict(attributes)
        if tag == "figure":
            self.inside.append(a.get("aria-label", "") if a.get("role") == "img" else "")
        if tag in ("img", "svg", "canvas"):
            said = a.get("alt") or next(filter(None, self.inside), "")
            self.pictures += 1
            self.silent += [] if len(said.split()) > 2 else [f"{tag} {said}"]

    def handle_endtag(self, tag):
        if tag == "figure":
            self.inside.pop()


def test_every_picture_has_an_alternative_text(page):
    read = Silent()
    read.feed(page)
    assert read.pictures > 4
    assert read.silent == []


def test_nothing_is_loaded_from_elsewhere(page):
    loads = Loads()
    loads.feed(page)
    assert loads.found
    assert [v[:60] for v in loads.found if not v.startswith(("data:", "#"))] == []
    assert re.findall(r"url\((?!#|\"#)[^)]*\)|@import", page) == []
    assert page.count("data:image/png;base64,") == 1, "pictures travel inside"


def test_it_carries_the_numbers_it_was_given(page):
    text = re.sub(r"<[^>]+>", " ", page).replace("\u00a0", " ")
    numbers = ["4.85", "0.93", "0.62", "31.4", "7.9", "12.3 W/m2/K (95 %: 10.1 … 14.6)", "1.13", "1.02", "1.26", "123"]
    numbers += ["5.07", "9.14"]
    assert [n for n in numbers if n not in text] == []


def test_the_verdict_comes_first_and_names_the_effect(page):
    body = page[page.index("<main>") :]
    assert body.index("Missing from the model: convection at flange.right") < body.index("<h2>")
    found = render(Report("a", "", None, documents()[1], finding="Found: wind. Held out 1.8 -> 0.4 K."))
    assert 0 < found.index('"good">Found: wind') < found.index("Missing from the model: "), "what was found stays first"


def test_sections_follow_the_parts_given(page):
    titles = re.findall(r"<h2>(.*?)</h2>", page)
    assert titles[:3] == ["The error, step by step", "The machine", "Measured and modelled"]
    assert "How to repeat this" in titles
    assert re.findall(r"<h2>", render(Report("empty"))) == []


def test_a_step_back_to_the_model_as_declared_has_no_bars():
    """Its errors were never written: undo in the workbench, then the report."""
    back = {**HISTORY[-1], "action": "step back", "effect": "", "words": "step back", "tests": []}
    page = render(Report("r", history=[*HISTORY, back]))
    assert "The error, step by step" in page
    assert "Last step: " not in page


def test_evidence_of_each_has_words_before_its_code():
    compare, diagnose = documents()
    one = {**diagnose["candidates"][0], "words": "wind at the flange", "decision": "cannot-tell"}
    page = render(Report("r", comparison=compare, diagnosis={**diagnose, "candidates": [one]}))
    evidence = page[page.index("Evidence of each by itself") :]
    assert f'wind at the flange<br><code class="code">{one["effect"]}</code>' in evidence
    assert "cannot tell" in evidence
    assert "cannot-tell" not in page


def test_words_from_outside_are_escaped(page):
    assert "road &lt;test&gt;" in page
    assert "road <test>" not in page


def test_ids_are_unique(page):
    ids = re.findall(r'\bid="([^"]+)"', page)
    assert len(ids) == len(set(ids))


WORDS = {
    "adequate": "yet it is off at",
    "group": "one of convection at flange.right or ",
    "several": "and",
    "outside": "near flange.right",
}
WORDS |= {"absorbed": "hide", "data": "sensors"}


@pytest.mark.parametrize("code", WORDS)
def test_every_verdict_has_its_words(code):
    compare, diagnose = documents()
    assert WORDS[code] in verdict({**diagnose, "verdict": code}, compare)[1]


def test_a_model_worse_than_no_model_is_told_first_and_what_the_fit_moved_beside_it():
    compare = documents()[0]
    plain = {"warning": "Worse than no model.", "sentence": "Held out 9 K; no model at all 3 K.", "best_K": 3.0}
    page = render(Report("own", comparison={**compare, "yardstick": plain, "strained": "The fit moved much."}))
    assert page.index("Worse than no model.") < page.index("The fit moved much.") < page.index("Held out 9 K;")
    assert "Worse than" not in render(Report("own", comparison=compare))


def test_what_contradicts_the_verdict_is_what_the_report_says():
    compare, diagnose = documents()
    check = {"check": "tests", "passed": False, "contradicts": True}
    outside = {**diagnose, "verdict": "outside", "words": "core in dusk reads 7.3 K too high", "checks": [check]}
    assert verdict(outside, compare)[1] == "Core in dusk reads 7.3 K too high."
    assert "agrees" in verdict({**diagnose, "verdict": "adequate"}, None)[1]


def test_one_cause_that_is_not_sure_is_told_as_such():
    compare, diagnose = documents()
    one = next({**c, "decision": "group"} for c in diagnose["candidates"] if c["decision"] in ("named", "group"))
    sentence = verdict({**diagnose, "verdict": "group", "candidates": [one]}, compare)[1]
    assert sentence.startswith("Perhaps missing from the model: ")
    assert sentence.endswith(". These tests cannot tell.")


def test_a_wrong_base_is_what_the_report_says_first():
    rows = [("none", True, True), ("bench", False, False), ("plate", False, False)]
    bases = [{"test": "b", "base": b, "declared": said, "excluded": out} for b, said, out in rows]
    sentence = verdict({**documents()[1], "verdict": "data", "bases": bases}, None)[1]
    assert sentence.startswith("b did not stand on the base its sheet says (none), but on bench or plate")


def told(**ahead):
    _, diagnose = documents()
    page = render(Report("a", "", None, {**diagnose, "next_tests": [], "next_sensors": [], **ahead}))
    return re.sub(r"<[^>]+>", " ", page)


def test_only_what_would_decide_is_proposed():
    spin = {"test": "spin without current", "separates": [], "predicted_gain": 3.0, "hours": 4.0}
    blower = {"test": "blower on", "separates": ["a@b / c@d"], "predicted_gain": 44.0, "hours": 4.0}
    probe = {"place": "shaft", "separates": ["a@b / c@d"], "predicted_gain": 31.0, "hours": 16.0}
    text = told(next_tests=[spin, blower], next_sensors=[probe])
    assert "What would decide" in text
    assert "blower on" in text
    assert "shaft" in text
    assert "spin" not in text
    assert "No candidate test would tell them apart" in told(next_tests=[spin])


def test_the_current_of_a_test_stands_beside_it():
    level = {"input": "current_A", "level_A": 214.25, "share_of_rms": 0.923}
    heat = {"test": "heating", "separates": ["a@b / c@d"], "predicted_gain": 44.0, "hours": 4.0, "currents": [level]}
    assert "current_A at 214.2 A, 0.92 of its rms" in told(next_tests=[heat])


def test_the_viewer_stands_in_a_frame_that_sees_nothing_of_the_page():
    inner = '<!doctype html><p title="x">&amp;</p><script>1 < 2</script>'
    text = render(Report("case", viewer=inner))
    frame = re.search(r'<iframe ([^>]*) srcdoc="([^"]*)"></iframe>', text)
    assert unescape(frame[2]) == inner
    assert 'sandbox="allow-scripts"' in frame[1]
    assert 'loading="lazy"' in frame[1]
    assert "<script" not in text.replace(frame[0], "")
    assert "<iframe" not in render(Report("case"))


@pytest.mark.heavy
def test_a_browser_draws_the_viewer_in_the_report(browser, tmp_path):
    """From disk, and with the policy under which the workbench hands the report out."""
    text = render(Report("case", viewer=viewer_page(viewer_document("motor", NODES, [recorded()], PLACE))))
    rule = f'<meta http-equiv="Content-Security-Policy" content="{report_policy()}">'.replace(
        "; frame-ancestors 'none'", ""
    )  # a page from disk cannot forbid its frames
    said = []
    for name, shown in (("plain", text), ("ruled", text.replace("<head>", f"<head>{rule}", 1))):
        file = tmp_path / f"{name}.html"
        file.write_text(shown, encoding="utf-8")
        page = browser.new_page()
        page.on("console", lambda message: said.append(message.text))
        page.goto(file.as_uri())
        page.click("summary:has-text('Turn it')")
        page.frame_locator("iframe").locator("#title:has-text('at 60 min')").wait_for()
        page.close()
    assert said == []
