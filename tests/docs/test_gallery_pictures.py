"""Every example has its picture in the gallery, drawn by docs/images/examples.py from what the example leaves."""

import sys

import numpy as np
import pytest
from PIL import Image


@pytest.fixture(scope="module")
def drawing(root):
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(root / "docs" / "images"))
        import examples

        yield examples
    sys.modules.pop("examples")


def test_no_example_is_without_a_picture(root, drawing):
    shown = {p.stem.partition("-")[0] for p in (root / "docs/images/gallery").iterdir()}
    assert {p.stem for p in (root / "examples").glob("*.py")} - drawing.OWN_PAGES == shown


@pytest.mark.parametrize(("computed", "lines"), [(np.arange(9.0), 2), (np.ones((9, 2)), 4), (np.ones((4, 4)), 2)])
def test_computed_and_expected_are_drawn_over_each_other(drawing, tmp_path, computed, lines):
    left = {"time": np.arange(9.0), "computed": computed, "expected": computed}
    (ax,) = drawing.drawn(left, tmp_path / "a.png").axes
    assert len(ax.lines) == lines
    assert [text.get_text() for text in ax.get_legend().get_texts()] == ["computed", "expected"]
    with Image.open(tmp_path / "a.png") as picture:
        assert picture.size == (960, 450)


def test_a_number_is_drawn_with_its_digits(drawing):
    (ax,) = drawing.drawn({"computed": 1.25, "exact": 1.5}).axes
    assert [text.get_text().strip() for text in ax.texts] == ["computed 1.25", "expected 1.5"]
