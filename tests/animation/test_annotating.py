"""What is painted on a picture of a movie."""

import pytest

from vtray.animation.annotating import annotated, check_annotate
from vtray.base.errors import OutputError


def test_texts_name_the_frame_and_its_time() -> None:
    given = {"title": "{frame:03d}", "time": "{time:.1f} ps", "axes": True, "labels": [1]}
    found = annotated(given, 7, 0.25, {"labels": [2], "legend": "x"})
    assert found == {
        "title": "007",
        "time": "0.2 ps",
        "axes": True,
        "labels": [1, 2],
        "legend": "x",
    }
    assert annotated({"frame": True, "time": True}, 7, 0.25, {}) == {"frame": 7, "time": 0.25}
    assert annotated({"time": 3.5}, None, None, {}) == {"time": 3.5}
    assert annotated({}, 7, 0.25, {}) == {}


@pytest.mark.parametrize("text", ["{}", "{x}", "{frame!z}", "{frame.x}", "{frame[0]}", "{frame:z}"])
def test_texts_that_are_not_understood(text: str) -> None:
    with pytest.raises(OutputError, match=r"title: expected \{frame\} and \{time\} alone in brac"):
        annotated({"title": text}, 7, 0.25, {})


def test_what_can_be_gone_through_but_once_is_for_all_pictures() -> None:
    labels = zip(["a", "b"], [(0, 0, 0), (1, 0, 0)], strict=True)
    legend = (pair for pair in [("O", "red")])
    found = check_annotate({"labels": labels, "legend": legend, "title": "x"})
    for _ in range(2):
        assert [text for text, _ in annotated(found, 0, 0.0, {})["labels"]] == ["a", "b"]
    assert found["legend"] == [("O", "red")]
    assert found["title"] == "x"


def test_what_is_not_known() -> None:
    for given in ({"time": True}, {"title": "{time}"}):
        with pytest.raises(OutputError, match="the data do not say the time of a picture"):
            annotated(given, 7, None, {})
