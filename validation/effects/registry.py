"""The catalogue: every effect at every place of a network where it can sit, ours and other people's."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from importlib import import_module
from pathlib import Path
from pkgutil import walk_packages
from typing import Any

from geom.errors import InputError
from geom.plugins import plugins
from lumped.model.network import Network
from lumped.schemas.reader import suggestion
from validation.effects.above import Above
from validation.effects.base import Effect, ReadingEffect, Scene
from validation.effects.during import During
from validation.effects.input_terms import InputConductance, InputLoss
from validation.effects.time_window import IN, event, odd_tests

HERE = Path(__file__).parent
READ: dict[str, type[ReadingEffect]] = {c.kind: c for c in (Above, InputLoss, InputConductance)}


def _concrete(base: type[Effect]) -> Iterable[type[Effect]]:
    for sub in base.__subclasses__():
        yield from _concrete(sub)
        if not getattr(sub, "__abstractmethods__", None):
            yield sub


def kinds() -> dict[str, type[Effect]]:
    """Every kind of effect by name: the files of this folder, then entry points of 'thermoscope.effects'."""
    for module in walk_packages([str(HERE)], "validation.effects."):
        import_module(module.name)
    root: Any = Effect
    every = (c for c in _concrete(root) if not issubclass(c, ReadingEffect))
    classes = [c for c in every if hasattr(c, "kind")]  # one that holds for a while has that of another
    builtin = {c.kind: c for c in classes if c.__module__.startswith("validation.effects.")}
    return dict(sorted(builtin.items())) | {c.kind: c for c in plugins("effects").values()}


def catalogue(scene: Scene, only: Iterable[str] | None = None) -> tuple[Effect, ...]:
    """All effects that can sit somewhere in the scene; `only` restricts the kinds."""
    table = kinds()
    always = [kind for kind, cls in table.items() if not cls.temporary]
    classes = [_of(kind, table, "the kinds to look for") for kind in (always if only is None else only)]
    return tuple(cls(place) for cls in classes for place in cls.places(scene))


def _of(kind: str, classes: Mapping[str, type[Effect]], where: str) -> type[Effect]:
    if kind not in classes:
        raise InputError(f"unknown effect '{kind}'", where, suggestion(kind, classes))
    return classes[kind]


def effect(name: str, scene: Scene | None = None) -> Effect:
    """The effect called 'kind@place'; with a scene, only if it can sit there."""
    kind, _, place = name.partition("@")
    if kind in READ:
        one = READ[kind](place)
        if scene is not None and not set(one.inputs) <= scene.inputs:
            raise InputError(f"unknown input in '{place}'", f"effect '{name}'", ", ".join(sorted(scene.inputs)))
        return one
    cls = _of(kind, kinds(), f"effect '{name}'")
    base, separator, condition = place.rpartition(IN)
    if separator:
        if cls.mapping == "offset" and scene is not None and condition in scene.inputs:
            raise InputError(f"'{kind}' follows no input", f"effect '{name}'", f"{kind}@{base}{IN}TEST")
        return During.of(cls(base), _checked_condition(condition, scene, name))
    if scene is not None and place not in (places := cls.places(scene)):
        nowhere = f"it can sit nowhere here; it needs: {'; '.join(cls.lacking(scene))}"
        right = suggestion(place, places, "it can sit at") if places else nowhere
        what = f"'{kind}' cannot sit at '{place}'" if place else f"'{kind}' needs a place: {kind}@PLACE"
        raise InputError(what, f"effect '{name}'", right)
    return cls(place)


def _checked_condition(condition: str, scene: Scene | None, name: str) -> str:
    """The condition, if the scene has what it speaks of."""
    if scene is not None and condition not in scene.inputs:
        window = event(condition)
        for test in window.tests if window else odd_tests(condition) or (condition,):
            if test not in scene.tests:
                right = f"one of {', '.join(scene.tests)}, or an event as `diagnose` names it"
                raise InputError(f"unknown test or event '{test}'", f"effect '{name}'", right)
    return condition


def with_effects(network: Network, inside: Sequence[Effect], more: Sequence[Effect]) -> Network:
    """The network with the effects of a model, each of which acts on what those before it brought, and with `more` that
    are on trial and act on these, not on each other."""
    larger = replace(network, declared=network.identities)
    for one in inside:
        larger = replace(one.extend(larger), adopted=larger.adopted | {one.name})
    return replace(extended(larger, more), declared=network.declared)


def extended(network: Network, effects: Iterable[Effect]) -> Network:
    """The network with several effects at zero amplitude. They sit by what the network is without them."""
    larger = replace(network, declared=network.identities)
    for one in effects:
        larger = one.extend(larger)
    return replace(larger, declared=network.declared)
