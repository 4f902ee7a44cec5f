"""The network that a case runs: hottest points of parts that nothing heats, thin insulation between hot and cold."""

from dataclasses import replace

import numpy as np
import pytest

from geom import load_machine
from geom.machine_file import machine_from
from lumped.build.fixed_coefficients import rated
from lumped.build.pipeline import CASE, Meshing, meshed, networks_of, reduced
from lumped.machine.bases import on_all, on_every_base


def test_insulation_is_within_5_percent_of_its_rise(tmp_path, monkeypatch):
    """Against the field on the same mesh, at nominal films, all x10, and all contacts x0.2; 9 % without its favour."""
    monkeypatch.setenv("THERMOSCOPE_CACHE", str(tmp_path))
    few = {"rotor": {"slots": 12}, "housing": {"fins": 8}}
    machine = load_machine("series-dc-100kw")
    made = machine_from({"machine": {"family": "series-dc"}, "geometry": few}, "few")
    small = on_all(replace(made, sections={**machine.sections, "contacts": {"default": {"gap_mm": 0.05}}}))
    ready = meshed(small, Meshing(0.1, 24, 1, 0.1))
    recipe = replace(CASE, random_points=2, joined_contacts=(5.0,))
    reduction = reduced(ready, recipe)
    off = {}
    for favour in (1.0, CASE.thin):
        network = on_every_base(networks_of(small, reduction, replace(recipe, thin=favour))[0])
        point = rated(small, network, ready.films, ready.contacts)
        assert "field.insulation" not in point.watts
        off[favour] = 0.0
        for films, contacts in ((1.0, 1.0), (10.0, 1.0), (1.0, 0.2)):
            there = replace(
                point,
                films={k: films * h for k, h in point.films.items()},
                contacts={k: contacts * g for k, g in point.contacts.items()},
            )
            rows = ready.field.blocks["field.insulation"].dofs
            exact, ours = (
                np.max(T[rows]) for T in (there.of_field(ready.field), there.of_network(network, ready.field))
            )
            off[favour] = max(off[favour], 100.0 * abs(ours / exact - 1.0))
    assert off[CASE.thin] < 5.0 < off[1.0]


@pytest.mark.nightly
def test_a_liner_between_winding_and_core_is_within_5_percent_where_its_contacts_are_opposed(tmp_path, monkeypatch):
    """Close to the core, far from the winding and the gap's air: its nose is as warm as neither; 9 % else."""
    monkeypatch.setenv("THERMOSCOPE_CACHE", str(tmp_path))
    machine = on_all(load_machine("tefc-industrial"))
    ready = meshed(machine, Meshing(0.1, 24, 1, 0.1))
    off = {}
    for opposed in (1.0, CASE.opposed_contacts):
        recipe = replace(CASE, random_points=2, joined_contacts=(5.0,), opposed_contacts=opposed)
        network = on_every_base(networks_of(machine, reduced(ready, recipe), recipe)[0])
        point = rated(machine, network, ready.films, ready.contacts)
        assert "slot.liner" not in point.watts
        near, far, film = "slot.liner|stator.core", "slot.liner|winding", "slot.liner.gap"
        there = replace(
            point,
            films={**point.films, film: 0.4 * point.films[film]},
            contacts={**point.contacts, near: 4.7 * point.contacts[near], far: 0.36 * point.contacts[far]},
        )
        rows = ready.field.blocks["slot.liner"].dofs
        exact, ours = (np.max(T[rows]) for T in (there.of_field(ready.field), there.of_network(network, ready.field)))
        off[opposed] = 100.0 * abs(ours / exact - 1.0)
    assert off[CASE.opposed_contacts] < 5.0 < off[1.0]
