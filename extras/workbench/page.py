"""The page of a tab: page.html is its template (Vue and Vuetify). All of it works by keyboard."""

from collections.abc import Callable
from html import escape
from importlib.resources import files
from typing import Any

from trame.ui.vuetify3 import VAppLayout
from trame.widgets import client, trame as extra
from trame_plotly import module as plotly

from extras.workbench.session import Session, started
from thermoscope import plugin as th

KEYS = (("j", "next"), ("k", "previous"), ("d", "diagnose"), ("u", "undo"), ("r", "report"))
BROWSER = ("drop", "machine", "plots")  # scripts of the page


def draw(session: Session) -> None:
    """Build the page; afterwards only the state changes."""
    template, css = (
        files("extras.workbench").joinpath(f"page.{end}").read_text(encoding="utf-8") for end in ("html", "css")
    )
    server, acts = session.shown.server, actions(session)
    # What the page runs besides its template, from this package and nowhere else
    code = str(files("extras.workbench").joinpath("browser"))
    session.shown.server.enable_module(
        {"serve": {"__thermoscope": code, **plotly.serve}, "scripts": [f"__thermoscope/{name}.js" for name in BROWSER]}
    )
    session.state.plotly = plotly.scripts[0]  # plots.js loads it
    session.state.trame__title = f"thermoscope: {session.state.case_name}"
    for name, act in acts.items():
        server.controller.trigger(name)(act)
    with VAppLayout(server, theme=("dark ? 'dark' : 'light'",)) as layout:
        client.Style(css)
        trap = extra.MouseTrap(**{name: acts[name] for _, name in KEYS})  # plain Tab and Enter work without it
        for key, name in KEYS:
            trap.bind(key, name)
        layout.root.add_child(template.replace("@RULE@", escape(th.RULE)))


def actions(session: Session) -> dict[str, Callable[..., Any]]:
    """What the page asks for, by its name in the template."""
    return {
        "pick": lambda name: session.shown.select(str(name)),
        "next": lambda: session.shown.next_sensor(1),
        "previous": lambda: session.shown.next_sensor(-1),
        "add": lambda effect: started(session.step("add", str(effect))),
        "remove": lambda effect: started(session.step("remove", str(effect))),
        "calibrate": lambda: started(session.step("calibrate")),
        "diagnose": lambda: started(session.diagnose()),
        "undo": lambda: started(session.undo()),
        "report": lambda: started(session.report()),
        "take_over": lambda: started(session.take_over()),
        "keep_anyway": lambda: started(session.keep_anyway()),
        "make_case": lambda: started(session.make_case()),
        "not_these": lambda: session.show_dropped(None),
        "edit_dropped": session.edit_dropped,
        "done": session.done,
        "paper": session.paper,
        "stop": session.stop,
    }
