"""The command of this extra; nothing heavy is loaded until it runs."""

from typing import Annotated

import typer

from thermoscope import plugin as th

show_commands = typer.Typer(name="show")


@show_commands.command()
def serve(
    case: th.CaseArgument,
    host: Annotated[str, typer.Option(help="Where to listen; all browsers need the token.")] = "127.0.0.1",
    port: Annotated[int, typer.Option(min=0, max=65535, help="0 takes a free one.")] = 8710,
) -> int:
    """The workbench in the browser: the machine, its sensors, what is missing, add it and see the error fall."""
    import os

    from extras.workbench.access_control import AccessControl
    from extras.workbench.jobs import prepare
    from extras.workbench.serve import application, serve_until_stopped, token_for

    prepare()  # loads packages while the case is opened
    access = AccessControl(host, token_for(os.environ.get("THERMOSCOPE_TOKEN")))
    with th.progress() as tell:
        folder = th.open_case_for_writing(case, tell)
    app = application(folder, access)
    serve_until_stopped(app, access, port, lambda url: th.say(f"open {url}  (Ctrl-C ends)"))
    return 0
