"""A bench that steers itself: a motor with a hidden loss is asked, set point by set point, until its name is known.

python examples/live_bench.py [FOLDER]

The motor is a program of its own that serves rows over TCP and takes set points; what it hides stays in a file that
the bench may not read until the end.
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

HIDDEN = "copper.ac@winding"
FASTER = "30"  # than real time
ROOT = Path(__file__).parents[1]

# %% The motor: writes the case that its user would declare, and serves at a free port.
out = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(tempfile.mkdtemp())
case, truth = out / "servo", out / "truth.json"
hides = ["--kind", "servo", "--seed", "100", "--hidden", HIDDEN, "--case", str(case), "--truth", str(truth)]
motor = subprocess.Popen(
    [sys.executable, "-m", "simulated.bench", *hides, "--serve", "127.0.0.1:0", "--faster", FASTER],
    cwd=ROOT,
    stdout=subprocess.PIPE,
    text=True,
)
served = next(line.split()[-1] for line in motor.stdout or () if line.startswith("serving"))

# %% The bench: set points go out until one cause has 90 %, within the limits of bench.toml.
command = ["bench", "live", str(case), "--follow", served, "--drive", "--out", str(out), "--json", "-"]
try:
    run = subprocess.run([sys.executable, "-m", "thermoscope", *command], cwd=ROOT, capture_output=True, text=True)
finally:
    motor.terminate()
    motor.communicate()  # its last words, and its end
document = json.loads(run.stdout)
error = float(not document["decided"] or document["odds"][0]["cause"] != HIDDEN)
print(f"after {document['minutes']:.0f} min: {document['stop']}; odds over time in {out / 'live-odds.png'}")
