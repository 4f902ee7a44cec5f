"""The machines of the benchmark. Another kind is a file of the truth, a network in machines/ and a line here."""

from hidden.truth.archetype import Archetype
from hidden.truth.machines.brushed import BRUSHED
from hidden.truth.machines.crane import CRANE
from hidden.truth.machines.disc import DISC
from hidden.truth.machines.hairpin import HAIRPIN
from hidden.truth.machines.incubator import INCUBATOR
from hidden.truth.machines.jacket import JACKET
from hidden.truth.machines.mill import MILL
from hidden.truth.machines.servo import SERVO
from hidden.truth.machines.tefc import TEFC
from hidden.truth.machines.transformer import TRANSFORMER

KINDS: dict[str, Archetype] = {
    k.name: k for k in (TEFC, JACKET, BRUSHED, SERVO, INCUBATOR, MILL, DISC, CRANE, HAIRPIN, TRANSFORMER)
}
