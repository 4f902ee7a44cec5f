"""What a process has loaded already, it need not load for the first test it runs."""

import subprocess
import sys

SCRIPT = """
import sys
from dataclasses import replace
import numpy as np
from numba.core.dispatcher import Dispatcher
import thermoscope.kernels
from lumped.integration.record import Record
from lumped.integration.simulate import simulate
from lumped.integration.balance import balance
from lumped.model.network import Parameter
from lumped.model.build import bare_network, node_link, node_source
from lumped.transfer.laws import Fixed

def loaded():
    rooms = [m for name, m in sorted(sys.modules.items()) if name.startswith("lumped.")]
    return {f.py_func.__name__: len(f.signatures) for m in rooms for f in vars(m).values() if isinstance(f, Dispatcher)}

before = loaded()
two = bare_network("two", {"a": 10.0, "b": 20.0}, ("ambient",))
links = [node_link(two, n, "film", n, "ambient", Fixed(2.0)) for n in ("a", "b")]
two = two.extended(links, [node_source(two, "loss", "copper", {"a": 1.0}, Fixed(5.0))], ())
air = {"ambient": np.full(5, 20.0)}
hot = Parameter("film", (("a", 1.0),))
two = replace(two, parameters=(hot,))
record = Record(np.arange(5.0), {}, air, 20.0)
for tangents in ((), two.parameters):
    simulate(two, record, rows=[two.place("a").mean], tangents=tangents, keep_states=not tangents)
balance(two, record)
print(any(before.values()), before == loaded())
"""


def test_a_test_of_another_network_needs_no_kernel_more(root):
    answer = subprocess.run([sys.executable, "-c", SCRIPT], cwd=root, capture_output=True, text=True, check=True)
    assert answer.stdout.split() == ["True", "True"]
