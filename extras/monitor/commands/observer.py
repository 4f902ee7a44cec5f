"""thermoscope use export CASE --as observer"""

from collections.abc import Mapping, Sequence
from pathlib import Path

from thermoscope import plugin as th


def export_observer(
    case: str, out: Path | None, limits: Mapping[str, float], names: Sequence[str], target: str | None
) -> int:
    """The observer of a case in C99."""
    import numpy as np

    from extras.monitor.observer_code import code_writer, observer_files, observer_model
    from extras.monitor.rows.observing import chosen, designed, less_sure, model_gap, taught_tests

    with th.progress() as tell:
        whole = th.open_case(case, tell)
        folder = whole.small  # a controller's memory is short
        looks, of_whole = (code_writer().outputs(th.model_of(f)[0], f, limits) for f in (folder, whole))
        gap: dict[str, float] = {}
        if folder is not whole:
            tell("small network beside the large one")
            rows = [{o.name: o.row for o in each} for each in (of_whole, looks)]
            gap = model_gap([th.model_of(whole), th.model_of(folder)], taught_tests(whole), rows)
            folder = less_sure(folder, gap)
        channels = {c.name: c for t in folder.case.tests for c in t.channels}
        sensors = chosen([*channels.values()], names, str(folder.settings.path))
        design = designed(folder, tell)
        tell("writing the observer")
        filters = [design.as_learned(c) for c in sensors]
        learned, bias = [s.channel for s in filters], np.array([s.bias_K for s in filters])
        reference = th.standing_reference(folder.case)
        of = observer_model(design.process, design.noise, design.rise_K, learned, reference, looks, bias)
    where = out or folder.settings.out / "observer"
    paths = [th.write_whole(where / name, text) for name, text in observer_files(of).items()]
    document = {
        "case": folder.case.name,
        "revision": folder.case.model.revision,
        "as": "observer",
        "files": [str(p) for p in paths],
        "state_bytes": of.bytes,
        "inputs": of.input_names,
        "sensors": [c.name for c in sensors],
        "missing_heat": of.process.bodies,
        "outputs": [o.name for o in looks],
        "small_network_K": gap,
    }
    sentence = f"An observer of {th.counted(len(sensors), 'sensor')}, {of.bytes} bytes from step to step."
    if gap:
        sentence += f" Its small network is within {max(gap.values()):.2g} K (rms) of the large one in the calibration."
    th.give(document, target, lambda: th.Summary(sentence, [str(p) for p in paths], "--json FILE has all numbers"))
    return 0
