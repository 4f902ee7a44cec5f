"""Who hears what long work is at: whoever was named, else a line with a bar below the cell of a notebook."""

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from html import escape

Progress = Callable[[str], None]


def silent(message: str) -> None:
    """No progress."""


@contextmanager
def hearing(progress: Progress, command: str, subject: str) -> Iterator[Progress]:
    """Whom to tell what is going on; the line of a notebook goes when the work ends.

    progress : `silent` where the caller named nobody
    command, subject : whose stages these are, so that share and time left are known: "explain diagnose", a case's path
    """
    shell = getattr(sys.modules.get("IPython"), "get_ipython", lambda: None)()
    if progress is not silent or not hasattr(shell, "kernel"):  # a terminal's IPython has no kernel
        yield progress
        return
    from IPython.display import HTML, display

    from thermoscope.console.progress_bar import remembering, timed_lines
    from validation.threads import listening

    line = display(HTML(""), display_id=True)

    def show(words: str, share: float | None) -> None:
        value = "" if share is None else f' value="{share:.3f}"'
        line.update(HTML(f"<progress{value}></progress> {escape(words)}"))

    try:
        with remembering(f"{command} 0", subject) as stages, timed_lines(stages, show, 1.0) as tell, listening(tell):
            yield tell
    finally:
        line.update(HTML(""))
