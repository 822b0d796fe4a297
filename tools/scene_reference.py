"""Write docs/scene.md, the reference of the scene file, from the schema."""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, get_args

from warpsph.scene import scene_json_schema
from warpsph.scene.expressions import FUNCTIONS
from warpsph.scene.probes import Probe
from warpsph.scene.rules import in_words

PAGE = Path(__file__).resolve().parents[1] / "docs" / "scene.md"

INTRODUCTION = f"""\
# The scene file

<!-- Written by tools/scene_reference.py from the schema; change it there. -->

A scene is a YAML 1.2 file. It says everything that defines a run. `warpsph run FILE` runs it; the same
objects build a scene from Python (`warpsph.scene`), and `Scene.to_yaml()` writes it back with every default
filled in.

- Units are SI: metres, seconds, kilograms, pascals; angles are in degrees. Two dimensions mean unit depth.
- Every vector has as many components as `dimension` says.
- Names of fluids, boundaries, structures, clamps, loads, probes and references are a letter, then letters,
  digits and underscores.
- An expression is arithmetic in `x`, `y`, `z` [m] and, where the time has a meaning, `t` [s]:
  `+ - * / % **`, comparisons, `pi`, and {", ".join(f"`{name}`" for name in sorted(FUNCTIONS))}.
- A CSV file has a header line; empty lines and lines that begin with `#` are skipped. File names count from
  the directory of the scene file.
- `--set key.sub=value` overrides any value, list items by their index: `--set fluids.water.shape.max.0=2`.
- Keys in **bold** are required.

For completion and checks in an editor, write the JSON schema to a file and name it in the first line of the
scene (VS Code with the YAML extension understands it):

```sh
warpsph schema > scene.schema.json
```
```yaml
# yaml-language-server: $schema=scene.schema.json
```

A whole scene:

```yaml
name: column
dimension: 2
spacing: 0.02
gravity: [0.0, -9.81]
time: {{end: 1.0, frame_rate: 50}}
fluids:
  water:
    shape: {{type: box, min: [0, 0], max: [1, 1]}}
    density: 1000
boundaries:
  tank:
    shape: {{type: box, min: [0, 0], max: [4, 2]}}
    side: outside
    open: [y_max]
probes:
  front: {{type: front, axis: x}}
```
"""

Node = Mapping[str, Any]
SCHEMA = scene_json_schema()
OBJECTS = (
    ("domain", "Domain"),
    ("time", "Time"),
    ("numerics", "Numerics"),
    ("fluids.*", "Fluid"),
    ("boundaries.*", "Boundary"),
    ("open_boundaries.*.shape", "PatchShape"),
    ("structures.*", "Structure"),
    ("structures.*.material", "Material"),
    ("structures.*.rigid", "Rigid"),
    ("structures.*.clamps.*", "Clamp"),
    ("numerics.structure", "StructureNumerics"),
    ("contact", "Contact"),
    ("output", "Output"),
    ("accuracy", "Accuracy"),
    ("validation", "Validation"),
)
UNIONS = (
    (
        "Shapes",
        "`shape` of fluids, boundaries and structures, `region` of clamps and loads",
        ("Boundary", "shape"),
    ),
    ("Motions", "each item of `motion` of boundaries and clamps", ("Boundary", "motion")),
    ("State", "`numerics.state`", ("Numerics", "state")),
    ("Density diffusion", "`numerics.density_diffusion`", ("Numerics", "density_diffusion")),
    ("Viscosity", "`numerics.viscosity`", ("Numerics", "viscosity")),
    ("Viscosity laws", "`law` of a viscous stress", ("ViscousStress", "law")),
    ("Particle order", "`numerics.particle_order`", ("Numerics", "particle_order")),
    ("Wall methods", "`numerics.wall`", ("Numerics", "wall")),
    ("Open boundaries", "each value of `open_boundaries`", None),
    ("Velocity profiles", "`velocity` of open boundaries", ("VelocityBoundary", "velocity")),
    ("Initial pressure", "`pressure` of fluids", ("Fluid", "pressure")),
    ("Loads", "each value of `loads` of structures", ("Structure", "loads")),
    ("Solutions", "`numerics.structure.solution`", ("StructureNumerics", "solution")),
    ("Probes", "each value of `probes`", None),
    ("References", "each value of `references`", None),
)
PARTS = (
    ("Bounds", "`bounds` of a plane, `domain.kill_box`", "Bounds"),
    ("Rotation", "`rotate` of a transform", "Rotation"),
    ("History in a file", "`history` of open boundaries", "HistoryTable"),
    ("Figure", "`accuracy.quantity`", "Figure"),
    ("Table in the scene", "`table` of a series reference", "InlineTable"),
    ("Table in a file", "`table` of a series reference", "FileTable"),
    ("Profile in the scene", "`table` of a profile reference", "InlineProfile"),
    ("Profile in a file", "`table` of a profile reference", "FileProfile"),
)


