"""thermoscope show serve CASE"""

from __future__ import annotations

import os

from thermoscope.plugin import open_case_for_writing, progress, say


def serve(case: str, host: str, port: int) -> int:
    """The workbench in the browser, until Ctrl-C."""
    from extras.workbench.access_control import AccessControl
    from extras.workbench.jobs import prepare
    from extras.workbench.serve import application, token_for
    from extras.workbench.serve import serve as run

    prepare()  # loads packages while the case is opened
    access = AccessControl(host, token_for(os.environ.get("THERMOSCOPE_TOKEN")))
    with progress() as tell:
        folder = open_case_for_writing(case, tell)
    app = application(folder, access)
    run(app, access, port, lambda url: say(f"open {url}  (Ctrl-C ends)"))
    return 0
