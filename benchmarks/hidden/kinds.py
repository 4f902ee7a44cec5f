"""The machines of the benchmark. Another kind is a file of the truth, a network in machines/ and a line here."""

from hidden.truth.archetype import Archetype
from hidden.truth.brushed_tests import BRUSHED
from hidden.truth.disc import DISC
from hidden.truth.incubator import INCUBATOR
from hidden.truth.jacket_tests import JACKET
from hidden.truth.mill_tests import MILL
from hidden.truth.servo import SERVO
from hidden.truth.tefc_tests import TEFC

KINDS: dict[str, Archetype] = {k.name: k for k in (TEFC, JACKET, BRUSHED, SERVO, INCUBATOR, MILL, DISC)}
