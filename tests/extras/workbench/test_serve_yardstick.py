"""What plain models leave stands on the page as `compare` says it, and not before the model was compared."""

from dataclasses import replace

import pytest
from small_case import small_case
from trame.app import get_server

from extras.workbench.appearance import appearance_of
from extras.workbench.display import Display
from extras.workbench.machines import Bench
from thermoscope.case_folder.folder import load_case
from thermoscope.commands.test.compare import compared, comparison_summary


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    into = tmp_path_factory.mktemp("yardstick")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("THERMOSCOPE_CACHE", str(into / "cache"))
        yield load_case(small_case(into))


def test_the_page_says_of_plain_models_what_compare_says(folder):
    shown = Display(Bench(folder), get_server("plain models"))
    assert (shown.state.warning, shown.state.plain) == ("", "")
    look = appearance_of(folder)
    shown.model(folder.history, look)
    _, document = compared(folder, lambda message: None)
    assert shown.state.plain.startswith("Held out ")
    assert shown.state.plain == comparison_summary(document, "three").parts[0]
    worse = {**look.errors["yardstick"], "warning": "Worse than no model at all."}
    moved = "The fit moved much."
    shown.model(folder.history, replace(look, errors={**look.errors, "yardstick": worse, "strained": moved}))
    assert shown.state.warning == f"Worse than no model at all. {moved}"
