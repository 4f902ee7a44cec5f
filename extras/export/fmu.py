"""A functional mock-up unit (FMI 2.0 or 3.0, co-simulation) from a model: compiled C and its description."""

import hashlib
import io
import re
import zipfile
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any
from xml.etree.ElementTree import Element, SubElement, indent, tostring

import numpy as np

from extras.export.c_code import RUNTIME, c_files, heading
from extras.export.compilers import PLATFORMS, Platform, here, library
from extras.export.model import Model, Signal
from thermoscope import MissingDependency, plugin as th

STILL = (1980, 1, 1, 0, 0, 0)  # the date of every member: equal models give equal files
TOOL = "thermoscope"
Attributes = dict[str, Any]  # of an XML element
STEP_S = 1.0  # communication step that the file proposes


@dataclass(frozen=True)
class Variable:
    """One variable of the FMU.  causality : input, output, parameter or independent"""

    name: str
    causality: str
    start: float | None = None
    unit: str = ""
    about: str = ""
    low: float | None = None
    high: float | None = None


def identifier(model: Model) -> str:
    """The name of the library: letters, digits, underscores."""
    return "thermal_" + re.sub(r"\W", "_", model.name, flags=re.ASCII)


def variables(model: Model) -> list[Variable]:
    """All of them; the place in the list is the value reference."""
    out = [Variable(s.name, "input", start_of(s, model), s.unit, _range(s)) for s in model.signals]
    for o in model.outputs:
        error = "" if o.error_K is None else f"{o.error_K:.2f} K rms against measurements ({o.role} tests)"
        limit = "" if o.limit is None else f"limit {o.limit:g} degC"
        out.append(Variable(o.name, "output", None, "degC", "; ".join(filter(None, [limit, error]))))
    out += [
        Variable(f"start of {n}", "parameter", start, "degC", "first temperature")
        for n, start, is_node in zip(model.states, model.start_degC, model.node, strict=True)
        if is_node
    ]
    return [*out, Variable("time", "independent", None, "s")]


def _range(s: Signal) -> str:
    return "" if s.low is None or s.high is None else f"tests covered {s.low:.5g} to {s.high:.5g}"


def start_of(s: Signal, model: Model) -> float:
    return model.initial_degC if s in model.boundaries else 0.0


def token(model: Model) -> str:
    """Says which description belongs to which library: from the content of both."""
    content = hashlib.sha256(repr(sorted(c_files(model).items())).encode()).hexdigest()
    return "{" + "-".join(content[a:b] for a, b in ((0, 8), (8, 12), (12, 16), (16, 20), (20, 32))) + "}"


def sources(model: Model, version: int) -> dict[str, str]:
    """What is compiled."""
    states = np.flatnonzero(model.node)
    starts = ", ".join(f"{start_of(s, model):.17g}" for s in model.signals) or "0"
    lines = [
        f'#define FMU_TOKEN "{token(model)}"',
        f"#define THERMAL_NODES {states.size}",
        f"static const double START_SIGNAL[] = {{{starts}}};",
        f"static const double START_NODE[] = {{{', '.join(f'{model.start_degC[i]:.17g}' for i in states)}}};",
        f"static const int NODE_STATE[] = {{{', '.join(map(str, states))}}};",
    ]
    runtime_files = ("fmu.h", f"fmi{version}.c")
    fixed = {name: (RUNTIME / name).read_text(encoding="utf-8") for name in runtime_files}
    return {**c_files(model), **fixed, "thermal_network_fmu.h": "\n".join([*lines, ""])}


def fmu(model: Model, version: int, targets: Sequence[Platform] = PLATFORMS) -> tuple[bytes, list[str]]:
    """The file, and the platforms it runs on: those of `targets` for which a compiler is at hand.

    Raises MissingDependency where there is none for this computer.
    """
    files, name, folders = sources(model, version), identifier(model), []
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as archive:
        _put(archive, "modelDescription.xml", description(model, version))
        for target in sorted(targets, key=lambda t: t != here()):
            try:
                code = library(files, target)
            except MissingDependency:
                if target == here():
                    raise
                continue
            folder = target.fmi2 if version == 2 else target.fmi3
            _put(archive, f"binaries/{folder}/{name}{target.ending}", code)
            folders.append(folder)
        for file, text in files.items():
            _put(archive, f"sources/{file}", text)
        if version == 3:
            _put(archive, "sources/buildDescription.xml", _build(name, files))
        _put(archive, "documentation/README.txt", "\n".join([*map(th.visible, heading(model)), ""]))
    return out.getvalue(), folders


