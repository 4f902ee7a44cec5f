"""The machines of the benchmark."""

from hidden.truth.archetype import Archetype
from hidden.truth.brushed_tests import BRUSHED
from hidden.truth.jacket_tests import JACKET
from hidden.truth.tefc_tests import TEFC

KINDS: dict[str, Archetype] = {k.name: k for k in (TEFC, JACKET, BRUSHED)}
