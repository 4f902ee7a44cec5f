"""One tab: what it shows, its model's history, and the one calculation it may have running."""

import asyncio
import re
import time
from collections.abc import Callable, Coroutine, Mapping, Sequence
from pathlib import Path
from typing import Any

from extras.workbench import steps
from extras.workbench.appearance import Appearance, at, same, undone
from extras.workbench.display import LOOK_S, Display, newest, say_done
from extras.workbench.dropped import DROP_FOLDER, Dropped
from extras.workbench.jobs import FailedError, Job, StoppedError
from extras.workbench.machines import Bench, Drawing
from thermoscope import InputError, ThermoscopeError, plugin as th

REMEMBERED = 8  # revisions whose comparison is at hand
TITLES = {"add": "Adding", "remove": "Taking out", "calibrate": "Calibrating"}


class Session:
    """What the buttons of a tab do."""

    def __init__(self, bench: Bench, server: Any, turn_to: Callable[[Bench], None] = lambda bench: None) -> None:
        """turn_to : makes another case the one that new tabs open"""
        self.bench, self.shown, self.turn_to = bench, Display(bench, server), turn_to
        self.state = self.shown.state
        self.history: th.History = bench.folder.history
        self.diagnosis: dict[str, Any] | None = None
        self.dropped: Dropped | None = None
        self.viewer_page = ""
        self.viewer_rest: dict[str, Any] = {}
        self._refused: th.StoredRevision | None = None
        self._closed = False
        self._seen = 0.0
        self._job: Job | None = None
        self._drawing: Drawing | None = None
        self._on_screen: th.History | None = None
        self._known: list[tuple[th.StoredRevision, Appearance]] = []

    @property
    def folder(self) -> th.Folder:
        """The case with this tab's model."""
        return at(self.bench.folder, self.history)

    @property
    def file(self) -> Path:
        return self.bench.folder.settings.model_file

    def open(self) -> None:
        """Show the model, and the last diagnosis if it is of this model; then what others have made of it since."""
        if self.bench.first is None:
            started(self._compare())
            return
        self._known = [(self.history.last, self.bench.first)]
        self.shown.model(self.history, self.bench.first)
        self.diagnosis = th.current_diagnosis(self.folder)
        self.shown.show_candidates(self.diagnosis)
        started(self.take_over())

    async def _compare(self) -> None:
        """Wait for the first comparison, with the machine as soon as it is drawn."""
        started(self.machine())
        with self.state:
            self.state.busy = self.state.comparing = True
        try:
            await self.bench.compared(steps.comparing_job)
        except (FailedError, StoppedError) as fault:
            self._complain(str(fault))
        finally:
            with self.state:
                self.state.busy = self.state.comparing = False
                if self.bench.first is not None and not self._closed:
                    self.open()

    async def diagnose(self) -> None:
        """Look for what is missing."""
        result = await self._calculate("Looking for what is missing", steps.searched, self.folder)
        if result is not None:
            if th.load_history(self.file) == self.history:
                th.save_diagnosis(self.folder, result)
            with self.state:
                self.diagnosis = dict(result)
                self.shown.show_candidates(self.diagnosis)

    async def step(self, action: str, effect: str = "") -> None:
        """Add or remove an effect, or calibrate; what is not accepted waits for `keep_anyway`."""
        effects = {"add": {c["effect"] for c in self.state.candidates}, "remove": set(self.history.last.effects)}
        if effect not in effects.get(action, {""}):
            return
        words = th.added_words(self.folder.case, [effect] if effect else [])
        title = f"{TITLES[action]} {words}".strip()
        result = await self._calculate(title, steps.stepped, self.folder, action, effect)
        if result is None:
            return
        revision, document, look = result
        good = bool(document["accepted"]) or action == "remove"
        verdict = "accepted" if good else "not accepted"
        text = f"{f'{action} {words}'.strip()}: {verdict}; {document['why']}"
        self._refused = None if good else revision
        with self.state:
            self.state.outcome = {
                "good": good,
                "text": (document["found"] if good and document["found"] else text).replace("->", "→"),
            }
            if good:
                self._write(self.history.and_then(revision), look)

    async def keep_anyway(self) -> None:
        """Write the step that was not accepted."""
        if self._refused is not None and self._write(self.history.and_then(self._refused)):
            await self._show(self.history)

    async def undo(self) -> None:
        """One step back. That is a revision too, so nothing is lost."""
        back = undone(self.history)
        if back is not None and not self.state.busy and self._write(back):
            await self._show(self.history)
            with self.state:
                self.state.outcome = {"good": True, "text": f"undone; {self.history.last.why}"}

    async def take_over(self) -> None:
        """Show the model that the file holds by now."""
        try:
            await self._show(th.load_history(self.file))
        except ThermoscopeError as fault:
            self._complain(str(fault))

    async def report(self) -> None:
        """Write out/report.html and offer it."""
        if await self._calculate("Writing the report", steps.reported, self.folder) is not None:
            with self.state:
                self.state.report = f"report.html?{time.time_ns()}"

    async def take_in(self, files: Sequence[Path]) -> None:
        """Show what the columns of dropped files are taken for, and the machines in files of other programs."""
        if self.state.busy:
            self._complain("the page is calculating: drop the files again when that has ended")
            return
        home, imported = self.folder.settings.path.resolve().parent, list[dict[str, Any]]()
        records = [file for file in files if not th.is_foreign_machine(file)]
        for file in files:
            if file not in records:
                document = await self._calculate("Reading the machine", steps.machine, file, home)
                if document is None:
                    return
                with self.state:
                    imported.append(document)
                    self.state.imported, self.state.error = [*imported], ""
        network = self.folder.case.model.network
        if records and (dropped := await self._calculate("Reading the recordings", steps.recordings, records, network)):
            self.show_dropped(dropped)

    def show_dropped(self, dropped: Dropped | None) -> None:
        """The columns on the page, None for none any more."""
        self.dropped = dropped
        with self.state:
            self.state.drop, self.state.error = dropped and dropped.document, ""

    def edit_dropped(self, change: str, key: str, value: str) -> None:
        """A column dragged to a part ("move"), or what was not recorded ("constant")."""
        if self.dropped is None or change not in ("move", "constant"):
            return
        try:
            act = self.dropped.moved if change == "move" else self.dropped.constant
            self.show_dropped(act(key, value))
        except InputError as fault:
            self._complain(str(fault))

    async def make_case(self) -> None:
        """A new case of the dropped files beside this one; new tabs open it."""
        case = self.folder
        answer = await self._calculate(
            "Writing the case", steps.new_case, self.dropped, case.settings, case.case.model.network
        )
        if answer is not None:
            folder, look = answer
            self.turn_to(Bench(folder, look))
            with self.state:
                self.state.drop, self.state.made = None, str(folder.settings.path)

    async def machine(self) -> None:
        """The model on the machine, for the browser to draw: made beside whatever else is calculated."""
        if self.bench.folder.built is None:
            return
        if self._drawing is not None and self._drawing.history == self.history and not self._drawing.stopped:
            return  # it is waited for already
        self._leave()
        if self._on_screen == self.history:
            return
        document = self.bench.machines.find(self.history)
        if document is not None:
            self._draw(document)
            return
        mine = self._drawing = self.bench.machines.drawing(self.folder, steps.drawing_job)
        mine.hear(self._preparing)
        try:
            for number, part in enumerate(mine.parts):
                document = await asyncio.shield(part)
                if self._drawing is not mine:
                    return  # another model was to be drawn
                (self._complete if number else self._draw)(document)
        except StoppedError:
            return
        except FailedError as fault:
            self._complain(str(fault))
        finally:
            if self._drawing is mine:
                self._leave()

    def _draw(self, document: Mapping[str, Any]) -> None:
        """Another machine in the browser; which errors count as agreement, the page tells it."""
        self._on_screen = self.history
        self.viewer_page, self.viewer_rest = th.render(document), {}
        with self.state:
            self.state.viewer, self.state.viewer_rest = f"viewer.html?{time.time_ns()}#bench", ""

    def _complete(self, document: Mapping[str, Any]) -> None:
        """More of the machine that the browser draws already."""
        self.viewer_rest = {**self.viewer_rest, **document}  # all of it, whichever part the browser asks for first
        with self.state:
            self.state.viewer_rest = f"viewer-rest.json?{time.time_ns()}"

    def _leave(self) -> None:
        """Wait for no machine any more."""
        if self._drawing is not None:
            self._drawing.leave(self._preparing)
            self._drawing = None
            self._preparing("")

    def paper(self) -> None:
        """From light to dark and back."""
        self.shown.paper(not self.state.dark, self.diagnosis)
        self._seen = 0.0  # the picture of the bench takes the new paper at the next look

    async def watch_bench(self) -> None:
        """Show what a run on the bench writes into the case, until the tab is closed."""
        while not self._closed:
            file = newest(self.bench.folder.settings.path)
            if file is not None and (mtime := file.stat().st_mtime) != self._seen:
                self._seen = mtime
                with self.state:
                    self.shown.show_bench(file)
            await asyncio.sleep(LOOK_S)

    def done(self) -> None:
        """The set point that the bench asks for is there."""
        file = newest(self.bench.folder.settings.path)
        if file is not None and self.state.live and self.state.live["asks"]:
            say_done(file)
            with self.state:
                self.state.live = {**self.state.live, "asks": False}

    def stop(self) -> None:
        """End the calculation."""
        if self._job is not None:
            self._job.stop()

    @property
    def calculates(self) -> bool:
        """Whether something runs for this tab alone; the first comparison is for all."""
        return bool(self.state.busy) and not self.state.comparing

    def close(self) -> None:
        self._closed = True
        self.stop()
        self._leave()

    def _write(self, new: th.History, look: Appearance | None = None) -> bool:
        """To model.toml, unless somebody else has written there; then show it."""
        try:
            self.history = th.save_history(self.file, new, self.history)
        except (ThermoscopeError, OSError) as fault:
            self._complain(str(fault))
            return False
        self._refused = None
        if look is not None:
            self._keep(look)
        return True

    async def _show(self, history: th.History) -> None:
        """The model that `history` ends with, from memory where it was shown before."""
        look = next((look for r, look in self._known if same(r, history.last)), None)
        if look is None:
            folder = at(self.bench.folder, history)
            look = await self._calculate("Running the model", steps.appearance, folder)
        if look is not None:
            with self.state:
                self.state.error, self.history = "", history
                self._keep(look)

    def _keep(self, look: Appearance) -> None:
        last = self.history.last
        self._known = [*((r, x) for r, x in self._known if not same(r, last)), (last, look)][-REMEMBERED:]
        self.shown.model(self.history, look)
        self.diagnosis = th.current_diagnosis(self.folder)
        self.shown.show_candidates(self.diagnosis)
        started(self.machine())

    async def _calculate(self, title: str, work: Callable[..., Any], *arguments: Any) -> Any:
        """The result of a process of its own; None when it failed, was stopped, or another one is running."""
        if self.state.busy:
            return None
        self._job = Job(work, *arguments)
        with self.state:
            self.state.busy, self.state.error, self.state.outcome = True, "", None
            self._tell(title, "starting")
        try:
            return await self._job.run(lambda message: self._tell(title, message))
        except (FailedError, StoppedError) as fault:
            self._complain(str(fault))
            return None
        finally:
            self._job = None
            with self.state:
                self.state.busy = False

    def _tell(self, title: str, message: str) -> None:
        with self.state:
            self.state.job = {"title": title, "message": message, "percent": share(message)}

    def _preparing(self, message: str) -> None:
        with self.state:
            self.state.preparing = message

    def _complain(self, message: str) -> None:
        with self.state:
            self.state.error = re.sub(DROP_FOLDER, "", message)  # of a dropped file its own name


def share(message: str) -> float | None:
    """'test 12/40' -> 30.0; None where the message counts nothing."""
    match = re.search(r"(\d+)/(\d+)", message)
    return round(100.0 * int(match[1]) / int(match[2]), 1) if match and int(match[2]) else None


_running: set[asyncio.Task] = set()


def started(coroutine: Coroutine[Any, Any, None]) -> None:
    """Begin a task that outlives the click. It is not given back: trame would wait for it, and the page with it."""
    task = asyncio.get_running_loop().create_task(coroutine)
    _running.add(task)
    task.add_done_callback(_running.discard)