def _put(archive: zipfile.ZipFile, name: str, content: str | bytes) -> None:
    info = zipfile.ZipInfo(name, STILL)
    info.compress_type, info.external_attr = zipfile.ZIP_DEFLATED, 0o644 << 16
    archive.writestr(info, content)


def _text(root: Element) -> bytes:
    indent(root)
    for element in root.iter():
        element.attrib = {key: th.xml_text(value) for key, value in element.attrib.items()}
    return bytes(tostring(root, "UTF-8", xml_declaration=True))


def _build(name: str, files: dict[str, str]) -> bytes:
    root = Element("fmiBuildDescription", fmiVersion="3.0")
    build = SubElement(root, "BuildConfiguration", modelIdentifier=name)
    group = SubElement(build, "SourceFileSet", language="C99")
    for file in files:
        if file.endswith(".c"):
            SubElement(group, "SourceFile", name=file)
    return _text(root)


def description(model: Model, version: int) -> bytes:
    """modelDescription.xml"""
    key: Attributes = {"guid" if version == 2 else "instantiationToken": token(model)}
    root = Element(
        "fmiModelDescription",
        fmiVersion=f"{version}.0",
        modelName=model.name,
        generationTool=TOOL,
        description=heading(model)[0],
        variableNamingConvention="flat",
        **key,
    )
    _co_simulation(root, model, version)
    fmi_variables = variables(model)
    units = SubElement(root, "UnitDefinitions")
    for unit in dict.fromkeys(v.unit for v in fmi_variables if v.unit):
        SubElement(units, "Unit", name=unit)
    SubElement(root, "DefaultExperiment", startTime="0", stopTime="3600", stepSize=f"{STEP_S:g}")
    _variables(root, fmi_variables if version == 3 else fmi_variables[:-1], version)
    structure, outputs = SubElement(root, "ModelStructure"), range(len(fmi_variables))
    results = [i for i in outputs if fmi_variables[i].causality == "output"]
    if version == 2:
        for group in ("Outputs", "InitialUnknowns"):
            element = SubElement(structure, group)
            for i in results:
                SubElement(element, "Unknown", index=str(i + 1))
    else:
        for group in ("Output", "InitialUnknown"):
            for i in results:
                SubElement(structure, group, valueReference=str(i))
    return _text(root)


def _co_simulation(root: Element, model: Model, version: int) -> None:
    state = "state" if version == 2 else "State"
    can: Attributes = {
        f"canGetAndSetFMU{state}": "true",
        f"canSerializeFMU{state}": "true",
        "canHandleVariableCommunicationStepSize": "true",
    }
    if version == 2:
        can |= {"canInterpolateInputs": "true", "canNotUseMemoryManagementFunctions": "true"}
    element = SubElement(root, "CoSimulation", modelIdentifier=identifier(model), **can)
    if version == 2:
        files = SubElement(element, "SourceFiles")
        for file in sources(model, 2):
            if file.endswith(".c"):
                SubElement(files, "File", name=file)


def _variables(root: Element, variables: Sequence[Variable], version: int) -> None:
    element = SubElement(root, "ModelVariables")
    for reference, v in enumerate(variables):
        attributes: Attributes = {"name": v.name, "valueReference": str(reference), "causality": v.causality}
        attributes["variability"] = "fixed" if v.causality == "parameter" else "continuous"
        if v.about:
            attributes["description"] = v.about
        if v.causality == "output":
            attributes["initial"] = "calculated"
        if v.causality == "parameter":
            attributes["initial"] = "exact"
        value: Attributes = {"unit": v.unit} | ({} if v.start is None else {"start": f"{v.start:.17g}"})
        if version == 2:
            SubElement(SubElement(element, "ScalarVariable", **attributes), "Real", **value)
        else:
            SubElement(element, "Float64", **attributes, **value)
