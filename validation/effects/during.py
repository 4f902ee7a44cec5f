"""An effect that holds in one test, or for a while: any other, times an input that says when."""

from collections.abc import Iterable
from dataclasses import dataclass, replace

from geom.errors import InputError
from lumped.model.network import Link, Network, Parameter, Source
from lumped.transfer.laws import CLOCK, Law
from measured.doubt import USUAL
from measured.sensors.operators import of_measurement
from validation.effects.base import Effect, Scene, with_parameter
from validation.effects.build import Shaped, copy_elements
from validation.effects.time_window import ALIKE, IN, Event, TimeWindow, event, odd_tests

SAME = (
    "kind",
    "title",
    "unit",
    "at",
    "source",
    "isolating_test",
    "typical",
    "sign",
    "low",
    "high",
    "neutral",
    "confused_with",
    "needs",
    "fault",
    "empirical",
)


@dataclass(frozen=True)
class During(Effect):
    """An effect while a condition holds: "kind@place in CONDITION", that is a test, all but some tests, an event or an
    input of 0 to 1."""

    base: Effect
    condition: str

    def __post_init__(self) -> None:
        for name in SAME:  # of this one, as they are of the other
            object.__setattr__(self, name, getattr(self.base, name))
        object.__setattr__(self, "prior_sd", USUAL["switched"] * self.base.prior_sd)
        mapping = "offset" if self.base.mapping == "offset" else "amplitude"
        object.__setattr__(self, "mapping", mapping)

    @classmethod
    def of(cls, base: Effect, condition: str) -> "During":
        return cls(f"{base.place}{IN}{condition}", base, condition)

    @property
    def changes_others(self) -> bool:
        return self.base.changes_others

    @property
    def event(self) -> Event | None:
        """When it held, where that is not all of a test or what an input says."""
        return event(self.condition)

    @property
    def tests(self) -> tuple[str, ...]:
        """Those that were different from the others, because it held there or there alone did not."""
        return self.event.tests if self.event else odd_tests(self.condition) or (self.condition,)

    def can_act(self, test: str) -> bool:
        """Can it hold in a test?"""
        return (test in self.tests) != bool(odd_tests(self.condition))

    @property
    def when(self) -> str:
        """In which test, or from when to when."""
        return self.event.words if self.event else f"in {self.condition}"

    @property
    def statement(self) -> str:
        return f"{self.base.statement} {self.when}"

    def repeats(self, other: Effect) -> bool:
        """Is another the same cause in nearly the same while, its ends found anew?"""
        if not (isinstance(other, During) and self.event and other.event and self.base.name == other.base.name):
            return False
        return self.event.overlap(other.event) >= ALIKE

    @classmethod
    def candidate_places(cls, scene: Scene) -> Iterable[str]:
        """Nowhere by itself: readings say which of the many there could be."""
        return ()

    def extend(self, network: Network) -> Network:
        larger = self.base.extend(network)
        amplitude = replace(larger.parameters[-1], prior_sd=USUAL["switched"] * larger.parameters[-1].prior_sd)
        if self.base.temporary and of_measurement(amplitude):
            targets = tuple((f"{t}{IN}{self.condition}", factor) for t, factor in amplitude.targets)
            return with_parameter(network, replace(amplitude, name=self.name, targets=targets))
        if amplitude.mapping == "amplitude":
            return self._conditional(network, larger, amplitude)
        if amplitude.mapping == "offset":
            return with_parameter(network, replace(amplitude, name=self.name, targets=self._in_test(amplitude)))
        return self._copied(network, amplitude)

    def _in_test(self, parameter: Parameter) -> tuple[tuple[str, float], ...]:
        """A boundary alone can be off in a test, and all through it (`lasts`); no sensor, and no clock."""
        if not self.base.of_tests:
            raise self.lasting("a film, a flow or a loss; a boundary in a whole test")
        return tuple((f"{target}{IN}{self.condition}", factor) for target, factor in parameter.targets)

    def lasting(self, right: str) -> InputError:
        """What to raise where it can hold for no while."""
        return InputError(f"'{self.base.name}' cannot hold for a while", f"effect '{self.name}'", right)

    def _law(self, law: Law, factor: float = 1.0) -> Law:
        return Shaped.of(law, TimeWindow(self.condition, factor), CLOCK)

    def _conditional(self, network: Network, larger: Network, parameter: Parameter) -> Network:
        """What the other effect adds, times the condition."""
        links, sources = larger.links[len(network.links) :], larger.sources[len(network.sources) :]
        names = [*(x.name for x in links), *(x.name for x in sources)]
        new = {name: f"{name}{IN}{self.condition}" for name in names}

        def gate_targets(p: Parameter, first: int) -> Parameter:
            """With the names of what this brought from one of its targets on: those before may be the same effect's,
            there without the condition."""
            return replace(p, targets=(*p.targets[:first], *((new.get(t, t), e) for t, e in p.targets[first:])))

        count = len(network.parameters)
        both = zip(larger.parameters, network.parameters, strict=False)
        parameters = [gate_targets(p, len(before.targets)) for p, before in both]
        parameters += [gate_targets(p, 0) for p in (*larger.parameters[count:-1], replace(parameter, name=self.name))]
        return replace(network, parameters=tuple(parameters)).extended(
            links=[replace(x, name=new[x.name], law=self._law(x.law)) for x in links],
            sources=[replace(x, name=new[x.name], law=self._law(x.law)) for x in sources],
        )

    def _copied(self, network: Network, parameter: Parameter) -> Network:
        """A share of what is there, more or less while the condition holds.

        Copies that others of its kind have brought in are not copied again: with n of them there would be 2^n, for the
        product of two changes of one flow in one test.
        """
        items = {x.name: x for x in reversed(network.elements)}
        copies: dict[str, tuple[Link | Source, Law]] = {}
        for target, exponent in parameter.targets:
            if target not in items:
                raise self.lasting("a film, a flow or a loss")
            if not gated(items[target].law):
                copies[f"{self.name}:{target}"] = items[target], self._law(items[target].law, exponent)
        amplitude = replace(parameter, name=self.name, targets=tuple((n, 1.0) for n in copies), mapping="amplitude")
        return with_parameter(copy_elements(network, copies), replace(amplitude, value=0.0, neutral=0.0))


def gated(law: Law) -> bool:
    """Does a law hold for a while only?"""
    return isinstance(law, Shaped) and isinstance(law.shape, TimeWindow)
