"""Drawings: every way to draw one machine gives its areas, as closed forms have them; what is wrong is one message."""

import cmath
import math

import pytest
from foreign_machines import (
    BORE,
    DEEP,
    MAGNET,
    OPENING,
    OUTER,
    POLES,
    SHAFT,
    SLOTS,
    SURFACE,
    TIP,
    WIDE,
    Sheet,
    box,
    rotor,
    slot_points,
    stator,
    whole,
)

from geom import InputError, import_draft, load_machine
from geom.importing.dxf import USUAL_FILL
from geom.machine_file import machine_from

STACK = 50.0
ROUND = {"stator": "Ständerblech", "winding": "Kupfer", "rotor": "Läufer", "slot": "Nut", "magnet": "Magnete"}


def areas(draft):
    """mm2 of every part's section."""
    machine = machine_from(draft.sections(), "drawn")
    return {part.name: 1e6 * sum(profile.area for profile, *_ in part.prisms) for part in machine.parts}


def draft_of(sheet, folder, **answers):
    return import_draft(sheet.saved(folder), **{"stack_mm": STACK, **answers})


def pitches(slots, poles):
    sheet = Sheet()
    stator(sheet, slots)
    rotor(sheet, poles)
    return sheet


def cut_in_slots():
    """One pitch from the middle of a slot to that of the next."""
    sheet, upper = Sheet(), slot_points()[::-1][:4]
    for side, turn in ((1, cmath.exp(-1j * math.pi / SLOTS)), (-1, cmath.exp(1j * math.pi / SLOTS))):

        def points(corners, side=side):
            return corners if side > 0 else [z.conjugate() for z in corners]

        sheet.lines("stator", points([*upper, DEEP + 0j]), turn, close=False)
        sheet.line("stator", DEEP * turn, OUTER * turn)
        sheet.polyline("winding", points([TIP + 1 + 0j, DEEP - 0.25 + 0j, DEEP - 0.25 + 2.75j, TIP + 1 + 2.75j]), turn)
    half = math.pi / SLOTS
    sheet.arc("stator", BORE, -half + cmath.phase(upper[0]), half - cmath.phase(upper[0]))
    sheet.arc("stator", OUTER, -half, half)
    rotor(sheet, 1)
    return sheet


def plain_circles():
    """Iron as circles, slots and magnets on their own layers, by German names."""
    sheet = Sheet(names=ROUND)
    for radius in (BORE, OUTER):
        sheet.circle("stator", radius)
    for k in range(SLOTS):
        turn = cmath.exp(2j * math.pi * k / SLOTS)
        sheet.lines("slot", slot_points(), turn)
        sheet.polyline("winding", box(TIP + 1, DEEP - 0.25, WIDE - 0.5), turn)
    sheet.circle("rotor", SURFACE)
    sheet.circle("Welle", SHAFT)
    for k in range(POLES):
        sheet.polyline("magnet", box(*MAGNET), 1j**k)
    return sheet


def blocks():
    """Every pitch a block of its own, sides and all."""
    sheet = Sheet()
    space, sheet.space = sheet.space, sheet.document.blocks.new("pitch")
    stator(sheet, 1)
    sheet.space = space
    for k in range(SLOTS):
        space.add_blockref("pitch", (0, 0), dxfattribs={"rotation": 360 * k / SLOTS})
    rotor(sheet)
    return sheet


WAYS = {
    "whole": whole,
    "one slot and one pole": lambda: pitches(1, 1),
    "a pole pitch": lambda: pitches(6, 1),
    "halves": lambda: pitches(12, 2),
    "cut in the slots": cut_in_slots,
    "plain circles": plain_circles,
    "blocks": blocks,
    "in inches, beside the origin": lambda: whole(insunits=1, unit=25.4, axis=3 + 2j),
}


