"""The accuracy that a scene asks for: read as meant, or refused at its line."""

import pytest
from scene_texts import DAM_BREAK, problems_of

from warpsph.scene import scene_from_yaml
from warpsph.scene.references import Figure

FIGURE = '{column: "front.position[m]", feature: maximum}'


def asking(quantity: str = "front", within: str = "3%", more: str = "") -> str:
    return f"{DAM_BREAK}accuracy:\n  quantity: {quantity}\n  within: {within}\n  {more}\n"


@pytest.mark.parametrize("within", ["3%", "3 %", "0.03", "3.0%"])
def test_a_target_is_a_part_or_a_percentage(within: str) -> None:
    accuracy = scene_from_yaml(asking(within=within)).accuracy
    assert accuracy is not None
    assert accuracy.within == pytest.approx(0.03)
    assert accuracy.quantity == "front"


def test_a_figure_has_the_keys_of_feature_references() -> None:
    quantity = '{column: "front.position[m]", feature: arrival, threshold: 2.0, window: [0.1, 1.0]}'
    accuracy = scene_from_yaml(asking(quantity, more="pilots: [0.2, 0.1]")).accuracy
    assert accuracy is not None
    assert isinstance(accuracy.quantity, Figure)
    assert accuracy.quantity.threshold == 2.0
    assert accuracy.pilots == (0.2, 0.1)


def test_a_scene_writes_its_accuracy_back() -> None:
    scene = scene_from_yaml(asking(FIGURE))
    assert scene_from_yaml(scene.to_yaml()) == scene


@pytest.mark.parametrize(
    ("quantity", "within", "more", "key", "says"),
    [
        ("frnt", "3%", "", "accuracy.quantity", "there is no reference 'frnt'; did you mean 'front'?"),
        ("energy", "3%", "", "accuracy.quantity", "a limit is kept or not"),
        ("pressure", "3%", "", "accuracy.quantity", "norm: max"),
        ("[front]", "3%", "", "accuracy.quantity", "not allowed here"),
        ("{column: front, feature: mean}", "3%", "", "accuracy.quantity.column", "no probe column 'front'"),
        ("{feature: mean}", "3%", "", "accuracy.quantity.column", "missing"),
        (FIGURE.replace("maximum", "arrival"), "3%", "", "accuracy.quantity.threshold", "arrival needs it"),
        (FIGURE.replace("maximum", "maximu"), "3%", "", "accuracy.quantity.feature", "'maximum'"),
        (FIGURE, "three%", "", "accuracy.within", "not allowed here"),
        (FIGURE, "3", "", "accuracy.within", "too large"),
        (FIGURE, "0%", "", "accuracy.within", "too small"),
        (FIGURE, "3%", "pilots: [0.1]", "accuracy.pilots", "too few"),
        (FIGURE, "3%", "pilots: [0.1, 0.2]", "accuracy.pilots.1", "before it has 0.1 m"),
        (FIGURE, "3%", "pilots: [1.5, 0.2]", "accuracy.pilots.0", "larger than fluids.water.shape"),
        (FIGURE, "3%", "relative_to: 0", "accuracy.relative_to", "too small"),
        (FIGURE, "3%", "spacing: 1", "accuracy.spacing", "unknown key"),
    ],
)
def test_nonsense_is_refused_by_its_key(quantity: str, within: str, more: str, key: str, says: str) -> None:
    text = asking(quantity, within, more)
    (problem,) = problems_of(text)
    assert problem.key == key
    assert says in problem.message
    assert problem.allowed
    line = text.splitlines()[(problem.line or 0) - 1]
    assert line.strip().startswith(("quantity", "within", "pilots", "relative_to", "spacing"))


def test_a_reference_that_is_itself_refused_is_not_missed() -> None:
    text = asking("front").replace("    bound: 0.03\n", "    bound: -1\n")
    assert [problem.key for problem in problems_of(text)] == ["references.front.bound"]