def page() -> str:
    """The whole text of the page."""
    blocks = [INTRODUCTION, "## Top level\n", *_table(SCHEMA)]
    for key, name in OBJECTS:
        blocks += [f"\n## `{key}`\n", f"{_text(_definition(name))}\n", *_table(_definition(name))]
    for title, place, source in UNIONS:
        blocks += [f"\n## {title}\n", f"Chosen by `type`: {place}.\n"]
        for tag, node in _choices(_union(title.lower().replace(" ", "_"), source)):
            blocks += [f"\n### `{tag}`\n", f"{_text(node)}{_columns(tag, title)}\n", *_table(node)]
    for title, place, name in PARTS:
        blocks += [
            f"\n## {title}\n",
            f"{_text(_definition(name))} Stands in {place}.\n",
            *_table(_definition(name)),
        ]
    return re.sub(r"\n{3,}", "\n\n", "\n".join(blocks)).rstrip() + "\n"


def _definition(name: str) -> Node:
    return SCHEMA["$defs"][name]


def _union(section: str, source: tuple[str, str] | None) -> Node:
    if source is None:
        return next(iter(SCHEMA["properties"][section]["patternProperties"].values()))
    name, key = source
    node = _definition(name)["properties"][key]
    named = node.get("patternProperties", {}).values()
    return next(iter(named), node.get("items", node))


def _choices(union: Node) -> Iterator[tuple[str, Node]]:
    for branch in union["oneOf"]:
        node = _definition(branch["$ref"].rpartition("/")[2])
        yield node["properties"]["type"]["const"], node


def _table(node: Node) -> list[str]:
    """A table of the keys of an object, without its tag; nothing where it has no other key."""
    keys = [key for key in node["properties"] if key != "type" or "const" not in node["properties"][key]]
    if not keys:
        return []
    required = node.get("required", ())
    keys.sort(key=lambda key: key not in required)
    rows = [_row(key, node["properties"][key], key in required) for key in keys]
    return ["| key | value | meaning |", "| --- | --- | --- |", *rows]


def _row(key: str, node: Node, required: bool) -> str:
    name = f"**`{key}`**" if required else f"`{key}`"
    value = re.sub(r"(a mapping with a type): [\w, ]+", r"\1", in_words(node))
    return f"| {name} | {value} | {_text(node)} |"


def _text(node: Node) -> str:
    return " ".join(node.get("description", "").split()).replace("|", "\\|")


def _columns(tag: str, title: str) -> str:
    """The columns that a probe writes in two and three dimensions."""
    if title != "Probes":
        return ""
    models = {model.model_fields["type"].default: model for model in get_args(get_args(Probe)[0])}
    probe = models[tag].model_construct()
    flat, solid = (", ".join(f"`{column}`" for column in probe.columns("NAME", d)) for d in (2, 3))
    return f" Columns: {flat}." if flat == solid else f" Columns in 2D: {flat}; in 3D: {solid}."


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
    sys.stdout.write(f"{PAGE}\n")
