"""Serve a machine with a hidden truth, row by row.

python -m simulated.bench --kind servo --seed 3 --case CASE --truth FILE
"""

import argparse
import json
import socket
import time
from collections.abc import Callable
from pathlib import Path

from simulated.bench.kinds import HIDDEN, KINDS, write_case
from simulated.bench.plant import PERIOD, Plant, drawn


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="simulated.bench", description=__doc__)
    parser.add_argument("--kind", choices=list(KINDS), default="servo")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--hidden", choices=HIDDEN, help="what is hidden; drawn by default")
    parser.add_argument("--case", type=Path, help="write the case of this kind there first")
    parser.add_argument("--truth", type=Path, help="file for the truth, which nobody may read")
    parser.add_argument("--serve", default="127.0.0.1:7700", help="HOST:PORT of the TCP line")
    parser.add_argument("--faster", type=float, default=1.0, help="times real time")
    parser.add_argument("--hours", type=float, default=3.0)
    return parser.parse_args()


def serve(plant: Plant, link: socket.socket, faster: float, hours: float) -> None:
    """Rows as JSON lines out, set points as JSON lines in, until the other side ends."""
    link.setblocking(False)
    left = b""
    send: Callable[[bytes], None] = link.sendall
    while plant.time < 3600.0 * hours:
        begin = time.monotonic()
        try:
            got = link.recv(65536)
            if not got:
                return
            left += got
        except BlockingIOError:
            pass
        *lines, left = left.split(b"\n")
        for line in lines:
            plant.apply(json.loads(line)["set"])
        if (row := plant.row()) is not None:
            link.setblocking(True)
            send(json.dumps(row).encode() + b"\n")
            link.setblocking(False)
        time.sleep(max(PERIOD / faster - (time.monotonic() - begin), 0.0))


def main() -> None:
    a = arguments()
    truth = drawn(a.kind, a.seed, a.hidden)
    if a.case:
        print(f"case: {write_case(a.kind, a.case)}", flush=True)
    if a.truth:
        a.truth.write_text(json.dumps(truth.document(), indent=1), encoding="utf-8")
        a.truth.chmod(0)
    host, _, port = a.serve.rpartition(":")
    with socket.create_server((host, int(port))) as server:
        print(f"serving tcp://{host}:{server.getsockname()[1]}", flush=True)
        plant = Plant(truth)
        while plant.time < 3600.0 * a.hours:  # a client that comes back finds the machine as it is now
            link, _ = server.accept()
            try:
                serve(plant, link, a.faster, a.hours)
            except OSError:
                continue
            finally:
                link.close()


if __name__ == "__main__":
    main()
