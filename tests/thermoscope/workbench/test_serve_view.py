"""The machine of a tab: sensors are found where they are drawn, pictures follow the temperatures."""

import numpy as np
import pytest
from motor_case import POSITIONS
from small_motor import motor

from thermoscope.workbench.view import Stage
from viz import split
from viz.data import Sensor
from viz.rendering.cut import cut_away
from viz.rendering.scene import View

SENSORS = tuple(Sensor(name, xyz, r, 1.0) for (name, xyz), r in zip(POSITIONS.items(), (0.2, 3.0, -4.0), strict=True))


@pytest.fixture(scope="module")
def surface():
    return cut_away(split(motor(24)))


@pytest.fixture
def stage(surface):
    picked = []
    one = Stage(surface, (20.0, 120.0), picked.append)
    one.picked = picked
    one.temperatures(np.full(len(surface.points), 60.0, np.float32))
    one.markers(SENSORS, "T_yoke")
    yield one
    one.close()


def clicked(stage, x, y, moved=0):
    interactor = stage.window.GetInteractor()
    interactor.SetEventPosition(round(x), round(y))
    interactor.InvokeEvent("LeftButtonPressEvent")
    interactor.SetEventPosition(round(x) + moved, round(y))
    interactor.InvokeEvent("LeftButtonReleaseEvent")


def test_a_click_on_a_dot_names_its_sensor(stage):
    stage.plotter.screenshot(return_img=True)
    for name, (x, y) in stage.on_screen().items():
        clicked(stage, x + 4, y - 4)
        assert stage.picked[-1] == name


def test_a_click_beside_the_dots_and_a_drag_name_nothing(stage):
    stage.plotter.screenshot(return_img=True)
    x, y = stage.on_screen()["T_flange"]
    clicked(stage, 5, 5)
    clicked(stage, x, y, moved=30)
    assert stage.picked == []


def test_dots_are_drawn_where_clicks_find_them(stage):
    from viz.colours import VERDICT

    picture = np.asarray(stage.plotter.screenshot(return_img=True)).astype(int)
    for sensor in SENSORS:
        x, y = stage.on_screen()[sensor.name]
        colour = [int(VERDICT[sensor.verdict][i : i + 2], 16) for i in (1, 3, 5)]
        assert np.abs(picture[picture.shape[0] - round(y), round(x)] - colour).max() < 12


def test_a_dot_that_something_covers_is_hollow(surface):
    """One behind the middle of the machine, one before it."""
    towards, middle = View().axes()[0], surface.points.mean(axis=0)
    sensors = tuple(Sensor(f"{by}", tuple(middle + by * towards), 0.0) for by in (-0.5, 0.5))
    one = Stage(surface, (20.0, 120.0), lambda name: None)
    one.markers(sensors, "0.5")
    picture = np.asarray(one.plotter.screenshot(return_img=True)).astype(int)
    middles = [picture[picture.shape[0] - round(y), round(x)] for x, y in one.on_screen().values()]
    one.close()
    assert middles[0].min() > 240
    assert middles[1].min() < 100


def test_the_picture_follows_temperature_view_and_paper(stage, surface):
    def picture():
        stage.plotter.render()
        return np.asarray(stage.plotter.screenshot(return_img=True)).astype(int)

    cool = picture()
    stage.temperatures(np.full(len(surface.points), 115.0, np.float32))
    hot = picture()
    assert np.abs(hot - cool).mean() > 5
    stage.turn(30.0, 0.0, 1.0)
    assert np.abs(picture() - hot).mean() > 2
    stage.reset()
    assert np.abs(picture() - hot).mean() < 1
    stage.paper(True)
    assert picture()[2, 2].max() < 60
