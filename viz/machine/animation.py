"""The machine warming up, as a moving picture."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageColor

from geom.arrays import Array, Mask
from geom.errors import InputError, MissingDependency
from viz.colours import LIGHT, VERDICT, Theme, rgb
from viz.data import Sensor
from viz.machine import field
from viz.machine.thermocouples import frame_points
from viz.rendering import scene
from viz.rendering.callouts import HOLLOW, draw_on_top
from viz.rendering.cut import QUARTER, Surface, Wedge, cut_away
from viz.rendering.ghost import covered, obstacle
from viz.rendering.nodes import SplitMesh, on_nodes
from viz.rendering.scene import Room, View

if TYPE_CHECKING:
    import pyvista

PALETTE = 24  # pictures that a GIF's colours are taken from
BITS, ROUNDS = 5, 3  # of a channel by which colours are counted; of k-means after the median cut
DOT = 17.0  # pixels of a dot in a picture 960 wide
SWELL = 1.1  # of its own size that the ring around a dot grows by while it pulses
HERTZ = 1.2  # pulses in a second: slow enough not to flicker


def animate(
    nodes: SplitMesh,
    times: Sequence[float],
    fields: Array,
    path: str | Path,
    *,
    wedge: Wedge | None = QUARTER,
    view: View | None = None,
    theme: Theme = LIGHT,
    frames_per_second: float = 12.0,
    titles: Sequence[str] = (),
    sensors: Sequence[Sequence[Sensor]] = (),
    limits: tuple[float, float] | None = None,
    size: tuple[int, int] = (960, 600),
    tell: Callable[[int], None] = lambda number: None,
) -> Path:
    """Write a .gif or .mp4 of fields (n_times, n_nodes) degC on one colour scale.

    titles : one per field, else the minute of the test;  tell : called with the number of each picture that is drawn
    sensors : one row per field, all in one order; those that the model misses pulse
    limits : of the colour scale (degC), those of all fields if not given

    An .mp4 needs imageio-ffmpeg (the extra [video]), which brings an encoder of its own, under the GPL.
    """
    path, T = Path(path), on_nodes(nodes, fields)
    if path.suffix not in WRITERS:
        raise InputError(f"cannot write '{path.suffix}'", str(path), f"a file name that ends in {' or '.join(WRITERS)}")
    if len(T) != len(times) or not len(T):
        raise InputError(f"{len(times)} times but {len(T)} fields", "animation", "one field per time")
    if sensors and len(sensors) != len(T):
        raise InputError(f"{len(sensors)} rows of sensors but {len(T)} fields", "animation", "one row per field")
    p, view = scene.plotter(theme, size), view or View()
    surface = cut_away(nodes, wedge)
    data = field.paint(p, surface, T[0], limits or (float(T.min()), float(T.max())), theme)
    scene.colour_bar(p, field.UNIT, theme)
    scene.look(p, frame_points(surface, sensors[0] if sensors else ()), view, Room(right=0.12, top=scene.TITLE))
    pictures, pulses = [], Pulses(p, surface, sensors[0]) if sensors else None
    words_of = titles or [f"{time / 60:.0f} min" for time in times]
    letters = max(map(len, words_of))
    for number, (words, values) in enumerate(zip(words_of, T, strict=True), 1):
        tell(number)
        if pulses is not None:
            pulses.show(sensors[number - 1], number / frames_per_second)
        data.point_data["T"] = surface.values(values)
        scene.headline(p, words, theme, letters)
        pictures.append(np.asarray(p.screenshot(return_img=True)))
    p.close()
    path.parent.mkdir(parents=True, exist_ok=True)
    return WRITERS[path.suffix](path, pictures, frames_per_second)


class Pulses:
    """Dots on a plotter whose camera stands still; `show` moves them on."""

    def __init__(self, p: "pyvista.Plotter", surface: Surface, sensors: Sequence[Sensor]) -> None:
        self._p, self._xyz = p, np.array([s.xyz for s in sensors]).reshape(-1, 3)
        self._hidden = covered(obstacle(surface), self._xyz, np.array(p.camera.position))

    def show(self, sensors: Sequence[Sensor], second: float) -> None:
        """The sensors as they are at this instant of the film (s); they stay in the order in which they came."""
        colours = np.array([rgb(s.colour) for s in sensors], np.uint8).reshape(-1, 3)
        wrong = np.array([s.verdict in ("hot", "cold") for s in sensors], bool)
        phase = second * HERTZ % 1.0
        self._dots("pulse", wrong, colours, DOT * (1.4 + SWELL * np.sin(np.pi * phase)), 1)
        self._dots("halo", np.ones_like(wrong), np.full_like(colours, 255), 1.35 * DOT, 2)
        self._dots("dot", np.ones_like(wrong), colours, DOT, 3)
        self._dots("core", self._hidden, np.full_like(colours, 255), HOLLOW * DOT, 4)

    def _dots(self, name: str, mask: Mask, colours: NDArray[np.uint8], size: float, order: int) -> None:
        self._p.remove_actor(name, reset_camera=False, render=False)  # type: ignore[arg-type]
        if mask.any():
            style: dict[str, Any] = {"point_size": size, "lighting": False, "render_points_as_spheres": True}
            style |= {"name": name, "reset_camera": False, "render": False}
            draw_on_top(self._p.add_points(self._xyz[mask], scalars=colours[mask], rgb=True, **style), order)


def _gif(path: Path, pictures: list[NDArray[np.uint8]], frames_per_second: float) -> Path:
    """A looping GIF with one palette, taken from pictures all along the way."""
    palette = _palette(pictures)
    frames = [Image.fromarray(one).quantize(palette=palette, dither=Image.Dither.NONE) for one in pictures]
    pause = round(1000 / frames_per_second)
    frames[0].save(path, save_all=True, append_images=frames[1:], duration=pause, loop=0, optimize=False)
    return path


def _palette(pictures: list[NDArray[np.uint8]]) -> Image.Image:
    """255 colours. Each colour has the root of its share to say: else paper and shell leave none to small hot parts."""
    sample = np.linspace(0, len(pictures) - 1, min(PALETTE, len(pictures))).astype(int)
    some = np.concatenate([pictures[i][::2, ::2].reshape(-1, 3) for i in sample])
    key = (some >> (8 - BITS)).astype(int) @ [1 << 2 * BITS, 1 << BITS, 1]
    _, group, count = np.unique(key, return_inverse=True, return_counts=True)
    mean = np.stack([np.bincount(group, channel) / count for channel in some.T], axis=1)
    says = np.sqrt(count).astype(int)
    dots = np.array([ImageColor.getrgb(colour) for colour in VERDICT.values()], np.uint8)  # small, but they matter
    row = np.concatenate(
        [np.repeat(np.round(mean).astype(np.uint8), says, axis=0), np.repeat(dots, says.max(), axis=0)]
    )
    return Image.fromarray(row[None]).quantize(255, kmeans=ROUNDS)


def _mp4(path: Path, pictures: list[NDArray[np.uint8]], frames_per_second: float) -> Path:
    """H.264 that browsers and slide programs play."""
    try:
        from imageio_ffmpeg import write_frames
    except ImportError:
        raise MissingDependency(
            "an .mp4 needs an encoder; write a .gif, or: pip install 'thermoscope[video]'"
        ) from None
    height, width = pictures[0].shape[:2]
    writer = write_frames(str(path), (width, height), fps=frames_per_second, macro_block_size=2)
    writer.send(None)
    for picture in pictures:
        writer.send(np.ascontiguousarray(picture))
    writer.close()
    return path


WRITERS = {".gif": _gif, ".mp4": _mp4}
