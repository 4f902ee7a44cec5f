"""What would decide is shown only where something would."""

from validation.tables import next_tests, offers


def shown(**document):
    return "\n".join(map(str, next_tests({"next_tests": [], "next_sensors": [], **document})))


def planned(name, gain, *separates, **more):
    return {"test": name, "separates": list(separates), "predicted_gain": gain, "hours": 2.0, **more}


def test_what_a_test_tells_apart_is_said_in_words():
    pair = "convection.buoyant@heater2 / convection.constant@heater2"
    (offer,) = offers({"next_tests": [planned("blower on", 44.0, pair)]})
    film, steady = "natural convection growing with the rise", "steady extra cooling to ambient"
    assert offer["separates"] == [f"{film} at heater2 from {steady} at heater2"]


def test_a_test_that_separates_is_shown_and_the_others_are_not():
    out = shown(next_tests=[planned("blower on", 31.0, "a@b / c@d"), planned("spin", 4.0)])
    assert "blower on" in out
    assert "spin" not in out


def test_that_none_would_decide_is_said_with_the_nearest():
    out = shown(next_tests=[planned("spin", 4.0), planned("blower on", 7.0)])
    assert "No candidate test" in out
    assert "blower on" in out


def test_nothing_is_said_where_there_is_no_group():
    assert shown() == ""


def test_the_current_of_a_test_is_told_in_ampere_and_as_share_of_its_rms():
    level = {"input": "current_A", "level_A": 128.8, "share_of_rms": 0.938}
    out = shown(next_tests=[planned("heating", 31.0, "a@b / c@d", currents=[level], current_factor=0.72)])
    assert "Heating: current_A at 128.8 A, 0.94 of its rms." in out
