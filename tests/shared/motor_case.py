"""The small case with a stand-in machine to look at: `python motor_case.py FOLDER` serves it on a free port."""

import os
import sys
from dataclasses import dataclass, replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.append(str(HERE))

from small_case import small_case  # noqa: E402
from small_motor import machine, motor  # noqa: E402

from thermoscope.case_folder.folder import Folder, load_case  # noqa: E402

POSITIONS = {"T_winding": (-0.15, 0.0, 0.30), "T_yoke": (-0.16, 0.1, 0.40), "T_flange": (-0.15, 0.06, 0.65)}
HOME = {"winding": "winding", "flange": "flange"}


@dataclass(frozen=True)
class Uniform:
    """Every part at the temperature of one node of the network."""

    count: dict[str, int]
    states: tuple[str, ...]

    def of_part(self, part: str, x: np.ndarray) -> np.ndarray:
        node = HOME.get(part.split(".")[0], "yoke")
        return np.repeat(x[None, self.states.index(node)], self.count[part], axis=0)


def with_motor(path: Path) -> Folder:
    """The case of that folder, its three nodes spread over the parts of a small motor."""
    from viz import split

    folder, mesh = load_case(path), motor(24)
    nodes = split(mesh)
    count = {part: len(nodes.of(part)) for part in nodes.parts}
    network = folder.case.model.network
    recovered = replace(network, recovery=Uniform(count, network.states))
    case = replace(folder.case, model=replace(folder.case.model, network=recovered))
    return replace(
        folder, case=case, built=SimpleNamespace(mesh=mesh, network=recovered, machine=machine()), positions=POSITIONS
    )


def main() -> None:
    from extras.workbench.access_control import AccessControl
    from extras.workbench.serve import application, serve_until_stopped

    case, access = small_case(Path(sys.argv[1])), AccessControl("127.0.0.1", os.environ.get("THERMOSCOPE_TOKEN", ""))
    app = application(with_motor(case), access)
    serve_until_stopped(app, access, 0, lambda url: print(url, flush=True))


if __name__ == "__main__":
    main()
