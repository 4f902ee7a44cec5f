"""Small cases and the command line of another folder serve here too."""

import importlib.util
import sys
from pathlib import Path

TESTS = Path(__file__).parents[1]
sys.path.append(str(TESTS / "thermoscope"))
_command = importlib.util.spec_from_file_location("thermoscope_command_line", TESTS / "thermoscope" / "conftest.py")
command_line = importlib.util.module_from_spec(_command)
sys.modules["thermoscope_command_line"] = command_line
_command.loader.exec_module(command_line)
thermoscope = command_line.thermoscope
