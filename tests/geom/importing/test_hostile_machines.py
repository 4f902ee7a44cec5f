"""Machine files that an attacker made: one message, exit code 2, nothing written, nothing outside the folder."""

import json
import os

import pytest
from command_line import answered, refusal
from foreign_machines import motor_cad, pyleecan, saved
from hostile_machines import BESIDE, ESCAPE, NAMES, SOLIDS, TEXTS, box, step


def refused(folder, file):
    """The message; a machine file of another program is imported, all others are built."""
    command = "import" if file.suffix in (".json", ".mot") else "build"
    message = refusal(folder, command, file, "--out", folder / "out")
    assert message.isprintable()
    assert "fault of the program" not in message
    assert "its reader ended" not in message
    return message


@pytest.mark.parametrize("kind", TEXTS)
def test_a_text_is_refused(tmp_path, kind):
    name, content = TEXTS[kind]
    text = content if isinstance(content, str | bytes) else json.dumps(content)
    (tmp_path / name).write_bytes(text if isinstance(text, bytes) else text.encode())
    refused(tmp_path, tmp_path / name)


@pytest.mark.nightly
@pytest.mark.parametrize("kind", BESIDE)
def test_what_stands_beside_a_step_file_is_refused(tmp_path, kind):
    step(tmp_path, BESIDE[kind], winding=box(10))
    refused(tmp_path, tmp_path / "m.step")


@pytest.mark.nightly
@pytest.mark.parametrize("kind", SOLIDS)
def test_solids_are_refused(tmp_path, kind):
    step(tmp_path, **SOLIDS[kind])
    refused(tmp_path, tmp_path / "m.step")


@pytest.mark.parametrize("target", ["m.toml", "/dev/zero", "folder"])
def test_a_link_is_followed_to_a_file_alone(tmp_path, target):
    (tmp_path / "folder").mkdir()
    (tmp_path / "m.toml").symlink_to(target)
    refused(tmp_path, tmp_path / "m.toml")


def test_a_pipe_is_no_machine_file(tmp_path):
    os.mkfifo(tmp_path / "m.toml")
    refused(tmp_path, tmp_path / "m.toml")


@pytest.mark.parametrize("kind", ["comment of C", "folder above"])
def test_a_foreign_name_becomes_one_of_a_file_in_its_folder(tmp_path, kind):
    source = saved(tmp_path, pyleecan(name=NAMES[kind]), "m.json")
    assert answered("import", source, "--out", tmp_path / "out", cwd=tmp_path).code == 0
    (written,) = (tmp_path / "out").iterdir()
    assert {p.name for p in tmp_path.iterdir()} == {"m.json", "out"}
    assert written.suffix == ".toml"


def test_a_title_with_control_characters_reaches_no_terminal(tmp_path):
    (tmp_path / "m.mot").write_text(motor_cad(Title=ESCAPE))
    done = answered("import", tmp_path / "m.mot", "--out", tmp_path / "out", cwd=tmp_path)
    assert (done.out + done.err).replace("\n", "").isprintable()
    assert all(ESCAPE not in file.read_text() for file in (tmp_path / "out").iterdir())