@pytest.mark.parametrize("way", WAYS)
def test_areas_are_those_of_closed_forms(way, tmp_path):
    draft = draft_of(WAYS[way](), tmp_path)
    sizes = areas(draft)
    lid = BORE**2 * math.asin(OPENING / 2 / BORE) - OPENING / 2 * math.sqrt(BORE**2 - OPENING**2 / 4)
    to_bore = OPENING * (TIP - math.sqrt(BORE**2 - OPENING**2 / 4)) - lid  # of the opening, beyond the bore's circle
    slot = to_bore + WIDE * (DEEP - TIP)
    magnet = (MAGNET[1] - MAGNET[0]) * MAGNET[2]
    assert sizes["stator.core"] == pytest.approx(math.pi * (OUTER**2 - BORE**2) - SLOTS * slot, rel=1e-8)
    assert sizes["magnets"] == pytest.approx(POLES * magnet, rel=1e-8)
    assert sizes["rotor.core"] == pytest.approx(math.pi * (SURFACE**2 - SHAFT**2) - POLES * magnet, rel=1e-8)
    copper = sizes["winding"] * draft.value("geometry.winding", "fill")  # 40 % of what is drawn, wherever that is
    assert copper == pytest.approx(USUAL_FILL * SLOTS * (DEEP - 0.25 - TIP - 1) * (WIDE - 0.5), rel=1e-5)


def test_single_conductors_are_copper(tmp_path):
    """Six bars in every slot, 5 mm by 2 mm."""
    sheet = Sheet()
    stator(sheet, 1, winding=box(TIP + 1, TIP + 3, 5.0))
    for k in range(1, 6):
        sheet.polyline("winding", box(TIP + 1 + 3 * k, TIP + 3 + 3 * k, 5.0))
    rotor(sheet, 1)
    draft = draft_of(sheet, tmp_path)
    assert areas(draft)["winding"] * draft.value("geometry.winding", "fill") == pytest.approx(24 * 60.0, rel=1e-5)


def test_the_room_beside_the_winding_is_its_liner(tmp_path):
    """0.25 mm at both sides and at the bottom, 0.16 W/m/K: 640 W/m2/K, less for the arc that closes the slot."""
    contact = draft_of(pitches(1, 1), tmp_path).value("contacts", "stator.core|winding")
    assert contact["h_W_m2K"] == pytest.approx(0.16 / 0.25e-3, rel=0.2)


def surface_magnets(kind):
    """Breadloaf magnets of 4 mm x 24 mm under an arc of 30 mm, as bulges, arcs or a spline."""
    sheet = Sheet()
    stator(sheet, 1)
    sheet.circle("rotor", 30.0)
    sheet.circle("rotor", SHAFT)
    half, radius = 12.0, 30.0
    a, b = 34 - 1j * half, 34 + 1j * half
    foot = [math.sqrt(30**2 - half**2) + 1j * y for y in (half, -half)]
    sweep = 2 * math.asin(half / radius)
    for k in range(POLES):
        turn = 1j**k
        bulges = [math.tan(sweep / 4), 0.0, -math.tan(math.asin(half / 30) / 2), 0.0]
        if kind == "bulges":
            sheet.polyline("magnet", [a, b, *foot], turn, bulges)
            continue
        sheet.line("magnet", foot[1] * turn, a * turn)
        sheet.line("magnet", b * turn, foot[0] * turn)
        sheet.arc("magnet", 30.0, *(k * math.pi / 2 + s * math.asin(half / 30) for s in (-1, 1)))
        centre = 34 - radius * math.cos(sweep / 2)
        top = [(centre + radius * cmath.exp(1j * (-sweep / 2 + sweep * i / 40))) * turn for i in range(41)]
        sheet.space.add_spline([(*sheet.at(z), 0) for z in top], dxfattribs={"layer": "magnet"})
    segment = radius**2 * (sweep - math.sin(sweep)) / 2
    foot_segment = 30**2 * (2 * math.asin(half / 30) - math.sin(2 * math.asin(half / 30))) / 2
    return sheet, POLES * (2 * half * (34 - foot[0].real) + segment - foot_segment)


