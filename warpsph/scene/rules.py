"""What the schema allows at a place of a scene file."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any

from warpsph.scene.json_schema import scene_json_schema

Node = Mapping[str, Any]


@dataclass(frozen=True)
class Rule:
    """What the schema says about one place of a scene file.

    `node` speaks of any value, `branch` of the kind of value that stands there.
    """

    node: Node
    branch: Node

    @property
    def description(self) -> str:
        """What the value means, with unit and default."""
        return " ".join(self.node.get("description", "").split())

    @property
    def default_type(self) -> str | None:
        """The `type` of the object that stands here by default."""
        default = self.node.get("default")
        return default.get("type") if isinstance(default, dict) else None

    @property
    def keys(self) -> list[str]:
        """Keys that may stand in the mapping here; empty where the value is no mapping with fixed keys."""
        names = self.branch.get("propertyNames", {}).get("enum", ())
        return list(self.branch.get("properties", names))

    @property
    def types(self) -> list[str]:
        """Values that `type` may take here; empty where there is no choice."""
        unions = [node for node in _alternatives(self.node) if "discriminator" in node]
        return [tag for union in unions for tag in union["discriminator"]["mapping"]]

    @property
    def choices(self) -> list[str]:
        """Words that may stand here; empty where there is no choice of words."""
        nodes = _alternatives(self.node)
        return [
            str(word)
            for node in nodes
            for word in node.get("enum", [node["const"]] if "const" in node else [])
        ]

    @property
    def allowed(self) -> str:
        """Values that may stand here, in words."""
        return in_words(self.node)


def rule_at(path: Sequence[str | int], data: Any) -> Rule:
    """The rule for a place; `data` decides where the schema branches by `type`. Empty where none is known."""
    node: Node = _schema()
    for part in path:
        node = _child(_branch(node, data), part)
        data = _item(data, part)
    return Rule(node, _branch(node, data))


@cache
def _schema() -> dict[str, Any]:
    return scene_json_schema()


def _resolved(node: Node) -> Node:
    reference = node.get("$ref")
    if reference is None:
        return node
    return {
        **_schema()["$defs"][reference.rpartition("/")[2]],
        **{k: v for k, v in node.items() if k != "$ref"},
    }


def _alternatives(node: Node) -> list[Node]:
    node = _resolved(node)
    if "anyOf" in node:
        return [leaf for branch in node["anyOf"] for leaf in _alternatives(branch)]
    return [node]


def _branch(node: Node, data: Any) -> Node:
    """The alternative of a node that the data chose; empty where it chose none."""
    branches = [branch for alternative in _alternatives(node) for branch in _tagged(alternative, data)]
    kind = "object" if isinstance(data, dict) else "array" if isinstance(data, list) else None
    fitting = [branch for branch in branches if branch.get("type") == kind]
    return max(fitting, key=lambda branch: _fit(branch, data), default={})


def _tagged(node: Node, data: Any) -> list[Node]:
    """The branches of a union that are left once `type` has chosen; other nodes as they are."""
    if "oneOf" not in node:
        return [node]
    if "discriminator" not in node:
        return [_resolved(branch) for branch in node["oneOf"]]
    tag = data.get("type") if isinstance(data, dict) else None
    chosen = node["discriminator"]["mapping"].get(tag) if isinstance(tag, str) else None
    return [_resolved({"$ref": chosen})] if chosen else []


def _fit(branch: Node, data: Any) -> int:
    """How well the keys of the data suit an untagged branch."""
    keys = set(data) if isinstance(data, dict) else set()
    return len(keys & set(branch.get("properties", ()))) - len(set(branch.get("required", ())) - keys)


def _child(node: Node, part: str | int) -> Node:
    if isinstance(part, int):
        items = node.get("prefixItems", ())
        return items[part] if part < len(items) else node.get("items", {})
    if part in node.get("properties", {}):
        return node["properties"][part]
    free = [*node.get("patternProperties", {}).values(), node.get("additionalProperties")]
    return next((child for child in free if isinstance(child, dict)), {})


def _item(data: Any, part: str | int) -> Any:
    if isinstance(data, dict):
        return data.get(part)
    return data[part] if isinstance(data, list) and isinstance(part, int) and part < len(data) else None


def in_words(node: Node) -> str:
    """Values that a node of the schema allows."""
    null_first = sorted(_alternatives(node), key=lambda alternative: alternative.get("type") != "null")
    return " or ".join(dict.fromkeys(_kind_in_words(alternative) for alternative in null_first))


def _kind_in_words(node: Node) -> str:
    if "const" in node:
        return str(node["const"])
    if "enum" in node:
        return ", ".join(map(str, node["enum"]))
    if "discriminator" in node:
        return f"a mapping with a type: {', '.join(node['discriminator']['mapping'])}"
    if "oneOf" in node:
        return " or ".join(_kind_in_words(_resolved(branch)) for branch in node["oneOf"])
    return _KINDS[node["type"]](node) if "type" in node else ""


def _mapping_in_words(node: Node) -> str:
    keys = list(node.get("properties", ())) or node.get("propertyNames", {}).get("enum", ())
    return f"a mapping with the keys {', '.join(keys)}" if keys else "a mapping of names"


def _list_in_words(node: Node) -> str:
    shortest, longest = node.get("minItems", 0), node.get("maxItems")
    count = f"{shortest} " if shortest == longest else f"{shortest} or {longest} " if longest else ""
    item = next(iter(node.get("prefixItems", ())), node.get("items", {}))
    return f"a list of {count}values, each {in_words(item)}"


def _number_in_words(node: Node) -> str:
    noun = "a whole number" if node["type"] == "integer" else "a number"
    limits = [
        f"{word} {node[key]:g}"
        for key, word in (
            ("exclusiveMinimum", "greater than"),
            ("minimum", "at least"),
            ("exclusiveMaximum", "less than"),
            ("maximum", "at most"),
        )
        if key in node
    ]
    return " ".join([noun, " and ".join(limits)]).strip()


_KINDS: Mapping[str, Callable[[Node], str]] = {
    "null": lambda node: "null",
    "boolean": lambda node: "true or false",
    "string": lambda node: "text",
    "integer": _number_in_words,
    "number": _number_in_words,
    "array": _list_in_words,
    "object": _mapping_in_words,
}
