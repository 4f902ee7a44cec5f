"""The page of a tab, in Vuetify: the machine and a sensor's curves, errors, what is missing. All of it by keyboard."""

from __future__ import annotations

from importlib.resources import files
from typing import Any

from trame.ui.vuetify3 import VAppLayout
from trame.widgets import client, html
from trame.widgets import trame as extra
from trame.widgets import vuetify3 as v3
from trame_client.widgets.core import AbstractElement
from trame_plotly import module as plotly

from extras.workbench.session import Session, started
from thermoscope.plugin import RULE

KEYS = (("j", "next"), ("k", "previous"), ("d", "diagnose"), ("u", "undo"), ("r", "report"))
BROWSER = ("drop", "machine", "plots")  # scripts of the page
PLOTLY = {"displayModeBar": "false", "displaylogo": "false", "responsive": "true"}
HINT = (
    "Keys: j, k sensors · arrows, +, −, 0 view · space plays · d diagnose · u undo · r report · Tab, Enter everywhere"
)


def draw(session: Session) -> None:
    """Build the page; afterwards only the state changes."""
    css = files("extras.workbench").joinpath("page.css").read_text(encoding="utf-8")
    _browser_code(session)
    session.state.trame__title = f"thermoscope: {session.state.case_name}"
    with VAppLayout(session.shown.server, theme=("dark ? 'dark' : 'light'",)):
        client.Style(css)
        _keys(session)
        _bar(session)
        with v3.VMain(), html.Div(classes="bench"):
            with html.Section(classes="left"):
                _machine(session)
                _curve()
            with html.Section(classes="right"):
                with html.Div(classes="top"):
                    _messages(session)
                    _errors()
                _sensors(session)
                _missing(session)
                _recordings(session)
                _steps()


def _browser_code(session: Session) -> None:
    """What the page runs besides its templates, from this package and nowhere else."""
    code = str(files("extras.workbench").joinpath("browser"))
    session.shown.server.enable_module(
        {"serve": {"__thermoscope": code, **plotly.serve}, "scripts": [f"__thermoscope/{name}.js" for name in BROWSER]}
    )
    session.state.plotly = plotly.scripts[0]  # plots.js loads it


def _figure(name: str) -> None:
    """A figure of the page's state, once there is what draws it: looked up by name then, not with the page."""
    options = [f':{key}="{value}"' for key, value in PLOTLY.items()]
    AbstractElement(
        "component",
        raw_attrs=[
            'v-if="plots"',
            ":is=\"'trame-plotly'\"",
            ':key="plots"',
            f':data="{name}.data"',
            f':layout="{name}.layout"',
            *options,
            'style="width: 100%; height: 100%"',
        ],
    )


def aria(attribute: str, value: str) -> dict[str, list[str]]:
    """What a screen reader is told; trame's widgets do not know these attributes by name."""
    return {"raw_attrs": [f'{attribute}="{value}"']}


def pictured(words: str) -> dict[str, list[str]]:
    """An alternative text for what is drawn inside; `words` is an expression of the page's state."""
    return {"raw_attrs": ['role="img"', f':aria-label="{words}"']}


def _keys(session: Session) -> None:
    """Shortcuts; plain Tab and Enter work without them."""
    acts: dict[str, Any] = {
        "next": lambda: session.shown.next_sensor(1),
        "previous": lambda: session.shown.next_sensor(-1),
        "diagnose": lambda: started(session.diagnose()),
        "undo": lambda: started(session.undo()),
        "report": lambda: started(session.report()),
    }
    trap = extra.MouseTrap(**acts)
    for key, name in KEYS:
        trap.bind(key, name)