@pytest.mark.parametrize("kind", ["bulges", "spline"])
def test_magnets_on_the_surface(kind, tmp_path):
    sheet, expected = surface_magnets(kind)
    draft = draft_of(sheet, tmp_path)
    chords = POLES * 25.0 * 2e-3  # mm2: chords leave a spline of 25 mm by 2 um
    assert areas(draft)["magnets"] == pytest.approx(expected, abs=chords if kind == "spline" else 1e-6)
    assert draft.value("geometry.rotor", "core_diameter_mm") == pytest.approx(60.0)
    assert draft.value("[outlines.pockets]", "loops_mm") is None


def test_ring_magnet_and_housing(tmp_path):
    sheet = Sheet()
    stator(sheet, 1)
    for layer, radius in (("rotor", 30.0), ("rotor", SHAFT), ("magnet", 30.0), ("magnet", 35.0), ("Gehäuse", 76.0)):
        sheet.circle(layer, radius)
    draft = draft_of(sheet, tmp_path)
    assert areas(draft)["magnets"] == pytest.approx(math.pi * (35**2 - 30**2), rel=1e-9)
    assert draft.value("geometry.housing", "thickness_mm") == pytest.approx(6.0)


def without(layer):
    sheet = whole()
    for entity in list(sheet.space.query(f'*[layer=="{layer}"]')):
        sheet.space.delete_entity(entity)
    return sheet


def open_slot():
    sheet = whole()
    sheet.space.delete_entity(sheet.space.query('LINE[layer=="stator"]')[3])
    return sheet


def odd_sector():
    sheet = without("stator")
    for radius in (BORE, OUTER):
        sheet.arc("stator", radius, 0.0, 1.0)
    return sheet


WRONG = {
    "no length": (whole, {"stack_mm": None}, "how long the stack is; --stack-mm"),
    "no units": (lambda: whole(insunits=0), {}, r"does not say its units.*--units, one of: mm"),
    "layers of other names": (
        lambda: whole(names={"stator": "A1"}),
        {},
        "layers 'A1'.* no layer is of the stator; layers named by part",
    ),
    "no winding": (lambda: without("winding"), {}, "no layer is of the winding"),
    "an open outline": (open_slot, {}, r"layer stator: an outline is open at x = 60, y = -?3 mm"),
    "a part of a turn": (odd_sector, {}, "spans 57.296 degrees"),
}


@pytest.mark.parametrize("fault", WRONG)
def test_faults_are_one_message(fault, tmp_path):
    sheet, answers, message = WRONG[fault]
    with pytest.raises(InputError, match=message):
        draft_of(sheet(), tmp_path, **answers)


@pytest.mark.parametrize("content", [b"hello", None])
def test_damaged_files_are_one_message(content, tmp_path):
    path = whole().saved(tmp_path)
    text = path.read_bytes()
    path.write_bytes(text[: len(text) // 2] if content is None else content)
    with pytest.raises(InputError, match="not readable as DXF"):
        import_draft(path, stack_mm=STACK)


def test_blocks_that_multiply_are_refused(tmp_path):
    sheet = whole()
    block = sheet.document.blocks.new("line")
    block.add_line((0, 0), (1, 0))
    attributes = {"layer": "rotor", "row_count": 1000, "column_count": 1000, "row_spacing": 1, "column_spacing": 1}
    sheet.space.add_blockref("line", (0, 0), dxfattribs=attributes)
    with pytest.raises(InputError, match="too many lines"):
        draft_of(sheet, tmp_path)


def test_texts_of_a_drawing_answer(tmp_path):
    """Length and unit stand in it: scripts build it, too."""
    sheet = whole(insunits=0)
    sheet.space.add_text("stack_mm = 120, units = mm")
    machine = load_machine(sheet.saved(tmp_path))
    core = next(part for part in machine.parts if part.name == "stator.core")
    assert core.span[1] - core.span[0] == pytest.approx(0.12)