def _bar(session: Session) -> None:
    with v3.VAppBar(density="compact", flat=True, border="b"):
        html.H1("{{ case_name }}", classes="title")
        html.Span("revision {{ revision }}", classes="chip", id="revision")
        with html.Span(v_for="e in effects", key="e", classes="chip strong"):
            html.Span("+ {{ e }}")
            v3.VBtn(
                icon="mdi-close",
                size="x-small",
                variant="text",
                disabled=("busy",),
                click=(lambda effect: started(session.step("remove", str(effect))), "[e]"),
                **aria(":aria-label", "'take out ' + e"),
            )
        v3.VSpacer()
        _button("Undo", "undo", "mdi-undo", lambda: started(session.undo()), "busy || !can_undo")
        _button("Calibrate", "calibrate", "mdi-tune", lambda: started(session.step("calibrate")), "busy")
        _button("Report", "report", "mdi-file-document-outline", lambda: started(session.report()), "busy")
        html.A("open report", v_if=("report",), href=("report",), target="_blank", id="report-link", rel="noopener")
        v3.VBtn(
            icon=("dark ? 'mdi-weather-sunny' : 'mdi-weather-night'",),
            click=session.paper,
            **aria(":aria-label", "dark ? 'light page' : 'dark page'"),
        )


def _button(text: str, name: str, icon: str, act: Any, disabled: str) -> None:
    label = aria("aria-label", text)  # narrow pages show the icon alone
    v3.VBtn(text, id=name, prepend_icon=icon, click=act, disabled=(disabled,), variant="text", **label)


def _machine(session: Session) -> None:
    """A frame in which the browser draws; `browser/machine.js` tells it what is chosen, and hears what is clicked."""
    session.shown.server.controller.trigger("pick")(lambda name: session.shown.select(str(name)))
    with html.Div(classes="card machine"):
        with html.Div(classes="row"):
            v3.VSelect(
                v_model=("test",),
                items=("test_names",),
                label="test",
                density="compact",
                hide_details=True,
                variant="outlined",
                style="max-width: 14rem",
                id="test",
            )
            html.Span(
                "the machine of revision {{ revision }} is being prepared: {{ preparing }}",
                v_if=("preparing",),
                classes="faint",
                id="preparing",
                **aria("role", "status"),
            )
        if session.bench.why_flat:
            html.P("{{ why_flat }}", classes="flat")
            return
        attributes = [
            ':data-test="test"',
            ':data-sensor="sensor"',
            ':data-dark="dark"',
            ':data-rest="viewer_rest"',
            ':data-limits="JSON.stringify(limits)"',
            ":title=\"'the machine: ' + test\"",
        ]
        html.Iframe(
            v_if=("viewer",),
            src=("viewer",),
            classes="view",
            id="viewer",
            raw_attrs=[*attributes, "@pick=\"trigger('pick', [$event.detail])\""],
        )
        html.Div(v_if=("!viewer",), classes="view waiting", **aria("aria-hidden", "true"))


def _curve() -> None:
    label = "'readings and model of ' + sensor + ' in ' + test + ', and their difference'"
    with html.Div(v_if=("comparing",), classes="card curve"):
        html.Div(classes="waiting", **aria("aria-hidden", "true"))
    with html.Div(v_if=("!comparing",), classes="card curve", id="curve", **pictured(label)):
        html.Div(v_if=("!plots",), classes="waiting", **aria("aria-hidden", "true"))
        _figure("curve")


def _messages(session: Session) -> None:
    with html.Div(**aria("role", "status")):
        with html.Div(v_if=("busy && !comparing",), classes="card job", id="job"):
            html.B("{{ job.title }}")
            html.Span("{{ job.message }}", classes="faint", id="job-message")
            v3.VProgressLinear(
                model_value=("job.percent || 0",),
                indeterminate=("job.percent === null",),
                color="primary",
                height=8,
                id="progress",
                **aria("aria-label", "progress"),
            )
            v3.VBtn("Stop", click=session.stop, size="small", variant="outlined", id="stop")
        with html.Div(v_if=("error",), classes="card bad", id="error", **aria("role", "alert")):
            html.Span("{{ error }}")
            v3.VBtn(
                "Take over",
                click=lambda: started(session.take_over()),
                size="small",
                variant="outlined",
                v_if=("error.includes('take over')",),
                id="take-over",
            )
        with html.Div(v_if=("outcome",), classes=("'card ' + (outcome.good ? 'good' : 'warn')",), id="outcome"):
            html.Span("{{ outcome.text }}")
            v3.VBtn(
                "Keep it anyway",
                click=lambda: started(session.keep_anyway()),
                size="small",
                variant="outlined",
                v_if=("!outcome.good",),
                id="anyway",
            )


def _errors() -> None:
    with html.Div(classes="card", id="errors"):
        html.H2("Error of every test")
        html.P("the model is being compared with every test", v_if=("comparing",), classes="faint", id="comparing")
        html.P("all: {{ rms }} K; the sensors' own uncertainty explains {{ floor }} K", v_if=("rms",), classes="faint")
        _skeleton("test_names.length")
        with html.Div(
            v_for="t in tests",
            key="t.name",
            classes=("'bar' + (t.role === 'hold-out' ? ' held' : '')",),
            id=("'error-' + t.name",),
        ):
            html.Span("{{ t.name }} ({{ t.role }})", classes="name")
            with html.Span(classes="track"):
                html.Span(classes="was", style=("{ width: t.was + '%' }",))
                html.Span(classes="now", style=("{ width: t.width + '%' }",))
            html.Span("{{ t.before && t.before !== t.rmse ? t.before + ' → ' : '' }}{{ t.rmse }} K", classes="value")


def _skeleton(count: str) -> None:
    """Grey bars where rows will stand."""
    html.Div(v_if=("comparing",), v_for=f"i in {count}", key="i", classes="waiting row", **aria("aria-hidden", "true"))


def _sensors(session: Session) -> None:
    with html.Div(classes="card", id="sensors"):
        html.H2("Sensors in {{ test }}")
        html.P(RULE, classes="faint")
        _skeleton("8")
        with html.Button(
            v_for="s in sensors",
            key="s.name",
            type="button",
            classes=("'bar sensor ' + s.tone + (s.name === sensor ? ' chosen' : '')",),
            id=("'sensor-' + s.name",),
            click=(lambda name: session.shown.select(str(name)), "[s.name]"),
            **aria(":aria-pressed", "s.name === sensor"),
        ):
            html.Span("{{ s.label }}", classes="name", title=("s.place",))
            with html.Span(classes="track"):
                html.Span(classes="now", style=("{ width: s.width + '%' }",))
            html.Span("{{ s.rmse }} K {{ s.verdict === 'over' ? s.tone : '' }}", classes="value")


def _missing(session: Session) -> None:
    with html.Div(classes="card", id="missing"):
        html.H2("What is missing?")
        with html.Div(classes="row"):
            v3.VBtn(
                "Diagnose",
                id="diagnose",
                color="primary",
                variant="flat",
                prepend_icon="mdi-magnify",
                click=lambda: started(session.diagnose()),
                disabled=("busy",),
            )
        with html.Div(v_if=("verdict",)):
            html.P("{{ verdict.sentence }}", classes=("'verdict ' + verdict.tone",), id="verdict")
            html.P("{{ verdict.words }}", classes="faint")
            _candidates(session)
            label = "'which of the candidates look alike: a matrix of their likeness'"
            with html.Div(v_if=("has_confusion",), classes="confusion", id="confusion", **pictured(label)):
                _figure("confusion")
            html.P("{{ verdict.unseen }}", classes="faint")
            html.P("{{ a }}", v_for="a in verdict.ahead", key="a", classes="faint")


def _recordings(session: Session) -> None:
    """Files dropped on the page: a channel goes where it is dragged, or where its list says."""
    session.shown.server.controller.trigger("edit_dropped")(session.edit_dropped)
    with html.Div(classes="card", id="own"):
        html.H2("Recordings of your own")
        html.Label("Drop files anywhere on this page, or choose them: ", raw_attrs=['for="recordings"'])
        html.Input(type="file", id="recordings", raw_attrs=["multiple"])
        html.P("{{ made }} is written; new tabs show it.", v_if=("made",), id="made")
        html.A("open it", v_if=("made",), href="/", id="open-made")
        with html.Div(v_if=("drop",), id="dropped"):
            html.P("{{ drop.files }}: drag a channel to its part, or choose the part from its list", classes="faint")
            _channels()
            _targets()
            with html.P(v_for="n in drop.missing", key="n"):
                html.Span("{{ n }} was not recorded; constant: ")
                html.Input(
                    raw_attrs=[
                        ':aria-label="n"',
                        ':value="drop.constants[n]"',
                        "@change=\"trigger('edit_dropped', ['constant', n, $event.target.value])\"",
                    ]
                )
            _button("Make a case of them", "make-case", "mdi-folder-plus", lambda: started(session.make_case()), "busy")
            _button("Not these", "not-these", "mdi-close", lambda: session.show_dropped(None), "busy")


def _channels() -> None:
    """Every column of the files, to drag, with a list of where it can go."""
    on_change = "@change=\"trigger('edit_dropped', ['move', c.key, $event.target.value])\""
    with html.Div(classes="scroll"), html.Table(), html.Tbody(), html.Tr(v_for="c in drop.columns", key="c.key"):
        with html.Td():
            html.Span(
                "{{ c.name }}",
                classes="chip",
                id=("'column-' + c.name",),
                raw_attrs=[
                    'draggable="true"',
                    "@dragstart=\"dragged = c.key; $event.dataTransfer.setData('text/plain', c.key)\"",
                ],
            )
        with (
            html.Td(),
            html.Select(raw_attrs=[':value="c.goes"', ":aria-label=\"'where ' + c.name + ' is'\"", on_change]),
        ):
            html.Option("left out", value="")
            html.Option("{{ p.name }}", v_for="p in drop.parts", key="p.name", value=("p.name",))
        html.Td("{{ c.quantity }} {{ c.unit }}")
        html.Td("{{ c.doubt }}", classes="faint")


def _targets() -> None:
    """Parts, surroundings and inputs of the model, to drop channels on."""
    drop = "@drop.prevent.stop=\"trigger('edit_dropped', ['move', dragged, p.name])\""
    with (
        html.Div(classes="targets"),
        html.Div(
            v_for="p in drop.parts",
            key="p.name",
            classes=("'target ' + p.kind",),
            id=("'part-' + p.name",),
            raw_attrs=['@dragover.prevent=""', drop],
        ),
    ):
        html.B("{{ p.name }}")
        html.Span("{{ p.columns.join(', ') }}")


def _candidates(session: Session) -> None:
    with html.Div(classes="scroll"), html.Table():
        with html.Thead(), html.Tr():
            for name in ("effect", "", "probability", "refitted without → with"):
                html.Th(name)
        with html.Tbody(), html.Tr(v_for="c in candidates", key="c.effect", classes=("c.decision",)):
            with html.Td(title=("c.title + '. ' + c.test",)):
                html.Div("{{ c.effect }}", classes="effect")
                html.Div("{{ c.amplitude }}", classes="faint")
                html.Div("looks like {{ c.alike }}", v_if=("c.alike",), classes="faint")
            with html.Td():
                v3.VBtn(
                    "Add",
                    size="small",
                    variant=("c.decision === 'no' ? 'text' : 'flat'",),
                    color=("c.decision === 'no' ? '' : 'primary'",),
                    disabled=("busy || c.inside",),
                    click=(lambda effect: started(session.step("add", str(effect))), "[c.effect]"),
                    id=("'add-' + c.effect",),
                    **aria(":aria-label", "'add ' + c.effect"),
                )
            with html.Td(), html.Span(classes="evidence", title=("'probability ' + c.score",)):
                html.Span(classes="now", style=("{ width: c.width + '%' }",))
            with html.Td():
                html.Div("{{ c.error }}")
                html.Div("held out {{ c.held }}", v_if=("c.held",), classes="faint")


def _steps() -> None:
    with html.Details(classes="card", id="steps"):
        html.Summary("Steps of the model")
        with html.Ol(reversed=True):
            html.Li("{{ s.number }}: {{ s.text }} {{ s.why }}", v_for="s in steps", key="s.number", value=("s.number",))
        html.P(HINT, classes="faint")
